//! `pseudopod check`: finds all faults of experiment documents without running them.

use crate::error::{Error, Result};
use crate::experiment::Document;
use std::path::PathBuf;

/// Checks experiment documents and reports all their faults.
#[derive(Debug, Clone, clap::Args)]
pub struct CheckArgs {
    /// The documents.
    #[arg(required = true, value_name = "EXPERIMENT")]
    pub documents: Vec<PathBuf>,
    /// Changes a key before checking, as in --set run.until="10 s".
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
}

/// Runs the command: a line for every good document, then the faults of all others.
///
/// # Errors
/// [`Error::Input`] with the faults of all documents.
pub fn run(args: CheckArgs) -> Result<()> {
    let mut faults = Vec::new();
    for path in &args.documents {
        match Document::read(path, &args.sets) {
            Ok(document) => {
                let cells: usize = document.experiment.cells.values().map(|cell| cell.count()).sum();
                let (types, title) = (document.experiment.cells.len(), &document.experiment.title);
                println!("{}: good: \"{title}\", {cells} cells of {types} types", path.display());
            }
            Err(Error::Input(found)) => faults.extend(found),
            Err(other) => return Err(other),
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(Error::Input(faults)) }
}
