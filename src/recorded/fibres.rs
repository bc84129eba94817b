//! Quantities of cells in runs in which fibres come and go.

use super::cell::{CellQuantity, Values, row};

use Values::Number;

/// All of them, in the order of the result file; they stand behind those of all runs.
#[rustfmt::skip]
pub const FIBRES: &[CellQuantity] = &[
    row("/cells/fibre_count", "1", Number(|c| c.fibres.count, "fibres"),
        "Fibres that were made at run time and are there."),
    row("/cells/fibre_tension", "pN", Number(|c| c.fibres.tension, "tension of fibres"),
        "Sum of what they pull with: stiffness times activation times length."),
    row("/cells/fibre_length", "um", Number(|c| c.fibres.length, "mean length of fibres"),
        "Their mean length; NaN where there are none."),
    row("/cells/fibre_energy", "pN um", Number(|c| c.fibres.energy, "energy of fibres"),
        "Their energy: half of tension times length, summed."),
];
