//! The fields of an EML document on a grid: how they start, spread and react.
//!
//! A document keeps its own units of time and length; the fields are moved in µm and s, and their values are
//! concentrations in the unit that the document gives them.

use super::beside::Beside;
use super::carry::Carrying;
use super::clock::clock;
use super::course::Course;
use super::grid::Grid;
use super::joint::{Alone, Joint};
use super::layout::{Placing, describe, layout, unit};
use super::lines;
use super::noise::Noise;
use super::profiles::profiles;
use super::reactor::Reactor;
use super::scales::{POSITION, Scales, in_circle};
use super::scene::Scene;
use super::species::Species;
use super::state::Fields;
use super::step::{Acts, Report, Stepping};
use super::transport::Transport;
use crate::equations::program::{Program, initial_values};
use crate::equations::tree::{QuantityId, Role, System};
use crate::equations::{Range, eml};
use crate::error::{Error, Fault, Location, Result};
use crate::ode::{Kick, Numbers};

/// Gives the values of a profile that lies in a file, its `scale` included: one for each box of the grid, x fastest.
pub type LoadProfile<'a> = dyn Fn(&eml::Profile, &Grid) -> Result<Vec<f64>> + 'a;

/// Relative and absolute tolerance of a step where no document says any and fields react: by a table of problems (the book, Fields); no
/// absolute one, as nothing is known of units, so that no number is small by itself.
const REACTING: (f64, f64) = (3e-3, 0.0);

/// The same where nothing reacts, and what is wrong in a step spreads and decays.
const SPREADING: (f64, f64) = (1e-3, 1e-6);

/// The fields of one document on one grid. It never changes; what does is in [`Fields`].
#[derive(Debug, Clone)]
pub struct FieldSystem {
    name: String,
    /// The equations, in the document's own units.
    system: System,
    grid: Grid,
    species: Vec<Species>,
    units: Vec<String>,
    starts: Vec<Start>,
    inputs: Vec<(String, f64)>,
    /// None where nothing reacts.
    reactor: Option<Reactor>,
    /// None where no field is carried.
    transport: Option<Transport>,
    /// None where there is no noise.
    noise: Option<Noise>,
    /// Tells when the clock switches something; none where it does not.
    clock: Option<Program>,
    /// None where there are fields alone.
    beside: Option<Beside>,
    ranges: Vec<Range>,
    scales: Scales,
}

/// How a field starts.
#[derive(Debug, Clone)]
struct Start {
    quantity: QuantityId,
    profile: eml::Profile,
    location: Location,
}

impl Start {
    fn of(field: &eml::FieldDescription) -> Self {
        Self { quantity: field.quantity, profile: field.initial.clone(), location: field.location.clone() }
    }
}

