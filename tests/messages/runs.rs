//! What the program says on the terminal when something goes wrong: transcripts of commands beside their inputs.
//!
//! Every `.txt` file of `tests/messages/runs`, `tests/messages/equations`, `tests/messages/tracks`, `tests/messages/sweeps` and `tests/messages/verify` is a transcript. It begins with a comment
//! (`# …`) that says what must hold; each line `$ …` is a command of the shell, run in a folder of its own that holds the
//! documents of its folder (`*.toml`, `*.eml`, `*.xml`, `*.csv`) and, for runs, the meshes of `tests/messages/meshes`; below it
//! stand what the command printed on standard output, then on standard error, and its exit status if that is not 0.

use crate::turns::take_turn;
use std::path::{Path, PathBuf};
use std::process::Command;

const RUNS: &str = "tests/messages/runs";
const EQUATIONS: &str = "tests/messages/equations";
const TRACKS: &str = "tests/messages/tracks";
const SWEEPS: &str = "tests/messages/sweeps";
const VERIFY: &str = "tests/messages/verify";

/// Files of a folder that end in `ending`, in order.
fn files(folder: &str, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| Path::new(folder).join(entry.unwrap().file_name()));
    let mut paths: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|end| end == ending)).collect();
    paths.sort();
    paths
}

/// A new folder with everything that the transcripts of a folder name.
fn stage(folder: &str) -> tempfile::TempDir {
    let stage = tempfile::tempdir().unwrap();
    let endings = if folder == RUNS { ["obj", "stl", "ply"].as_slice() } else { &[] };
    let meshes = endings.iter().flat_map(|ending| files("tests/messages/meshes", ending));
    let documents = ["toml", "eml", "xml", "csv", "json"].into_iter().flat_map(|ending| files(folder, ending));
    for path in documents.chain(meshes) {
        std::fs::copy(&path, stage.path().join(path.file_name().unwrap())).unwrap();
    }
    stage
}

/// Runs one command of the shell with the program on its path; what it printed and how it ended.
fn shell(command: &str, folder: &Path) -> String {
    let program = Path::new(env!("CARGO_BIN_EXE_pseudopod"));
    let path = std::env::join_paths(
        [program.parent().unwrap().to_path_buf()]
            .into_iter()
            .chain(std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default())),
    );
    let out = Command::new("bash")
        .args(["-c", command])
        .current_dir(folder)
        .env("PATH", path.unwrap())
        .env("LC_ALL", "C.UTF-8")
        .output()
        .unwrap();
    let mut text = String::from_utf8_lossy(&out.stdout).into_owned();
    text.push_str(&String::from_utf8_lossy(&out.stderr));
    if !out.status.success() {
        text.push_str(&match out.status.code() {
            Some(code) => format!("exit {code}\n"),
            None => format!("ended by {}\n", out.status),
        });
    }
    // The folder is another one every time.
    text.replace(&folder.display().to_string(), "FOLDER")
}

/// The transcript as it comes out now.
fn play(transcript: &str, folder: &str) -> String {
    let stage = stage(folder);
    let comment = transcript.lines().take_while(|line| !line.starts_with("$ "));
    let mut text: String = comment.map(|line| format!("{line}\n")).collect();
    for command in transcript.lines().filter_map(|line| line.strip_prefix("$ ")) {
        text.push_str(&format!("$ {command}\n{}", shell(command, stage.path())));
    }
    text
}

#[test]
fn every_transcript_comes_out_as_it_is_kept() {
    let _turn = take_turn();
    compare(RUNS, 9);
}

#[test]
fn every_transcript_of_equations_comes_out_as_it_is_kept() {
    let _turn = take_turn();
    compare(EQUATIONS, 5);
}

#[test]
fn every_transcript_of_tracks_comes_out_as_it_is_kept() {
    let _turn = take_turn();
    compare(TRACKS, 2);
}

#[test]
fn every_transcript_of_studies_comes_out_as_it_is_kept() {
    let _turn = take_turn();
    compare(SWEEPS, 3);
}

#[test]
fn every_transcript_of_claims_and_beginnings_comes_out_as_it_is_kept() {
    let _turn = take_turn();
    compare(VERIFY, 4);
}

/// Plays the transcripts of a folder, of which there are some at least.
fn compare(folder: &str, least: usize) {
    let transcripts = files(folder, "txt");
    assert!(transcripts.len() >= least, "transcripts are missing: {transcripts:?}");
    let mut differences = Vec::new();
    // One after the other: a program started while another one is would inherit its files and their locks.
    for path in transcripts {
        let kept = std::fs::read_to_string(&path).unwrap();
        let said = play(&kept, folder);
        if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
            std::fs::write(&path, &said).unwrap();
        } else if said != kept {
            let unlike = said.lines().zip(kept.lines()).position(|(a, b)| a != b).unwrap_or(0) + 1;
            differences.push(format!("{}, from line {unlike}:\n{said}", path.display()));
        }
    }
    assert!(differences.is_empty(), "transcripts that changed:\n\n{}", differences.join("\n\n"));
}

#[test]
fn every_refusal_says_what_to_do_and_ends_as_promised() {
    let _turn = take_turn();
    for path in [RUNS, EQUATIONS, TRACKS, SWEEPS, VERIFY].into_iter().flat_map(|folder| files(folder, "txt")) {
        let text = std::fs::read_to_string(&path).unwrap();
        for part in text.split("\n$ ").skip(1).filter(|part| part.starts_with("pseudopod ")) {
            let Some((_, code)) = part.trim_end().rsplit_once("exit ") else { continue };
            // In a chain of commands the code may be that of another program.
            if part.lines().next().is_some_and(|command| command.contains(" && ") || command.contains(" | ")) {
                continue;
            }
            let part_of = format!("{}: {part}", path.display());
            assert!(["1", "2", "3", "130"].contains(&code), "{part_of}");
            let helps = part.contains("help: ") || part.contains("\"help\": ") || part.contains("--help");
            // Words that went to a file are shown by the next command of the transcript.
            assert!(helps || part.contains("2> words"), "{part_of}");
            assert!(!part.contains("panicked") && !part.contains("RUST_BACKTRACE"), "{part_of}");
        }
    }
}

/// The page of the book on equations with what the program prints now below each command of its `text` blocks.
fn page_as_played(page: &str) -> String {
    let stage = stage(EQUATIONS);
    let document =
        page.split("```xml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("the page's document");
    std::fs::write(stage.path().join("decay.eml"), document).unwrap();
    let mut parts = page.split("```text\n");
    let mut played = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (block, rest) = part.split_once("```").expect("the end of a block");
        played.push_str("```text\n");
        for command in block.lines().filter_map(|line| line.strip_prefix("$ ")) {
            played.push_str(&format!("$ {command}\n{}", shell(command, stage.path())));
        }
        played.push_str("```");
        played.push_str(rest);
    }
    played
}

#[test]
fn the_book_shows_what_the_program_prints_of_equations() {
    let _turn = take_turn();
    let path = "docs/src/howto_equations.md";
    let kept = std::fs::read_to_string(path).unwrap();
    let played = page_as_played(&kept);
    if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
        std::fs::write(path, played).unwrap();
    } else {
        assert_eq!(played, kept, "{path} shows something else");
    }
}
