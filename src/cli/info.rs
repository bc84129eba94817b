//! `pseudopod info`: describes a result file.

use super::report::Report;
use crate::error::Result;
use crate::output::{ResultFile, describe, to_json};
use serde_json::Value;
use std::path::PathBuf;

/// Describes a result file.
#[derive(Debug, Clone, clap::Args)]
pub struct InfoArgs {
    /// The result file.
    pub result: PathBuf,
    /// Prints everything in the file but the arrays, as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the command.
///
/// # Errors
/// As [`ResultFile::open`].
pub fn run(args: &InfoArgs) -> Result<Report> {
    let file = ResultFile::open(&args.result)?;
    if !args.json {
        return Ok(Report { words: describe(&file)?, ..Report::default() });
    }
    let Value::Object(facts) = to_json(&file)? else { return Ok(Report::default()) };
    Ok(Report { facts, ..Report::default() })
}
