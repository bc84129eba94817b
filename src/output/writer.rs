//! Writes the result of a run, frame by frame, so that a kill at any moment loses no frame that was recorded.
//!
//! A frame goes into the [log](super::frame_log) beside the result; from there frames are taken into the next
//! [version](super::versions) of the file, at first once a second and then as often as that costs a twentieth of the time.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant as Clock};

use hdf5::File;

use super::catalogue::entry;
use super::checkpoint::{CheckpointMeta, DATASET, checkpoint_path, save_checkpoint};
use super::claim::{Overwrite, claim};
use super::columns::Columns;
use super::container::{self, Access, failed, machine_error, set_number};
use super::fields::{check_layout, field_view_path, write_views};
use super::fits::misfit;
use super::frame_log::{FrameLog, Owner, frames_path};
use super::header::{Header, Measure};
use super::layout_io::{write_header, write_layout};
use super::reader::ResultFile;
use super::renewal::take_in;
use super::reopening::{Kept, Reopened, reopen};
use super::texts::set_text;
use super::versions::{prepare, renew};
use super::{Frame, Layout};
use crate::error::{Error, Fault, Result};

/// Least time between two versions of the file that [`ResultWriter::append`] makes by itself.
const LEAST_INTERVAL: Duration = Duration::from_secs(1);
/// How much longer the time to the next version is than the last one took.
const PER_RENEWAL: u32 = 20;

/// A result being written. Dropping it takes all frames into the file and leaves an unfinished, readable result.
pub struct ResultWriter {
    path: PathBuf,
    header: Header,
    layout: Layout,
    log: FrameLog,
    owner: Owner,
    /// Steps made up to each frame.
    steps: Vec<u64>,
    /// Whether forces are recorded; unknown until there are atoms.
    forces: Option<bool>,
    /// Measures that are not in the file yet.
    summary: Vec<Measure>,
    renewed: Renewed,
    least_interval: Duration,
    /// Set when the disk refused a frame, or the run has ended: nothing more is written.
    is_over: bool,
}

/// The version of the file that others see.
struct Renewed {
    frames: usize,
    at: Clock,
    took: Duration,
}

impl ResultWriter {
    /// Makes the file and writes all that does not change during the run.
    ///
    /// # Errors
    /// [`Error::Input`] if the file or its checkpoint exists (with [`Overwrite::Refuse`]) or is being written, its folder does
    /// not exist or may not be written, the layout has neither cells nor chemistry, or fields or systems that the file
    /// cannot hold; [`Error::Machine`] if the disk refuses.
    pub fn create(path: &Path, header: &Header, layout: &Layout, overwrite: Overwrite) -> Result<Self> {
        if layout.types.is_empty() && layout.fields.is_empty() && layout.systems.is_empty() {
            let fault =
                Fault::new("there is nothing to record").help("give the experiment a cell, a field or a system");
            return Err(Error::input(fault));
        }
        check_layout(layout)?;
        claim(path, overwrite, layout)?;
        let log = FrameLog::take(path)?;
        // Looked at again: whoever had the log may have made the result meanwhile.
        claim(path, overwrite, layout).inspect_err(|_| log.remove_if_new())?;
        Self::begin(path, header, layout, log)
    }

    /// Makes the file anew. The old one stays, with its checkpoint, until the new one is whole.
    fn begin(path: &Path, header: &Header, layout: &Layout, mut log: FrameLog) -> Result<Self> {
        let fill = |file: &File| {
            write_header(file, header).and_then(|()| write_layout(file, layout))?;
            Columns::create(file, layout).map(|_| ())
        };
        let refused = |error: std::io::Error| machine_error(path, "could not be made", &error.to_string());
        let new = prepare(path, fill).inspect_err(|_| log.remove_if_new())?;
        remove(&checkpoint_path(path)).inspect_err(|_| log.remove_if_new())?;
        let owner = Owner::of(header, 0);
        let begun = new.put().and_then(|()| log.begin(&owner, layout)).map_err(refused);
        begun.and_then(|()| write_views(path, layout)).inspect_err(|_| {
            // A result that could not be begun is of no use, and would stand in the way of the next try.
            remove_all(path, layout);
            log.remove();
        })?;
        Ok(Self::around(path, header, layout, log, Reopened { owner, ..Reopened::default() }))
    }

