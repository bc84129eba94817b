//! Logs as kills, full disks and others leave them.

use super::*;

use crate::output::example::{cells, frame_with_fields, header, layout_with_fields as layout};

/// A run: headers are made anew each time, and begin at another second.
fn owner() -> Owner {
    Owner::of(&Header { started: "2026-03-01T12:00:00Z".into(), ..header() }, 0)
}

fn frame(number: usize) -> Frame {
    frame_with_fields(&cells(3), number)
}

fn log_of(result: &Path, first: usize, frames: usize) -> FrameLog {
    let mut log = FrameLog::take(result).unwrap();
    log.begin(&owner(), &layout()).unwrap();
    (first..first + frames).for_each(|number| log.append(number, &frame(number)).unwrap());
    log
}

fn found(result: &Path) -> FrameLog {
    match FrameLog::look(result) {
        Found::Free(log) => log,
        Found::Nothing | Found::Taken => panic!("the log must be there and free"),
    }
}

fn replayed(log: &mut FrameLog, first: usize) -> Vec<Frame> {
    log.replay(&owner(), first).unwrap().collect()
}

/// Frames hold numbers that are none, so that bits are compared.
fn bits(frame: &Frame) -> Vec<u8> {
    postcard::to_stdvec(frame).unwrap()
}

#[test]
fn frames_come_back_to_the_bit_and_those_that_are_known_are_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let result = folder.path().join("run.h5");
    let mut log = log_of(&result, 5, 4);
    for first in [5, 7, 9] {
        let found = replayed(&mut log, first);
        assert!(found.iter().map(bits).eq((first..9).map(|number| bits(&frame(number)))), "from {first}");
    }
    assert!(replayed(&mut log, 3).is_empty(), "frames 3 and 4 are missing");
    // What is appended after a look goes to the end.
    log.append(9, &frame(9)).unwrap();
    assert_eq!(replayed(&mut log, 5).len(), 5);
    log.clear().unwrap();
    assert!(replayed(&mut log, 5).is_empty());
    log.append(10, &frame(10)).unwrap();
    assert_eq!(replayed(&mut log, 10).len(), 1, "its head stays");
}

#[test]
fn a_log_cut_anywhere_holds_the_frames_before_and_a_wrong_byte_ends_it() {
    let folder = tempfile::tempdir().unwrap();
    let result = folder.path().join("run.h5");
    drop(log_of(&result, 0, 3));
    let whole = fs::read(frames_path(&result)).unwrap();
    let ends: Vec<usize> = (0..=3)
        .map(|frames| {
            drop(log_of(&result, 0, frames));
            fs::metadata(frames_path(&result)).unwrap().len() as usize
        })
        .collect();
    for cut in 0..=whole.len() {
        fs::write(frames_path(&result), &whole[..cut]).unwrap();
        let expected = ends.iter().filter(|end| **end <= cut).count().saturating_sub(1);
        assert_eq!(replayed(&mut found(&result), 0).len(), expected, "cut at {cut}");
    }
    for at in (0..whole.len()).step_by(11) {
        let mut wrong = whole.clone();
        wrong[at] ^= 0x40;
        fs::write(frames_path(&result), wrong).unwrap();
        let expected = ends.iter().filter(|end| **end <= at).count().saturating_sub(1);
        assert_eq!(replayed(&mut found(&result), 0).len(), expected, "wrong at {at}");
    }
}

#[test]
fn frames_of_another_run_are_no_frames() {
    let folder = tempfile::tempdir().unwrap();
    let mut log = log_of(&folder.path().join("run.h5"), 0, 3);
    let resumed = Owner { resumed: 1, ..owner() };
    let later = Owner { started: "2026-03-01T12:00:01Z".into(), ..owner() };
    for other in [resumed, later] {
        assert_eq!(log.replay(&other, 0).unwrap().count(), 0);
    }
}

#[test]
fn one_at_a_time_has_the_log() {
    let folder = tempfile::tempdir().unwrap();
    let result = folder.path().join("run.h5");
    assert!(matches!(FrameLog::look(&result), Found::Nothing));
    let log = log_of(&result, 0, 1);
    assert!(matches!(FrameLog::look(&result), Found::Taken));
    let text = FrameLog::take(&result).err().unwrap().to_string();
    assert!(text.contains("is being written by a running simulation"), "{text}");
    fs::remove_file(frames_path(&result)).unwrap();
    assert!(!log.is_there());
    drop(FrameLog::take(&result).unwrap());
    log.remove();
    assert!(frames_path(&result).exists(), "it is another's by now");
}
