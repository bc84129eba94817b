//! The experiments that ship keep what they claim.

mod chemotactic_index;
mod experiments;
#[path = "../support/index_table.rs"]
mod index_table;
mod red_cell_fit;
#[path = "../support/shared.rs"]
mod shared;
mod sorting_statistics;
