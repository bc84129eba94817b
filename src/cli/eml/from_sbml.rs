//! `pseudopod eml from-sbml`: writes an SBML model as an EML document.

use super::read::read;
use super::written::Target;
use crate::cli::report::Report;
use crate::equations::eml::{self, Written};
use crate::error::{Error, Fault, Result, Source};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Writes an SBML model as an EML document, to edit it or to join it to cells.
#[derive(Debug, Clone, clap::Args)]
pub struct FromSbmlArgs {
    /// The SBML model.
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,
    /// Where it goes to.
    #[command(flatten)]
    pub target: Target,
}

/// Runs the command.
///
/// # Errors
/// A model that cannot be read, or says what EML cannot; a file that exists or cannot be written.
pub fn run(args: &FromSbmlArgs) -> Result<Report> {
    args.target.write(&args.model, convert)
}

/// The model as EML, and what the reader should know.
fn convert(path: &Path) -> Result<(String, Vec<String>)> {
    let mut read = read(path)?;
    if read.sbml.is_none() {
        let fault = Fault::new(format!("{} is no SBML model", path.display()));
        return Err(Error::input(fault.help("its first element must be <sbml>; an EML document needs no conversion")));
    }
    let file = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    if read.document.name.is_empty() {
        read.document.name = path.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    }
    let origin = format!("Origin: the SBML model \"{}\" ({file}), converted by Pseudopod.", read.document.name);
    let Written { text, notices } = eml::write(&read.document, &origin);
    let source = Source { name: format!("{} as EML", path.display()), text };
    // What EML cannot hold (a start that is not finite, a formula that is too deep) shows when it is read.
    let source = Arc::new(source);
    eml::read(source.clone())?;
    let text = source.text.clone();
    Ok((text, read.notices.into_iter().chain(notices).collect()))
}
