//! A day of simulated time in one run: it takes no more memory and no longer a step in the end than before, and volumes stay exact.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use pseudopod::output::ResultFile;

use crate::turns::take_turn;

/// Names the program that runs, in place of the one that was built for the tests.
const PROGRAM: &str = "PSEUDOPOD_SOAK_PROGRAM";

/// Twenty-five cells that wander, meet within the first hours and stay one aggregate, in which they change places.
const DAY: &str = r#"
title = "A day of an aggregate"
seed = 5
[run]
until = "24 h"
integrator = { max_step = "20 s" }
[cells.cell]
number = 25
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { random_from = ["-25 um", "-25 um", "-25 um"], random_to = ["25 um", "25 um", "25 um"] }
[cells.cell.mechanics]
drag = "20 pN s/um"
shape_memory = { stiffness = "1 pN/um" }
[cells.cell.motility]
brownian = { speed = "0.25 um/min", persistence = "10 min", space = "volume" }
attraction = { to = ["0 um", "0 um", "0 um"], stiffness = "0.001 pN/um" }
[contact]
strength = "0.07 pN/um^2"
energy = "0.07 pN/um"
[output]
every = "10 min"
"#;
/// What is run, s.
const UNTIL: f64 = 86_400.0;
/// Memory that the second half of the run may take beyond the first, KiB; 492 were measured, of 39 000. In half a day there are 15 000 steps and
/// 72 frames: a number kept of each cell and step would take 3 000, each frame 3 600.
const MOST_GROWTH: u64 = 1024;
/// How much longer a step may take in the last quarter than in the second; 0.98 times was measured, on a machine with much else to do.
const MOST_SLOWING: f64 = 1.3;
/// A frame of 1 050 atoms with positions and forces takes 50 kB in memory, and 32 in the result.
const MOST_BYTES_A_FRAME: u64 = 40_000;

/// What the run was like at some moment.
#[derive(Debug, Clone, Copy)]
struct Sample {
    /// Simulated time, s.
    time: f64,
    steps: f64,
    /// Time that the processors spent on it, s: what else the machine does is not in it.
    processors: f64,
    /// The most memory until then, KiB.
    memory: u64,
}

/// What the system says of a process: seconds of processors, and the most memory that it had, KiB.
fn spent(process: u32) -> Option<(f64, u64)> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let memory = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let memory = memory.trim().trim_end_matches(" kB").parse().ok()?;
    let numbers = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The name, in brackets, may hold spaces; user and system time are the 12th and 13th number after it, in hundredths of a second.
    let mut after = numbers.rsplit_once(')')?.1.split_whitespace().skip(11);
    let mut hundredths = || after.next()?.parse::<f64>().ok();
    Some(((hundredths()? + hundredths()?) / 100.0, memory))
}

/// Runs the day on one thread, and looks at the process whenever it tells where it is, which is every five seconds.
fn run(program: &Path, folder: &Path) -> Vec<Sample> {
    std::fs::write(folder.join("day.toml"), DAY).unwrap();
    let began = Instant::now();
    let mut child = Command::new(program)
        .args(["run", "day.toml", "-o", "day.vtkhdf", "--no-pictures", "--threads", "1"])
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let (mut samples, mut said) = (Vec::new(), String::new());
    for line in BufReader::new(child.stderr.take().unwrap()).lines().map_while(Result::ok) {
        // "t = 372.1 of 86400 s, 464 steps, about 800 s left"
        let numbers: Vec<f64> = line.split([' ', ',']).filter_map(|word| word.parse().ok()).collect();
        if let (true, &[time, _, steps, _], Some((processors, memory))) =
            (line.starts_with("t = "), &numbers[..], spent(child.id()))
        {
            samples.push(Sample { time, steps, processors, memory });
        } else {
            said.push_str(&line);
            said.push('\n');
        }
    }
    assert!(child.wait().unwrap().success(), "{said}");
    println!("{:.0} s of wall time, {} samples", began.elapsed().as_secs_f64(), samples.len());
    samples
}

/// The last sample before a share of the run is over.
fn at(samples: &[Sample], share: f64) -> Sample {
    let before = samples.iter().rev().find(|sample| sample.time <= share * UNTIL);
    *before.unwrap_or_else(|| panic!("nothing was told in the first {share} of the run"))
}

#[test]
#[ignore = "slow: 24 simulated hours of twenty-five cells (7 to 15 min)"]
fn a_day_of_an_aggregate_takes_no_more_memory_and_no_longer_a_step_in_the_end() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let program = std::env::var_os(PROGRAM).map_or_else(|| env!("CARGO_BIN_EXE_pseudopod").into(), PathBuf::from);
    let samples = run(&program, folder.path());

    let [quarter, half, late, end] = [0.25, 0.5, 0.75, 1.0].map(|share| at(&samples, share));
    let a_step = |from: Sample, to: Sample| 1e3 * (to.processors - from.processors) / (to.steps - from.steps);
    let (before, after) = (a_step(quarter, half), a_step(late, end));
    println!("{} steps; {before:.3} ms a step in the second quarter, {after:.3} ms in the last", end.steps);
    println!("memory at most {} KiB in the first half, {} KiB in the end", half.memory, end.memory);
    assert!(end.memory <= half.memory + MOST_GROWTH, "memory grows: {half:?} {end:?}");
    assert!(after <= MOST_SLOWING * before, "steps become slower: {before} and {after} ms");

    let path = folder.path().join("day.vtkhdf");
    let file = ResultFile::open(&path).unwrap();
    assert_eq!(file.frames(), 145, "one every ten minutes, and the first");
    let errors = (0..file.frames()).flat_map(|frame| file.cell_values("volume_error", frame).unwrap());
    let worst = errors.map(f64::abs).fold(0.0, f64::max);
    let bytes = std::fs::metadata(&path).unwrap().len();
    println!("volumes within {worst:.1e}, {bytes} bytes");
    assert!(worst < 1e-12, "a volume is off by {worst}");
    assert!(bytes < MOST_BYTES_A_FRAME * file.frames() as u64, "{bytes} bytes");
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left.len(), 2, "nothing but the document and the result is left: {left:?}");
}
