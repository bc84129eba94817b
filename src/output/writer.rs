//! Writes the result of a run, frame by frame, so that a kill at any moment leaves a file that opens.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant as Clock};

use hdf5::{Attribute, File};

use super::checkpoint::{CheckpointMeta, DATASET, checkpoint_path, save_checkpoint};
use super::columns::Columns;
use super::container::{self, Access, failed, machine_error, set_number, set_text};
use super::fields::{check_layout, field_view_path, write_views};
use super::free_space;
use super::header::{Header, Measure};
use super::layout_io::{read_header, read_layout, write_header, write_layout};
use super::mark::FlushMark;
use super::mend::mend;
use super::pieces::has_frames;
use super::reader::ResultFile;
use super::whole::whole_frames;
use super::{Frame, Layout};
use crate::error::{Error, Fault, Result};

/// A flush costs about a millisecond and is the only time at which a kill can tear the file ([`mend`]), so it is rare.
const FLUSH_INTERVAL: Duration = Duration::from_secs(1);

/// What to do with a result file that is already there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Overwrite {
    /// Keep it: an error.
    Refuse,
    /// Replace it and its checkpoint.
    Replace,
}

/// A result file being written. Dropping it flushes what was appended and leaves an unfinished, readable file.
pub struct ResultWriter {
    path: PathBuf,
    file: File,
    header: Header,
    columns: Columns,
    step_count: Attribute,
    mark: FlushMark,
    last_flush: Clock,
    flush_interval: Duration,
    /// Frames at the last flush.
    flushed: usize,
    /// Set when the disk refused a write: the file is left as it was at the last flush.
    broken: bool,
}

impl ResultWriter {
    /// Makes the file and writes all that does not change during the run.
    ///
    /// # Errors
    /// [`Error::Input`] if the file or its checkpoint exists (with [`Overwrite::Refuse`]), its folder does not exist
    /// or may not be written, the layout has neither cells nor chemistry, or fields or systems that the file cannot hold;
    /// [`Error::Machine`] if the disk refuses.
    pub fn create(path: &Path, header: &Header, layout: &Layout, overwrite: Overwrite) -> Result<Self> {
        if layout.types.is_empty() && layout.fields.is_empty() && layout.systems.is_empty() {
            let fault =
                Fault::new("there is nothing to record").help("give the experiment a cell, a field or a system");
            return Err(Error::input(fault));
        }
        check_layout(layout)?;
        claim(path, overwrite, layout)?;
        // A file that could not be begun is of no use, and would stand in the way of the next try.
        Self::begin(path, header, layout).inspect_err(|_| drop(std::fs::remove_file(path)))
    }

    fn begin(path: &Path, header: &Header, layout: &Layout) -> Result<Self> {
        let file = container::create(path)?;
        let made = write_header(&file, header)
            .and_then(|()| write_layout(&file, layout))
            .and_then(|()| Columns::create(&file, layout));
        let columns = made.map_err(|error| failed(path, "could not be made", &error))?;
        write_views(path, layout)?;
        Self::around(path, file, header, columns)
    }

    /// Opens the file of an unfinished or finished run to go on after the given step: later frames are removed.
    ///
    /// # Errors
    /// [`Error::Input`] if the file cannot be opened or belongs to another experiment; [`Error::Machine`] if the disk
    /// refuses.
    pub fn reopen(path: &Path, header: &Header, layout: &Layout, keep_until_step: u64) -> Result<Self> {
        let damaged = |error: hdf5::Error| container::damaged(path, &error.to_string());
        // Opened for reading first: a refusal changes nothing, not even the length of the file.
        let seen = container::open(path, Access::Read)?;
        let (found, known) = (read_header(&seen).map_err(damaged)?, read_layout(&seen).map_err(damaged)?);
        let (torn, begun) = (FlushMark::is_set(&seen), has_frames(&seen));
        drop(seen);
        check_same_run(path, &found, header)?;
        if !begun && !torn {
            return Self::begin(path, header, layout);
        }
        if known != *layout {
            return Err(Error::input(
                Fault::new(format!("{} holds other cells than this experiment makes", path.display()))
                    .help("resume with the version of pseudopod that began the run"),
            ));
        }
        if torn {
            mend(path, &found, layout, keep_until_step)?;
        }
        let file = container::open(path, Access::Append)?;
        let whole = whole_frames(&file, layout).map_err(damaged)?;
        let steps = file.dataset("/step").and_then(|steps| steps.read_raw::<i64>()).map_err(damaged)?;
        let last = i64::try_from(keep_until_step).unwrap_or(i64::MAX);
        let keep = steps[..whole].iter().take_while(|step| **step <= last).count();
        let unfinished = remove_end(path, &file);
        let columns = unfinished.and_then(|()| {
            Columns::reopen(&file, layout, keep).map_err(|error| failed(path, "could not be changed", &error))
        })?;
        write_views(path, layout)?;
        Self::around(path, file, header, columns)
    }

