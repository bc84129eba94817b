//! The run of an experiment into a file: a simulation that is recorded, saved, reported, stopped and resumed.

mod measures;
mod progress;
mod recording;

pub use measures::measure_result;
pub use progress::{Quiet, Report};

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use crate::error::{Error, Fault, Result};
use crate::experiment::{Document, PushedApart};
use crate::output::{Header, Kept, Overwrite, ResultFile, ResultWriter, checkpoint_path, load_checkpoint};
use crate::simulation::{Builder, CancelToken, CheckpointFault, Ready, Simulation, SimulationError, layout_of};
use recording::{Recording, Stop};

/// How a run is to be made.
#[derive(Debug, Clone)]
pub struct RunOptions {
    /// Where the result goes.
    pub result: PathBuf,
    /// What to do with a result that is there.
    pub overwrite: Overwrite,
    /// Threads; all cores when absent. The result does not depend on it.
    pub threads: Option<usize>,
    /// Ends the run at the next step, with a checkpoint to resume from.
    pub cancel: CancelToken,
}

impl RunOptions {
    /// A run into this file, on all cores, that leaves a result alone that is there.
    pub fn new(result: impl Into<PathBuf>) -> Self {
        Self { result: result.into(), overwrite: Overwrite::Refuse, threads: None, cancel: CancelToken::new() }
    }
}

/// How a run is to be gone on with.
#[derive(Debug, Clone, Default)]
pub struct ResumeOptions {
    /// Threads; all cores when absent. The result does not depend on it.
    pub threads: Option<usize>,
    /// The most memory that the experiment may take by an estimate, in bytes; any when absent.
    pub memory: Option<u64>,
    /// Ends the run at the next step, with a checkpoint to resume from.
    pub cancel: CancelToken,
}

/// What a run did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Steps made, those before a resume included.
    pub steps: u64,
    /// Frames in the result.
    pub frames: usize,
    /// Steps of this call alone.
    pub made: u64,
    /// Those among them that contacts shortened.
    pub limited: u64,
    /// Wall-clock seconds of this call.
    pub wall_time: f64,
    /// Cells that this call pushed apart before it began.
    pub pushed: PushedApart,
}

/// Runs an experiment from its start.
///
/// # Errors
/// [`Error::Input`] for a document that cannot be compiled or a result that cannot be made, [`Error::Numbers`] when a
/// step fails (the last good state is in the checkpoint), [`Error::Interrupted`] once the token is cancelled,
/// [`Error::Machine`] when the disk refuses.
pub fn run(document: &Document, options: &RunOptions, report: &mut dyn Report) -> Result<Outcome> {
    let RunOptions { result, overwrite, threads, cancel } = options;
    let document = &document.with_equations();
    if let Some(input) = document.files().into_iter().find(|input| crate::files::are_same(input, result)) {
        let fault =
            Fault::new(format!("{} is what the run reads: its result cannot be written there", input.display()));
        return Err(Error::input(fault.help("name another file with -o")));
    }
    let builder = Simulation::builder().threads_or_all(*threads).cancel_token(cancel.clone());
    let ready = {
        let told = Mutex::new(&mut *report);
        let tell = |what| told.lock().unwrap_or_else(PoisonError::into_inner).settle(what);
        builder.ready_told(document, &tell)?
    };
    let (source, title, simulation) = (&document.source, &document.experiment.title, &ready.simulation);
    let header = Header {
        equations: document.equations.clone().into_iter().collect(),
        ..Header::now(&source.name, title, &source.text, &document.sets, simulation.model().seed)
    };
    let writer = ResultWriter::create(result, &header, &layout_of(simulation.model()), *overwrite)?;
    simulation.notices().iter().for_each(|notice| report.notice(notice));
    drive(ready, document, writer, result, report, Start::Fresh).map_err(|error| can_go_on(error, result))
}

