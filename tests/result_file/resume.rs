//! A run that goes on leaves the file of a run that never stopped.

use pseudopod::output::{
    Frame, Kept, Measure, ResultFile, ResultWriter, checkpoint_path, frames_path, load_checkpoint,
};

use crate::example::{cells, frame, header, layout, write};
use crate::round_trip::assert_holds;

fn frames(number: u32, count: usize) -> Vec<Frame> {
    (0..count).map(|index| frame(&cells(number), index)).collect()
}

#[test]
fn a_resumed_file_equals_an_uninterrupted_one() {
    let folder = tempfile::tempdir().unwrap();
    // (cells, frames of the first part, frames kept, frames in all): within a piece of the file, across pieces, at
    // the end of a piece, and with one compressed piece per frame.
    for (number, first, keep, all) in [(3, 10, 6, 12), (3, 600, 300, 700), (3, 600, 512, 520), (1500, 4, 2, 5)] {
        let path = folder.path().join(format!("{number}-{first}-{keep}.h5"));
        drop(write(&path, number, first));
        let mut writer =
            ResultWriter::reopen(&path, &header(), &layout(), Kept::until(10 * (keep as u64 - 1))).unwrap();
        assert_eq!(writer.frames(), keep);
        (keep..all).for_each(|index| writer.append(&frame(&cells(number), index)).unwrap());
        writer.finish(3.0).unwrap();
        let result = ResultFile::open(&path).unwrap();
        assert_holds(&result, &frames(number, all));
        assert_eq!(result.ending().resumed, 1);
    }
}

#[test]
fn a_run_resumed_before_its_first_frame_begins_anew() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    drop(write(&path, 2, 0));
    let mut writer = ResultWriter::reopen(&path, &header(), &layout(), Kept::until(0)).unwrap();
    (0..3).for_each(|index| writer.append(&frame(&cells(2), index)).unwrap());
    drop(writer);
    assert_holds(&ResultFile::open(&path).unwrap(), &frames(2, 3));
}

#[test]
fn the_checkpoint_moves_into_the_finished_file_and_out_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    let mut writer = write(&path, 2, 5);
    writer.save_checkpoint(40, 1.0, b"state at 40").unwrap();
    let measure = Measure { name: "m".into(), value: 1.0, unit: "1".into(), description: "Number.".into() };
    writer.write_summary(&[measure]);
    assert!(checkpoint_path(&path).exists());
    writer.finish(1.0).unwrap();
    assert!(!checkpoint_path(&path).exists(), "the finished file stands alone");

    let inside = load_checkpoint(&path).unwrap().unwrap();
    assert_eq!((inside.meta.step, inside.payload.as_slice()), (40, b"state at 40".as_slice()));
    assert_eq!(inside.meta.header.experiment, header().experiment);
    assert_eq!(inside.meta.experiment_hash, header().experiment_hash());

    let writer = ResultWriter::reopen(&path, &header(), &layout(), Kept::until(40)).unwrap();
    drop(writer);
    assert!(checkpoint_path(&path).exists(), "a run that goes on always has a checkpoint");
    assert_eq!(load_checkpoint(&path).unwrap().unwrap(), inside);
    let result = ResultFile::open(&path).unwrap();
    assert_eq!((result.summary().unwrap().len(), result.ending().finished), (0, false));
}

#[test]
fn another_experiment_cannot_resume() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    drop(write(&path, 2, 3));
    let mut other = header();
    other.seed += 1;
    let refusal = |outcome: pseudopod::error::Result<ResultWriter>| outcome.err().unwrap().to_string();
    let text = refusal(ResultWriter::reopen(&path, &other, &layout(), Kept::until(10)));
    assert!(text.contains("another seed"), "{text}");
    other = header();
    other.experiment.push('#');
    let text = refusal(ResultWriter::reopen(&path, &other, &layout(), Kept::until(10)));
    assert!(text.contains("another experiment document"), "{text}");
    let mut others = layout();
    others.types[1].atoms += 1;
    let text = refusal(ResultWriter::reopen(&path, &header(), &others, Kept::until(10)));
    assert!(text.contains("other cells"), "{text}");
    assert_eq!(ResultFile::open(&path).unwrap().frames(), 3, "a refusal loses nothing");
}

#[test]
fn a_result_that_lost_frames_from_before_its_checkpoint_is_not_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    let mut writer = write(&path, 2, 1);
    writer.set_least_interval(std::time::Duration::from_secs(1000));
    (1..5).for_each(|index| writer.append(&frame(&cells(2), index)).unwrap());
    writer.save_checkpoint(40, 1.0, b"state at 40").unwrap();
    // As a kill leaves it, copied without the log in which four of the frames wait.
    let copy = folder.path().join("copy.h5");
    std::fs::copy(&path, &copy).unwrap();
    std::fs::copy(checkpoint_path(&path), checkpoint_path(&copy)).unwrap();
    let before = std::fs::read(&copy).unwrap();
    let meta = load_checkpoint(&copy).unwrap().unwrap().meta;
    assert_eq!(meta.frames, 5);
    let error = ResultWriter::reopen(&copy, &header(), &layout(), (&meta).into()).err().unwrap();
    let words = error.to_string().replace(&copy.display().to_string(), "copy.h5");
    assert_eq!(words, "4 of the 5 frames that were recorded before the checkpoint of copy.h5 are missing");
    assert!(std::fs::read(&copy).unwrap() == before, "a refusal changes nothing");
    assert!(!frames_path(&copy).exists(), "and leaves nothing behind");
    // With the log they are there.
    std::fs::copy(frames_path(&path), frames_path(&copy)).unwrap();
    let writer = ResultWriter::reopen(&copy, &header(), &layout(), (&meta).into()).unwrap();
    assert_eq!(writer.frames(), 5);
}
