//! Quantities of cells in runs that record what cells do to what is around them: forces in the mean over the last step.

use super::cell::{CellQuantity, Values, row};

use Values::{Number, Vector};

/// All of them, in the order of the result file; they stand behind those of all runs.
#[rustfmt::skip]
pub const TRACTION: &[CellQuantity] = &[
    row("/cells/traction", "pN", Vector(|c| c.traction.traction, [("x", "traction along x"), ("y", "traction along y"), ("z", "traction along z")]),
        "Force of the cell on planes, in the mean over the last step."),
    row("/cells/traction_of_cells", "pN", Vector(|c| c.traction.of_cells, [("x", "force on other cells along x"), ("y", "force on other cells along y"), ("z", "force on other cells along z")]),
        "Force of the cell on other cells."),
    row("/cells/drag", "pN", Vector(|c| c.traction.drag, [("x", "drag along x"), ("y", "drag along y"), ("z", "drag along z")]),
        "Drag of the medium on the cell."),
    row("/cells/outer_force", "pN", Vector(|c| c.traction.outer, [("x", "outer force along x"), ("y", "outer force along y"), ("z", "outer force along z")]),
        "Loads, gravity, attraction and what drives a walk: what acts on the cell from outside without touching it."),
    row("/cells/inertia", "pN", Vector(|c| c.traction.inertia, [("x", "inertia along x"), ("y", "inertia along y"), ("z", "inertia along z")]),
        "Mass times acceleration of the cell; 0 in over-damped runs. outer_force + holding_force + drag - traction - traction_of_cells - inertia is 0."),
    row("/cells/holding_force", "pN", Vector(|c| c.traction.held, [("x", "holding force along x"), ("y", "holding force along y"), ("z", "holding force along z")]),
        "What holds the atoms of the cell that are fixed, or moves those that go on a course."),
    row("/cells/traction_total", "pN", Number(|c| c.traction.total, "total traction"),
        "Sum of the sizes of the forces of the atoms on planes."),
    row("/cells/traction_dipole", "pN um", Number(|c| c.traction.dipole, "traction dipole"),
        "Trace of the first moment, along the first plane, of the forces of the atoms on planes; below 0 where the cell draws what it stands on together."),
    row("/cells/traction_moment", "pN um", Vector(|c| c.traction.moment, [("1", "lowest moment of traction"), ("2", "middle moment of traction"), ("3", "highest moment of traction")]),
        "Principal values of the symmetric part of that moment, lowest first."),
    row("/cells/traction_axis", "1", Vector(|c| c.traction.axis, [("x", "axis of traction, x"), ("y", "axis of traction, y"), ("z", "axis of traction, z")]),
        "Unit vector along the axis of the lowest of these; 0 where there is no traction."),
];
