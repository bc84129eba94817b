//! The loop: steps, records, checkpoints, progress, stop and resume.

mod progress;
mod record;
mod touch;

pub use progress::{Progress, Quiet, Report};
pub use record::{frame_of, layout_of};

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use crate::error::{Error, Fault, Result};
use crate::experiment::{Compiled, Document, PushedApart, compile, notices, prepare, settle_start};
use crate::output::{Frame, Header, Overwrite, ResultFile, ResultWriter, checkpoint_path, load_checkpoint};
use crate::sim::contact::check_passed;
use crate::sim::{State, Trouble, Workspace, begin_chemistry, step};

/// How a run is to be made.
#[derive(Debug, Clone)]
pub struct RunOptions {
    /// Where the result goes.
    pub result: PathBuf,
    /// What to do with a result that is there.
    pub overwrite: Overwrite,
    /// Threads; all cores when absent. The result does not depend on it.
    pub threads: Option<usize>,
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

/// Set by the first Ctrl-C or termination signal; a run then ends at the next step with a checkpoint.
pub static STOP: AtomicBool = AtomicBool::new(false);

/// Runs an experiment from its start.
///
/// # Errors
/// [`Error::Input`] for a document that cannot be compiled or a result that cannot be made, [`Error::Numbers`] when a
/// step fails (the last good state is in the checkpoint), [`Error::Interrupted`] after [`STOP`], [`Error::Machine`] when
/// the disk refuses.
pub fn run(document: &Document, options: &RunOptions, report: &mut dyn Report) -> Result<Outcome> {
    let pool = pool_of(options.threads)?;
    let document = &document.with_equations();
    let prepared = prepare(document)?;
    let mut said = notices(document, &prepared);
    let mut compiled = prepared.build();
    let pushed = settle_start(document, &mut compiled)?;
    said.extend(pushed.notice());
    let (source, title) = (&document.source, &document.experiment.title);
    let header = Header {
        equations: document.equations.clone().into_iter().collect(),
        ..Header::now(&source.name, title, &source.text, &document.sets, compiled.model.seed)
    };
    let layout = layout_of(&compiled.model);
    let writer = ResultWriter::create(&options.result, &header, &layout, options.overwrite)?;
    said.iter().for_each(|notice| report.notice(notice));
    within(pool, || drive(compiled, writer, &options.result, report, Start::Fresh))
        .map(|outcome| Outcome { pushed, ..outcome })
        .map_err(|error| can_go_on(error, &options.result))
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
/// As [`run`], and [`Error::Input`] when there is no checkpoint or it belongs to another experiment.
pub fn resume(result: &Path, threads: Option<usize>, report: &mut dyn Report) -> Result<Outcome> {
    let pool = pool_of(threads)?;
    if let Some(outcome) = finished_already(result)? {
        return Ok(outcome);
    }
    let Some(checkpoint) = load_checkpoint(result)? else {
        let (name, side) = (result.display(), checkpoint_path(result));
        let fault = Fault::new(format!("{name} is not finished, and its checkpoint {} is not there", side.display()))
            .help("put the checkpoint back beside the result, or run the experiment again");
        return Err(Error::input(fault));
    };
    let header = checkpoint.meta.header.clone();
    let document = document_of(&header, result)?;
    let mut compiled = compile(&document)?;
    let state: State = postcard::from_bytes(&checkpoint.payload).map_err(|error| {
        let fault = Fault::new(format!("the checkpoint of {} cannot be read: {error}", result.display()))
            .help("resume with the version of pseudopod that began the run");
        Error::input(fault)
    })?;
    check_fits(&compiled.state, &state, result)?;
    compiled.state = state;
    let layout = layout_of(&compiled.model);
    let writer = ResultWriter::reopen(result, &header, &layout, checkpoint.meta.step)?;
    within(pool, || drive(compiled, writer, result, report, Start::Resumed)).map_err(|error| can_go_on(error, result))
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
    let folder = |path: &Path| path.parent().map(Path::to_path_buf).unwrap_or_default();
    let document = Path::new(&header.document);
    let base = if document.exists() { folder(document) } else { folder(result) };
    let equations = header.equations.iter().cloned().collect();
    Document::parse_beside(&header.document, &header.experiment, &base, &header.sets, equations)
}

fn check_fits(fresh: &State, state: &State, result: &Path) -> Result<()> {
    let same = fresh.kinds.len() == state.kinds.len()
        && fresh.walks.len() == state.walks.len()
        && fresh.chemistry.has_shape_of(&state.chemistry)
        && fresh.kinds.iter().zip(&state.kinds).all(|(a, b)| {
            a.positions.len() == b.positions.len()
                && a.velocities.len() == b.velocities.len()
                && a.rest_volumes.len() == b.rest_volumes.len()
        });
    if same {
        return Ok(());
    }
    let fault = Fault::new(format!("the checkpoint of {} belongs to another experiment", result.display()))
        .help("a mesh file may have changed since the run began: put the old one back, or run the experiment again");
    Err(Error::input(fault))
}

/// The threads that were asked for; `None` stands for all cores.
fn pool_of(threads: Option<usize>) -> Result<Option<rayon::ThreadPool>> {
    let Some(threads) = threads else { return Ok(None) };
    if threads == 0 {
        let fault =
            Fault::new("a run cannot be made by 0 threads").help("ask for 1 or more; leave it out for all cores");
        return Err(Error::input(fault));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| Error::Machine {
        message: format!("{threads} threads could not be started: {error}"),
        help: "ask for fewer with --threads".into(),
    })?;
    Ok(Some(pool))
}

fn within<T: Send>(pool: Option<rayon::ThreadPool>, work: impl FnOnce() -> T + Send) -> T {
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Start {
    Fresh,
    Resumed,
}

/// Steps, records and checkpoints until the end.
fn drive(
    compiled: Compiled,
    mut writer: ResultWriter,
    result: &Path,
    report: &mut dyn Report,
    start: Start,
) -> Result<Outcome> {
    let Compiled { model, mut state, schedule } = compiled;
    let began = Instant::now();
    let mut ws = Workspace::new(&model);
    let mut recorder = record::Recorder::new(&model, &schedule);
    let (mut recorded, first, mut limited) = (state.step, state.step, 0);
    if let Err(trouble) = begin_chemistry(&model, &mut state, &mut ws) {
        let help = trouble.help_at(&model, &state);
        return Err(failed(trouble, help, writer, &state, None, result));
    }
    if start == Start::Fresh {
        writer.append(&recorder.record(&model, &mut state, &ws, 0.0))?;
        save(&mut writer, &state)?;
    }
    // Where cells were last known to be outside each other.
    let mut good = model.contact.is_some().then(|| state.clone());
    report.begin(state.time, model.until);
    while state.time < model.until {
        let before = state.time;
        match step(&model, &mut state, &mut ws) {
            Ok(done) => {
                limited += u64::from(done.limited);
                let last = state.time >= model.until;
                if last || passed(before, state.time, schedule.every) {
                    if let Err(trouble) = check_passed(&model, &state) {
                        report.end();
                        let help = trouble.help_at(&model, &state);
                        return Err(failed(trouble, help, writer, &good.unwrap_or(state), None, result));
                    }
                    good = model.contact.is_some().then(|| state.clone());
                    writer.append(&recorder.record(&model, &mut state, &ws, done.dt))?;
                    recorded = state.step;
                }
                if passed(before, state.time, schedule.checkpoint) && !last {
                    save(&mut writer, &state)?;
                }
            }
            Err(trouble) => {
                // The last good state is what the user wants to look at.
                let unseen = (state.step > recorded).then(|| recorder.record(&model, &mut state, &ws, 0.0));
                report.end();
                let help = trouble.help_at(&model, &state);
                return Err(failed(trouble, help, writer, &state, unseen, result));
            }
        }
        report.step(state.time, state.step);
        if STOP.load(Ordering::Relaxed) {
            save(&mut writer, &state)?;
            report.end();
            return Err(Error::Interrupted { time: state.time, result: result.to_path_buf() });
        }
    }
    save(&mut writer, &state)?;
    report.end();
    let wall_time = began.elapsed().as_secs_f64();
    let frames = writer.frames();
    finish(writer, result, wall_time)?;
    let pushed = PushedApart::default();
    Ok(Outcome { steps: state.step, frames, made: state.step - first, limited, wall_time, pushed })
}

/// Whether a multiple of `interval` lies in (before, after].
fn passed(before: f64, after: f64, interval: f64) -> bool {
    // The slack lets a clock that adds many steps reach a multiple that it misses by round-off.
    let count = |time: f64| (time / interval * (1.0 + 1e-12)).floor();
    count(after) > count(before)
}

fn save(writer: &mut ResultWriter, state: &State) -> Result<()> {
    let payload = postcard::to_stdvec(state).expect("plain numbers always encode");
    writer.save_checkpoint(state.step, state.time, &payload)
}

/// Keeps the last good state, as a frame and as a checkpoint, and says what happened.
fn failed(
    trouble: Trouble,
    help: &str,
    mut writer: ResultWriter,
    state: &State,
    unseen: Option<Frame>,
    result: &Path,
) -> Error {
    let kept = unseen.map_or(Ok(()), |frame| writer.append(&frame)).and_then(|()| save(&mut writer, state));
    let kept = kept.is_ok().then(|| result.to_path_buf());
    Error::Numbers { message: trouble.to_string(), help: help.to_owned(), kept }
}

/// Evaluates the measures of the experiment on what was recorded and ends the file.
fn finish(mut writer: ResultWriter, result: &Path, wall_time: f64) -> Result<()> {
    let file = writer.read()?;
    let document = document_of(file.header(), result)?;
    let (measures, faults) = crate::analysis::measure_result(&file, &document)?;
    drop(file);
    writer.write_summary(&measures)?;
    writer.finish(wall_time)?;
    // A measure that cannot be computed is told once the run and all other measures are safe.
    if faults.is_empty() { Ok(()) } else { Err(Error::Input(faults)) }
}