impl FieldSystem {
    /// Puts the fields of a document on its grid. What the document leaves open is taken from `placing`. A side that is
    /// no multiple of the spacing is lengthened at its upper end, so that the spacing is kept.
    ///
    /// # Errors
    /// All faults with their locations: a grid that nothing places, with fewer than 4 boxes along an axis or more than
    /// memory holds; coefficients and walls without meaning; a scheme that reactions cannot be taken with.
    pub fn new(document: &eml::Document, placing: Option<&Placing>) -> Result<Self> {
        let grid = layout(document, placing)?;
        let mut faults = Vec::new();
        let scales = Scales {
            seconds: document.seconds,
            micrometres: document.grid.as_ref().map_or(1.0, |grid| grid.micrometres),
        };
        let beside = Beside::new(document, &grid, scales)?;
        let document = &document.fields_alone();
        let system = &document.system;
        let constants = initial_values(system, 0.0).map_err(|circle| in_circle(document, &circle))?;
        let mut species = Vec::new();
        for field in &document.fields {
            let one = describe(field, system, &constants, scales);
            match one.check(&grid) {
                Err(Error::Input(more)) => {
                    faults.extend(more.into_iter().map(|fault| fault.at(field.location.clone())))
                }
                Err(other) => return Err(other),
                Ok(()) => {}
            }
            species.push(one);
        }
        let reactor = Reactor::new(document, scales).map_err(|error| match error {
            Error::Input(more) => faults.extend(more),
            _ => unreachable!("a reactor only finds faults"),
        });
        let (true, Ok(reactor)) = (faults.is_empty(), reactor) else { return Err(Error::Input(faults)) };
        let transport = Transport::new(document, &grid, &constants, scales)?;
        let given = |quantity: &&crate::equations::tree::Quantity| {
            quantity.role == Role::Input && !POSITION.contains(&quantity.id.as_str())
        };
        let default = |id: &String| system.find(id).map_or(0.0, |number: QuantityId| constants[number as usize]);
        let inputs = system.quantities.iter().filter(given).map(|input| (input.id.clone(), default(&input.id)));
        Ok(Self {
            name: document.name.clone(),
            inputs: inputs.collect(),
            units: document.fields.iter().map(|field| unit(system, field)).collect(),
            starts: document.fields.iter().map(Start::of).collect(),
            system: system.clone(),
            clock: clock(document)?,
            beside,
            grid,
            ranges: species.iter().map(|species| species.range).collect(),
            species,
            reactor,
            noise: Noise::new(document, scales)?,
            transport,
            scales,
        })
    }

    /// The grid, in µm.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// What the fields are kicked by, to be looked at as a whole; none where there is no noise.
    pub fn noise(&self) -> Option<&impl std::fmt::Debug> {
        self.noise.as_ref()
    }

    /// What carries the fields, to be looked at as a whole; none where nothing does.
    pub fn transport(&self) -> Option<&impl std::fmt::Debug> {
        self.transport.as_ref()
    }

    /// What stands beside the fields; none where they are alone.
    pub fn beside(&self) -> Option<&Beside> {
        self.beside.as_ref()
    }

    /// The relative and absolute tolerance of a step where nobody says any.
    pub fn usual_tolerance(&self) -> (f64, f64) {
        if self.is_acted_on() || self.beside.is_some() { REACTING } else { SPREADING }
    }

    /// Whether anything acts on the fields beside diffusion and decay.
    fn is_acted_on(&self) -> bool {
        self.reactor.is_some() || self.transport.is_some()
    }

    /// The document's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The equations, in the document's own units.
    pub fn equations(&self) -> &System {
        &self.system
    }

    /// The fields in the order of the document, their coefficients in µm and s.
    pub fn species(&self) -> &[Species] {
        &self.species
    }

    /// The unit of each field's values, as the document writes it; empty where it has none.
    pub fn units(&self) -> &[String] {
        &self.units
    }

    /// The index of a field among the species.
    pub fn species_number(&self, id: &str) -> Option<usize> {
        self.species.iter().position(|species| species.name == id)
    }

    /// Inputs of the document with their defaults, in the order in which [`Self::advance`] takes them.
    pub fn inputs(&self) -> &[(String, f64)] {
        &self.inputs
    }

    /// The number of a quantity of the document.
    pub fn quantity(&self, id: &str) -> Option<QuantityId> {
        self.system.find(id)
    }

    /// Fields without any substance in them, for the values of others.
    ///
    /// # Panics
    /// Never: grid and species have been checked.
    pub fn empty(&self) -> Fields {
        Fields::new(self.grid.clone(), self.species.clone()).expect("grid and species were checked")
    }