/// What the run of a result did, if it came to its end; then there is nothing to resume.
///
/// # Errors
/// As [`ResultFile::open`].
pub fn finished_already(result: &Path) -> Result<Option<Outcome>> {
    // While there is a checkpoint beside it, the run was not yet done with the file, or had not begun to record.
    if checkpoint_path(result).exists() {
        return Ok(None);
    }
    let file = ResultFile::open(result)?;
    let steps = file.steps()?.last().copied().unwrap_or(0);
    let done =
        Outcome { steps, frames: file.frames(), made: 0, limited: 0, wall_time: 0.0, pushed: PushedApart::default() };
    Ok(file.ending().finished.then_some(done))
}

/// Goes on with a run that was stopped or killed, from its last checkpoint. A finished run stays as it is.
///
/// # Errors
/// As [`run`], and [`Error::Input`] when there is no checkpoint, it belongs to another experiment, or the experiment takes more memory than it may.
pub fn resume(result: &Path, options: &ResumeOptions, report: &mut dyn Report) -> Result<Outcome> {
    let builder = Simulation::builder().threads_or_all(options.threads).cancel_token(options.cancel.clone());
    if let Some(outcome) = finished_already(result)? {
        return Ok(outcome);
    }
    let Some(checkpoint) = load_checkpoint(result)? else { return begin_again(&builder, result, options, report) };
    let header = checkpoint.meta.header.clone();
    let document = document_within(&header, result, options)?;
    let mut ready = builder.ready_to_restore(&document)?;
    ready.simulation.restore(&checkpoint.payload).map_err(|error| cannot_restore(&error, result))?;
    let layout = layout_of(ready.simulation.model());
    let writer = ResultWriter::reopen(result, &header, &layout, (&checkpoint.meta).into())?;
    drive(ready, &document, writer, result, report, Start::Resumed).map_err(|error| can_go_on(error, result))
}

/// Goes on with a run that was killed before its first checkpoint, from its start, which is all that it has recorded.
fn begin_again(builder: &Builder, result: &Path, options: &ResumeOptions, report: &mut dyn Report) -> Result<Outcome> {
    let file = ResultFile::open(result)?;
    if file.steps()?.iter().any(|step| *step > 0) {
        let (name, side) = (result.display(), checkpoint_path(result));
        let fault = Fault::new(format!("{name} is not finished, and its checkpoint {} is not there", side.display()))
            .help("put the checkpoint back beside the result, or run the experiment again");
        return Err(Error::input(fault));
    }
    let header = file.header().clone();
    drop(file);
    let document = document_within(&header, result, options)?;
    let ready = builder.ready_told(&document, &|_| ())?;
    let writer = ResultWriter::reopen(result, &header, &layout_of(ready.simulation.model()), Kept::until(0))?;
    drive(ready, &document, writer, result, report, Start::Recorded).map_err(|error| can_go_on(error, result))
}

/// The document of a result, which may take as much memory as the options say.
fn document_within(header: &Header, result: &Path, options: &ResumeOptions) -> Result<Document> {
    let mut document = document_of(header, result)?;
    document.memory = options.memory;
    Ok(document)
}

/// Why the state in a checkpoint cannot be taken up.
fn cannot_restore(error: &SimulationError, result: &Path) -> Error {
    let name = result.display();
    Error::input(match error {
        SimulationError::Checkpoint(CheckpointFault::Foreign) => Fault::new(format!(
            "the checkpoint of {name} belongs to another experiment"
        ))
        .help("a mesh file may have changed since the run began: put the old one back, or run the experiment again"),
        other => Fault::new(format!("the checkpoint of {name} cannot be read: {other}"))
            .help("resume with the version of pseudopod that began the run"),
    })
}

/// When the machine failed in the middle of a run: what is recorded is safe, and how to go on from there.
fn can_go_on(error: Error, result: &Path) -> Error {
    match error {
        Error::Machine { message, help } if checkpoint_path(result).exists() => {
            Error::Machine { message, help: format!("{help}; then go on with: pseudopod resume {}", result.display()) }
        }
        other => other,
    }
}

