//! What can go wrong with a simulation, by kind, so that a program can tell one trouble from another.

use super::fibre_fault::FibreFault;
use super::id::CellId;
use crate::error::words::{all_of, meant};
use crate::error::{Error, Fault};
use crate::sim::{PopulationTrouble, Trouble};

/// Why a simulation could not be made, or could not do what was asked.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The experiment is at fault: [`Error::Input`] has all faults with their positions in the text.
    #[error(transparent)]
    Input(#[from] Error),
    /// The numbers failed in a step; the state is the one before it.
    #[error(transparent)]
    Trouble(#[from] Trouble),
    /// The cancel token asked to stop. The state is that of the last step made.
    #[error("cancelled at t = {} s", crate::error::short(*.time))]
    Cancelled {
        /// Simulated time reached, s.
        time: f64,
    },
    /// A cell that the simulation does not have.
    #[error("there is no cell {cell}")]
    NoSuchCell {
        /// The cell.
        cell: CellId,
    },
    /// A name that the simulation does not have.
    #[error("there is no {what} `{name}`")]
    Unknown {
        /// What it would be: a series, a load, fibres, a species, …
        what: &'static str,
        /// The name as it was given.
        name: String,
        /// The names that there are.
        known: Vec<String>,
    },
    /// A number that cannot be what was asked.
    #[error("{what} cannot be {value}: {expected} was expected")]
    Value {
        /// What was to have it.
        what: String,
        /// The number.
        value: f64,
        /// What it should have been.
        expected: &'static str,
    },
    /// Something that can be set of some cells, but not of this one.
    #[error("{what} cannot be set: {why}")]
    NotSettable {
        /// What was to be set, of which cell.
        what: String,
        /// Why this cell has no such thing.
        why: String,
        /// What to do.
        help: &'static str,
    },
    /// A buffer of another length.
    #[error("the buffer holds {found} positions, {expected} were expected")]
    Length {
        /// Positions that there are.
        expected: usize,
        /// Positions that fit into the buffer.
        found: usize,
    },
    /// Forces on more or fewer atoms than a cell has.
    #[error("forces on {found} atoms of cell {cell} were given, which has {expected}")]
    Forces {
        /// The cell.
        cell: CellId,
        /// Atoms that it has.
        expected: usize,
        /// Forces that were given.
        found: usize,
    },
    /// A model and a state that do not belong together.
    #[error("the state is not one of this model: {0}")]
    Mismatch(String),
    /// Cells that cannot come or go.
    #[error(transparent)]
    Population(#[from] PopulationTrouble),
    /// A fibre that cannot be what was asked.
    #[error(transparent)]
    Fibre(#[from] FibreFault),
    /// Bytes that cannot be restored.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointFault),
}

/// Why a checkpoint cannot be restored.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointFault {
    /// The bytes do not begin like a checkpoint.
    #[error("the bytes are not a checkpoint of a simulation")]
    NotACheckpoint,
    /// The bytes were cut or changed.
    #[error("the checkpoint is damaged: {0}")]
    Damaged(String),
    /// It was made by a program that arranges the bytes in another way.
    #[error("the checkpoint has version {found}, this program knows {known}")]
    Version {
        /// Its version.
        found: u32,
        /// The version of this program.
        known: u32,
    },
    /// It is one of another model.
    #[error("the checkpoint belongs to another experiment")]
    Foreign,
}

impl SimulationError {
    /// What was expected and what to do, in a sentence; none where the message says it all.
    pub fn help(&self) -> Option<String> {
        Some(match self {
            Self::Input(Error::Input(faults)) => return faults.iter().find_map(|fault| fault.help.clone()),
            Self::Input(Error::Numbers { help, .. } | Error::Machine { help, .. } | Error::Stopped { help, .. }) => {
                help.clone()
            }
            Self::Input(Error::Interrupted { .. }) | Self::Value { .. } => return None,
            Self::Trouble(trouble) => trouble.help().to_owned(),
            Self::Population(_) => {
                "let cells come where and when there is space for them, and go while they are there".to_owned()
            }
            Self::Cancelled { .. } => "go on with a new cancel token".to_owned(),
            Self::NoSuchCell { .. } => "ask `cells` which there are".to_owned(),
            Self::Unknown { known, .. } if known.is_empty() => "there is none at all".to_owned(),
            Self::Unknown { name, known, .. } => {
                let names = || known.iter().map(String::as_str);
                let near = meant(name, names()).map_or(String::new(), |near| format!("did you mean `{near}`? "));
                format!("{near}there is {}", all_of(names()))
            }
            Self::NotSettable { help, .. } => (*help).to_owned(),
            Self::Length { .. } => "ask `atom_count` for the length of the buffer".to_owned(),
            Self::Forces { .. } => {
                "give one for each atom, in the order of positions, or one for the whole cell by `set_force`".to_owned()
            }
            Self::Mismatch(_) => "make the state with `State::new` from this model".to_owned(),
            Self::Fibre(fault) => fault.help().to_owned(),
            Self::Checkpoint(fault) => fault.help().to_owned(),
        })
    }
}

impl CheckpointFault {
    /// What to do.
    pub fn help(&self) -> &'static str {
        match self {
            Self::NotACheckpoint => "give the bytes that `Simulation::checkpoint` returned",
            Self::Damaged(_) => "take an older checkpoint, or begin again",
            Self::Version { .. } => "restore it with the version of pseudopod that made it",
            Self::Foreign => "make the simulation from the document, the settings and the meshes that it was made from",
        }
    }
}

impl From<SimulationError> for Error {
    fn from(error: SimulationError) -> Self {
        let (message, help) = (error.to_string(), error.help());
        match error {
            SimulationError::Input(error) => error,
            SimulationError::Trouble(_) | SimulationError::Population(_) => {
                Self::Numbers { message, help: help.unwrap_or_default(), kept: None }
            }
            _ => Self::input(help.into_iter().fold(Fault::new(message), Fault::help)),
        }
    }
}
