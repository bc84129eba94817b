//! `pseudopod resume`: goes on with a run from its last checkpoint.

use super::report::Report;
use super::run::{How, cancelled_by_signals, reporter, tell};
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
    let (threads, cancel) = (args.how.threads, cancelled_by_signals());
    let outcome = crate::run::resume(&args.result, threads, &cancel, &mut *reporter(&args.how))?;
    tell(&args.result, &outcome, &args.how)
}
