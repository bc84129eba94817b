//! Studies as their users run them: planned, run several at a time, killed, run again, collected.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use pseudopod::output::{ResultFile, checkpoint_path};

use crate::turns::take_turn;

const EXPERIMENT: &str = r#"
title = "Two cells whose calcium may run away"
[run]
until = "1 s"
integrator = { max_step = "0.1 s" }
[cells.cell]
number = 2
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "5 pN/um" } }
motility = { brownian = { speed = "20 um/min", persistence = "5 s" } }
chemistry = ["burst"]
[chemistry.burst]
document = "burst.eml"
[output]
every = "0.2 s"
checkpoint = "0.5 s"
[measure.way]
kind = "value"
series = "position_x"
unit = "um"
description = "where cells are in the end"
[measure.calcium]
kind = "value"
series = "burst.calcium"
description = "calcium in the end"
"#;
/// From c calcium is 1/(1/c - t): below 1 it lasts a second.
const BURST: &str = r#"<eml name="burst" level="cell" time_unit="s"><variable id="calcium" initial="0.4" rate="calcium^2"/>
    <link from="system.calcium" to="cell.stiffness" transfer="1 + 0.1*tanh(value)"/></eml>"#;

/// Writes a study with some values of calcium, whose runs last so long.
fn write_study(folder: &Path, values: &str, replicates: u32, until: &str) {
    let study = format!(
        "title = \"Calcium\"\nexperiment = \"cells.toml\"\nreplicates = {replicates}\nset = ['run.until=\"{until}\"']\n\
         [[parameter]]\nkey = \"chemistry.burst.set.calcium\"\nname = \"at first\"\nvalues = {values}\n"
    );
    std::fs::write(folder.join("study.toml"), study).unwrap();
    std::fs::write(folder.join("cells.toml"), EXPERIMENT).unwrap();
    std::fs::write(folder.join("burst.eml"), BURST).unwrap();
}

fn pseudopod(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pseudopod")).args(arguments).current_dir(folder).output().unwrap()
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// Runs a command that has to end with this code.
fn says(folder: &Path, code: i32, arguments: &[&str]) -> String {
    let output = pseudopod(folder, arguments);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}\n{}", words(&output));
    words(&output)
}

fn plan(folder: &Path, to: &str) {
    says(folder, 0, &["sweep", "plan", "study.toml", "-o", to, "--no-probe"]);
}

/// The bits of all that the physics decides, frame by frame.
fn bits(path: &Path) -> Vec<u64> {
    let file = ResultFile::open(path).unwrap();
    let mut numbers: Vec<f64> = file.times().unwrap();
    for frame in 0..file.frames() {
        numbers.extend(file.positions(frame).unwrap().into_flattened());
        numbers.extend(file.cell_values("burst.calcium", frame).unwrap());
    }
    numbers.extend(file.summary().unwrap().iter().map(|measure| measure.value));
    numbers.into_iter().map(f64::to_bits).collect()
}

fn result(folder: &Path, number: u32) -> PathBuf {
    folder.join(format!("out/runs/{number:05}.vtkhdf"))
}

#[test]
fn a_study_is_run_while_failures_are_kept_and_what_is_lost_is_made_again() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_study(folder, "[0.3, 2.0, 0.4]", 2, "1 s");
    plan(folder, "out");
    // Points 1 to 3 for each of two replicates: runs 2 and 5 have a calcium that runs away after half a second.
    let said = says(folder, 3, &["sweep", "run", "out", "-j", "2"]);
    for part in
        ["2 of 6 runs failed", "run 2 (at first = 2)", "run 5 (at first = 2)", "out/logs/00005.log", "fails at t = 0.5"]
    {
        assert!(said.contains(part), "{part} in\n{said}");
    }
    assert!(!said.contains("run 3 ("), "{said}");
    let complete = [1, 3, 4, 6].map(|number| bits(&result(folder, number)));
    assert!(!result(folder, 2).exists() && !folder.join("out/runs/00001.part").exists());
    assert_ne!(complete[0], complete[2], "replicates differ");

    // A result that was lost is made again, by the study or by itself, with the same bits; one that is there is left alone.
    std::fs::remove_file(result(folder, 4)).unwrap();
    std::fs::remove_file(result(folder, 6)).unwrap();
    let one = ["run", "--plan", "out/runs.csv", "--row", "6", "--quiet", "--threads", "1"];
    says(folder, 0, &one);
    assert!(says(folder, 2, &one).contains("--skip-complete"));
    says(folder, 0, &[&one[..], &["--skip-complete"]].concat());
    says(folder, 3, &["sweep", "run", "out", "-j", "3", "--quiet"]);
    assert!(complete == [1, 3, 4, 6].map(|number| bits(&result(folder, number))), "other numbers");

    let collect = || {
        let said = says(folder, 0, &["sweep", "collect", "out"]);
        let files = ["summary.csv", "summary.parquet", "figures/way.svg", "figures/calcium.png"];
        (said, files.map(|name| std::fs::read(folder.join("out").join(name)).unwrap()))
    };
    let (said, files) = collect();
    assert!(said.contains("6 runs: 4 complete, 2 failed"), "{said}");
    assert_eq!(collect().1, files);
    let table = String::from_utf8(files[0].clone()).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines[0], "run,at first,replicate,seed,status,way (um),calcium,version,wall_time (s)");
    assert!(lines[1].starts_with("1,0.3,1,") && lines[1].contains(",complete,"), "{table}");
    assert!(lines[5].starts_with("5,2,2,") && lines[5].ends_with(",failed,,,,"), "{table}");

    // Results of other inputs are told.
    std::fs::copy(result(folder, 1), result(folder, 3)).unwrap();
    std::fs::remove_file(result(folder, 6)).unwrap();
    let said = collect().0;
    assert!(said.contains("6 runs: 2 complete, 2 failed, 1 differs, 1 missing"), "{said}");
    assert!(said.contains("run 3 (at first = 0.4) differs: not chemistry.burst.set.calcium=0.4"), "{said}");
}