    /// The fields at time 0, as their profiles have them.
    ///
    /// # Errors
    /// Values that are not finite or, of a concentration, negative, with the field's location in the document; what `load`
    /// finds.
    pub fn start(&self, load: &LoadProfile) -> Result<Fields> {
        let mut fields = Fields::new(self.grid.clone(), self.species.clone())?;
        let mut faults = Vec::new();
        let mut take = |fields: &mut Fields, number: usize, values: Result<Vec<f64>>| -> Result<()> {
            match values.and_then(|values| fields.set_values(number, &values)) {
                Err(Error::Input(more)) => {
                    let location = &self.starts[number].location;
                    let located =
                        |fault: Fault| if fault.location.is_none() { fault.at(location.clone()) } else { fault };
                    faults.extend(more.into_iter().map(located));
                    Ok(())
                }
                other => other,
            }
        };
        let mut starts = Vec::new();
        for (number, start) in self.starts.iter().enumerate() {
            let from_file = !matches!(start.profile, eml::Profile::Expression(_));
            if from_file {
                take(&mut fields, number, load(&start.profile, &self.grid))?;
            }
            starts.push((start.quantity, from_file.then(|| fields.values(number).to_vec())));
        }
        let computed = profiles(&self.system, &self.grid, self.scales, starts)
            .map_err(|circle| Error::input(Fault::new(format!("a circle of {}", circle.join(", ")))))?;
        for (number, values) in computed.into_iter().enumerate() {
            take(&mut fields, number, Ok(values))?;
        }
        if faults.is_empty() { Ok(fields) } else { Err(Error::Input(faults)) }
    }

    /// Moves the fields by a window of time, s, with what stands beside them. Those of the inputs that it gives are written, the others stand still;
    /// there is one for each of [`Self::inputs`].
    ///
    /// # Errors
    /// Numbers that fail in either; both then hold anything.
    ///
    /// # Panics
    /// As [`Self::advance`], and where nothing stands beside the fields.
    pub fn advance_with(
        &self,
        fields: &mut Fields,
        window: f64,
        inputs: &mut [f64],
        stepping: Stepping,
        scene: Scene,
    ) -> Result<Report> {
        self.joint(fields, inputs, stepping, scene, |mut joint| joint.run(window))
    }

    /// Lets fields and what stands beside them see each other as they are.
    ///
    /// # Panics
    /// As [`Self::advance_with`].
    pub fn look(&self, fields: &mut Fields, inputs: &mut [f64], scene: Scene) {
        self.joint(fields, inputs, Stepping::Fixed(1), scene, |mut joint| joint.look());
    }

    /// The same, and executes the events that are due: at a start, or when an input has been set. Returns whether there were any.
    ///
    /// # Errors
    /// As [`Self::advance_with`].
    ///
    /// # Panics
    /// As [`Self::advance_with`].
    pub fn settle(&self, fields: &mut Fields, inputs: &mut [f64], scene: Scene) -> Result<bool> {
        self.joint(fields, inputs, Stepping::Fixed(1), scene, |mut joint| joint.settle())
    }

    /// Does something with the fields and what stands beside them.
    fn joint<T>(
        &self,
        fields: &mut Fields,
        inputs: &mut [f64],
        stepping: Stepping,
        scene: Scene,
        work: impl FnOnce(Joint) -> T,
    ) -> T {
        assert_eq!(inputs.len(), self.inputs.len(), "one number for each input of '{}'", self.name);
        let beside = self.beside.as_ref().expect("something stands beside the fields");
        let advance = |fields: &mut Fields, window: f64, inputs: &[f64], stepping: Stepping| {
            self.advance(fields, window, inputs, stepping)
        };
        let alone = Alone {
            name: &self.name,
            scales: self.scales,
            ranges: &self.ranges,
            are_acted_on: self.is_acted_on(),
            advance: &advance,
        };
        work(Joint { alone, beside, fields, inputs, scene, stepping, report: Report::default() })
    }

