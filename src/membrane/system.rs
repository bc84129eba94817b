//! A document of membranes, compiled: a program for the atoms of the surface, one for the inside of a cell, one for the start.

use crate::equations::eml::{Document, SURFACE, Taken};
use crate::equations::program::Program;
use crate::equations::tree::{Expr, QuantityId, Role, System};
use crate::ode::clocked;

/// How a window is cut into steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MembraneStepping {
    /// So that the error of a step stays below the tolerances, eq. (surface.6).
    Adaptive {
        /// Relative to the size of a variable.
        relative: f64,
        /// In its own unit.
        absolute: f64,
    },
    /// Into equal steps no longer than this, in the document's unit of time; the tolerances are those of the linear solver.
    Longest {
        /// The step.
        step: f64,
        /// As above.
        relative: f64,
        /// As above.
        absolute: f64,
    },
}

impl MembraneStepping {
    /// Relative and absolute tolerance.
    pub(super) fn tolerances(self) -> (f64, f64) {
        match self {
            Self::Adaptive { relative, absolute } | Self::Longest { relative, absolute, .. } => (relative, absolute),
        }
    }
}

/// What a slot of a program is filled with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Slot {
    /// A component of the position from the centre of the surface.
    Position(usize),
    /// A pool, by its number.
    Pool(usize),
    /// What is set of the inside from outside, by its number.
    Open(usize),
    /// What is set of an atom from outside, by its number.
    Given(usize),
    /// Area of the cell.
    Area,
    /// Volume of the cell.
    Volume,
}

/// A number taken from the surface: its number among the open quantities of the inside.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sum {
    pub open: usize,
    pub taken: Taken,
}

/// The compiled document of a membrane. It never changes; what does is in [`MembraneState`](super::MembraneState) and, pools and
/// inputs, in the population of the inside.
#[derive(Debug, Clone)]
pub struct MembraneSystem {
    /// Rates on the surface; further groups are the integrands of the sums, the strengths of noise, and what is shown of atoms, each in one of
    /// its own.
    pub(super) surface: Program,
    /// The pools, with the sums, area, volume and the inputs of the document open; the only further group are the strengths of noise.
    pub(super) inside: Program,
    /// All variables at the start: what its only further group says, those of the surface first.
    pub(super) start: Program,
    /// Tells when the clock switches something in all cells; none where it does not.
    pub(super) clock: Option<Program>,
    pub(super) slots: Vec<Slot>,
    pub(super) start_slots: Vec<Slot>,
    /// Where area and volume stand among the open quantities of the inside.
    pub(super) measures: [usize; 2],
    pub(super) sums: Vec<Sum>,
    /// Diffusion coefficients of the variables on the surface, µm² per unit of time.
    pub(super) diffusion: Vec<f64>,
    /// The variables on the surface, and the pools, that have noise.
    pub(super) noisy: [Vec<usize>; 2],
    /// What is set of atoms from outside: the quantity, and what it is until it is set.
    pub(super) given: Vec<(QuantityId, f64)>,
    /// Of each variable on the surface identifier and unit.
    pub names: Vec<(String, String)>,
    /// How windows are cut.
    pub stepping: MembraneStepping,
    /// Whether the equations use the volume of the cell.
    pub uses_volume: bool,
}

impl MembraneSystem {
    /// Compiles a document of membranes; `shown` are expressions of its quantities that [`Self::show`] works out at all atoms.
    ///
    /// # Errors
    /// The identifiers along a circle of definitions or initial values.
    ///
    /// # Panics
    /// When the document is of another level.
    pub fn new(document: &Document, stepping: MembraneStepping, shown: &[Expr]) -> Result<Self, Vec<String>> {
        let membrane = document.membrane.as_ref().expect("a document of membranes");
        let system = &document.system;
        let on_surface: Vec<QuantityId> = membrane.surface.iter().map(|variable| variable.quantity).collect();
        let pools: Vec<QuantityId> = system.variables().into_iter().filter(|q| !on_surface.contains(q)).collect();
        let (surface, inside, start) = (outer(system, &pools), inner(system, &membrane.local), beginning(system));
        let integrands: Vec<Expr> = membrane.totals.iter().map(|total| total.integrand.clone()).collect();
        let variables: Vec<Expr> = on_surface.iter().chain(&pools).map(|number| Expr::Quantity(*number)).collect();
        let [(noisy, strengths), (noisy_pools, of_pools)] = noise(document, &on_surface);
        let noisy = [noisy, noisy_pools];
        let groups: Vec<Vec<Expr>> =
            [integrands, strengths].into_iter().chain(shown.iter().map(|one| vec![one.clone()])).collect();
        let surface = Program::with(&surface, 0.0, &[], &groups)?;
        let inside = Program::with(&inside, 0.0, &[], &[of_pools])?;
        let start = Program::with(&start, 0.0, &[], &[variables])?;
        let open = |id: &str| system.find(id).and_then(|quantity| inside.open_index(quantity)).unwrap_or(usize::MAX);
        let slot = |quantity: &QuantityId| -> Slot {
            let id = system.quantities[*quantity as usize].id.as_str();
            if let Some(given) = membrane.given.iter().position(|given| given == quantity) {
                return Slot::Given(given);
            }
            match (SURFACE.iter().position(|known| *known == id), pools.iter().position(|pool| pool == quantity)) {
                (Some(axis @ 0..3), _) => Slot::Position(axis),
                (Some(3), _) => Slot::Area,
                (Some(_), _) => Slot::Volume,
                (None, Some(pool)) => Slot::Pool(pool),
                (None, None) => Slot::Open(open(id)),
            }
        };
        let clock = Some(clocked(system)?).filter(|program| !program.further.is_empty());
        let volume = system.find(SURFACE[4]);
        let expressions = system.quantities.iter().flat_map(|quantity| {
            let own = match &quantity.role {
                Role::Variable { rate: own } | Role::Defined { rule: own } => Some(own),
                Role::Parameter | Role::Input => None,
            };
            own.into_iter().chain([&quantity.initial])
        });
        let mut uses_volume = false;
        let integrands = membrane.totals.iter().map(|total| &total.integrand);
        for expression in expressions.chain(integrands).chain(document.noise.iter().map(|noise| &noise.strength)) {
            expression.each_quantity(&mut |used| uses_volume |= Some(used) == volume);
        }
        let values = &surface.initial;
        let given = membrane.given.iter().map(|number| (*number, values[*number as usize])).collect();
        Ok(Self {
            slots: surface.open.iter().map(slot).collect(),
            start_slots: start.open.iter().map(slot).collect(),
            measures: [open(SURFACE[3]), open(SURFACE[4])],
            sums: (membrane.totals.iter())
                .map(|total| Sum { open: open(&system.quantities[total.quantity as usize].id), taken: total.taken })
                .collect(),
            diffusion: (membrane.surface.iter())
                .map(|variable| variable.diffusion.evaluate(0.0, &|number| values[number as usize]))
                .collect(),
            noisy,
            given,
            names: (on_surface.iter())
                .map(|number| &system.quantities[*number as usize])
                .map(|quantity| (quantity.id.clone(), quantity.unit.clone()))
                .collect(),
            surface,
            inside,
            start,
            clock,
            stepping,
            uses_volume,
        })
    }

