//! `pseudopod verify`: holds experiments and results to what is claimed of them.

use super::claims::claim_object;
use super::crash;
use super::how::{cancelled_by_signals, reporter};
use super::memory;
use super::report::{Form, Report, path_text};
use super::run::{default_name, make_folder};
use crate::analysis::claims::ClaimResult;
use crate::error::{Error, Fault, Paint, Result, render, say};
use crate::output::Overwrite;
use crate::run::RunOptions;
use crate::simulation::CancelToken;
use crate::verify::{Of, Subject, subjects, table};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Runs experiments, or reads results, and tells which of the claims about them (expected.toml) hold. Exit status 3 if any does not.
#[derive(Debug, Clone, clap::Args)]
pub struct VerifyArgs {
    /// A document, a folder of an experiment or of several, or a result.
    #[arg(required = true, value_name = "TARGET")]
    pub targets: Vec<PathBuf>,
    /// The claims; by default the expected.toml beside the document.
    #[arg(long, value_name = "FILE")]
    pub expected: Option<PathBuf>,
    /// Keeps the results of the runs in this folder.
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
    /// Replaces results that are there.
    #[arg(long, requires = "output")]
    pub force: bool,
    /// Threads; the result does not depend on it.
    #[arg(long)]
    pub threads: Option<usize>,
    /// Says nothing but errors, those about claims included.
    #[arg(short, long)]
    pub quiet: bool,
    /// Prints what was found as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the command: all that can be told without a run comes first, so that nobody waits an hour for a misspelt word.
///
/// # Errors
/// [`Error::Input`] with the faults of all documents and claims, [`Error::Stopped`] when interrupted. Claims that do not hold
/// and runs that fail are told in the report.
pub fn run(args: &VerifyArgs) -> Result<Report> {
    let subjects = all_subjects(args)?;
    let claims: usize = subjects.iter().map(|subject| subject.claims.len()).sum();
    if subjects.len() > 1 && !args.quiet {
        say(&format!("{} experiments with {claims} claims", subjects.len()));
    }
    let scratch = scratch_folder()?;
    let folder = args.output.as_deref().unwrap_or(scratch.path());
    make_folder(folder)?;
    let cancel = cancelled_by_signals();
    let mut told = Told::default();
    for (number, subject) in subjects.iter().enumerate() {
        if let (Of::Document(_), false) = (&subject.of, args.quiet) {
            say(&format!("{}: running ({} of {})", subject.path.display(), number + 1, subjects.len()));
        }
        let outcome = verify(subject, folder, args, &cancel);
        told.add(subject, outcome, args)?;
    }
    Ok(told.report(subjects.len()))
}

fn all_subjects(args: &VerifyArgs) -> Result<Vec<Subject>> {
    if let (Some(_), [_, _, ..]) = (&args.expected, args.targets.as_slice()) {
        let fault = Fault::new("--expected was given with several targets");
        return Err(Error::input(fault.help("verify one document or result at a time with --expected")));
    }
    let form = if args.json { Form::Json } else { Form::Words };
    let memory = memory::allowed(None)?;
    let (mut found, mut faults) = (Vec::new(), Vec::new());
    for target in &args.targets {
        let read = crash::told_as_damage("verify", form, target, || subjects(target, args.expected.as_deref()));
        match read {
            Ok(more) => found.extend(more),
            Err(Error::Input(more)) => faults.extend(more),
            Err(other) => return Err(other),
        }
    }
    for subject in &mut found {
        if let Of::Document(document) = &mut subject.of {
            document.memory = memory;
        }
    }
    if faults.is_empty() { Ok(found) } else { Err(Error::Input(faults)) }
}

fn scratch_folder() -> Result<tempfile::TempDir> {
    tempfile::Builder::new().prefix("pseudopod-verify-").tempdir().map_err(|error| Error::Machine {
        message: format!("a folder for results could not be made: {error}"),
        help: "name one that you may write to with -o, or in the variable TMPDIR".into(),
    })
}

/// Runs or reads one subject. A result that nobody asked to keep goes once it is read.
fn verify(subject: &Subject, folder: &Path, args: &VerifyArgs, cancel: &CancelToken) -> Result<Vec<ClaimResult>> {
    let result = folder.join(default_name(&subject.path));
    let overwrite = if args.force { Overwrite::Replace } else { Overwrite::Refuse };
    let options = RunOptions { overwrite, threads: args.threads, cancel: cancel.clone(), ..RunOptions::new(&result) };
    let outcome = subject.verify(&options, &mut *reporter(args.quiet));
    if let (None, Of::Document(_)) = (&args.output, &subject.of) {
        // Should it stay, it goes with its folder.
        drop(std::fs::remove_file(&result));
    }
    outcome
}

/// What was found so far.
#[derive(Default)]
struct Told {
    words: String,
    experiments: Vec<Value>,
    held: usize,
    claims: usize,
    missed: Vec<String>,
    faults: Vec<Fault>,
}

impl Told {
    /// Takes down what became of a subject. Only an interruption and a machine that fails end everything.
    fn add(&mut self, subject: &Subject, outcome: Result<Vec<ClaimResult>>, args: &VerifyArgs) -> Result<()> {
        let (results, failure) = match outcome {
            Ok(results) => (results, None),
            Err(Error::Interrupted { time, .. }) if args.output.is_none() => {
                let message =
                    format!("interrupted at t = {} s of {}", crate::error::short(time), subject.path.display());
                return Err(Error::Stopped { message, help: "verify begins anew; with -o results are kept".into() });
            }
            Err(error @ (Error::Input(_) | Error::Numbers { .. })) => (subject.unmeasured(), Some(error)),
            Err(other) => return Err(other),
        };
        let (held, name) = (results.iter().filter(|result| result.holds()).count(), subject.path.display());
        let mut words = format!("{name}: {}\n", subject.title);
        if let Of::Result { notice: Some(notice) } = &subject.of {
            // Writing to a text cannot fail.
            let _ = writeln!(words, "  {notice}");
        }
        words.push_str(&table(&results));
        let _ = writeln!(words, "  {held} of {} claims hold\n", results.len());
        let mut object = json!({
            "path": path_text(&subject.path), "title": subject.title, "hold": held, "number": results.len(),
            "claims": results.iter().map(claim_object).collect::<Vec<_>>(),
        });
        if let Some(error) = failure {
            object["failure"] = error.to_string().into();
            match error {
                // Told with all others when everything is done.
                Error::Input(faults) => self.faults.extend(faults),
                other => say(render(&other, Paint::Plain).trim_end()),
            }
        }
        let missed = results.iter().filter(|result| !result.holds());
        self.missed.extend(missed.map(|result| format!("{name}: {result}")));
        self.held += held;
        self.claims += results.len();
        self.experiments.push(object);
        if !args.quiet {
            self.words.push_str(&words);
        }
        Ok(())
    }

    fn report(mut self, subjects: usize) -> Report {
        let (held, claims) = (self.held, self.claims);
        let sum = format!("{held} of {claims} claims hold");
        if subjects > 1 && !self.words.is_empty() {
            let _ = writeln!(self.words, "{sum}, of {subjects} experiments");
        }
        let words = if subjects > 1 { self.words } else { self.words.trim_end().to_owned() + "\n" };
        let failure = if !self.faults.is_empty() {
            Some(Error::Input(self.faults))
        } else if self.missed.is_empty() {
            None
        } else {
            let help = "see the README of the experiment for what may differ; a claim that you changed on purpose gets its new bound and reason";
            let missed = self.missed.join("\n");
            Some(Error::Numbers { message: format!("{sum}; these do not:\n{missed}"), help: help.into(), kept: None })
        };
        let words = if words == "\n" { String::new() } else { words };
        Report { words, failure, ..Report::default() }
            .fact("hold", held)
            .fact("number", claims)
            .fact("experiments", self.experiments)
    }
}
