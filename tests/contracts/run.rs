//! What a run promises: resume is exact, threads and output do not matter, exit codes.

use crate::turns::take_turn;
use pseudopod::experiment::Document;
use pseudopod::output::ResultFile;
use pseudopod::run::{Quiet, ResumeOptions, RunOptions, resume, run};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const TEXT: &str = r#"
title = "Cells that wander and are pulled"
seed = 5
[run]
until = "60 s"
integrator = { max_step = "0.02 s" }
[cells.white]
number = 12
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "5 pN/um" } }
motility = { brownian = { speed = "5 um/min", persistence = "5 s" } }
loads = [{ name = "pull", cap = { direction = [0, 0, 1], number = 3 }, direction = [0, 0, 1], force = [["0 s", "0 pN"], ["30 s", "5 pN"]] }]
[output]
every = "1 s"
checkpoint = "2 s"
[measure.height]
kind = "value"
series = "size_z"
"#;

fn document(sets: &[&str]) -> Document {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    Document::parse("test.toml", TEXT, Path::new("."), &sets).unwrap()
}

fn run_to(folder: &Path, name: &str, threads: usize, sets: &[&str]) -> PathBuf {
    let result = folder.join(name);
    let options = RunOptions { threads: Some(threads), ..RunOptions::new(&result) };
    run(&document(sets), &options, &mut Quiet).unwrap();
    result
}

/// Everything recorded that the physics decides.
#[derive(Debug, PartialEq)]
struct Contents {
    times: Vec<f64>,
    positions: Vec<Vec<[f64; 3]>>,
    series: Vec<Vec<f64>>,
}

fn contents(path: &Path) -> Contents {
    let file = ResultFile::open(path).unwrap();
    let positions = (0..file.frames()).map(|frame| file.positions(frame).unwrap()).collect();
    let series = ["energy", "volume", "velocity_x", "size_z"]
        .map(|name| file.cell_series(name).unwrap().iter().copied().collect())
        .to_vec();
    Contents { times: file.times().unwrap(), positions, series }
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let one = run_to(folder.path(), "one.h5", 1, &["run.until=10 s"]);
    let two = run_to(folder.path(), "two.h5", 2, &["run.until=10 s"]);
    assert_eq!(contents(&one), contents(&two));
}

#[test]
fn output_does_not_disturb_the_run() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let often = run_to(folder.path(), "often.h5", 2, &["run.until=10 s", "output.every=0.1 s", "output.forces=true"]);
    let rare = run_to(folder.path(), "rare.h5", 2, &["run.until=10 s", "output.every=5 s"]);
    let last = |path: &Path| {
        let file = ResultFile::open(path).unwrap();
        file.positions(file.frames() - 1).unwrap()
    };
    assert_eq!(last(&often), last(&rare));
}

/// Starts the program on the document, kills it after a while, resumes, and compares with a run left alone.
#[test]
fn a_killed_run_resumes_to_the_same_bits() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("test.toml");
    std::fs::write(&path, TEXT).unwrap();
    let whole = run_to(folder.path(), "whole.h5", 2, &[]);
    let result = folder.path().join("killed.h5");
    let mut child = Command::new(env!("CARGO_BIN_EXE_pseudopod"))
        .args(["run", "--quiet", "--no-pictures", "-o"])
        .arg(&result)
        .arg(&path)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut killed = false;
    for _ in 0..2000 {
        std::thread::sleep(std::time::Duration::from_millis(5));
        let kept = pseudopod::output::checkpoint_path(&result);
        if std::fs::metadata(&kept).is_ok() && child.try_wait().unwrap().is_none() {
            std::thread::sleep(std::time::Duration::from_millis(150));
            child.kill().unwrap();
            killed = true;
            break;
        }
    }
    child.wait().unwrap();
    assert!(killed, "the run ended before it could be killed");
    if !ResultFile::open(&result).unwrap().ending().finished {
        resume(&result, &ResumeOptions { threads: Some(1), ..ResumeOptions::default() }, &mut Quiet).unwrap();
    }
    assert_eq!(contents(&whole), contents(&result));
}

fn program(arguments: &[&str], folder: &Path) -> (Option<i32>, String) {
    let out = Command::new(env!("CARGO_BIN_EXE_pseudopod")).args(arguments).current_dir(folder).output().unwrap();
    (out.status.code(), String::from_utf8_lossy(&out.stderr).into_owned())
}

#[test]
fn exit_codes_are_as_promised() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("good.toml"), TEXT).unwrap();
    std::fs::write(folder.path().join("bad.toml"), TEXT.replace("drag", "darg")).unwrap();
    let quick = ["--quiet", "--no-pictures", "--until", "2 s"];
    let with = |start: &[&'static str]| start.iter().copied().chain(quick).collect::<Vec<_>>();
    assert_eq!(program(&with(&["run", "good.toml"]), folder.path()).0, Some(0));
    let (code, text) = program(&with(&["run", "bad.toml"]), folder.path());
    assert!(code == Some(2) && text.contains("did you mean") && text.contains("bad.toml:"), "{text}");
    let (code, text) = program(&with(&["run", "good.toml"]), folder.path());
    assert!(code == Some(2) && text.contains("--force"), "an existing result must be kept: {text}");
    // A stiff cell under an explicit step that is known to be unstable ends with exit 3 and keeps its last state.
    let mut unstable = with(&["run", "good.toml", "-o", "unstable.h5"]);
    unstable.extend(["--set", "run.integrator.method=explicit", "--set", "run.integrator.step=1 s"]);
    let (code, text) = program(&unstable, folder.path());
    assert!(code == Some(2) && text.contains("stable"), "{text}");
    unstable.extend(["--set", "run.integrator.allow_unstable=true", "--force"]);
    unstable.iter_mut().filter(|word| **word == "2 s").for_each(|word| *word = "2000 s");
    let (code, text) = program(&unstable, folder.path());
    assert!(code == Some(3) && text.contains("unstable.h5"), "{code:?} {text}");
}

/// A model whose units are ignored, which is told on standard error.
const MODEL: &str = r#"<?xml version="1.0"?>
<sbml xmlns="http://www.sbml.org/sbml/level3/version1/core" level="3" version="1">
<model><listOfUnitDefinitions><unitDefinition id="minute"><listOfUnits>
<unit kind="second" exponent="1" scale="0" multiplier="60"/></listOfUnits></unitDefinition></listOfUnitDefinitions>
<listOfParameters><parameter id="x" value="1" constant="false"/></listOfParameters>
<listOfRules><rateRule variable="x"><math xmlns="http://www.w3.org/1998/Math/MathML"><ci> x </ci></math></rateRule>
</listOfRules></model></sbml>
"#;

#[test]
fn nothing_stops_where_nobody_listens_to_standard_error() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bad.toml"), TEXT.replace("drag", "darg")).unwrap();
    std::fs::write(folder.path().join("model.xml"), MODEL).unwrap();
    let (code, told) = program(&["eml", "solve", "model.xml", "--until", "1"], folder.path());
    assert!(code == Some(0) && told.contains("note: "), "{told}");
    for (expected, arguments) in [(0, &["eml", "solve", "model.xml", "--until", "1"][..]), (2, &["run", "bad.toml"])] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let mut child = Command::new(env!("CARGO_BIN_EXE_pseudopod"));
        let child = child.args(arguments).current_dir(folder.path()).stdout(Stdio::null()).stderr(writer);
        assert_eq!(child.status().unwrap().code(), Some(expected));
    }
}