    fn around(path: &Path, file: File, header: &Header, columns: Columns) -> Result<Self> {
        let step_count = file.group("/VTKHDF/Steps").and_then(|steps| steps.attr("NSteps"));
        let step_count = step_count.map_err(|error| failed(path, "could not be made", &error))?;
        let mark = FlushMark::of(&file);
        let mut writer = Self {
            path: path.to_path_buf(),
            file,
            header: header.clone(),
            columns,
            step_count,
            mark,
            last_flush: Clock::now(),
            flush_interval: FLUSH_INTERVAL,
            flushed: 0,
            broken: false,
        };
        writer.flush()?;
        Ok(writer)
    }

    /// Sets the least time between two flushes that [`append`](Self::append) does by itself; one second if not set.
    pub fn set_flush_interval(&mut self, interval: Duration) {
        self.flush_interval = interval;
    }

    /// Frames appended so far, those kept by [`reopen`](Self::reopen) included.
    pub fn frames(&self) -> usize {
        self.columns.frames()
    }

    /// Appends a frame. It is on disk after the next flush, which comes by itself once a second.
    ///
    /// # Errors
    /// [`Error::Machine`] if the disk refuses; the file then keeps the frames of the last flush, and is removed if there are
    /// none.
    ///
    /// # Panics
    /// If the sizes of the frame are not those of the layout and of its own cells.
    pub fn append(&mut self, frame: &Frame) -> Result<()> {
        self.check_whole()?;
        let appended = self.columns.append(&self.file, frame);
        self.settle(appended)?;
        if self.frames() == 1 || self.last_flush.elapsed() >= self.flush_interval {
            self.flush()?;
        }
        Ok(())
    }

    /// Hands all frames so far to the system: they survive a kill of the program.
    ///
    /// # Errors
    /// As [`append`](Self::append).
    pub fn flush(&mut self) -> Result<()> {
        self.check_whole()?;
        let flushed = self.write_out();
        self.settle(flushed)?;
        self.flushed = self.frames();
        self.last_flush = Clock::now();
        Ok(())
    }

    fn write_out(&mut self) -> hdf5::Result<()> {
        self.hand_over()?;
        self.file.flush()?;
        self.mark.set(&self.path, false)?;
        self.columns.forget_history(&self.file)
    }

    /// All of a flush but what HDF5 itself knows of the file. From here on until the flush has ended a kill tears it.
    fn hand_over(&mut self) -> hdf5::Result<()> {
        self.columns.write()?;
        self.step_count.write_scalar(&(self.columns.frames() as i64))?;
        free_space::reserve(&self.path, self.file.size())?;
        self.mark.set(&self.path, true)
    }

    /// The file as a kill in the middle of a flush may leave it.
    #[cfg(test)]
    pub(super) fn hand_over_now(&mut self) {
        self.hand_over().unwrap();
    }

    /// Flushes, then saves the checkpoint of this instant beside the result, on the disk itself.
    ///
    /// # Errors
    /// [`Error::Machine`] if the disk refuses.
    pub fn save_checkpoint(&mut self, step: u64, time: f64, payload: &[u8]) -> Result<()> {
        self.flush()?;
        self.sync()?;
        save_checkpoint(&self.path, &CheckpointMeta::new(&self.header, step, time), payload)
    }

