//! What chemistry means: compiled systems, fields and links. Nothing here changes during a run.

use super::links::{AtAtoms, Link, Observations, Source};
use super::membrane::Membrane;
use crate::cell::ends::AtomReading;
use crate::equations::program::Program;
use crate::equations::tree::QuantityId;
use crate::field::{FieldSystem, Stepping};
use crate::ode::{EventPlan, Method, Noise, Pace, Starts, Tolerances};

/// All chemistry of a model; empty lists where there is none.
#[derive(Debug, Clone, Default)]
pub struct Chemistry {
    /// Systems of the scene and of cells, in the order of the document.
    pub reactors: Vec<Reactor>,
    /// Fields, in the order of the document.
    pub fields: Vec<FieldReactor>,
    /// Links in an order in which each comes after those whose numbers it uses in the same instant; see [`Self::set_links`].
    pub links: Vec<Link>,
    /// What these links read, each thing once.
    pub observations: Observations,
    /// Species that links sense as a mean over cells: (field, species).
    pub sensed: Vec<(usize, usize)>,
    /// Species that cells secrete: (field, species).
    pub secreted: Vec<(usize, usize)>,
    /// Volume (µm³, 0 of an open mesh) and area (µm²) of the mesh at rest of each kind.
    pub rest: Vec<[f64; 2]>,
    /// Whether some link reads a measure of cells.
    pub measures_cells: bool,
    /// Whether some link imposes positions of atoms.
    pub imposes_atoms: bool,
}

/// A system of equations that the scene has once, or each of some cells.
#[derive(Debug, Clone)]
pub struct Reactor {
    /// Its name in the document.
    pub name: String,
    /// The equations.
    pub program: Program,
    /// Its events; empty where it has none.
    pub events: EventPlan,
    /// Its noise, but for what of it lives on membranes; none where it has none.
    pub noise: Option<Noise>,
    /// Starts that are drawn for each member; none where nothing is.
    pub starts: Option<Starts>,
    /// How often noise kicks, in the system's unit of time.
    pub pace: Pace,
    /// What of it lives on the membranes of its cells; its own equations are those of their insides.
    pub membrane: Option<Membrane>,
    /// The number of the fields that it stands beside and is moved with; none where it is moved by itself.
    pub beside: Option<usize>,
    /// Who has it.
    pub members: Members,
    /// Seconds in the system's unit of time.
    pub seconds: f64,
    /// How it is solved.
    pub method: Method,
    /// Tolerances of a method with an error estimate.
    pub tolerances: Tolerances,
    /// Time between two exchanges with the model, s; after every step where there is none.
    pub exchange: Option<f64>,
    /// Names and units of the quantities that are recorded, with their numbers.
    pub recorded: Vec<(QuantityId, String, String)>,
}

impl Reactor {
    /// Whether it is moved by itself, and not with the fields that it stands beside.
    pub fn is_moved_alone(&self) -> bool {
        self.beside.is_none()
    }
}

/// Who has a system.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Members {
    /// The scene, once.
    Scene,
    /// Every cell of these kinds (rising numbers), in the order of all cells.
    Kinds(Vec<usize>),
}

impl Members {
    /// How many copies of the system there are, where `cells` says how many cells a kind has.
    pub fn count(&self, cells: impl Fn(usize) -> usize) -> usize {
        match self {
            Self::Scene => 1,
            Self::Kinds(kinds) => kinds.iter().map(|&kind| cells(kind)).sum(),
        }
    }
}

/// Fields on a grid and how they are stepped.
#[derive(Debug, Clone)]
pub struct FieldReactor {
    /// Its name in the document.
    pub name: String,
    /// Grid, species, reactions.
    pub system: FieldSystem,
    /// The number of the system of what stands beside them.
    pub scene: Option<usize>,
    /// How a step of the model is cut into steps of the fields.
    pub stepping: FieldStepping,
    /// How often noise kicks, s.
    pub pace: Pace,
    /// Values of the system's quantities at the start, for transfers.
    pub constants: Vec<f64>,
}

/// How a step of the model is cut into steps of fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FieldStepping {
    /// Into equal steps no longer than this, s.
    Longest(f64),
    /// So that the error of a step stays below the tolerances; see [`Stepping::Adaptive`].
    Adaptive {
        /// Relative to the size of each species.
        relative: f64,
        /// In the document's unit of concentration.
        absolute: f64,
    },
}

impl FieldStepping {
    /// The steps of a window, s.
    pub fn of(self, window: f64) -> Stepping {
        match self {
            // The slack keeps a window that is a whole number of steps from getting one more by round-off.
            Self::Longest(step) => Stepping::Fixed((window / step - 1e-9).ceil().clamp(1.0, 1e9) as u32),
            Self::Adaptive { relative, absolute } => Stepping::Adaptive { relative, absolute },
        }
    }
}

impl Chemistry {
    /// Takes links, in an order in which they can carry.
    pub fn set_links(&mut self, links: Vec<Link>) {
        let of_cells = |number: usize| self.reactors[number].members != Members::Scene;
        self.observations = Observations::of(&links, of_cells);
        self.links = links;
    }

    /// Whether some link reads what touches.
    pub fn reads_contact(&self) -> bool {
        let at_atoms = |link: &Link| matches!(link.from, Source::Atoms(AtAtoms::Read(AtomReading::InContact(_))));
        self.measures_cells || self.reads_neighbours() || self.links.iter().any(at_atoms)
    }

    /// Whether some link reads what neighbours have.
    pub fn reads_neighbours(&self) -> bool {
        self.links.iter().any(|link| matches!(link.from, Source::Neighbours(_)))
    }

    /// Whether some link reads what cells do to what is around them.
    pub fn reads_tractions(&self) -> bool {
        let at_atoms = |link: &Link| matches!(link.from, Source::Atoms(AtAtoms::Read(AtomReading::Traction)));
        self.links.iter().any(at_atoms)
    }

    /// Whether there is nothing to do.
    pub fn is_empty(&self) -> bool {
        self.reactors.is_empty() && self.fields.is_empty()
    }
}
