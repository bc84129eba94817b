//! The experiments that ship keep what they claim.

mod experiments;
mod sorting_statistics;
