//! Why fibres cannot be made or removed as a program asks.

use super::id::CellId;
use crate::error::short;

/// Why a fibre cannot be what was asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FibreFault {
    /// The type of the cell has no budget of fibres.
    #[error("cells of type `{kind}` have no fibres that are made at run time")]
    NoBudget {
        /// The type.
        kind: String,
    },
    /// The cell has as many as it may.
    #[error("cell {cell} has {budget} fibres, all that its budget allows")]
    Full {
        /// The cell.
        cell: CellId,
        /// What it may have at most.
        budget: usize,
    },
    /// An end that is no atom of the cell.
    #[error("cell {cell} has no atom {atom}: its atoms are 0 to {}", .atoms - 1)]
    NoSuchAtom {
        /// The cell.
        cell: CellId,
        /// The end.
        atom: u32,
        /// Atoms of the cell.
        atoms: usize,
    },
    /// Both ends are the same atom.
    #[error("both ends of a fibre of cell {cell} are its atom {atom}")]
    NoLength {
        /// The cell.
        cell: CellId,
        /// The atom.
        atom: u32,
    },
    /// Stiffnesses that sum up at an atom to more than steps of this size bear.
    #[error("fibres at atom {atom} of cell {cell} would have {} pN/um together, and steps bear {}", short(*.found), short(*.limit))]
    TooStiff {
        /// The cell.
        cell: CellId,
        /// The atom.
        atom: u32,
        /// What they would sum up to, those that pseudopods may make included, pN/µm.
        found: f64,
        /// The most that they may, pN/µm.
        limit: f64,
    },
    /// A fibre that the cell does not have, or not any more.
    #[error("cell {cell} has no fibre {number}")]
    NoSuchFibre {
        /// The cell.
        cell: CellId,
        /// The number of the fibre.
        number: u64,
    },
    /// A fibre that a pseudopod has made.
    #[error("fibre {number} of cell {cell} is that of a pseudopod")]
    OfPseudopod {
        /// The cell.
        cell: CellId,
        /// The number of the fibre.
        number: u64,
    },
}

impl FibreFault {
    /// What to do.
    pub fn help(&self) -> &'static str {
        match self {
            Self::NoBudget { .. } => "add `fibre_budget` to the type, the most that a cell may have",
            Self::Full { .. } => "remove one first, or give the type a larger `fibre_budget`",
            Self::NoSuchAtom { .. } => "take atoms of the cell itself, numbered from 0",
            Self::NoLength { .. } => "take two atoms",
            Self::TooStiff { .. } => {
                "let it be softer, take another atom, or let steps be shorter (run.integrator.max_step)"
            }
            Self::NoSuchFibre { .. } => "ask `fibres` which there are",
            Self::OfPseudopod { .. } => "leave it to its pseudopod, or set `pseudopods.retraction`",
        }
    }
}