    /// Opens the file of an unfinished or finished run to go on from where `kept` says: later frames are removed.
    ///
    /// # Errors
    /// [`Error::Input`] if the file cannot be opened, is being written, belongs to another experiment or has lost frames;
    /// [`Error::Machine`] if the disk refuses. Nothing is changed then.
    pub fn reopen(path: &Path, header: &Header, layout: &Layout, kept: Kept) -> Result<Self> {
        // Looked at before anything is made beside it.
        drop(container::open(path, Access::Read)?);
        let mut log = FrameLog::take(path)?;
        let reopened = reopen(path, header, layout, kept, &mut log).inspect_err(|_| log.remove_if_new())?;
        match reopened {
            Some(reopened) => {
                write_views(path, layout)?;
                Ok(Self::around(path, header, layout, log, reopened))
            }
            None => Self::begin(path, header, layout, log),
        }
    }

    fn around(path: &Path, header: &Header, layout: &Layout, log: FrameLog, reopened: Reopened) -> Self {
        let Reopened { owner, steps, forces } = reopened;
        Self {
            path: path.to_path_buf(),
            header: header.clone(),
            layout: layout.clone(),
            log,
            owner,
            renewed: Renewed { frames: steps.len(), at: Clock::now(), took: Duration::ZERO },
            steps,
            forces,
            summary: Vec::new(),
            least_interval: LEAST_INTERVAL,
            is_over: false,
        }
    }

    /// Sets the least time between two versions of the file that [`append`](Self::append) makes by itself; one second if not
    /// set.
    pub fn set_least_interval(&mut self, interval: Duration) {
        self.least_interval = interval;
    }

    /// Frames appended so far, those kept by [`reopen`](Self::reopen) included.
    pub fn frames(&self) -> usize {
        self.steps.len()
    }

    /// Appends a frame. It survives a kill of the program from now on, and is seen by readers with the next version of the
    /// file, see [`renew`](Self::renew).
    ///
    /// # Errors
    /// [`Error::Machine`] if the disk refuses; all frames before are safe, and the file is removed if there are none.
    ///
    /// # Panics
    /// If the sizes of the frame are not those of the layout and of its own cells.
    pub fn append(&mut self, frame: &Frame) -> Result<()> {
        self.check_open()?;
        if self.forces.is_none() && !frame.positions.is_empty() {
            self.forces = Some(!frame.forces.is_empty());
        }
        if let Some(words) = misfit(&self.layout, self.forces == Some(true), frame) {
            panic!("{words}");
        }
        if let Err(error) = self.log.append(self.frames(), frame) {
            return Err(self.give_up(machine_error(&self.path, "could not be written", &error.to_string())));
        }
        self.steps.push(frame.step);
        let Renewed { frames: seen, at, took } = self.renewed;
        if seen == 0 {
            return self.renew().map_err(|error| self.give_up(error));
        }
        if at.elapsed() < self.least_interval.max(took * PER_RENEWAL) {
            return Ok(());
        }
        match self.renew() {
            Err(error) if !self.path.exists() => Err(self.give_up(error)),
            // There may be no space for a second file, or not for now: the frames are safe in the log, and the run goes on.
            // How it ends is told by `finish`.
            Err(_) => {
                self.renewed.at = Clock::now();
                Ok(())
            }
            Ok(()) => Ok(()),
        }
    }

    /// Takes all frames so far into the file, so that readers see them.
    ///
    /// # Errors
    /// [`Error::Machine`] if the disk refuses or the file has gone. The frames are safe, and the writer goes on.
    pub fn renew(&mut self) -> Result<()> {
        self.check_open()?;
        if self.renewed.frames == self.frames() && self.summary.is_empty() {
            return Ok(());
        }
        self.renew_with(|_| Ok(()))
    }

    /// Makes the next version of the file, with what else is to be changed in it.
    fn renew_with(&mut self, change: impl FnOnce(&File) -> hdf5::Result<()>) -> Result<()> {
        let Self { path, layout, owner, log, summary, renewed, .. } = self;
        let (began, frames) = (Clock::now(), self.steps.len());
        let failed = |error: hdf5::Error| failed(path, "could not be written", &error);
        let replay = log.replay(owner, renewed.frames);
        let replay =
            replay.map_err(|error| machine_error(&frames_path(path), "could not be read", &error.to_string()))?;
        renew(path, |file| {
            let taken = take_in(file, layout, renewed.frames, replay).map_err(failed)?;
            if taken != frames {
                return Err(machine_error(&frames_path(path), "was changed by another program", "frames are missing"));
            }
            summary.iter().try_for_each(|measure| write_measure(file, measure)).map_err(failed)?;
            change(file).map_err(failed)
        })?;
        summary.clear();
        let refused = |error: std::io::Error| machine_error(path, "could not be written", &error.to_string());
        if log.is_there() {
            log.clear().map_err(refused)?;
        } else {
            // Somebody has removed it; all that was in it is in the file by now.
            *log = FrameLog::take(path)?;
            log.begin(owner, layout).map_err(refused)?;
        }
        *renewed = Renewed { frames, at: Clock::now(), took: began.elapsed() };
        Ok(())
    }

