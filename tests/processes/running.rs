//! A result while its run goes on: everybody reads it, nobody else writes it.

use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use pseudopod::output::ResultFile;

use crate::killed_runs::{pseudopod, write_document};
use crate::turns::take_turn;

/// A run that has recorded a frame and is far from its end.
fn begun(folder: &Path) -> Child {
    write_document(folder, "100 min");
    let mut run = pseudopod(folder, &["run", "cells.toml", "-o", "run.h5"]);
    let mut child = run.stderr(Stdio::piped()).spawn().unwrap();
    let began = Instant::now();
    while ResultFile::open(&folder.join("run.h5")).is_err() {
        assert!(child.try_wait().unwrap().is_none(), "the run ends before a frame");
        assert!(began.elapsed() < Duration::from_secs(60), "the run records nothing");
        std::thread::sleep(Duration::from_millis(20));
    }
    child
}

fn program(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pseudopod")).args(arguments).current_dir(folder).output().unwrap()
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// Stops a run as Ctrl-C does; its exit code.
fn interrupted(mut run: Child) -> Option<i32> {
    assert!(Command::new("sh").args(["-c", &format!("kill -INT {}", run.id())]).status().unwrap().success());
    run.wait().unwrap().code()
}

#[cfg(unix)]
#[test]
fn a_result_is_read_while_it_is_written_and_written_by_one_alone() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let run = begun(folder.path());
    let info = program(folder.path(), &["info", "run.h5"]);
    assert!(info.status.success() && words(&info).contains("being run"), "{}", words(&info));
    let export = program(folder.path(), &["export", "run.h5", "-o", "table.csv"]);
    assert!(export.status.success(), "{}", words(&export));

    let again = program(folder.path(), &["run", "cells.toml", "-o", "run.h5", "--force", "--no-pictures"]);
    assert_eq!(again.status.code(), Some(2), "{}", words(&again));
    insta::assert_snapshot!(words(&again), @r"
      × run.h5 is being written by a running simulation
      help: wait until it has ended, or stop it with Ctrl-C: it can be resumed

    1 fault
    ");
    let resume = program(folder.path(), &["resume", "run.h5", "--no-pictures"]);
    assert_eq!(resume.status.code(), Some(2), "{}", words(&resume));

    assert_eq!(interrupted(run), Some(130));
    let info = program(folder.path(), &["info", "run.h5"]);
    assert!(words(&info).contains("interrupted"), "{}", words(&info));
    let names: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(!names.iter().any(|name| name == "run.h5.frames" || name == "run.h5.new"), "{names:?}");
}

#[cfg(unix)]
#[test]
fn a_result_that_is_removed_while_it_is_written_is_told_as_such() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let run = begun(folder.path());
    std::fs::remove_file(folder.path().join("run.h5")).unwrap();
    let ended = run.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(1));
    insta::assert_snapshot!(words(&ended), @r"
    × run.h5 is gone: it was removed or moved while it was being written
    help: put it back; frames that it does not hold are in the file beside it that ends in .frames; then go on
          with: pseudopod resume run.h5
    ");
    assert!(folder.path().join("run.h5.checkpoint").exists() && folder.path().join("run.h5.frames").exists());
}

#[test]
fn nothing_is_written_onto_what_is_read_and_nothing_is_replaced_unasked() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    write_document(folder.path(), "1 s");
    let say = |arguments: &[&str]| {
        let output = program(folder.path(), arguments);
        format!("{}exit {}\n", words(&output), output.status.code().unwrap_or(-1))
    };
    let before = std::fs::read(folder.path().join("cells.toml")).unwrap();
    insta::assert_snapshot!(say(&["run", "cells.toml", "-o", "cells.toml", "--force"]), @r"
      × cells.toml is what the run reads: its result cannot be written there
      help: name another file with -o

    1 fault
    exit 2
    ");
    insta::assert_snapshot!(say(&["run", "cells.toml", "-o", "clock.eml", "--force"]), @r"
      × ./clock.eml is what the run reads: its result cannot be written there
      help: name another file with -o

    1 fault
    exit 2
    ");
    assert_eq!(std::fs::read(folder.path().join("cells.toml")).unwrap(), before);
    std::fs::write(folder.path().join("run.png"), b"somebody's picture").unwrap();
    insta::assert_snapshot!(say(&["run", "cells.toml", "-o", "run.h5"]), @r"
      × run.png exists
      help: use --force to replace it, or move it away

    1 fault
    exit 2
    ");
    assert!(!folder.path().join("run.h5").exists());
    assert!(
        pseudopod(folder.path(), &["run", "cells.toml", "-o", "run.h5"])
            .stdin(Stdio::null())
            .status()
            .unwrap()
            .success()
    );
    std::fs::rename(folder.path().join("run.h5"), folder.path().join("run.png")).unwrap();
    insta::assert_snapshot!(say(&["render", "run.png", "-o", "run.png", "--force"]), @r"
      × run.png is named twice
      help: give each file that is read or written a name of its own

    1 fault
    exit 2
    ");
    std::fs::rename(folder.path().join("run.png"), folder.path().join("run.csv")).unwrap();
    insta::assert_snapshot!(say(&["export", "run.csv", "-o", "./run.csv", "--force"]), @r"
      × ./run.csv is named twice
      help: give each file that is read or written a name of its own

    1 fault
    exit 2
    ");
    assert!(ResultFile::open(&folder.path().join("run.csv")).is_ok());
}

#[cfg(unix)]
#[test]
fn pipes_are_not_waited_for() {
    let folder = tempfile::tempdir().unwrap();
    assert!(Command::new("mkfifo").arg(folder.path().join("pipe.toml")).status().unwrap().success());
    let said = program(folder.path(), &["check", "pipe.toml"]);
    assert_eq!(said.status.code(), Some(2));
    insta::assert_snapshot!(words(&said), @r"
      × pipe.toml cannot be read: it is a pipe or a device, and a file was expected
      help: save the document to a file first

    1 fault
    ");
    std::fs::rename(folder.path().join("pipe.toml"), folder.path().join("pipe.h5")).unwrap();
    let said = program(folder.path(), &["info", "pipe.h5"]);
    assert_eq!(said.status.code(), Some(2), "{}", words(&said));
}
