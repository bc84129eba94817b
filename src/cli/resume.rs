//! `pseudopod resume`: goes on with a run from its last checkpoint.

use super::report::Report;
use super::run::{How, reporter, stop_on_signals, tell};
use crate::error::Result;
use std::path::PathBuf;

/// Goes on with a run that was stopped or killed.
#[derive(Debug, Clone, clap::Args)]
pub struct ResumeArgs {
    /// The result file of the run.
    pub result: PathBuf,
    /// How it is run.
    #[command(flatten)]
    pub how: How,
}

/// Runs the command.
///
/// # Errors
/// As [`crate::run::resume`].
pub fn run(args: &ResumeArgs) -> Result<Report> {
    if crate::run::finished_already(&args.result)?.is_some() {
        let words = match args.how.quiet {
            true => String::new(),
            false => format!("{}: finished already, nothing to resume\n", args.result.display()),
        };
        return Ok(Report { words, ..Report::of_files(&args.result, &[]) });
    }
    stop_on_signals();
    let outcome = crate::run::resume(&args.result, args.how.threads, &mut *reporter(&args.how))?;
    tell(&args.result, &outcome, &args.how)
}
