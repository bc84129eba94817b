//! One run of a study, by itself: begun, gone on with, or left alone where it is complete.
//!
//! A run is made in a folder of its own, `runs/00012.part`, and moves out of it when it is complete. So what is named like a result is
//! one, and what a kill leaves behind is found by whoever makes the run next.

use super::facts::Run;
use super::paths::{fingerprint, refused};
use super::plan::Plan;
use crate::error::{Error, Fault, Result, short};
use crate::experiment::Document;
use crate::output::{Header, Overwrite, ResultFile, checkpoint_path};
use crate::run::{self, Outcome, Report, ResumeOptions, RunOptions, finished_already};
use crate::simulation::CancelToken;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How a run of a study is to be made.
#[derive(Debug, Clone)]
pub struct OneOptions {
    /// Threads; all cores when absent. The result does not depend on it.
    pub threads: Option<usize>,
    /// Ends the run at the next step; the next try goes on from there.
    pub cancel: CancelToken,
    /// What becomes of a run that is complete.
    pub complete: Complete,
    /// Bytes of memory that it may take, by an estimate; any number when absent.
    pub memory: Option<u64>,
}

/// What becomes of a run that is complete already.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Complete {
    /// It is left alone, which is no error.
    Skip,
    /// It is an error.
    Refuse,
}

/// What was done.
#[derive(Debug)]
pub enum Done {
    /// Nothing: the run was complete.
    Skipped,
    /// The run came to its end.
    Made {
        /// What it did; steps and frames include those of earlier tries.
        outcome: Outcome,
        /// Why measures could not be taken.
        unmeasured: Vec<Fault>,
    },
}

/// The files of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Files {
    /// The result once it is complete.
    pub result: PathBuf,
    /// The folder in which it is made.
    pub part: PathBuf,
    /// The result while it is made.
    pub partial: PathBuf,
    /// Why the last try failed.
    pub trouble: PathBuf,
    /// What was said while it was run by `sweep run` or by a workflow.
    pub log: PathBuf,
}

impl Files {
    /// The files of a run of a plan.
    pub fn of(plan: &Plan, run: &Run) -> Self {
        let result = plan.folder.join(&run.output);
        let part = result.with_extension("part");
        let partial = part.join(result.file_name().unwrap_or_default());
        let log = plan.folder.join("logs").join(format!("{:05}.log", run.number));
        Self { trouble: part.join("trouble.txt"), result, part, partial, log }
    }
}

/// Makes a run of a plan.
///
/// # Errors
/// As [`run::run`], with [`Error::Stopped`] once the token is cancelled; [`Error::Input`] for a result or a begun run of other inputs, and
/// for files that changed since the study was planned.
pub fn run_one(plan: &Plan, run: &Run, options: &OneOptions, report: &mut dyn Report) -> Result<Done> {
    let files = Files::of(plan, run);
    if files.result.exists() {
        let file = ResultFile::open(&files.result)?;
        check_inputs(plan, run, file.header(), &files.result)?;
        return match options.complete {
            Complete::Skip => Ok(Done::Skipped),
            Complete::Refuse => {
                let fault = Fault::new(format!("{} is complete", files.result.display()));
                Err(Error::input(fault.help("add --skip-complete to leave it alone, or remove it to make it again")))
            }
        };
    }
    let begun = begun_before(plan, run, &files)?;
    plan.check_files()?;
    let made = match begun {
        true => {
            let OneOptions { threads, memory, cancel, .. } = options.clone();
            run::resume(&files.partial, &ResumeOptions { threads, memory, cancel }, report)
        }
        false => begin(plan, run, &files, options, report),
    };
    let done = match made {
        Ok(outcome) => Done::Made { outcome, unmeasured: Vec::new() },
        Err(Error::Interrupted { time, .. }) => {
            let message = format!("run {} was interrupted at t = {} s", run.number, short(time));
            return Err(Error::Stopped { message, help: "the same command goes on from there".into() });
        }
        // Measures are the last that is done: the run is complete without one.
        Err(Error::Input(unmeasured)) => match finished_already(&files.partial) {
            Ok(Some(outcome)) => Done::Made { outcome, unmeasured },
            _ => return Err(keep(Error::Input(unmeasured), &files)),
        },
        Err(other) => return Err(keep(other, &files)),
    };
    move_out(&files).map_err(|error| refused(&files.result, &error))?;
    Ok(done)
}

