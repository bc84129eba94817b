//! What chemistry means: compiled systems, fields and links. Nothing here changes during a run.

use crate::cell::ends::{Reading, Sense};
use crate::equations::program::Program;
use crate::equations::tree::{Expr, QuantityId};
use crate::field::{FieldSystem, Stepping};
use crate::ode::{EventPlan, Method, Tolerances};

/// All chemistry of a model; empty lists where there is none.
#[derive(Debug, Clone, Default)]
pub struct Chemistry {
    /// Systems of the scene and of cells, in the order of the document.
    pub reactors: Vec<Reactor>,
    /// Fields, in the order of the document.
    pub fields: Vec<FieldReactor>,
    /// Links in an order in which each comes after those whose numbers it uses in the same instant.
    pub links: Vec<Link>,
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

/// Who has a system.
#[derive(Debug, Clone, PartialEq)]
pub enum Members {
    /// The scene, once.
    Scene,
    /// These cells (numbers in the order of all cells), rising.
    Cells(Vec<u32>),
}

impl Members {
    /// How many copies of the system there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Scene => 1,
            Self::Cells(cells) => cells.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The cell that has a copy; none for the scene.
    pub fn cell(&self, member: usize) -> Option<usize> {
        match self {
            Self::Scene => None,
            Self::Cells(cells) => Some(cells[member] as usize),
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
    /// How a step of the model is cut into steps of the fields.
    pub stepping: FieldStepping,
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

/// A link: a number goes from one end through the transfer to the other at each exchange.
#[derive(Debug, Clone)]
pub struct Link {
    /// The document's own words for it, for messages.
    pub text: String,
    /// Whose link it is.
    pub owner: Owner,
    /// Where the number comes from.
    pub from: Source,
    /// Where it goes.
    pub to: Target,
    /// What becomes of it: an expression of the owner's quantities and of the value.
    pub transfer: Expr,
    /// Quantities of the owner that the transfer uses.
    pub uses: Vec<QuantityId>,
    /// Factor of the transfer.
    pub gain: f64,
}

/// Whose link it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Owner {
    /// A system.
    Reactor(usize),
    /// A document of fields.
    Field(usize),
}

/// Which cells an end names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Whose {
    /// The cell that has the system.
    Own,
    /// This cell, in the order of all cells.
    Cell(usize),
    /// All cells of a kind: their mean where it is read, each of them where it is set.
    Kind(usize),
}

/// Where a number comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Source {
    /// A quantity of the owner.
    Own(QuantityId),
    /// Simulated time, s.
    Time,
    /// A measure of a cell.
    Cell(Whose, Reading),
    /// A field as a cell senses it: the mean over its atoms of a channel of [`Chemistry::sensed`].
    Sensed(Whose, usize, Sense),
    /// A field at an atom: (whose, atom, field, species, what).
    AtAtom(Whose, usize, usize, usize, Sense),
    /// A number of a whole field: (field, species, what).
    Whole(usize, usize, Whole),
    /// A quantity of another system: (reactor, quantity, whose copy); the scene's only one for systems of the scene.
    Other(usize, QuantityId, Whose),
}

/// A number of a whole field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Whole {
    /// Mean value.
    Mean,
    /// Largest value.
    Largest,
    /// Smallest value.
    Smallest,
    /// Amount on the grid.
    Amount,
}

/// Where a number goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// An open quantity of the owner: its place among the inputs.
    Own(usize),
    /// Something that mechanics reads of a cell.
    Cell(Whose, Control),
}

/// What mechanics reads of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// Speed of the walk, µm/s.
    MotilitySpeed,
    /// A component of the velocity added to the walk, µm/s.
    Bias(usize),
    /// Factor of elastic forces.
    Stiffness,
    /// Factor of the strength of contacts.
    Adhesion,
    /// Rest volume, µm³.
    RestVolume,
    /// Rest volume over that of the mesh at rest.
    RestVolumeRatio,
    /// What may be set of a force: the number of its handle in [`CONTROLLED`](crate::mechanics::CONTROLLED), and its own among those
    /// of the kind that have this handle.
    Force(usize, usize),
    /// A component of an atom's position, µm.
    Atom(usize, usize),
    /// Amount released per second into a channel of [`Chemistry::secreted`].
    Secretion(usize),
}

impl Chemistry {
    /// Whether there is nothing to do.
    pub fn is_empty(&self) -> bool {
        self.reactors.is_empty() && self.fields.is_empty()
    }
}
