//! Damaged results, logs and checkpoints: every command ends, with a message where it cannot go on, and never by a signal.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::chance::Chance;
use crate::killed_runs::{pseudopod, write_document};
use crate::turns::take_turn;

/// Damages some bytes: at the beginning, where HDF5 keeps what it knows of the file, more often than elsewhere.
fn damage(bytes: &mut Vec<u8>, chance: &mut Chance) {
    if chance.below(6) == 0 {
        bytes.truncate(chance.below(bytes.len()));
    }
    for _ in 0..[1, 1, 2, 4, 16][chance.below(5)] {
        let reach = [64, 4096, 40_000, bytes.len()][chance.below(4)].min(bytes.len());
        if reach > 0 {
            let at = chance.below(reach);
            bytes[at] = [0, 0xff, bytes[at] ^ (1 << chance.below(8)), chance.below(256) as u8][chance.below(4)];
        }
    }
}

/// How a command ends, within a time.
fn exit_of(mut command: Command, longest: Duration) -> Result<i32, String> {
    let began = Instant::now();
    let mut child = command.stderr(Stdio::null()).spawn().unwrap();
    while began.elapsed() < longest {
        if let Some(status) = child.try_wait().unwrap() {
            return status.code().ok_or_else(|| format!("it ended with {status}"));
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let _ = child.kill();
    child.wait().unwrap();
    Err("it did not end".into())
}

/// Damages what a killed run left, so many times, and lets commands read it.
fn damage_and_read(times: usize, seed: u32) {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    write_document(folder.path(), "100 min");
    let mut run = pseudopod(folder.path(), &["run", "cells.toml", "-o", "run.h5"]).spawn().unwrap();
    let path = |ending: &str| folder.path().join(format!("run.h5{ending}"));
    let began = Instant::now();
    while !path(".frames").exists() || std::fs::metadata(path(".frames")).unwrap().len() < 20_000 {
        assert!(began.elapsed() < Duration::from_secs(60), "the run records nothing");
        std::thread::sleep(Duration::from_millis(5));
    }
    run.kill().unwrap();
    run.wait().unwrap();
    let ends = ["", ".frames", ".checkpoint"];
    let whole = ends.map(|ending| std::fs::read(path(ending)).unwrap());
    let mut chance = Chance::new(seed, 3);
    for time in 0..times {
        let which = chance.below(3);
        for (number, ending) in ends.iter().enumerate() {
            let mut bytes = whole[number].clone();
            if number == which {
                damage(&mut bytes, &mut chance);
            }
            std::fs::write(path(ending), bytes).unwrap();
        }
        let commands: [&[&str]; 3] = [
            &["info", "--json", "run.h5"],
            &["export", "run.h5", "-o", "x.csv", "--force"],
            &["plot", "run.h5", "--force"],
        ];
        for arguments in commands {
            let exit = exit_of(program(folder.path(), arguments), Duration::from_secs(20));
            assert!(matches!(exit, Ok(0 | 2)), "{arguments:?}, seed {seed}, {time}th time, {}: {exit:?}", ends[which]);
        }
    }
}

fn program(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pseudopod"));
    command.args(arguments).current_dir(folder).stdout(Stdio::null());
    command
}

#[test]
fn commands_bear_damaged_results() {
    damage_and_read(20, 1);
}

#[test]
#[ignore = "slow: damages a result, its log and its checkpoint three thousand times (10 min)"]
fn commands_bear_results_damaged_in_many_ways() {
    damage_and_read(3000, 2);
}

#[cfg(target_os = "linux")]
#[test]
fn a_crash_of_hdf5_is_told_as_damage() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let shim = crate::shim::shim(folder.path());
    write_document(folder.path(), "1 s");
    assert!(pseudopod(folder.path(), &["run", "cells.toml", "-o", "run.h5"]).status().unwrap().success());
    let say = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pseudopod"));
        command.args(arguments).current_dir(folder.path()).env("LD_PRELOAD", &shim).env("PSEUDOPOD_TEST_CRASH", "1");
        let out = command.output().unwrap();
        let words = [out.stdout, out.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        (out.status.code(), words)
    };
    for arguments in [&["info", "run.h5"][..], &["export", "run.h5", "-o", "x.csv"], &["resume", "run.h5"]] {
        let (exit, [_, words]) = say(arguments);
        assert_eq!(exit, Some(2), "{arguments:?}: {words}");
        let told = "  × run.h5 is damaged: reading it crashed the HDF5 library\n  help: copy it again if it was copied; \
                    otherwise run the experiment again with --force\n\n1 fault\n";
        assert_eq!(words, told, "{arguments:?}");
    }
    let (exit, [object, _]) = say(&["info", "--json", "run.h5"]);
    assert_eq!(exit, Some(2));
    let object: serde_json::Value = serde_json::from_str(&object).expect("a JSON object whatever happens");
    assert_eq!((&object["command"], &object["ok"]), (&"info".into(), &false.into()));
}
