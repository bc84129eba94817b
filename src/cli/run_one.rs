//! `pseudopod run --plan`: makes one run of a study, for whoever runs studies.

use super::how::{How, cancelled_by_signals, reporter};
use super::memory;
use super::report::Report;
use super::run::{RunArgs, tell};
use crate::error::{Error, Fault, Paint, Result, render, say};
use crate::study::{Complete, Done, Files, OneOptions, Plan, run_one};
use std::path::Path;

/// Runs the command for the run that `--plan` and `--row` name.
///
/// # Errors
/// As [`run_one`].
pub fn run(args: &RunArgs) -> Result<Report> {
    let (Some(table), Some(number)) = (args.plan.as_deref(), args.row) else {
        let fault = Fault::new("no run of a study was named");
        return Err(Error::input(fault.help("give --plan and --row")));
    };
    if args.how.view {
        let fault = Fault::new("a run of a study is not shown as it goes on");
        return Err(Error::input(
            fault.help("leave --view out: pseudopod view RESULT shows a result also while it is written"),
        ));
    }
    let folder = match table.is_dir() {
        true => table,
        false => table.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new(".")),
    };
    let plan = Plan::read(folder)?;
    let run = plan.run(number)?;
    let options = OneOptions {
        threads: args.how.threads,
        cancel: cancelled_by_signals(),
        complete: if args.skip_complete { Complete::Skip } else { Complete::Refuse },
        memory: memory::allowed(args.memory.as_deref())?,
    };
    let done = run_one(&plan, run, &options, &mut *reporter(args.how.quiet))?;
    let result = Files::of(&plan, run).result;
    match done {
        Done::Skipped => {
            let words =
                if args.how.quiet { String::new() } else { format!("{}: complete already\n", result.display()) };
            Ok(Report { words, ..Report::of_files(&result, &[]) })
        }
        Done::Made { outcome, unmeasured } => {
            if !unmeasured.is_empty() {
                let words = render(&Error::Input(unmeasured), Paint::Plain);
                say(&format!("the run is complete, without some of its measures:\n{}", words.trim_end()));
            }
            // Charts and pictures of a run of many are made by hand where they are wanted.
            tell(&result, &outcome, &How { no_pictures: true, ..args.how.clone() })
        }
    }
}
