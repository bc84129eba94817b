//! Files as a kill leaves them at every point of a flush.

use std::path::Path;
use std::time::Duration;

use super::*;
use crate::output::mark::FlushMark;
use crate::output::{Cell, Frame, Overwrite, ResultFile, ResultWriter};

#[path = "../../tests/result_file/example.rs"]
#[allow(dead_code)]
mod example;
use example::{cells, frame_with_fields, header, layout_with_fields as layout, stored};

/// The frame of this number: of five cells one vanishes after 110 frames and another is born after 150.
fn frame(number: usize) -> Frame {
    let mut cells = cells(5);
    if number >= 110 {
        cells.remove(2);
    }
    if number >= 150 {
        cells.push(Cell { id: 5, kind: 1, parent: Some(4) });
    }
    frame_with_fields(&cells, number)
}

/// A flush, as the file was when its last step began, and after it.
struct Flush {
    before: Vec<u8>,
    after: Vec<u8>,
}

impl Flush {
    /// Of a file that holds `first` frames already and gets `more`.
    fn of(folder: &Path, first: usize, more: usize) -> Self {
        let path = folder.join("run.h5");
        let mut writer = ResultWriter::create(&path, &header(), &layout(), Overwrite::Replace).unwrap();
        writer.set_flush_interval(Duration::from_secs(1000));
        (0..first).for_each(|number| writer.append(&frame(number)).unwrap());
        writer.flush().unwrap();
        (first..first + more).for_each(|number| writer.append(&frame(number)).unwrap());
        let before = {
            writer.hand_over_now();
            std::fs::read(&path).unwrap()
        };
        writer.flush().unwrap();
        drop(writer);
        Self { before, after: std::fs::read(&path).unwrap() }
    }

    /// Where the file was changed, as the first byte of each change.
    fn changes(&self) -> Vec<usize> {
        let differs = |at: usize| self.before[at] != self.after[at];
        (0..self.after.len()).filter(|at| differs(*at) && (*at == 0 || !differs(at - 1))).collect()
    }

    /// The file of a run that was killed when HDF5, which goes by addresses, had come to this byte.
    fn torn(&self, at: usize, path: &Path) {
        std::fs::write(path, [&self.after[..at], &self.before[at..]].concat()).unwrap();
        let _ = std::fs::remove_file(mended_path(path));
        set_mark(path);
    }
}

fn set_mark(path: &Path) {
    let mark = FlushMark::of(&container::open(path, Access::Read).unwrap());
    mark.set(path, true).unwrap();
}

fn assert_frames(result: &ResultFile, expected: &[Frame]) {
    assert_eq!(result.frames(), expected.len());
    for (number, frame) in expected.iter().enumerate() {
        assert_eq!(result.positions(number).unwrap(), frame.positions);
        assert_eq!(result.forces(number).unwrap().as_ref(), Some(&frame.forces));
        assert_eq!(result.field_frame("medium", "oxygen", number).unwrap(), stored(&frame.fields[1][0]));
        assert_eq!(result.pairs(number).unwrap(), frame.pairs);
        assert_eq!(result.cells(number), frame.cells);
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&result.cell_values("brain.U", number).unwrap()), bits(&frame.systems[0][0]));
        let energy: Vec<f64> = frame.records.iter().map(|cell| cell.energy).collect();
        assert_eq!(result.cell_values("energy", number).unwrap(), energy);
    }
}

/// Resumes after `kept` frames and appends three.
fn go_on(path: &Path, kept: usize) -> Result<()> {
    let mut writer = ResultWriter::reopen(path, &header(), &layout(), 10 * (kept as u64 - 1))?;
    assert_eq!(writer.frames(), kept);
    (kept..kept + 3).for_each(|number| writer.append(&frame(number)).unwrap());
    writer.finish(1.0).unwrap();
    let expected: Vec<Frame> = (0..kept + 3).map(frame).collect();
    let result = ResultFile::open(path).unwrap();
    assert_frames(&result, &expected);
    assert_eq!(result.ending().resumed, 1);
    assert!(!mended_path(path).exists());
    Ok(())
}

#[test]
fn a_run_killed_at_any_point_of_a_flush_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let flush = Flush::of(folder.path(), 100, 80);
    let changes = flush.changes();
    assert!(changes.len() > 200, "{} changes", changes.len());
    let path = folder.path().join("torn.h5");
    // Some sixty of them, and the end.
    for at in changes.iter().step_by(changes.len() / 60).chain([&flush.after.len()]) {
        flush.torn(*at, &path);
        go_on(&path, 100).unwrap_or_else(|error| panic!("torn at {at}: {error}"));
    }
}

#[test]
fn frames_torn_off_before_the_checkpoint_are_told_and_nothing_is_changed() {
    let folder = tempfile::tempdir().unwrap();
    // The last node of the tree of the positions is full (64 pieces, then 57 more each time): the next frame divides
    // it, and seven old pieces move into a new node, which is written last.
    let flush = Flush::of(folder.path(), 121, 1);
    let path = folder.path().join("torn.h5");
    let mut faults = Vec::new();
    for at in flush.changes().into_iter().step_by(10) {
        flush.torn(at, &path);
        let torn = std::fs::read(&path).unwrap();
        if let Err(error) = go_on(&path, 121) {
            assert!(std::fs::read(&path).unwrap() == torn, "a refusal changes nothing");
            assert!(!mended_path(&path).exists());
            faults.push(error.to_string().replace(&path.display().to_string(), "torn.h5"));
            go_on(&path, 114).unwrap();
        }
    }
    let told =
        "torn.h5 is damaged: the run was killed in a flush, and 7 of the frames before its checkpoint cannot be read";
    assert!(faults.len() > 5 && faults.iter().any(|fault| fault.starts_with(told)), "{faults:?}");
}

#[test]
fn a_torn_file_tells_of_no_frame_that_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let flush = Flush::of(folder.path(), 121, 10);
    let path = folder.path().join("torn.h5");
    let frames: Vec<Frame> = (0..131).map(frame).collect();
    for at in flush.changes().into_iter().step_by(10) {
        flush.torn(at, &path);
        let result = ResultFile::open(&path).unwrap();
        assert!(result.frames() >= 114, "torn at {at}: {} frames", result.frames());
        assert_frames(&result, &frames[..result.frames()]);
    }
}
