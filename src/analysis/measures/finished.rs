//! What measures are computed from.

use crate::analysis::fields::Fields;
use crate::analysis::recording::Recording;
use crate::output::ResultFile;
use std::path::{Path, PathBuf};

/// A finished run, as measures look at it.
pub struct Finished<'a> {
    /// Its series.
    pub recording: &'a Recording,
    /// The same run, for what is read frame by frame: fields, and who touches whom. A run without these has none.
    pub file: Option<&'a ResultFile>,
    /// Makes a path of the document one that the system can open.
    pub resolve: &'a dyn Fn(&Path) -> PathBuf,
}

impl<'a> Finished<'a> {
    /// Its fields.
    pub fn fields(&self) -> Fields<'a> {
        Fields::of(self.file)
    }
}
