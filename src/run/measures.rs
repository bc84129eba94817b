//! The measures that a document declares, computed from its finished run.

use crate::analysis::measures::Finished;
use crate::analysis::recording::Recording;
use crate::error::{Error, Fault, Result};
use crate::experiment::Document;
use crate::output::{Measure, ResultFile};

/// Evaluates all measures that a document declares, each multiplied by its scale. Those that cannot be computed come
/// as faults with their places in the document beside the others, which are worth keeping all the same.
///
/// # Errors
/// A damaged file.
pub fn measure_result(file: &ResultFile, document: &Document) -> Result<(Vec<Measure>, Vec<Fault>)> {
    let declared = &document.experiment.measure;
    let mut names: Vec<&str> = declared.values().flat_map(|measure| measure.kind.series()).collect();
    names.sort_unstable();
    names.dedup();
    let recording = Recording::read(file, &names)?;
    let run = Finished { recording: &recording, file: Some(file), resolve: &|path| document.resolve(path) };
    let (mut measures, mut faults) = (Vec::new(), Vec::new());
    for (name, declared) in declared {
        match declared.kind.evaluate(&run) {
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

#[cfg(test)]
#[path = "measures_tests.rs"]
mod tests;
