//! What is made of a document of equations: a text in a file or on the terminal, with notices.

use super::solve::tell;
use crate::cli::files::{Named, refuse_existing, refuse_same};
use crate::cli::report::{Report, path_text, paths};
use crate::error::{Error, Result};
use std::path::{Path, PathBuf};

/// Where a text comes from and goes to.
pub(super) struct Target<'a> {
    /// The document that it is made of.
    pub read: &'a Path,
    /// The file that it goes to; the terminal when absent.
    pub output: Option<&'a Path>,
    /// Whether a file that is there is replaced.
    pub force: bool,
    /// Whether what was made is told as JSON.
    pub json: bool,
}

impl Target<'_> {
    /// Makes the text, with its notices, and writes it.
    ///
    /// # Errors
    /// As `convert`; a file that exists or cannot be written.
    pub fn write(&self, convert: impl Fn(&Path) -> Result<(String, Vec<String>)>) -> Result<Report> {
        if let Some(path) = self.output {
            refuse_same(&[self.read, path])?;
            refuse_existing(path, self.force, Named::ByUser)?;
        }
        let (text, notices) = convert(self.read)?;
        if !self.json {
            tell(&notices);
        }
        let Some(path) = self.output else { return Ok(Report { words: text, ..Report::default() }) };
        std::fs::write(path, text).map_err(|error| Error::Machine {
            message: format!("{} cannot be written: {error}", path.display()),
            help: "name a file in a folder that exists and that you may write to with -o".into(),
        })?;
        let words = format!("{}\n", path.display());
        let report = Report { words, ..Report::default() }.fact("result", path_text(self.read));
        let files: [PathBuf; 1] = [path.to_owned()];
        Ok(report.fact("files", paths(&files)).fact("notices", notices))
    }
}
