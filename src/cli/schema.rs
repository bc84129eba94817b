//! `pseudopod schema`: prints the JSON schema of documents.

use super::files::{Named, refuse_existing};
use super::report::Report;
use crate::error::{Error, Result};
use std::path::{Path, PathBuf};

/// Prints the JSON schema of the experiment document, for editors.
#[derive(Debug, Clone, clap::Args)]
pub struct SchemaArgs {
    /// That of studies instead.
    #[arg(long)]
    pub study: bool,
    /// That of fits instead.
    #[arg(long, conflicts_with = "study")]
    pub fit: bool,
    /// Writes to this file instead of the terminal.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Replaces a file that is there.
    #[arg(long)]
    pub force: bool,
}

/// The schema as text, the same as in `docs/experiment.schema.json`.
pub fn text() -> String {
    format!("{:#}\n", crate::experiment::schema())
}

/// The schema of studies, the same as in `docs/study.schema.json`.
pub fn study_text() -> String {
    format!("{:#}\n", crate::study::schema())
}

/// The schema of fits, the same as in `docs/fit.schema.json`.
pub fn fit_text() -> String {
    format!("{:#}\n", crate::study::fit::schema())
}

/// Runs the command.
///
/// # Errors
/// The file exists or cannot be written.
pub fn run(args: &SchemaArgs) -> Result<Report> {
    let words = match args {
        SchemaArgs { study: true, .. } => study_text(),
        SchemaArgs { fit: true, .. } => fit_text(),
        _ => text(),
    };
    printed(words, args.output.as_deref(), args.force)
}

/// What a command prints, or writes to a file that the user names.
///
/// # Errors
/// The file exists or cannot be written.
pub(super) fn printed(words: String, output: Option<&Path>, force: bool) -> Result<Report> {
    let Some(path) = output else { return Ok(Report { words, ..Report::default() }) };
    refuse_existing(path, force, Named::ByUser)?;
    std::fs::write(path, words).map_err(|error| Error::Machine {
        message: format!("{} cannot be written: {error}", path.display()),
        help: "name a file in a folder that exists and that you may write to with -o".into(),
    })?;
    Ok(Report::default())
}
