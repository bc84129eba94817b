//! When the numbers fail: what, where and when.

use super::constraints::VolumeFailure;
use super::model::Model;
use super::state::{State, index};

/// Why a step could not be made. The state is the one before the step.
#[derive(Debug, Clone, PartialEq)]
pub enum Trouble {
    /// A position is not a finite number.
    NotFinite {
        /// Type of the cell.
        kind: String,
        /// Number of the cell within its type.
        cell: usize,
        /// Number of the atom within the cell.
        atom: usize,
        /// End of the step, s.
        time: f64,
    },
    /// A volume could not be restored.
    Volume {
        /// Type of the cell.
        kind: String,
        /// Number of the cell within its type.
        cell: usize,
        /// Relative error left.
        error: f64,
        /// End of the step, s.
        time: f64,
    },
    /// No step was small enough for the tolerance.
    StepTooSmall {
        /// Start of the step, s.
        time: f64,
        /// The smallest step tried, s.
        dt: f64,
    },
}

impl Trouble {
    pub(super) fn of_volume(model: &Model, time: f64, failure: VolumeFailure) -> Self {
        let kind = model.kinds[failure.kind].name.clone();
        Self::Volume { kind, cell: failure.cell, error: failure.error, time }
    }

    /// What to do about it.
    pub fn help(&self) -> &'static str {
        match self {
            Self::NotFinite { .. } => {
                "a step that is too large or a force that grows without bound does this: shorten run.integrator.step, \
                 or leave it out so that a stable step is chosen"
            }
            Self::Volume { .. } => {
                "the free atoms of the cell cannot hold its volume: fix fewer atoms, load it more slowly, shorten \
                 run.integrator.step if you set one, or use volume = { rule = \"compressible\", … }"
            }
            Self::StepTooSmall { .. } => {
                "the cell changes shape faster than any step can follow: look at its last state for folded or \
                 collapsed facets, lower the load, or raise run.integrator.tolerance"
            }
        }
    }
}

impl std::fmt::Display for Trouble {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::NotFinite { kind, cell, atom, time } => {
                write!(
                    f,
                    "the position of atom {atom} of cell {cell} of type `{kind}` is not a number at t = {time:.6} s"
                )
            }
            Self::Volume { kind, cell, error, time } => write!(
                f,
                "the volume of cell {cell} of type `{kind}` is {error:.1e} (relative) off its target at t = {time:.6} s"
            ),
            Self::StepTooSmall { time, dt } => {
                write!(f, "at t = {time:.6} s no step was small enough: {dt:.1e} s still misses the tolerance")
            }
        }
    }
}

/// Finds the first position that is not finite.
pub fn check_finite(model: &Model, time: f64, state: &State) -> Result<(), Trouble> {
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        // A sum is not finite when a part is not, or when it overflows, which is no better.
        if now.positions.iter().map(|x| x * 1e-30).sum::<f64>().is_finite() {
            continue;
        }
        for cell in 0..kind.cells {
            for atom in 0..kind.atoms() {
                if (0..3).any(|axis| !now.positions[index(kind, cell, atom, axis)].is_finite()) {
                    return Err(Trouble::NotFinite { kind: kind.name.clone(), cell, atom, time });
                }
            }
        }
    }
    Ok(())
}
