//! `pseudopod schema`: prints the JSON schema of the experiment document.

use crate::error::{Error, Result};
use std::io::Write;
use std::path::PathBuf;

/// Prints the JSON schema of the experiment document, for editors.
#[derive(Debug, Clone, clap::Args)]
pub struct SchemaArgs {
    /// Writes to this file instead of the terminal.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// The schema as text, the same as in `docs/experiment.schema.json`.
pub fn text() -> String {
    format!("{:#}\n", crate::experiment::schema())
}

/// Runs the command.
///
/// # Errors
/// The file or the terminal cannot be written.
pub fn run(args: SchemaArgs) -> Result<()> {
    let written = match &args.output {
        Some(path) => std::fs::write(path, text()),
        None => std::io::stdout().write_all(text().as_bytes()),
    };
    let name = args.output.map_or("standard output".to_owned(), |path| path.display().to_string());
    written.map_err(|error| Error::Machine {
        message: format!("{name} cannot be written: {error}"),
        help: "choose another file with -o".into(),
    })
}
