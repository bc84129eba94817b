//! `pseudopod resume`: goes on with a run from its last checkpoint.

use super::crash;
use super::how::{How, cancelled_by_signals};
use super::memory;
use super::report::{Form, Report};
use super::run::tell;
use super::view::Watch;
use crate::error::Result;
use crate::output::{ResultFile, to_json};
use crate::run::ResumeOptions;
use std::path::{Path, PathBuf};

/// Goes on with a run that was stopped or killed.
#[derive(Debug, Clone, clap::Args)]
pub struct ResumeArgs {
    /// The result file of the run.
    pub result: PathBuf,
    /// The most memory that it may take by an estimate, as in "8 GB"; by default what the machine has.
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<String>,
    /// How it is run.
    #[command(flatten)]
    pub how: How,
}

/// Runs the command.
///
/// # Errors
/// As [`crate::run::resume`].
pub fn run(args: &ResumeArgs) -> Result<Report> {
    let memory = memory::allowed(args.memory.as_deref())?;
    let form = if args.how.json { Form::Json } else { Form::Words };
    let finished = crash::told_as_damage("resume", form, &args.result, || {
        if args.result.exists() {
            read_through(&args.result);
        }
        crate::run::finished_already(&args.result)
    })?;
    if finished.is_some() {
        let words = match args.how.quiet {
            true => String::new(),
            false => format!("{}: finished already, nothing to resume\n", args.result.display()),
        };
        return Ok(Report { words, ..Report::of_files(&args.result, &[]) });
    }
    let cancel = cancelled_by_signals();
    let watch = Watch::start(&args.how, &args.result, &cancel)?;
    let options = ResumeOptions { threads: args.how.threads, memory, cancel };
    let outcome = crate::run::resume(&args.result, &options, &mut *watch.reporter(args.how.quiet))?;
    watch.end(tell(&args.result, &outcome, &args.how))
}

/// Reads what going on will read, so that a damaged file is told of before anything of it is changed. What is wrong with it in an
/// orderly way is told by whoever reads it next.
fn read_through(result: &Path) {
    if let Ok(file) = ResultFile::open(result) {
        let _ = to_json(&file);
        let last = file.frames() - 1;
        let _ = file.positions(last).and_then(|_| file.forces(last));
        file.series_names().iter().for_each(|name| drop(file.cell_values(name, last)));
    }
}
