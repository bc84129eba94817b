//! Numbers and series from a finished result file.

pub mod aggregates;
mod chemistry;
pub mod claims;
pub mod curve;
pub mod fields;
mod gaps;
pub mod measure;
pub mod msd;
#[cfg(test)]
mod noise;
pub mod pattern;
pub mod recording;
pub mod sorting;
pub mod statistics;
pub mod table;
pub mod waves;

use crate::error::{Error, Fault, Result};
use crate::experiment::Document;
use crate::output::{Measure, ResultFile};
use claims::{Claim, ClaimResult};
use recording::Recording;

/// Evaluates all measures that a document declares, each multiplied by its scale. Those that cannot be computed come
/// as faults with their places in the document beside the others, which are worth keeping all the same.
///
/// # Errors
/// A damaged file.
pub fn measure_result(file: &ResultFile, document: &Document) -> Result<(Vec<Measure>, Vec<Fault>)> {
    let declared = &document.experiment.measure;
    let mut names: Vec<&str> = declared.values().flat_map(|measure| measure::series_of(&measure.kind)).collect();
    names.sort_unstable();
    names.dedup();
    let recording = Recording::read(file, &names)?;
    let (mut measures, mut faults) = (Vec::new(), Vec::new());
    for (name, declared) in declared {
        match measure::evaluate(&declared.kind, &recording, Some(file), &|path| document.resolve(path)) {
            Ok(value) => measures.push(Measure {
                name: name.clone(),
                value: value * declared.scale,
                unit: if declared.unit.is_empty() { "1".to_owned() } else { declared.unit.clone() },
                description: declared.description.clone().unwrap_or_default(),
            }),
            Err(Error::Input(found)) => faults.extend(found.into_iter().map(|mut fault| {
                fault.message = format!("the measure `{name}` cannot be computed: {}", fault.message);
                // A fault that points into a table keeps its place there.
                fault.location =
                    fault.location.or_else(|| document.key_location(&format!("measure.{name}"), "this measure"));
                fault
            })),
            Err(other) => return Err(other),
        }
    }
    Ok((measures, faults))
}

/// Holds claims against the measures that a finished run stored in its file. A claim about a measure that could not be
/// computed fails, as does one about a measure that was never declared.
///
/// # Errors
/// A damaged file.
pub fn check_result(file: &ResultFile, claims: &[Claim]) -> Result<Vec<ClaimResult>> {
    let measures = file.summary()?.into_iter().map(|measure| (measure.name, measure.value)).collect();
    Ok(claims::check_claims(claims, &measures))
}

#[cfg(test)]
#[path = "result_tests.rs"]
mod tests;