    /// Opens what is recorded so far for reading, to find the measures before the file is finished.
    ///
    /// # Errors
    /// As [`append`](Self::append) and [`ResultFile::open`]: there must be a frame.
    pub fn read(&mut self) -> Result<ResultFile> {
        self.flush()?;
        ResultFile::open(&self.path)
    }

    /// Writes the measures of the experiment under `/summary`; one of the same name is replaced.
    ///
    /// # Errors
    /// [`Error::Machine`] if the disk refuses.
    pub fn write_summary(&mut self, measures: &[Measure]) -> Result<()> {
        self.check_whole()?;
        let written = measures.iter().try_for_each(|measure| self.write_measure(measure));
        self.settle(written)
    }

    fn write_measure(&self, measure: &Measure) -> hdf5::Result<()> {
        let group = self.file.group("summary").or_else(|_| self.file.create_group("summary"))?;
        if group.link_exists(&measure.name) {
            group.unlink(&measure.name)?;
        }
        let dataset = group.new_dataset::<f64>().obj_track_times(false).create(measure.name.as_str())?;
        dataset.write_scalar(&measure.value)?;
        set_text(&dataset, "unit", &measure.unit)?;
        set_text(&dataset, "description", &measure.description)
    }

    /// Ends the file: takes in the checkpoint, marks the run as finished after `wall_time` seconds and closes.
    ///
    /// # Errors
    /// [`Error::Machine`] if the disk refuses; the checkpoint then stays in its own file.
    pub fn finish(mut self, wall_time: f64) -> Result<()> {
        self.check_whole()?;
        let side = checkpoint_path(&self.path);
        let checkpoint = match std::fs::read(&side) {
            Ok(bytes) => Some(bytes),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
            Err(error) => return Err(machine_error(&side, "could not be read", &error.to_string())),
        };
        let ended = self.write_end(checkpoint.as_deref(), wall_time);
        self.settle(ended)?;
        self.flush()?;
        self.sync()?;
        if checkpoint.is_some() {
            std::fs::remove_file(&side)
                .map_err(|error| machine_error(&side, "could not be removed", &error.to_string()))?;
        }
        Ok(())
    }

    fn write_end(&self, checkpoint: Option<&[u8]>, wall_time: f64) -> hdf5::Result<()> {
        if let Some(bytes) = checkpoint {
            let row = super::catalogue::entry(DATASET);
            let dataset = self.file.new_dataset_builder().with_data(bytes).obj_track_times(false).create(DATASET)?;
            set_text(&dataset, "unit", row.unit)?;
            set_text(&dataset, "description", row.description)?;
        }
        let group = self.file.group("provenance")?;
        set_number(&group, "wall_time", wall_time)?;
        set_number(&group, "finished", 1_i64)
    }

    /// Waits until the disk itself has the file.
    fn sync(&self) -> Result<()> {
        std::fs::File::open(&self.path)
            .and_then(|file| file.sync_all())
            .map_err(|error| machine_error(&self.path, "could not be written", &error.to_string()))
    }

    fn check_whole(&self) -> Result<()> {
        match self.broken {
            false => Ok(()),
            true => Err(machine_error(&self.path, "could not be written", "an earlier write failed")),
        }
    }

    /// Passes success on. After a failure nothing more is written, so that the file stays as it was at the last flush.
    fn settle(&mut self, outcome: hdf5::Result<()>) -> Result<()> {
        let Err(error) = outcome else { return Ok(()) };
        let error = failed(&self.path, "could not be written", &error);
        self.broken = true;
        // A file without a frame is of no use, and would stand in the way of the next try.
        if self.flushed == 0 {
            self.columns.views(&self.path).chain([self.path.clone()]).for_each(|path| drop(std::fs::remove_file(path)));
        }
        Err(error)
    }
}

impl Drop for ResultWriter {
    fn drop(&mut self) {
        // Nobody is left to hear of a failure; the file then keeps the frames of the last flush.
        if !self.broken && self.flush().is_ok() {
            return;
        }
        // Closing would make HDF5 write what it has in memory, of which the disk took only a part. What is never
        // closed is never written: to the file this is a kill, which it survives.
        std::mem::forget(self.file.clone());
        std::mem::forget(self.step_count.clone());
        std::mem::forget(std::mem::take(&mut self.columns));
    }
}

