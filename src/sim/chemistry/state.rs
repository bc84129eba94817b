//! Where chemistry is: part of the state, and so of a checkpoint.

use serde::{Deserialize, Serialize};

use super::super::atom_controls::AtomControls;
use super::super::controls::Controls;
use super::super::model::Model;
use super::field_values::FieldValues;
use super::links::{Control, Owner, Target, Whose};
use super::model::{Members, Reactor};
use crate::field::{Fields, ScenePace};
use crate::membrane::{MembraneCells, MembraneState};
use crate::ode::{EventMemory, Numbers, Population};

/// Everything of chemistry that changes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ChemistryState {
    /// One population a system; the scene is a population of one.
    pub populations: Vec<Population>,
    /// What each member of a system knows of its events, one list a system; empty where a system has none.
    pub events: Vec<Vec<EventMemory>>,
    /// What is on the membranes of cells, one entry a system; empty where it has none.
    pub membranes: Vec<MembraneState>,
    /// Time that each system has reached, s.
    pub times: Vec<f64>,
    /// How often noise has kicked each system.
    pub kicks: Vec<u64>,
    /// One entry a document of fields.
    pub fields: Vec<FieldState>,
    /// What links set for mechanics.
    pub controls: Controls,
    /// Whether links have carried the numbers of this instant.
    pub carried: bool,
    /// Whether systems were told means in the step that led here.
    pub told_means: bool,
}

/// The fields of one document.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FieldState {
    /// `[species][box]`, in the document's unit of concentration.
    pub values: FieldValues,
    /// The pace of the adaptive steps.
    pub pace: (u32, u32),
    /// Values of the document's inputs.
    pub inputs: Vec<f64>,
    /// How often noise has kicked them.
    pub kicks: u64,
    /// The pace of steps with what stands beside them.
    pub scene: ScenePace,
}

impl ChemistryState {
    /// The start of so many cells of each kind: systems at their initial values, `fields` as they start.
    pub fn new(model: &Model, cells: &[usize], fields: &[Fields]) -> Self {
        let chemistry = &model.chemistry;
        let reactors = &chemistry.reactors;
        let members = |reactor: &Reactor| reactor.members.count(|kind| cells[kind]);
        let populations = reactors.iter().map(|reactor| {
            let mut population = Population::new(&reactor.program, members(reactor), reactor.method);
            let first = |kind: usize| cells[..kind].iter().sum::<usize>() as u64;
            let ids = |kind: &usize| first(*kind)..first(*kind) + cells[*kind] as u64;
            match &reactor.members {
                Members::Scene => draw_start(model.seed, reactor, &mut population, 0, 0),
                Members::Kinds(kinds) => kinds.iter().flat_map(ids).enumerate().for_each(|(member, id)| {
                    draw_start(model.seed, reactor, &mut population, member, id);
                }),
            }
            population
        });
        let events = |reactor: &Reactor| match reactor.events.is_empty() {
            true => Vec::new(),
            false => vec![reactor.events.before_start(0.0); members(reactor)],
        };
        let membrane = |reactor: &Reactor| match (&reactor.membrane, &reactor.members) {
            (Some(membrane), Members::Kinds(own)) => membrane.state(own, &model.kinds, cells),
            _ => MembraneState::default(),
        };
        let field = |(fields, reactor): (&Fields, &super::FieldReactor)| FieldState {
            values: (0..fields.species().len()).flat_map(|s| fields.values(s)).copied().collect::<Vec<_>>().into(),
            pace: fields.pace(),
            inputs: reactor.system.inputs().iter().map(|(_, value)| *value).collect(),
            kicks: 0,
            scene: ScenePace::default(),
        };
        Self {
            populations: populations.collect(),
            events: reactors.iter().map(events).collect(),
            membranes: reactors.iter().map(membrane).collect(),
            times: vec![0.0; reactors.len()],
            kicks: vec![0; reactors.len()],
            fields: fields.iter().zip(&chemistry.fields).map(field).collect(),
            controls: controls_of(model, cells),
            carried: false,
            told_means: false,
        }
    }