    /// Moves the fields by a window of time, s. The inputs stand still within it; there is one for each of
    /// [`Self::inputs`].
    ///
    /// # Errors
    /// Numbers that fail: the message names document, field, time and position, and the fields are as they were before.
    ///
    /// # Panics
    /// When the fields are not this system's, or there is not one input for each.
    pub fn advance(&self, fields: &mut Fields, window: f64, inputs: &[f64], stepping: Stepping) -> Result<Report> {
        assert_eq!(inputs.len(), self.inputs.len(), "one number for each input of '{}'", self.name);
        assert_eq!(fields.species().len(), self.species.len(), "the fields of '{}'", self.name);
        let Some(clock) = &self.clock else { return self.advance_piece(fields, window, inputs, stepping) };
        fields.in_pieces(clock, window, self.scales.seconds, |fields, length, share| {
            let stepping = match stepping {
                Stepping::Fixed(steps) => Stepping::Fixed((f64::from(steps) * share).ceil().max(1.0) as u32),
                adaptive => adaptive,
            };
            self.advance_piece(fields, length, inputs, stepping)
        })
    }

    /// The same where the clock switches nothing.
    fn advance_piece(&self, fields: &mut Fields, window: f64, inputs: &[f64], stepping: Stepping) -> Result<Report> {
        let carrying = self.transport.as_ref().map(|transport| Carrying { transport, inputs, window });
        let Some(reactor) = &self.reactor else {
            let acts = Acts { reactions: None, carrying };
            return fields.advance_all(window, stepping, acts).map_err(|error| self.named(error));
        };
        let course = Course::new(reactor, &self.grid, inputs, matches!(stepping, Stepping::Adaptive { .. }));
        let react = |chunk: &mut super::react::Chunk| course.react(chunk);
        let acts = Acts { reactions: Some(&react), carrying };
        fields.advance_all(window, stepping, acts).map_err(|error| {
            let broken = course.broken().map(|broken| broken.error(&self.name, &self.species, &self.grid));
            broken.unwrap_or_else(|| self.named(error))
        })
    }

    /// Kicks the fields by noise at the time that they have reached, eq. (noise.4). The inputs are those of [`Self::advance`], the time that the
    /// kick stands for is in s.
    ///
    /// # Errors
    /// Values that are not finite then: the message names document, field, time and position.
    ///
    /// # Panics
    /// As [`Self::advance`].
    pub fn kick(&self, fields: &mut Fields, inputs: &[f64], kick: Kick, numbers: Numbers) -> Result<()> {
        assert_eq!(inputs.len(), self.inputs.len(), "one number for each input of '{}'", self.name);
        assert_eq!(fields.species().len(), self.species.len(), "the fields of '{}'", self.name);
        let Some(noise) = &self.noise else { return Ok(()) };
        noise.kick(fields, inputs, kick, numbers);
        fields
            .check_finite("its noise is no number there; check it for roots of what is negative")
            .map_err(|error| self.named(error))
    }

    /// What [`Self::advance`] does by the method of lines, without noise: the differential equations of all boxes at once, handed to the engine's
    /// explicit method of order 5. For small grids, as the measure of [`Self::advance`].
    ///
    /// # Errors
    /// More than 4 000 values, and what the engine meets.
    ///
    /// # Panics
    /// As [`Self::advance`].
    pub fn reference(&self, fields: &Fields, window: f64, inputs: &[f64], rtol: f64, atol: f64) -> Result<Fields> {
        assert_eq!(inputs.len(), self.inputs.len(), "one number for each input of '{}'", self.name);
        if self.transport.is_some() {
            let fault =
                Fault::new(format!("the method of lines takes diffusion alone, and '{}' has transport", self.name));
            return Err(Error::input(fault.help("compare it with a finer grid and smaller steps")));
        }
        let inputs: Vec<(&str, f64)> =
            self.inputs.iter().zip(inputs).map(|((id, _), value)| (id.as_str(), *value)).collect();
        lines::solve_lines(&self.system, self.scales, fields, window, &inputs, [rtol, atol])
    }

    /// An error of the fields with the document's name.
    fn named(&self, error: Error) -> Error {
        match error {
            Error::Numbers { message, help, kept } => {
                Error::Numbers { message: format!("document '{}': {message}", self.name), help, kept }
            }
            other => other,
        }
    }
}
