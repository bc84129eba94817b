//! `pseudopod eml to-sbml`: writes an EML document as an SBML model.

use super::read::read;
use super::written::Target;
use crate::cli::report::Report;
use crate::equations::eml::Written;
use crate::equations::sbml;
use crate::error::{Error, Fault, Result};
use std::path::{Path, PathBuf};

/// Writes an EML document as an SBML model (Level 3 Version 2), for other programs.
#[derive(Debug, Clone, clap::Args)]
pub struct ToSbmlArgs {
    /// The EML document.
    #[arg(value_name = "FILE")]
    pub document: PathBuf,
    /// Where it goes to.
    #[command(flatten)]
    pub target: Target,
}

/// Runs the command.
///
/// # Errors
/// A document that cannot be read, or says what SBML cannot; a file that exists or cannot be written.
pub fn run(args: &ToSbmlArgs) -> Result<Report> {
    args.target.write(&args.document, convert)
}

/// The document as SBML, and what the reader should know.
fn convert(path: &Path) -> Result<(String, Vec<String>)> {
    let read = read(path)?;
    if read.sbml.is_some() {
        let fault = Fault::new(format!("{} is an SBML model already", path.display()));
        return Err(Error::input(fault.help("name an EML document; `eml from-sbml` writes a model as one")));
    }
    let Written { text, notices } = sbml::write(&read.document)?;
    Ok((text, notices))
}
