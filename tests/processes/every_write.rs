//! A writer stopped in front of every call by which it changes files: no frame that was appended is lost, and it goes on.

use std::os::unix::process::ExitStatusExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};

use pseudopod::error::Result;
use pseudopod::output::{Cell, CheckpointMeta, Frame, Kept, Overwrite, ResultFile, ResultWriter, load_checkpoint};

use crate::result_example::{cells, frame_with_fields, header, layout_with_fields as layout, stored};
use crate::shim::shim;
use crate::turns::take_turn;

/// Names the folder in which the child process works.
const FOLDER: &str = "PSEUDOPOD_TEST_STORAGE";
/// Frames of the first part, of which some are computed again, of the second, and in all. A tree of HDF5 holds 64 pieces
/// before it divides.
const FIRST: usize = 70;
const SECOND: usize = 74;
const ALL: usize = 76;

/// The frame of this number: of five cells one vanishes and another is born.
fn frame(number: usize) -> Frame {
    let mut cells = cells(5);
    if number >= 3 {
        cells.remove(2);
    }
    if number >= 5 {
        cells.push(Cell { id: 5, kind: 1, parent: Some(4) });
    }
    frame_with_fields(&cells, number)
}

/// A writer that notes after each frame how many must be there from now on.
struct Noted {
    writer: ResultWriter,
    note: PathBuf,
}

impl Noted {
    fn append(&mut self, frames: std::ops::Range<usize>) -> Result<()> {
        for number in frames {
            self.writer.append(&frame(number))?;
            note(&self.note, number + 1);
        }
        Ok(())
    }

    fn checkpoint(&mut self, frames: usize) -> Result<()> {
        let step = frame(frames - 1).step;
        self.writer.save_checkpoint(step, 0.25 * frames as f64, &[frames as u8; 5000])
    }
}

fn note(path: &Path, frames: usize) {
    std::fs::write(path, [frames as u8]).unwrap();
}

fn noted(folder: &Path) -> usize {
    std::fs::read(folder.join("note")).ok().and_then(|bytes| bytes.first().copied()).unwrap_or(0).into()
}

/// First frames, frames with other cells, versions of the file, checkpoints, an interruption, a resume that cuts, an end, and a
/// resume of what had ended.
fn write_all(folder: &Path) -> Result<()> {
    let (path, note_path) = (folder.join("run.h5"), folder.join("note"));
    let open = |writer| Noted { writer, note: note_path.clone() };
    let mut run = open(ResultWriter::create(&path, &header(), &layout(), Overwrite::Replace)?);
    run.append(0..1)?;
    run.checkpoint(1)?;
    run.append(1..4)?;
    run.writer.renew()?;
    run.checkpoint(4)?;
    run.append(4..6)?;
    run.checkpoint(6)?;
    run.append(6..FIRST)?;
    drop(run);
    // Frames after the checkpoint are cut off, and those before it stay.
    note(&note_path, 6);
    go_on(&path, &note_path, 6, SECOND)?;
    note(&note_path, SECOND);
    go_on(&path, &note_path, SECOND, ALL)
}

fn go_on(path: &Path, note_path: &Path, from: usize, to: usize) -> Result<()> {
    let meta = load_checkpoint(path)?.expect("a checkpoint").meta;
    assert_eq!(meta.frames, from);
    let mut run = Noted { writer: reopened(path, &meta)?, note: note_path.to_path_buf() };
    run.append(from..to)?;
    run.checkpoint(to)?;
    run.writer.finish(1.0)
}

fn reopened(path: &Path, meta: &CheckpointMeta) -> Result<ResultWriter> {
    ResultWriter::reopen(path, &header(), &layout(), Kept::from(meta))
}

/// Not a test by itself: the process that is stopped.
#[test]
fn child_that_is_stopped_at_a_write() {
    let Ok(folder) = std::env::var(FOLDER) else { return };
    write_all(Path::new(&folder)).unwrap();
}

fn stopped_at(call: usize, half: bool, shim: &Path, folder: &Path) -> ExitStatus {
    let mut child = Command::new(std::env::current_exe().unwrap());
    child.args(["--exact", "every_write::child_that_is_stopped_at_a_write", "--test-threads", "1"]);
    child.env(FOLDER, folder).env("LD_PRELOAD", shim).env("PSEUDOPOD_TEST_STOP", call.to_string());
    if half {
        child.env("PSEUDOPOD_TEST_HALF", "1");
    }
    child.stdout(Stdio::null()).stderr(Stdio::null()).status().unwrap()
}

