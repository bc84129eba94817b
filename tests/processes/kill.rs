//! A run killed at any moment leaves a file that opens, with every frame that was recorded.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use pseudopod::output::{Kept, Overwrite, ResultFile, ResultWriter, load_checkpoint};

use crate::result_example::{cells, frame_with_fields as frame, header, layout_with_fields as layout, stored};
use crate::turns::take_turn;

/// Names the file that the child process writes, and the least milliseconds between its versions.
const TASK: &str = "PSEUDOPOD_TEST_WRITE";
const CELLS: u32 = 30;

/// Not a test by itself: the process that is killed. It writes frames as fast as it can.
#[test]
fn child_that_writes_until_it_is_killed() {
    let Ok(task) = std::env::var(TASK) else { return };
    let (interval, path) = task.split_once(' ').unwrap();
    let cells = cells(CELLS);
    let mut writer = ResultWriter::create(Path::new(path), &header(), &layout(), Overwrite::Replace).unwrap();
    writer.set_least_interval(Duration::from_millis(interval.parse().unwrap()));
    for number in 0.. {
        writer.append(&frame(&cells, number)).unwrap();
        if number == 0 {
            std::fs::write(begun(Path::new(path)), b"").unwrap();
        }
        if number % 500 == 499 {
            writer.save_checkpoint(10 * number as u64, 0.25 * number as f64, &[7; 100_000]).unwrap();
        }
    }
}

/// The file by which the child says that it has appended the first frame.
fn begun(path: &Path) -> PathBuf {
    path.with_extension("begun")
}

/// Kills a writer after each of these times; how many files open with all their numbers right.
fn survivors(interval: Duration, lives: impl Iterator<Item = Duration>) -> (usize, usize, usize) {
    let _turn = take_turn();
    let (mut whole, mut resumable, mut most_frames) = (0, 0, 0);
    for life in lives {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.h5");
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "kill::child_that_writes_until_it_is_killed"])
            .env(TASK, format!("{} {}", interval.as_millis(), path.display()))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // The clock starts with the first frame: a run killed before it has nothing to lose.
        let start = Instant::now();
        while !begun(&path).exists() {
            assert!(start.elapsed() < Duration::from_secs(20), "the child writes nothing");
            std::thread::sleep(Duration::from_millis(2));
        }
        std::thread::sleep(life);
        // SIGKILL on every Unix.
        child.kill().unwrap();
        child.wait().unwrap();
        match check(&path) {
            Ok(frames) => {
                whole += 1;
                most_frames = most_frames.max(frames);
            }
            Err(found) => eprintln!("after {life:?}: {found}"),
        }
        match resume(&path) {
            Ok(()) => resumable += 1,
            Err(found) => eprintln!("after {life:?}, not resumed: {found}"),
        }
    }
    (whole, resumable, most_frames)
}

/// Goes on from the checkpoint, or from the first frame where there is none.
fn resume(path: &Path) -> Result<(), String> {
    let state = load_checkpoint(path).map_err(|error| error.to_string())?;
    let step = state.map_or(0, |state| state.meta.step);
    let writer =
        ResultWriter::reopen(path, &header(), &layout(), Kept::until(step)).map_err(|error| error.to_string())?;
    match (writer.frames() as u64, step / 10 + 1) {
        (found, expected) if found == expected => Ok(()),
        (found, expected) => Err(format!("{found} frames instead of {expected}")),
    }
}

/// Reads every frame and compares it with what was written.
fn check(path: &Path) -> Result<usize, String> {
    let result = ResultFile::open(path).map_err(|error| error.to_string())?;
    let layout = layout();
    let series = |name: &str| result.cell_series(name).map_err(|error| error.to_string());
    let (x, principal) = (series("position_x")?, series("principal_3")?);
    let brain = series("brain.U")?;
    for number in 0..result.frames() {
        let expected = frame(&cells(CELLS), number);
        let positions = result.positions(number).map_err(|error| error.to_string())?;
        let forces = result.forces(number).map_err(|error| error.to_string())?;
        let cells =
            (0..CELLS as usize).all(|cell| {
                x[[number, cell]] == expected.records[cell].position[0]
                    && principal[[number, cell]] == expected.records[cell].principal[2]
            }) && brain.row(number).iter().map(|u| u.to_bits()).eq(expected.systems[0][0].iter().map(|u| u.to_bits()));
        for (field, values) in layout.fields.iter().zip(&expected.fields) {
            for ((name, _), values) in field.species.iter().zip(values) {
                let found = result.field_frame(&field.name, name, number).map_err(|error| error.to_string())?;
                if found != stored(values) {
                    return Err(format!("field {name} in frame {number} of {} is wrong", result.frames()));
                }
            }
        }
        if positions != expected.positions || forces.as_ref() != Some(&expected.forces) || !cells {
            return Err(format!("frame {number} of {} is wrong", result.frames()));
        }
    }
    Ok(result.frames())
}

/// Moments without rhythm, from the golden ratio.
fn moments(count: u64, longest: Duration) -> impl Iterator<Item = Duration> {
    (1..=count).map(move |number| longest.mul_f64((number as f64 * 0.618_033_988_75).fract()))
}

#[test]
fn a_killed_run_opens_and_resumes() {
    let (whole, resumable, most_frames) = survivors(Duration::from_millis(100), moments(3, Duration::from_millis(600)));
    assert_eq!((whole, resumable), (3, 3));
    assert!(most_frames > 10, "{most_frames} frames are too few to tell");
}

#[test]
#[ignore = "slow: kills 40 runs whose file is brought up to date once a second (3 min)"]
fn forty_killed_runs_open_and_resume() {
    let (whole, resumable, most_frames) = survivors(Duration::from_secs(1), moments(40, Duration::from_secs(4)));
    eprintln!("{whole} of 40 open with all frames right, {resumable} resume, at most {most_frames} frames");
    assert_eq!((whole, resumable), (40, 40));
}

#[test]
#[ignore = "slow: kills 100 runs that bring the file up to date as often as they can (1 min)"]
fn runs_that_renew_their_file_all_the_time_are_never_torn() {
    let (whole, resumable, most_frames) = survivors(Duration::ZERO, moments(100, Duration::from_millis(500)));
    eprintln!("{whole} of 100 open with all frames right, {resumable} resume, at most {most_frames} frames");
    assert_eq!((whole, resumable), (100, 100));
}
