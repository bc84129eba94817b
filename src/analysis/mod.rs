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

use crate::error::{Error, Result};
use crate::experiment::Document;
use crate::output::{Measure, ResultFile};
use recording::Recording;

/// Evaluates all measures that a document declares, each multiplied by its scale.
///
/// # Errors
/// All measures that cannot be computed, each with its place in the document, or a damaged file.
pub fn measure_result(file: &ResultFile, document: &Document) -> Result<Vec<Measure>> {
    let declared = &document.experiment.measure;
    let mut names: Vec<&str> = declared.values().flat_map(|measure| measure::series_of(&measure.kind)).collect();
    names.sort_unstable();
    names.dedup();
    let recording = Recording::read(file, &names)?;
    let (mut measures, mut faults) = (Vec::new(), Vec::new());
    for (name, declared) in declared {
        match measure::evaluate(&declared.kind, &recording, &|path| document.resolve(path)) {
            Ok(value) => measures.push(Measure {
                name: name.clone(),
                value: value * declared.scale,
                unit: if declared.unit.is_empty() { "1".to_owned() } else { declared.unit.clone() },
                description: declared.description.clone().unwrap_or_default(),
            }),
            Err(Error::Input(found)) => faults.extend(found.into_iter().map(|mut fault| {
                fault.message = format!("the measure `{name}` cannot be computed: {}", fault.message);
                // A fault that points into a table keeps its place there.
                fault.place = fault.place.or_else(|| document.key_place(&format!("measure.{name}"), "this measure"));
                fault
            })),
            Err(other) => return Err(other),
        }
    }
    if faults.is_empty() { Ok(measures) } else { Err(Error::Input(faults)) }
}
