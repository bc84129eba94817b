//! Forces between a cell and what is around it, as they are recorded.

use serde::{Deserialize, Serialize};

/// What one cell does to what is around it, and what acts on it from outside.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct TractionRecord {
    /// Force on planes, pN.
    pub traction: [f64; 3],
    /// Force on other cells, pN.
    pub of_cells: [f64; 3],
    /// Drag of the medium, on the cell, pN.
    pub drag: [f64; 3],
    /// Loads, gravity, attraction and what drives a walk, on the cell, pN.
    pub outer: [f64; 3],
    /// Mass times acceleration, pN; 0 in over-damped runs.
    pub inertia: [f64; 3],
    /// What holds or moves atoms of the cell that are fixed or go on a course, on the cell, pN.
    pub held: [f64; 3],
    /// Sum of the sizes of the forces of its atoms on planes, pN.
    pub total: f64,
    /// Trace of the first moment of these forces along the first plane, pN·µm, below 0 where the cell draws what it stands on together.
    pub dipole: f64,
    /// Principal values of the symmetric part of that moment, the lowest first, pN·µm.
    pub moment: [f64; 3],
    /// Unit vector along the axis of the lowest of these; 0 where there is no traction.
    pub axis: [f64; 3],
}
