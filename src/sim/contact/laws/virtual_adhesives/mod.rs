//! Virtual adhesives (Carra, Martiel and Promayon 2007): atoms of cells that touch are cloned into rigid bodies, which recruit,
//! merge, lose atoms and die.

mod find;
mod recruit;
mod rigid;
mod scratch;
mod table;

pub use scratch::AdhesiveScratch;
pub use table::{AdhesiveTable, Zones};
