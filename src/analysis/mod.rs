//! Numbers and series from a finished result file.

pub mod msd;
pub mod statistics;
