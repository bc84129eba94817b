//! `pseudopod fit`: fits parameters of an experiment to data.

use super::files::{Named, refuse_existing};
use super::how::cancelled_by_signals;
use super::memory;
use super::report::{Report, path_text, paths};
use super::run::{default_name, make_folder};
use crate::error::{Result, say, short};
use crate::picture::save_stacked;
use crate::study::fit::charts::figures;
use crate::study::fit::{
    EvaluateOptions, FitDocument, Outcome, PROBLEM, Prepared, facts, fit, percent, read_petab, verdicts, write_petab,
    write_tables,
};
use crate::study::{Replaces, absolute, refused, relative};
use serde_json::Value;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Fits parameters of an experiment to data: their best values, intervals, what the data do not determine, tables and pictures. Runs that are in
/// the folder already are not made again.
#[derive(Debug, Clone, clap::Args)]
pub struct FitArgs {
    /// The fit document; or the problem.yaml of a PEtab problem of version 2, which is written as a fit document into the folder.
    pub fit: PathBuf,
    /// The folder of runs, tables and pictures; by default results/NAME.
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
    /// Runs at a time; by default as many as there are cores.
    #[arg(short, long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub jobs: Option<u32>,
    /// Threads of each run; by default the cores divided among the runs. Results do not depend on it.
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub threads: Option<u32>,
    /// The most memory that a run may take by an estimate, as in "8 GB"; by default what the machine has.
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<String>,
    /// Takes a folder that holds another fit, or this one before it changed; runs of the same inputs stay.
    #[arg(long)]
    pub force: bool,
    /// Writes the fit as tables of PEtab, version 2, into this folder, and runs nothing.
    #[arg(long, value_name = "FOLDER")]
    pub petab: Option<PathBuf>,
    /// Says nothing of the way there.
    #[arg(short, long)]
    pub quiet: bool,
    /// Prints what was found as JSON.
    #[arg(long)]
    pub json: bool,
    /// Makes no pictures.
    #[arg(long)]
    pub no_pictures: bool,
}

/// Runs the command. Tables and pictures that are there are replaced: they follow from the runs.
///
/// # Errors
/// As [`Prepared::new`] and [`fit`]; a folder with another plan.
pub fn run(args: &FitArgs) -> Result<Report> {
    let folder = args.output.clone().unwrap_or_else(|| default_folder(&args.fit));
    if args.fit.extension().is_some_and(|ending| ending == "yaml" || ending == "yml") {
        return from_petab(&args.fit, &folder, args.force);
    }
    let document = FitDocument::read(&args.fit)?;
    let memory = memory::allowed(args.memory.as_deref())?;
    let prepared = Prepared::new(document, &folder, memory)?;
    if let Some(folder) = &args.petab {
        return to_petab(&prepared, folder, args.force);
    }
    prepared.plan.write(if args.force { Replaces::Plan } else { Replaces::Nothing })?;
    let _alone = prepared.plan.claim("fit")?;
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let jobs = args.jobs.map_or(cores, |jobs| jobs as usize);
    let tell = |words: &str| {
        if !args.quiet {
            say(words);
        }
    };
    let options = EvaluateOptions {
        jobs,
        threads: args.threads.map_or((cores / jobs).max(1), |threads| threads as usize),
        cancel: cancelled_by_signals(),
        memory,
        tell: &tell,
    };
    let outcome = fit(&prepared, &options)?;
    let mut files = write_tables(&outcome, &folder)?;
    if !args.no_pictures {
        let pictures = folder.join("figures");
        std::fs::create_dir_all(&pictures).map_err(|error| refused(&pictures, &error))?;
        for figure in figures(&outcome, &prepared.document.fit.title) {
            files.extend(save_stacked(&figure.charts, &pictures.join(&figure.name))?);
        }
    }
    let mut words = told(&outcome);
    for path in &files {
        let _ = writeln!(words, "{}", path.display());
    }
    let mut report = Report { words, ..Report::default() }.fact("folder", path_text(&folder));
    report = report.fact("files", paths(&files)).fact("runs_made", outcome.made);
    if let Value::Object(found) = facts(&outcome) {
        report = found.into_iter().fold(report, |report, (name, value)| report.fact(&name, value));
    }
    Ok(report)
}

/// Writes a PEtab problem as a fit.
fn from_petab(problem: &Path, folder: &Path, force: bool) -> Result<Report> {
    make_folder(folder)?;
    refuse_existing(&folder.join("fit.toml"), force, Named::ByUser)?;
    let files = read_petab(problem, folder)?;
    let next = format!("next: pseudopod fit {}\n", files[0].display());
    Ok(written(&files, &next))
}

/// Writes a fit as a PEtab problem.
fn to_petab(prepared: &Prepared, folder: &Path, force: bool) -> Result<Report> {
    make_folder(folder)?;
    refuse_existing(&folder.join(PROBLEM), force, Named::ByUser)?;
    let experiment = relative(&absolute(&prepared.document.study.experiment()), &absolute(folder));
    let files = write_petab(&prepared.document.fit, &prepared.space, &prepared.observed, &experiment, folder)?;
    Ok(written(&files, ""))
}

fn written(files: &[PathBuf], next: &str) -> Report {
    let words = files.iter().map(|path| format!("{}\n", path.display())).collect::<String>() + next;
    Report { words, ..Report::default() }.fact("files", paths(files))
}

/// The folder of a fit for which no other is named: results/FOLDER-NAME.
fn default_folder(document: &Path) -> PathBuf {
    Path::new("results").join(default_name(document)).with_extension("")
}

/// What was found, in words.
fn told(outcome: &Outcome) -> String {
    let mut words = String::new();
    let sure = percent(outcome.confidence);
    for (axis, found) in outcome.each() {
        // Writing to a text cannot fail.
        let _ = writeln!(words, "{}", axis.told(found.value));
        if let Some(ends) = found.profile {
            let [low, high] = ends.map(|end| end.map_or("none".to_owned(), |end| axis.with_unit(end)));
            let _ = writeln!(words, "  {sure} % by the profile likelihood: {low} to {high}");
        }
        let [low, high] = found.covariance.map(|end| axis.with_unit(end));
        let _ = writeln!(words, "  {sure} % by the covariance: {low} to {high}");
    }
    let data: usize = outcome.compared.iter().map(|one| one.observed.data.len()).sum();
    let _ = writeln!(
        words,
        "χ² = {} of {data} data and {} degrees of freedom; {} evaluations, {} runs made",
        short((1e4 * outcome.chi2).round() / 1e4),
        outcome.freedom,
        outcome.evaluations.len(),
        outcome.made
    );
    verdicts(outcome).iter().for_each(|verdict| {
        let _ = writeln!(words, "note: {verdict}");
    });
    words
}
