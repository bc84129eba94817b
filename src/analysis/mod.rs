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

use crate::error::Result;
use crate::experiment::Document;
use crate::output::{Measure, ResultFile};
use recording::Recording;

/// Evaluates all measures that a document declares, in its order.
///
/// A measure that cannot be taken from this run, for instance because its table does not exist any more, is NaN and its
/// description says why: the run that was made is worth more than the one number that it lacks.
///
/// # Errors
/// A damaged result file.
pub fn measure_result(file: &ResultFile, document: &Document) -> Result<Vec<Measure>> {
    let declared = &document.experiment.measure;
    let recording = Recording::load(file, declared.values().flat_map(|one| measure::series(&one.kind)))?;
    let measures = declared.iter().map(|(name, one)| {
        let description = one.description.clone().unwrap_or_default();
        let (value, description) = match measure::evaluate(&one.kind, &recording, &|path| document.resolve(path)) {
            Ok(value) => (one.scale * value, description),
            Err(error) => (f64::NAN, format!("{description} (not measured: {error})").trim_start().to_owned()),
        };
        Measure { name: name.clone(), value, unit: one.unit.clone(), description }
    });
    Ok(measures.collect())
}

#[cfg(test)]
#[path = "result_tests.rs"]
mod tests;
