//! Numbers and series from a finished result file.

use crate::error::Result;
use crate::experiment::Document;
use crate::output::{Measure, ResultFile};

/// Evaluates all measures that a document declares.
pub fn measure_result(_file: &ResultFile, _document: &Document) -> Result<Vec<Measure>> {
    Ok(Vec::new())
}