    /// Saves the checkpoint of an instant beside the result, on the disk itself, as are the frames up to it.
    ///
    /// # Errors
    /// [`Error::Machine`] if the disk refuses.
    pub fn save_checkpoint(&mut self, step: u64, time: f64, payload: &[u8]) -> Result<()> {
        self.check_open()?;
        let synced = self.log.sync();
        synced.map_err(|error| machine_error(&self.path, "could not be written", &error.to_string()))?;
        let frames = self.steps.iter().take_while(|of_frame| **of_frame <= step).count();
        save_checkpoint(&self.path, &CheckpointMeta::new(&self.header, step, time, frames), payload)
    }

    /// Opens what is recorded so far for reading, to find the measures before the file is finished.
    ///
    /// # Errors
    /// As [`renew`](Self::renew) and [`ResultFile::open`]: there must be a frame.
    pub fn read(&mut self) -> Result<ResultFile> {
        self.renew()?;
        ResultFile::open(&self.path)
    }

    /// Takes measures of the experiment in, to be written under `/summary` with the next version of the file; one of the same
    /// name is replaced.
    pub fn write_summary(&mut self, measures: &[Measure]) {
        self.summary.extend_from_slice(measures);
    }

    /// Ends the file: takes in the checkpoint and marks the run as finished after `wall_time` seconds.
    ///
    /// # Errors
    /// [`Error::Machine`] if the disk refuses; the checkpoint then stays in its own file, and the frames in theirs.
    pub fn finish(mut self, wall_time: f64) -> Result<()> {
        self.check_open()?;
        let side = checkpoint_path(&self.path);
        let checkpoint = match std::fs::read(&side) {
            Ok(bytes) => Some(bytes),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
            Err(error) => return Err(machine_error(&side, "could not be read", &error.to_string())),
        };
        let ended = self.renew_with(|file| write_end(file, checkpoint.as_deref(), wall_time));
        self.is_over = true;
        ended?;
        self.log.remove();
        remove(&side)
    }

    fn check_open(&self) -> Result<()> {
        match self.is_over {
            false => Ok(()),
            true => Err(machine_error(&self.path, "could not be written", "an earlier write failed")),
        }
    }

    /// Writes nothing more.
    fn give_up(&mut self, error: Error) -> Error {
        self.is_over = true;
        // A result without a frame is of no use, and would stand in the way of the next try.
        if self.renewed.frames == 0 {
            remove_all(&self.path, &self.layout);
            self.log.remove();
        }
        error
    }
}

impl Drop for ResultWriter {
    fn drop(&mut self) {
        // Nobody is left to hear of a failure; the frames then stay in the log, from where the next reader takes them.
        if !self.is_over && self.renew().is_ok() {
            self.log.remove();
        }
    }
}

fn write_measure(file: &File, measure: &Measure) -> hdf5::Result<()> {
    let group = file.group("summary").or_else(|_| file.create_group("summary"))?;
    if group.link_exists(&measure.name) {
        group.unlink(&measure.name)?;
    }
    let dataset = group.new_dataset::<f64>().obj_track_times(false).create(measure.name.as_str())?;
    dataset.write_scalar(&measure.value)?;
    set_text(&dataset, "unit", &measure.unit)?;
    set_text(&dataset, "description", &measure.description)
}

fn write_end(file: &File, checkpoint: Option<&[u8]>, wall_time: f64) -> hdf5::Result<()> {
    if let Some(bytes) = checkpoint {
        let row = entry(DATASET);
        let dataset = file.new_dataset_builder().with_data(bytes).obj_track_times(false).create(DATASET)?;
        set_text(&dataset, "unit", row.unit)?;
        set_text(&dataset, "description", row.description)?;
    }
    let group = file.group("provenance")?;
    set_number(&group, "wall_time", wall_time)?;
    set_number(&group, "finished", 1_i64)
}

/// Removes a file, if it is there.
fn remove(path: &Path) -> Result<()> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(machine_error(path, "could not be removed", &error.to_string()))
        }
        _ => Ok(()),
    }
}

/// Removes a result that holds nothing, with what lies beside it.
fn remove_all(path: &Path, layout: &Layout) {
    let views = layout.fields.iter().map(|field| field_view_path(path, &field.name));
    views.chain([path.to_path_buf(), checkpoint_path(path)]).for_each(|path| drop(std::fs::remove_file(path)));
}
