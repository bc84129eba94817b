//! `pseudopod info`: describes a result file.

use crate::error::Result;
use crate::output::{ResultFile, describe, to_json};
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
pub fn run(args: &InfoArgs) -> Result<()> {
    let file = ResultFile::open(&args.result)?;
    if args.json {
        println!("{:#}", to_json(&file)?);
    } else {
        print!("{}", describe(&file)?);
    }
    Ok(())
}