fn assert_frames(result: &ResultFile, least: usize, at: &str) {
    let found = result.frames();
    assert!(found >= least, "{at}: {found} frames of at least {least}");
    for number in 0..found {
        let expected = frame(number);
        assert_eq!(result.positions(number).unwrap(), expected.positions, "{at}");
        assert_eq!(result.forces(number).unwrap().as_ref(), Some(&expected.forces), "{at}");
        assert_eq!(result.cells(number), expected.cells, "{at}");
        assert_eq!(result.pairs(number).unwrap(), expected.pairs, "{at}");
        assert_eq!(result.field_frame("medium", "oxygen", number).unwrap(), stored(&expected.fields[1][0]), "{at}");
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&result.cell_values("brain.U", number).unwrap()), bits(&expected.systems[0][0]), "{at}");
    }
}

/// What a reader finds, and that the run goes on from its checkpoint to its end.
fn assert_nothing_lost(folder: &Path, at: &str) {
    let (path, least) = (folder.join("run.h5"), noted(folder));
    match ResultFile::open(&path) {
        Ok(result) => assert_frames(&result, least, at),
        Err(error) => assert_eq!(least, 0, "{at}: {error}"),
    }
    let checkpoint = if path.exists() { load_checkpoint(&path).unwrap() } else { None };
    let Some(checkpoint) = checkpoint else {
        // Killed before the first checkpoint: nothing stands in the way of a run from the start.
        assert!(least <= 1, "{at}: no checkpoint after {least} frames");
        let overwrite = if path.exists() { Overwrite::Replace } else { Overwrite::Refuse };
        drop(
            ResultWriter::create(&path, &header(), &layout(), overwrite)
                .unwrap_or_else(|error| panic!("{at}: {error}")),
        );
        return;
    };
    let mut writer = reopened(&path, &checkpoint.meta).unwrap_or_else(|error| panic!("{at}: {error}"));
    assert_eq!(writer.frames(), checkpoint.meta.frames, "{at}");
    (checkpoint.meta.frames..ALL + 1).for_each(|number| writer.append(&frame(number)).unwrap());
    writer.finish(1.0).unwrap();
    let result = ResultFile::open(&path).unwrap();
    assert_eq!(result.frames(), ALL + 1, "{at}");
    assert_frames(&result, ALL + 1, at);
    assert!(result.ending().finished, "{at}");
    let left: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    let aside = |name: &&std::ffi::OsString| {
        let name = name.to_string_lossy();
        name.ends_with(".frames") || name.ends_with(".checkpoint")
    };
    assert_eq!(left.iter().find(aside), None, "{at}: an ended run stands alone");
}

/// Stops the writer in front of every `stride`th call from `first` on; how many calls it makes in all.
fn stop_everywhere(first: usize, stride: usize, half: bool) -> usize {
    let _turn = take_turn();
    let tools = tempfile::tempdir().unwrap();
    let shim = shim(tools.path());
    for call in (first..).step_by(stride) {
        let folder = tempfile::tempdir().unwrap();
        let status = stopped_at(call, half, &shim, folder.path());
        let at = format!("stopped at call {call}{}", if half { ", half done" } else { "" });
        if status.signal().is_none() {
            assert!(status.success(), "{at}: {status}");
            return call;
        }
        assert_nothing_lost(folder.path(), &at);
    }
    unreachable!("a writer comes to its end")
}

#[test]
fn a_writer_stopped_at_a_write_loses_nothing() {
    for half in [false, true] {
        let calls = stop_everywhere(3, 151, half);
        assert!(calls > 500, "{calls} calls are too few to tell");
    }
}

#[test]
#[ignore = "slow: stops a writer in front of each of its 3 000 and some calls that change files, and half through (half an hour)"]
fn a_writer_stopped_at_every_write_loses_nothing() {
    for half in [false, true] {
        let calls = stop_everywhere(1, 1, half);
        eprintln!("stopped in front of each of {calls} calls{}", if half { ", half done" } else { "" });
    }
}