/// Whether there is something to go on with. What was begun and holds nothing is removed.
fn begun_before(plan: &Plan, run: &Run, files: &Files) -> Result<bool> {
    let refused = |error: std::io::Error| refused(&files.part, &error);
    if !files.part.exists() {
        return Ok(false);
    }
    let found = wait_for_its_writer(&files.partial);
    let _ = std::fs::remove_file(&files.trouble);
    match found {
        Some(file) => {
            check_inputs(plan, run, file.header(), &files.part)?;
            Ok(true)
        }
        None if checkpoint_path(&files.partial).exists() => Ok(true),
        None => {
            std::fs::remove_dir_all(&files.part).map_err(refused)?;
            Ok(false)
        }
    }
}

/// How long a process is waited for that still writes the run: one whose parent was killed stops after its step.
const LONGEST_WAIT: Duration = Duration::from_secs(10);

/// The begun result, once nobody writes it any more, or for long enough.
fn wait_for_its_writer(partial: &Path) -> Option<ResultFile> {
    let began = Instant::now();
    loop {
        let file = ResultFile::open(partial).ok()?;
        if !file.ending().running || began.elapsed() > LONGEST_WAIT {
            return Some(file);
        }
        drop(file);
        std::thread::sleep(Duration::from_millis(50));
    }
}

fn begin(plan: &Plan, run: &Run, files: &Files, options: &OneOptions, report: &mut dyn Report) -> Result<Outcome> {
    let mut document = Document::read(&plan.experiment(), &plan.facts.sets_of(run))?;
    document.memory = options.memory;
    std::fs::create_dir_all(&files.part).map_err(|error| refused(&files.part, &error))?;
    let run_options = RunOptions {
        overwrite: Overwrite::Refuse,
        threads: options.threads,
        cancel: options.cancel.clone(),
        ..RunOptions::new(&files.partial)
    };
    run::run(&document, &run_options, report)
}

/// Makes sure that a result comes from what the plan says.
fn check_inputs(plan: &Plan, run: &Run, header: &Header, name: &Path) -> Result<()> {
    let Some(what) = difference(plan, run, header) else { return Ok(()) };
    let fault = Fault::new(format!(
        "{} was made from other inputs than {} of the plan: {what}",
        name.display(),
        run.told(&plan.facts.parameters)
    ));
    Err(Error::input(fault.help("move it away to make the run anew")))
}

/// In what the inputs of a result differ from those of a run.
pub fn difference(plan: &Plan, run: &Run, header: &Header) -> Option<String> {
    let known = |text: &str| plan.facts.files.values().any(|file| *file == fingerprint(text.as_bytes()));
    if !known(&header.experiment) {
        return Some("another text of the experiment".into());
    }
    if let Some((path, _)) = header.equations.iter().find(|(_, text)| !known(text)) {
        return Some(format!("another text of {path}"));
    }
    let wanted = plan.facts.sets_of(run);
    let unlike = wanted.iter().find(|set| !header.sets.contains(set));
    let unlike = unlike.map(|set| format!("not {set}"));
    unlike.or_else(|| (header.sets != wanted).then(|| "other changes of the experiment".into()))
}

/// Keeps why a try failed, for whoever collects the study.
fn keep(error: Error, files: &Files) -> Error {
    let kept = std::fs::create_dir_all(&files.part).and_then(|()| std::fs::write(&files.trouble, format!("{error}\n")));
    // Where the disk refuses that, too, the error itself still tells.
    drop(kept);
    error
}

/// Moves a complete result and what leads to its fields to where they belong, the result last.
fn move_out(files: &Files) -> std::io::Result<()> {
    let folder = files.result.parent().unwrap_or(Path::new("."));
    for entry in std::fs::read_dir(&files.part)? {
        let path = entry?.path();
        if path != files.partial && path.extension().is_some_and(|ending| ending == "vtkhdf") {
            std::fs::rename(&path, folder.join(path.file_name().unwrap_or_default()))?;
        }
    }
    std::fs::rename(&files.partial, &files.result)?;
    std::fs::remove_dir_all(&files.part)
}