    /// Copies another of the same shape without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        copy_each(&mut self.populations, &other.populations, Population::copy_from);
        copy_each(&mut self.events, &other.events, |to, from| copy_each(to, from, EventMemory::copy_from));
        copy_each(&mut self.membranes, &other.membranes, |to, from| {
            copy_each(&mut to.kinds, &from.kinds, MembraneCells::copy_from);
        });
        self.times.clone_from(&other.times);
        self.kicks.clone_from(&other.kicks);
        if self.fields.len() != other.fields.len() {
            self.fields.clone_from(&other.fields);
        }
        for (to, from) in self.fields.iter_mut().zip(&other.fields) {
            to.values.copy_from(&from.values);
            to.inputs.clone_from(&from.inputs);
            (to.pace, to.kicks, to.scene) = (from.pace, from.kicks, from.scene);
        }
        self.controls.copy_from(&other.controls);
        (self.carried, self.told_means) = (other.carried, other.told_means);
    }

    /// Takes a system with its events and its time as it is in another state of the same shape.
    pub fn take_system(&mut self, other: &Self, number: usize) {
        self.populations[number].copy_from(&other.populations[number]);
        copy_each(&mut self.events[number], &other.events[number], EventMemory::copy_from);
        (self.times[number], self.kicks[number]) = (other.times[number], other.kicks[number]);
    }

    /// Writes NaN over all numbers and forgets what is held in lists.
    pub fn poison(&mut self) {
        self.populations.clear();
        self.events.clear();
        self.membranes.clear();
        self.times.fill(f64::NAN);
        self.kicks.fill(u64::MAX);
        for field in &mut self.fields {
            field.kicks = u64::MAX;
            field.values.fill(f64::NAN);
            field.inputs.fill(f64::NAN);
        }
        self.controls = Controls::default();
    }

    /// Whether a checkpoint has the shape of a fresh start, at times that can be.
    pub fn has_shape_of(&self, other: &Self) -> bool {
        let cells = |a: &Population, b: &Population| a.cells() == b.cells() && a.has_shape_of(b);
        let knows = |a: &EventMemory, b: &EventMemory| a.has_shape_of(b);
        let events =
            |a: &[EventMemory], b: &[EventMemory]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| knows(a, b));
        let surfaces = |a: &MembraneState, b: &MembraneState| {
            a.kinds.len() == b.kinds.len() && a.kinds.iter().zip(&b.kinds).all(|(a, b)| a.has_shape_of(b))
        };
        let boxes =
            |a: &FieldState, b: &FieldState| (a.values.len(), a.inputs.len()) == (b.values.len(), b.inputs.len());
        self.populations.len() == other.populations.len()
            && self.times.len() == other.times.len()
            && self.times.iter().all(|time| time.is_finite())
            && self.kicks.len() == other.kicks.len()
            && self.membranes.len() == other.membranes.len()
            && self.membranes.iter().zip(&other.membranes).all(|(a, b)| surfaces(a, b))
            && self.events.len() == other.events.len()
            && self.fields.len() == other.fields.len()
            && self.populations.iter().zip(&other.populations).all(|(a, b)| cells(a, b))
            && self.events.iter().zip(&other.events).all(|(a, b)| events(a, b))
            && self.fields.iter().zip(&other.fields).all(|(a, b)| boxes(a, b))
    }
}

/// Gives a member of a system the start that is drawn for a cell with this id; nothing where none is.
pub(super) fn draw_start(seed: u64, reactor: &Reactor, population: &mut Population, member: usize, id: u64) {
    let Some(starts) = &reactor.starts else { return };
    let values = starts.values(Numbers { seed, system: &reactor.name }, id);
    values.iter().enumerate().for_each(|(variable, &value)| population.set_state(member, variable, value));
}

/// Makes a list the same as another, its first things without allocating, where `copy` does not.
fn copy_each<T: Clone>(to: &mut Vec<T>, from: &[T], copy: impl Fn(&mut T, &T)) {
    to.truncate(from.len());
    to.iter_mut().zip(from).for_each(|(to, from)| copy(to, from));
    to.extend_from_slice(&from[to.len()..]);
}

/// The lists that the links of a model write, at numbers that change nothing.
fn controls_of(model: &Model, counts: &[usize]) -> Controls {
    let cells = counts.iter().sum();
    let secretion = vec![vec![0.0; cells]; model.chemistry.secreted.len()];
    let mut controls = Controls { secretion, ..Controls::default() };
    let set = model.chemistry.links.iter().filter_map(|link| link.to.control());
    set.for_each(|control| controls.admit(control, cells));
    admit_atoms(model, counts, &mut controls);
    controls
}

/// Makes the lists that links write at atoms, where there are none.
pub(super) fn admit_atoms(model: &Model, counts: &[usize], controls: &mut Controls) {
    for link in &model.chemistry.links {
        let Target::Cell(whose, Control::Atoms(control)) = link.to else { continue };
        controls.of_atoms.resize_with(model.kinds.len(), AtomControls::default);
        let kinds = match (whose, link.owner) {
            (Whose::Kind(kind), _) => vec![kind],
            (Whose::Own, Owner::Reactor(number)) => match &model.chemistry.reactors[number].members {
                Members::Kinds(kinds) => kinds.clone(),
                Members::Scene => Vec::new(),
            },
            // The kind of a single cell is found when it is set.
            _ => (0..model.kinds.len()).collect(),
        };
        for kind in kinds {
            controls.of_atoms[kind].admit(control, counts[kind] * model.kinds[kind].atoms());
        }
    }
}
