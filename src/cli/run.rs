//! `pseudopod run`: runs an experiment and leaves its result, picture and charts.

use super::claims::Claims;
use super::files::{Named, refuse_existing};
use super::how::{How, cancelled_by_signals};
use super::memory;
use super::report::{Report, path_text, paths};
use super::view::Watch;
use crate::error::{Error, Fault, Result};
use crate::experiment::Document;
use crate::output::{Overwrite, ResultFile};
use crate::run::{self, Outcome, RunOptions};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Runs an experiment.
#[derive(Debug, Clone, clap::Args)]
pub struct RunArgs {
    /// The experiment document.
    #[arg(required_unless_present = "plan")]
    pub experiment: Option<PathBuf>,
    /// Makes a run of a study instead: the table of its runs, runs.csv.
    #[arg(long, value_name = "RUNS", requires = "row", conflicts_with_all = ["experiment", "output", "sets", "seed", "until", "force"])]
    pub plan: Option<PathBuf>,
    /// The number of the run, from 1.
    #[arg(long, value_name = "NUMBER", requires = "plan")]
    pub row: Option<u32>,
    /// Leaves a run of a study alone that is complete.
    #[arg(long, requires = "plan")]
    pub skip_complete: bool,
    /// The result file; by default results/<name of the document>.vtkhdf in the working folder.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Changes a key of the document, as in --set run.until="10 s".
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
    /// Another seed.
    #[arg(long)]
    pub seed: Option<u64>,
    /// Another end of the run, as in "10 s".
    #[arg(long, value_name = "TIME")]
    pub until: Option<String>,
    /// The most memory that it may take by an estimate, as in "8 GB"; by default what the machine has.
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<String>,
    /// Replaces a result that is there.
    #[arg(long)]
    pub force: bool,
    /// How it is run.
    #[command(flatten)]
    pub how: How,
}

/// Runs the command.
///
/// # Errors
/// As [`run::run`].
pub fn run(args: &RunArgs) -> Result<Report> {
    let Some(experiment) = args.experiment.as_deref() else {
        let fault = Fault::new("no experiment was named");
        return Err(Error::input(fault.help("name a document, or a run of a study with --plan and --row")));
    };
    let mut sets = args.sets.clone();
    sets.extend(args.seed.map(|seed| format!("seed={seed}")));
    sets.extend(args.until.as_ref().map(|until| format!("run.until={until}")));
    let mut document = Document::read(experiment, &sets)?;
    document.memory = memory::allowed(args.memory.as_deref())?;
    let result = args.output.clone().unwrap_or_else(|| default_result(experiment));
    let folder = result.parent().filter(|folder| args.output.is_none() && !folder.exists());
    folder.map_or(Ok(()), make_folder)?;
    let overwrite = if args.force { Overwrite::Replace } else { Overwrite::Refuse };
    // That the result itself exists is told by whoever makes it.
    if !args.how.no_pictures && !args.force && !result.exists() {
        for picture in crate::picture::default_files(&document, &result) {
            refuse_existing(&picture, false, Named::ByItself)?;
        }
    }
    let cancel = cancelled_by_signals();
    let watch = Watch::start(&args.how, &result, &cancel)?;
    let options = RunOptions { result: result.clone(), overwrite, threads: args.how.threads, cancel };
    let outcome = run::run(&document, &options, &mut *watch.reporter(args.how.quiet)).inspect_err(|_| {
        // A run that did not begin leaves no folder behind; one that holds something is not removed.
        folder.map(std::fs::remove_dir);
    })?;
    watch.end(tell(&result, &outcome, &args.how))
}

/// The result of a document for which no other file is named.
fn default_result(experiment: &Path) -> PathBuf {
    Path::new("results").join(default_name(experiment))
}

/// The name of the result of a document: <folder>-<document>.vtkhdf, or <folder>.vtkhdf for a document named experiment.toml.
pub fn default_name(experiment: &Path) -> String {
    let stem = experiment.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let folder = experiment.parent().and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
    let name = match folder {
        Some(folder) if stem == "experiment" => folder,
        Some(folder) => format!("{folder}-{stem}"),
        None => stem,
    };
    format!("{name}.vtkhdf")
}

/// Makes a folder for results, and those around it.
///
/// # Errors
/// [`Error::Machine`] when the system refuses.
pub fn make_folder(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|error| Error::Machine {
        message: format!("the folder {} could not be made: {error}", folder.display()),
        help: "name a result file in a folder you may write to with -o".into(),
    })
}

/// Makes the pictures and says what was done.
///
/// # Errors
/// As [`crate::picture::make_defaults`].
pub fn tell(result: &Path, outcome: &Outcome, how: &How) -> Result<Report> {
    let files = if how.no_pictures { Vec::new() } else { crate::picture::make_defaults(result)? };
    let file = ResultFile::open(result)?;
    let summary = file.summary()?;
    let claims = Claims::of(&file, &summary);
    let mut words = String::new();
    // Writing to a text cannot fail.
    if !how.quiet {
        let (name, Outcome { steps, frames, made, limited, wall_time, .. }) = (result.display(), outcome);
        let _ = writeln!(words, "{name}: {steps} steps, {frames} frames, {wall_time:.1} s");
        if *limited > 0 {
            let _ = writeln!(words, "contacts limited {limited} of {made} steps");
        }
        for path in &files {
            let _ = writeln!(words, "{}", path.display());
        }
        for measure in &summary {
            let (value, unit) = (number(measure.value), if measure.unit == "1" { "" } else { &measure.unit });
            let line = format!("{} = {value} {unit}  {}", measure.name, measure.description);
            let _ = writeln!(words, "{}", line.trim_end());
        }
        claims.add_words(&mut words);
    }
    let measures = summary.into_iter().map(|m| (m.name, serde_json::json!({ "value": m.value, "unit": m.unit })));
    let report = Report { words, ..Report::default() }.fact("result", path_text(result)).fact("files", paths(&files));
    let report = claims.add_facts(report);
    Ok(report
        .fact("steps", outcome.steps)
        .fact("frames", outcome.frames)
        .fact("steps_limited_by_contacts", outcome.limited)
        .fact("cells_pushed_apart", outcome.pushed.cells)
        .fact("farthest_push_um", outcome.pushed.farthest)
        .fact("wall_time_s", outcome.wall_time)
        .fact("summary", measures.collect::<serde_json::Map<_, _>>()))
}

/// A number with six digits, whatever its size.
fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-3..1e6).contains(&size) { format!("{value:.6}") } else { format!("{value:.5e}") }
}
