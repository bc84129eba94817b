//! What a run writes down: names, units, labels and meanings of all quantities, in one table.
//!
//! Documents name them, the run fills them, the result file stores them, charts and messages speak of them; all by the
//! tables here. A new quantity of cells is a field of [`CellRecord`] and a row of [`CELL`], or of [`TRACTION`] or [`FIBRES`] where only some runs have it; a
//! new series about contacts is a variant of [`ContactSeries`] and a row of [`CONTACTS`].

mod balance;
mod cell;
mod contacts;
mod fibres;
mod named;
mod series;
mod traction;

pub use balance::TractionRecord;
pub use cell::{CELL, CellQuantity, CellRecord, FibresRecord, VISCOUS, Values};
pub use contacts::{CONTACTS, ContactQuantity, ContactSeries, Recorded, Touch, contact_quantities};
pub use fibres::FIBRES;
pub use named::{
    Motion, NAMED, OUT_OF_BALANCE, names_by_type, series_of_moved, series_of_plates, series_of_pressures,
    series_of_tool, series_of_torques, series_of_traps,
};
pub use series::{DERIVED, OnDemand, cell_label, cell_quantities, cell_series, cell_unit, derived};
pub use traction::TRACTION;
