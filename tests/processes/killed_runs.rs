//! Runs with contacts, fields and chemistry, killed again and again, also just after they were resumed: they end with the
//! numbers of a run that never stopped.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use pseudopod::output::{Kept, ResultFile, ResultWriter, checkpoint_path};

use crate::turns::take_turn;

/// The document of the runs.
const DOCUMENT: &str = r#"
title = "Cells that stick, secrete and vanish"
seed = 11
[run]
until = "UNTIL"
integrator = { max_step = "0.1 s" }
[cells.white]
number = 8
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "5 pN/um" } }
motility = { brownian = { speed = "20 um/min", persistence = "5 s" } }
placement = { grid = [2, 2, 2], spacing = "10.5 um" }
chemistry = ["clock"]
[[cells.white.removed]]
time = "0.6 s"
number = 1
[contact]
strength = "0.1 pN/um^2"
[chemistry.clock]
document = "clock.eml"
[chemistry.field]
document = "field.eml"
[output]
every = "0.2 s"
checkpoint = "0.5 s"
"#;
const CLOCK: &str = r#"<eml name="clock" level="cell"><input id="c" default="0"/><variable id="u" initial="1" rate="c - 0.5*u"/>
    <link from="field[c]" to="system.c"/><link from="system.u" to="cell.secretion[c]"/></eml>"#;
const FIELD: &str = r#"<eml name="field"><grid dimension="2" spacing="4" origin="-40 -40" size="80 80"/>
    <field id="c" diffusion="30" decay="0.1" initial="2 + 0.02*x"/></eml>"#;

/// The program, quiet, on one thread and without pictures.
pub fn pseudopod(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pseudopod"));
    command.args(arguments).args(["-q", "--threads", "1", "--no-pictures"]).current_dir(folder);
    command.stdout(Stdio::null());
    command
}

/// Writes the document and its equations.
pub fn write_document(folder: &Path, until: &str) {
    std::fs::write(folder.join("cells.toml"), DOCUMENT.replace("UNTIL", until)).unwrap();
    std::fs::write(folder.join("clock.eml"), CLOCK).unwrap();
    std::fs::write(folder.join("field.eml"), FIELD).unwrap();
}

/// The bits of all that the physics decides, frame by frame.
fn bits(path: &Path) -> Vec<Vec<u64>> {
    let file = ResultFile::open(path).unwrap();
    let times = file.times().unwrap();
    let of_frame = |frame: usize| {
        let mut numbers: Vec<f64> = file.positions(frame).unwrap().into_flattened();
        numbers.push(times[frame]);
        for name in ["energy", "volume", "clock.u", "contact_share"] {
            numbers.extend(file.cell_values(name, frame).unwrap());
        }
        numbers.extend(file.field_frame("field", "c", frame).unwrap());
        numbers.into_iter().map(f64::to_bits).collect()
    };
    (0..file.frames()).map(of_frame).collect()
}

/// Lets a command live for a while; whether it came to its end by itself.
fn killed_after(mut command: Command, life: Duration) -> bool {
    let mut child = command.spawn().unwrap();
    std::thread::sleep(life);
    let ended = child.try_wait().unwrap();
    // SIGKILL on every Unix.
    let _ = child.kill();
    child.wait().unwrap();
    ended.is_some_and(|status| status.success())
}

/// Kills a run and what resumes it until it has come to its end; how many kills that took.
fn chain(folder: &Path, name: &str, lives: &mut impl Iterator<Item = Duration>, whole: &[Vec<u64>]) -> usize {
    let result: PathBuf = folder.join(name);
    let (mut kills, mut seen) = (0, 0);
    loop {
        // Once a frame was recorded a run is resumed; one that was killed before begins anew.
        let begun = seen > 0 || ResultFile::open(&result).is_ok();
        let command = match begun {
            true => pseudopod(folder, &["resume", name]),
            false => pseudopod(folder, &["run", "cells.toml", "-o", name, "--force"]),
        };
        // Lives become longer, so that a run that makes no way within one comes to its end on a slow machine, too.
        if killed_after(command, lives.next().unwrap() + Duration::from_millis(10) * kills as u32) {
            break;
        }
        kills += 1;
        // A resumed run first cuts off what was recorded after its checkpoint.
        if let Ok(found) = ResultFile::open(&result) {
            seen = found.frames();
            drop(found);
            let found = bits(&result);
            assert!(found[..] == whole[..found.len()], "after {kills} kills {name} has other numbers");
        } else {
            assert_eq!(seen, 0, "after {kills} kills {name} cannot be read any more");
        }
        assert!(kills < 500, "{name} makes no way");
    }
    assert!(bits(&result) == whole, "{name} ends with other numbers");
    kills
}

/// Runs chains of kills until there were so many.
fn kill(wanted: usize, until: &str, longest: Duration) -> usize {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    write_document(folder.path(), until);
    let run = pseudopod(folder.path(), &["run", "cells.toml", "-o", "whole.h5"]).status().unwrap();
    assert!(run.success());
    let whole = bits(&folder.path().join("whole.h5"));
    // Moments without rhythm, from the golden ratio; each third is within the first tenth of a second.
    let mut number = 0_u64;
    let mut lives = std::iter::from_fn(|| {
        number += 1;
        let share = (number as f64 * 0.618_033_988_75).fract();
        Some(if number.is_multiple_of(3) { Duration::from_millis(100) } else { longest }.mul_f64(share))
    });
    let mut kills = 0;
    while kills < wanted {
        let name = format!("run{kills}.h5");
        kills += chain(folder.path(), &name, &mut lives, &whole);
        let _ = std::fs::remove_file(folder.path().join(name));
    }
    kills
}

#[test]
fn a_run_killed_before_its_first_checkpoint_goes_on_from_its_start() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    write_document(folder.path(), "2 s");
    let status = pseudopod(folder.path(), &["run", "cells.toml", "-o", "run.h5"]).status().unwrap();
    assert!(status.success());
    let path = folder.path().join("run.h5");
    let whole = bits(&path);
    let file = ResultFile::open(&path).unwrap();
    let (header, layout) = (file.header().clone(), file.layout().clone());
    drop(file);
    drop(ResultWriter::reopen(&path, &header, &layout, Kept::until(0)).unwrap());
    std::fs::remove_file(checkpoint_path(&path)).unwrap();
    assert_eq!(bits(&path).len(), 1);
    assert!(pseudopod(folder.path(), &["resume", "run.h5"]).status().unwrap().success());
    assert!(bits(&path) == whole, "it ends with other numbers");
}

#[test]
fn killed_runs_and_killed_resumes_end_with_the_same_bits() {
    let kills = kill(8, "40 s", Duration::from_millis(500));
    assert!(kills >= 8);
}

#[test]
#[ignore = "slow: a thousand kills of runs with contacts, fields and chemistry, the first second and fresh resumes included (15 min)"]
fn a_thousand_kills_lose_nothing() {
    eprintln!("{} kills, nothing lost", kill(1000, "60 s", Duration::from_millis(1000)));
}