/// Waits until something holds.
fn wait(what: &str, mut holds: impl FnMut() -> bool) {
    let began = Instant::now();
    while !holds() {
        assert!(began.elapsed() < Duration::from_secs(60), "{what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// A command that goes on by itself.
fn begun(folder: &Path, arguments: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pseudopod"));
    command.args(arguments).current_dir(folder).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// A run while it is made.
fn part(folder: &Path, number: u32) -> PathBuf {
    folder.join(format!("out/runs/{number:05}.part/{number:05}.vtkhdf"))
}

/// Waits until a run is under way, or over on a machine that is faster than this test; whether it is under way.
fn under_way(folder: &Path, number: u32) -> bool {
    let begun = || ResultFile::open(&part(folder, number)).is_ok_and(|file| file.frames() > 2 && file.ending().running);
    wait("the run makes no frames", || begun() || result(folder, number).exists());
    !result(folder, number).exists()
}

/// How long runs last that are stopped on their way: a second or so, without optimisation, too.
const LONG: &str = if cfg!(debug_assertions) { "10 s" } else { "200 s" };

#[cfg(unix)]
#[test]
fn a_killed_run_and_an_interrupted_study_go_on_to_the_same_bits() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_study(folder, "[0.0, 0.001]", 1, LONG);
    plan(folder, "whole");
    says(folder, 0, &["sweep", "run", "whole", "-j", "2", "--quiet"]);
    let whole = ["whole/runs/00001.vtkhdf", "whole/runs/00002.vtkhdf"].map(|name| bits(&folder.join(name)));

    plan(folder, "out");
    let mut run = begun(folder, &["run", "--plan", "out/runs.csv", "--row", "1", "-q", "--threads", "1"]);
    let was_killed = under_way(folder, 1);
    run.kill().unwrap();
    run.wait().unwrap();
    let said = says(folder, 0, &["sweep", "collect", "out", "--no-pictures"]);
    assert!(!was_killed || said.contains("1 partial, 1 missing"), "{said}");

    let mut study = begun(folder, &["sweep", "run", "out", "-j", "2"]);
    let was_stopped = under_way(folder, 2);
    assert!(Command::new("sh").args(["-c", &format!("kill -INT {}", study.id())]).status().unwrap().success());
    let code = study.wait().unwrap().code();
    // Nothing goes on by itself, and nothing is lost; a run that was about to end may have done so.
    if was_stopped && code == Some(130) && !result(folder, 2).exists() {
        assert!(checkpoint_path(&part(folder, 2)).exists());
        assert!(!ResultFile::open(&part(folder, 2)).unwrap().ending().running);
    }

    if cfg!(target_os = "linux") {
        // Killed, it takes its runs with it: the next finds them at their checkpoints.
        let mut study = begun(folder, &["sweep", "run", "out", "-j", "2"]);
        under_way(folder, 2);
        study.kill().unwrap();
        study.wait().unwrap();
    }
    says(folder, 0, &["sweep", "run", "out", "-j", "2", "--quiet"]);
    assert!(whole == [1, 2].map(|number| bits(&result(folder, number))), "other numbers");
    let left: Vec<_> = std::fs::read_dir(folder.join("out/runs")).unwrap().collect();
    assert_eq!(left.len(), 2, "{left:?}");
}

#[test]
#[ignore = "slow: runs Snakemake, which PSEUDOPOD_SNAKEMAKE names: python3 -m venv v && v/bin/pip install snakemake (1 min)"]
fn snakemake_makes_the_same_runs_and_makes_a_lost_one_again() {
    let _turn = take_turn();
    let Some(snakemake) = std::env::var_os("PSEUDOPOD_SNAKEMAKE") else {
        panic!("name the program in the variable PSEUDOPOD_SNAKEMAKE");
    };
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_study(folder, "[0.3, 0.4]", 2, "1 s");
    plan(folder, "whole");
    says(folder, 0, &["sweep", "run", "whole", "-j", "2", "--quiet"]);
    says(folder, 0, &["sweep", "plan", "study.toml", "-o", "out", "--no-probe", "--engine", "snakemake"]);
    let make = || {
        let program = format!("pseudopod={}", env!("CARGO_BIN_EXE_pseudopod"));
        let mut command = Command::new(&snakemake);
        command.args(["--cores", "2", "--keep-going", "--config", &program]).current_dir(folder.join("out"));
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}", words(&output));
        words(&output)
    };
    make();
    let summary = |folder: &Path| std::fs::read_to_string(folder.join("summary.csv")).unwrap();
    assert_eq!(summary(&folder.join("out")).matches(",complete,").count(), 4);
    for number in 1..=4 {
        let alone = folder.join(format!("whole/runs/{number:05}.vtkhdf"));
        assert!(bits(&alone) == bits(&result(folder, number)), "run {number} has other numbers");
    }
    assert!(make().contains("Nothing to be done"));
    let before = bits(&result(folder, 3));
    std::fs::remove_file(result(folder, 3)).unwrap();
    make();
    assert!(before == bits(&result(folder, 3)), "other numbers");
}
