//! The experiments that ship keep what they claim.

mod chemotactic_index;
mod experiments;
mod sorting_statistics;
