//! What is made of a document of equations: a text in a file or on the terminal, with notices.

use super::read::named_files;
use super::solve::tell;
use crate::cli::files::{Named, refuse_existing, refuse_read, refuse_same};
use crate::cli::report::{Report, path_text, paths};
use crate::error::{Error, Result};
use std::path::{Path, PathBuf};

/// Where the text goes to.
#[derive(Debug, Clone, clap::Args)]
pub struct Target {
    /// The file to write; the terminal when absent.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Replaces a file that is there.
    #[arg(long)]
    pub force: bool,
    /// Prints what was made as JSON.
    #[arg(long, requires = "output")]
    pub json: bool,
}

impl Target {
    /// Makes the text of a document, with its notices, and writes it.
    ///
    /// # Errors
    /// As `convert`; a file that exists or cannot be written.
    pub(super) fn write(
        &self,
        read: &Path,
        convert: impl Fn(&Path) -> Result<(String, Vec<String>)>,
    ) -> Result<Report> {
        if let Some(path) = &self.output {
            refuse_same(&[read, path])?;
            refuse_read(&named_files(read), std::iter::once(path.as_path()))?;
            refuse_existing(path, self.force, Named::ByUser)?;
        }
        let (text, notices) = convert(read)?;
        if !self.json {
            tell(&notices);
        }
        let Some(path) = &self.output else { return Ok(Report { words: text, ..Report::default() }) };
        std::fs::write(path, text).map_err(|error| Error::Machine {
            message: format!("{} cannot be written: {error}", path.display()),
            help: "name a file in a folder that exists and that you may write to with -o".into(),
        })?;
        let words = format!("{}\n", path.display());
        let report = Report { words, ..Report::default() }.fact("result", path_text(read));
        let files: [PathBuf; 1] = [path.to_owned()];
        Ok(report.fact("files", paths(&files)).fact("notices", notices))
    }
}