    /// The program of the inside: its variables are the pools; sums, area, volume and the inputs of the document are open.
    pub fn inside(&self) -> &Program {
        &self.inside
    }

    /// Diffusion coefficients of the variables on the surface, µm² per unit of time.
    pub fn diffusion(&self) -> &[f64] {
        &self.diffusion
    }

    /// How many variables live on the surface.
    pub fn variables(&self) -> usize {
        self.names.len()
    }

    /// What each input that differs from atom to atom is until it is set.
    pub fn defaults(&self) -> Vec<f64> {
        self.given.iter().map(|(_, default)| *default).collect()
    }

    /// The number among these of a quantity.
    pub fn given_number(&self, quantity: QuantityId) -> Option<usize> {
        self.given.iter().position(|(given, _)| *given == quantity)
    }

    /// The quantity with one of these numbers.
    ///
    /// # Panics
    /// When there is none.
    pub fn given_quantity(&self, number: usize) -> QuantityId {
        self.given[number].0
    }

    /// The number of a variable on the surface.
    pub fn variable(&self, id: &str) -> Option<usize> {
        self.names.iter().position(|(name, _)| name == id)
    }

    /// Whether something is a quantity of the inside that is worth writing down: not what a cell's measures are anyhow.
    pub fn is_recorded(document: &Document, quantity: QuantityId) -> bool {
        let local = document.membrane.as_ref().is_some_and(|membrane| membrane.local[quantity as usize]);
        !local && !SURFACE.contains(&document.system.quantities[quantity as usize].id.as_str())
    }
}

/// Variables that have noise, by their numbers, and its strengths.
type Noisy = (Vec<usize>, Vec<Expr>);

/// What has noise of the variables on the surface, and of the pools.
fn noise(document: &Document, on_surface: &[QuantityId]) -> [Noisy; 2] {
    let pools: Vec<QuantityId> =
        document.system.variables().into_iter().filter(|variable| !on_surface.contains(variable)).collect();
    [on_surface, pools.as_slice()].map(|variables| {
        let number = |quantity| variables.iter().position(|variable| *variable == quantity);
        let noise = document.noise.iter();
        noise.filter_map(|noise| Some((number(noise.quantity)?, noise.strength.clone()))).unzip()
    })
}

/// The system as an atom of the surface sees it: pools are given.
fn outer(system: &System, pools: &[QuantityId]) -> System {
    let mut outer = system.clone();
    for pool in pools {
        outer.quantities[*pool as usize].role = Role::Input;
    }
    outer
}

/// The system as the inside sees it: what differs from atom to atom is a number that nothing uses.
fn inner(system: &System, local: &[bool]) -> System {
    let mut inner = system.clone();
    for (quantity, _) in inner.quantities.iter_mut().zip(local).filter(|(_, local)| **local) {
        (quantity.role, quantity.initial) = (Role::Parameter, Expr::Number(0.0));
    }
    // Initial values are worked out at the start of each cell, where area and volume are known.
    inner
}

/// The system at the start: variables are what their initial values say.
fn beginning(system: &System) -> System {
    let mut start = system.clone();
    for quantity in &mut start.quantities {
        if let Role::Variable { .. } = quantity.role {
            let rule = std::mem::replace(&mut quantity.initial, Expr::Number(0.0));
            quantity.role = Role::Defined { rule };
        }
    }
    start
}
