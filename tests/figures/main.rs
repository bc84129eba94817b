//! The experiments that ship keep what they claim.

mod chemotactic_index;
mod experiments;
mod fits;
#[path = "../support/index_table.rs"]
mod index_table;
#[path = "../support/shared.rs"]
mod shared;
mod sorting_statistics;
mod truth_cube;
mod tutorials;
