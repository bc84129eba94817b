//! The forces at an atom that a cell exchanges with what is around it.

use serde::{Deserialize, Serialize};

use crate::Vec3;

/// What an atom did to what its cell touches, and what acted on it from outside, in the mean over a step, pN. Over a cell
/// `outer + held + drag − traction − of_cells − inertia` is nothing, eq. (traction.1): what a cell does to itself has no sum.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct AtomBalance {
    /// Force on the obstacles that the cell touches.
    pub traction: [f64; 3],
    /// Force on other cells.
    pub of_cells: [f64; 3],
    /// Drag of the medium, on the atom.
    pub drag: [f64; 3],
    /// Loads, forces that a program exerts, gravity, attraction and what drives a walk, on the atom.
    pub outer: [f64; 3],
    /// What holds or moves it, where it is fixed or goes on a course, on the atom.
    pub held: [f64; 3],
    /// Mass times acceleration; 0 in over-damped runs.
    pub inertia: [f64; 3],
}

impl AtomBalance {
    /// Nothing acts: an atom that no step has moved yet.
    pub const NONE: Self = Self::all([0.0; 3]);

    /// NaN everywhere.
    pub(super) const UNKNOWN: Self = Self::all([f64::NAN; 3]);

    const fn all(force: [f64; 3]) -> Self {
        Self { traction: force, of_cells: force, drag: force, outer: force, held: force, inertia: force }
    }

    /// What is left of the sum over an atom, pN: what the rest of its cell does to it, with its sign turned.
    pub fn left(&self) -> Vec3 {
        let [traction, of_cells, drag, outer, held, inertia] =
            [self.traction, self.of_cells, self.drag, self.outer, self.held, self.inertia].map(Vec3::from);
        outer + held + drag - traction - of_cells - inertia
    }

    /// The sum of the sizes of all of them, pN: what [`left`](Self::left) is small beside.
    pub fn size(&self) -> f64 {
        [self.traction, self.of_cells, self.drag, self.outer, self.held, self.inertia]
            .map(|force| Vec3::from(force).norm())
            .iter()
            .sum()
    }
}