/// Makes sure that the path may be written, with errors that HDF5 does not tell apart.
fn claim(path: &Path, overwrite: Overwrite, layout: &Layout) -> Result<()> {
    use std::io::ErrorKind;
    let name = path.display();
    let side = checkpoint_path(path);
    let fault = |found: String, help: &str| Err(Error::input(Fault::new(found).help(help)));
    let force = "use --force to replace it, or another -o";
    if path.is_dir() {
        return fault(format!("{name} is a folder"), "name a file in it with -o");
    }
    if overwrite == Overwrite::Refuse && path.exists() {
        return fault(format!("{name} exists"), force);
    }
    if overwrite == Overwrite::Refuse && side.exists() {
        return fault(format!("{} exists: the checkpoint of a run that can be resumed", side.display()), force);
    }
    let views = layout.fields.iter().map(|field| field_view_path(path, &field.name));
    if let Some(view) = views.filter(|view| view.exists()).find(|_| overwrite == Overwrite::Refuse) {
        return fault(format!("{} exists: it would lead to a field of the result", view.display()), force);
    }
    let mut options = std::fs::OpenOptions::new();
    match overwrite {
        Overwrite::Refuse => options.write(true).create_new(true),
        Overwrite::Replace => options.write(true).create(true).truncate(false),
    };
    match options.open(path) {
        Ok(_) => {}
        Err(error) if error.kind() == ErrorKind::AlreadyExists => return fault(format!("{name} exists"), force),
        Err(error) if error.kind() == ErrorKind::NotFound => {
            return fault(
                format!("{name} could not be made: its folder does not exist"),
                "make the folder first, or use another -o",
            );
        }
        Err(error) if error.kind() == ErrorKind::PermissionDenied => {
            return fault(
                format!("{name} may not be written: permission denied"),
                "write to a folder that is yours with -o",
            );
        }
        Err(error) if error.kind() == ErrorKind::NotADirectory => {
            return fault(
                format!("{name} could not be made: a part of its path is a file, not a folder"),
                "use another -o",
            );
        }
        Err(error) => return Err(machine_error(path, "could not be made", &error.to_string())),
    }
    match std::fs::remove_file(&side) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(machine_error(&side, "could not be removed", &error.to_string()))
        }
        _ => Ok(()),
    }
}

/// A run goes on only with what it began with.
fn check_same_run(path: &Path, found: &Header, wanted: &Header) -> Result<()> {
    let differs = match () {
        () if found.experiment != wanted.experiment => "another experiment document",
        () if found.sets != wanted.sets => "other --set options",
        () if found.seed != wanted.seed => "another seed",
        () => return Ok(()),
    };
    let (name, side) = (path.display(), checkpoint_path(path));
    let (document, seed) = (&found.document, found.seed);
    Err(Error::input(
        Fault::new(format!("{name} ({document}, seed {seed}) was made with {differs} than what is to be resumed"))
            .help(format!("if {} came from another run, put the right one back or move it away", side.display())),
    ))
}

/// Takes the end of a finished run out of its file, so that it can go on. Its checkpoint goes back to a file of its
/// own first: at no moment is there none.
fn remove_end(path: &Path, file: &File) -> Result<()> {
    if file.link_exists("checkpoint") {
        let bytes = file.dataset(DATASET).and_then(|dataset| dataset.read_raw::<u8>());
        let bytes = bytes.map_err(|error| container::damaged(path, &error.to_string()))?;
        let side = checkpoint_path(path);
        if !side.exists() {
            std::fs::write(&side, bytes)
                .and_then(|()| std::fs::File::open(&side)?.sync_all())
                .map_err(|error| machine_error(&side, "could not be written", &error.to_string()))?;
        }
    }
    let removed = || -> hdf5::Result<()> {
        for name in ["checkpoint", "summary"] {
            if file.link_exists(name) {
                file.unlink(name)?;
            }
        }
        let group = file.group("provenance")?;
        let resumed: i64 = group.attr("resumed")?.read_scalar()?;
        set_number(&group, "resumed", resumed + 1)?;
        set_number(&group, "finished", 0_i64)?;
        set_number(&group, "wall_time", f64::NAN)
    };
    removed().map_err(|error| failed(path, "could not be changed", &error))
}
