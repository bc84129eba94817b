//! Numbers and series from a finished result file.

pub mod claims;
pub mod curve;
pub mod measure;
pub mod msd;
#[cfg(test)]
mod noise;
pub mod recording;
pub mod statistics;
pub mod table;
