//! `pseudopod sweep plan`: lists the runs of a study.

use crate::cli::memory;
use crate::cli::report::{Report, path_text, paths};
use crate::error::{Result, say};
use crate::study::{
    Design, Looked, PLAN_FILE, Plan, Points, RUNS_FILE, Replaces, StudyDocument, look_over, points, probe, snakemake,
    told,
};
use clap::ValueEnum;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::Duration;

/// Lists the runs of a study in a folder: runs.csv, with a row for each, and plan.json.
#[derive(Debug, Clone, clap::Args)]
pub struct PlanArgs {
    /// The study document.
    pub study: PathBuf,
    /// The folder of the study's plan, results and tables.
    #[arg(short, long, value_name = "FOLDER")]
    pub output: PathBuf,
    /// Tells nothing of how long runs will take, which costs some seconds to find out.
    #[arg(long)]
    pub no_probe: bool,
    /// Writes a workflow for another engine as well, which makes the same runs.
    #[arg(long, value_name = "NAME")]
    pub engine: Option<Engine>,
    /// The most memory that a run may take by an estimate, as in "8 GB"; by default what the machine has.
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<String>,
    /// Replaces the plan that is there; results stay, and those of other inputs are told as such.
    #[arg(long)]
    pub force: bool,
    /// Prints what was done as JSON.
    #[arg(long)]
    pub json: bool,
}

/// What workflows are written for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Engine {
    /// A Snakefile.
    Snakemake,
}

/// How long an experiment is tried to tell how long its runs take.
const PROBE: Duration = Duration::from_secs(3);

/// Runs the command.
///
/// # Errors
/// [`Error::Input`] for a study that is wrong, an experiment that does not take its values, and a folder with another plan.
pub fn run(args: &PlanArgs) -> Result<Report> {
    let study = StudyDocument::read(&args.study)?;
    let points = points(&study)?;
    let looked = look_over(&study, &points, memory::allowed(args.memory.as_deref())?)?;
    let mut words = told_points(&study, &points, &looked);
    let number = points.rows.len() as u64;
    let plan = Plan::new(&study, points, &looked.some[0], &looked.files, &args.output);
    plan.write(if args.force { Replaces::Plan } else { Replaces::Nothing })?;
    let mut files = [RUNS_FILE, PLAN_FILE].map(|name| args.output.join(name)).to_vec();
    if args.engine == Some(Engine::Snakemake) {
        files.push(snakemake::write(&plan)?);
    }
    let runs = plan.runs.len();
    let mut report =
        Report::default().fact("runs", runs).fact("points", number).fact("replicates", plan.facts.replicates);
    if !args.no_probe {
        match probe(&looked.some, PROBE) {
            Ok(found) => {
                let all = found.seconds * runs as f64;
                let (one, all_told, four) = (told(found.seconds), told(all), told(all / 4.0));
                let _ = writeln!(
                    words,
                    "about {one} a run on one core, by {:.1} % of {} of them: {all_told} in all, {four} with -j 4",
                    100.0 * found.share,
                    looked.some.len()
                );
                report = report.fact("seconds_a_run", found.seconds).fact("seconds", all);
            }
            // The plan stands; what is wrong shows again when the run is made.
            Err(error) => say(&format!("a run that was tried fails soon: {error}")),
        }
    }
    for path in &files {
        let _ = writeln!(words, "{}", path.display());
    }
    let _ = writeln!(words, "next: pseudopod sweep run {}", args.output.display());
    Ok(Report { words, ..report.fact("folder", path_text(&args.output)).fact("files", paths(&files)) })
}

/// "200 runs: 40 points, each 5 times; 40 of them were read and 12 built".
fn told_points(study: &StudyDocument, points: &Points, looked: &Looked) -> String {
    let (number, replicates) = (points.rows.len(), study.study.replicates);
    let mut words = format!("{} runs: {number} points", number as u64 * u64::from(replicates));
    // Writing to a text cannot fail.
    let _ =
        write!(words, "{}", if replicates == 1 { String::new() } else { format!(", each with {replicates} seeds") });
    let all = |checked: usize| if checked == number { "all".to_owned() } else { format!("{checked} of them") };
    let _ = writeln!(words, "; {} read and {} built without a fault", all(looked.read), all(looked.built));
    if let Design::Saltelli { number: base } = study.study.design {
        let (each, parameters) = (number / base as usize, study.study.parameter.len());
        let _ = writeln!(words, "{base} base points of {parameters} parameters, each with {each} points");
    }
    if let Design::Sobol { number } | Design::Saltelli { number } = study.study.design
        && !number.is_power_of_two()
    {
        let _ = writeln!(
            words,
            "{number} points of a Sobol sequence are not as even as {} or {}",
            number.next_power_of_two() / 2,
            number.next_power_of_two()
        );
    }
    words
}
