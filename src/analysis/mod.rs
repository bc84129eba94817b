//! Numbers and series from a finished result file.

pub mod aggregates;
pub mod bootstrap;
pub mod circular;
pub mod claims;
mod csv_fields;
pub mod curve;
pub mod displacement_map;
mod face_grid;
pub mod fields;
pub mod fronts;
pub mod furth;
mod gel;
mod half_space;
pub mod measures;
pub mod msd;
#[cfg(test)]
mod noise;
pub mod over;
pub mod pattern;
pub mod recording;
mod relaxation;
pub mod sensing;
pub mod sobol_indices;
pub mod speed_persistence;
pub mod statistics;
pub mod table;
pub mod tracks;
pub mod waves;

use crate::error::Result;
use crate::output::ResultFile;
use claims::{Claim, ClaimResult};

/// Holds claims against the measures that a finished run stored in its file. A claim about a measure that could not be
/// computed fails, as does one about a measure that was never declared.
///
/// # Errors
/// A damaged file.
pub fn check_result(file: &ResultFile, claims: &[Claim]) -> Result<Vec<ClaimResult>> {
    Ok(claims::check_claims(claims, &file.summary()?))
}