/// The document that a result was made from; paths start from the folder of the document if it is still there.
pub fn document_of(header: &Header, result: &Path) -> Result<Document> {
    let equations = header.equations.iter().cloned().collect();
    Document::parse_beside(&header.document, &header.experiment, &base_of(header, result), &header.sets, equations)
}

/// The document of a result that is looked at: as [`document_of`], but files that it names may be gone, as where somebody else made the result.
///
/// # Errors
/// A damaged file.
pub fn recorded_document_of(header: &Header, result: &Path) -> Result<Document> {
    let equations = header.equations.iter().cloned().collect();
    Document::parse_recorded(&header.document, &header.experiment, &base_of(header, result), &header.sets, equations)
}

/// Where paths in the document of a result start from.
fn base_of(header: &Header, result: &Path) -> PathBuf {
    let folder = |path: &Path| path.parent().map(Path::to_path_buf).unwrap_or_default();
    let document = Path::new(&header.document);
    if document.exists() { folder(document) } else { folder(result) }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Start {
    Fresh,
    /// The start is recorded, and not saved yet.
    Recorded,
    Resumed,
}

/// Lets a simulation go to the end of its experiment, recorded.
fn drive(
    ready: Ready,
    document: &Document,
    writer: ResultWriter,
    result: &Path,
    report: &mut dyn Report,
    start: Start,
) -> Result<Outcome> {
    let Ready { mut simulation, schedule, pushed } = ready;
    simulation.within(|simulation| {
        let (began, first, until) = (Instant::now(), simulation.steps(), simulation.end());
        let mut recording = Recording::new(simulation, writer, schedule, result, report);
        if let Err(trouble) = simulation.begin() {
            return Err(recording.keep_last(trouble, simulation));
        }
        match start {
            Start::Fresh => recording.record_start(simulation)?,
            Start::Recorded => recording.save(simulation)?,
            Start::Resumed => {}
        }
        recording.begin(simulation);
        // A run that was killed when it was at rest makes no other step.
        let until = if simulation.is_at_rest() { simulation.time() } else { until };
        let ended = simulation.run_with(until, |simulation, made| recording.look(simulation, made));
        recording.end();
        match ended {
            Ok(ControlFlow::Continue(()) | ControlFlow::Break(Stop::AtRest)) => {
                recording.tell_rest(simulation);
                recording.save(simulation)?;
            }
            Ok(ControlFlow::Break(Stop::Machine(error))) => return Err(error),
            Ok(ControlFlow::Break(Stop::Within(trouble))) => return Err(recording.keep_last(trouble, simulation)),
            Ok(ControlFlow::Break(Stop::Passed(trouble))) => return Err(recording.keep_good(trouble, simulation)),
            Err(trouble @ (SimulationError::Trouble(_) | SimulationError::Population(_))) => {
                return Err(recording.keep_last(trouble, simulation));
            }
            Err(SimulationError::Cancelled { time }) => {
                recording.save(simulation)?;
                return Err(Error::Interrupted { time, result: result.to_path_buf() });
            }
            Err(other) => return Err(other.into()),
        }
        let wall_time = began.elapsed().as_secs_f64();
        let Recording { writer, limited, report, .. } = recording;
        let (steps, frames) = (simulation.steps(), writer.frames());
        finish(writer, document, wall_time, report)?;
        Ok(Outcome { steps, frames, made: steps - first, limited, wall_time, pushed })
    })
}

/// Evaluates the measures of the experiment on what was recorded and ends the file.
fn finish(mut writer: ResultWriter, document: &Document, wall_time: f64, report: &mut dyn Report) -> Result<()> {
    let file = writer.read()?;
    let (measures, faults) = measure_result(&file, document)?;
    drop(file);
    writer.write_summary(&measures);
    writer.finish(wall_time)?;
    // A measure that cannot be computed is told once the run and all other measures are safe. A run that was cut short is not to blame.
    if document.is_cut_short {
        faults.iter().for_each(|fault| report.notice(&fault.message));
        return Ok(());
    }
    if faults.is_empty() { Ok(()) } else { Err(Error::Input(faults)) }
}
