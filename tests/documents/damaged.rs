//! Damaged documents, models, meshes and tables: every reader ends soon, with what is wrong and where, and never in a panic.
//!
//! Texts are damaged where their readers decide: words and numbers are swapped, doubled, left out or made extreme, lines repeated, ends
//! cut off. Which damage a text gets depends on its number alone, so that what is found is found again.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use pseudopod::analysis::claims;
use pseudopod::analysis::table::Table;
use pseudopod::analysis::tracks::read as tracks;
use pseudopod::equations;
use pseudopod::error::{Error, Paint, Source, render};
use pseudopod::experiment::Document;
use pseudopod::geometry::read_surface;

use crate::chance::Chance;

/// What stands in place of a number.
const NUMBERS: [&str; 14] = [
    "0",
    "-1",
    "1e308",
    "-1e308",
    "1e-320",
    "1e999",
    "nan",
    "inf",
    "99999999999999999999",
    "0.1",
    "1e9",
    "2147483648",
    "-0",
    "1e",
];
/// What stands in place of anything, or between.
const SIGNS: [&str; 24] = [
    "\"",
    "'",
    "\"\"\"",
    "[",
    "]",
    "[[",
    "{",
    "}",
    "<",
    ">",
    "</",
    "/>",
    "&",
    "&#x110000;",
    "]]>",
    "=",
    ",",
    "\0",
    "\u{7f}",
    "µ",
    "\u{1f9a0}",
    "\u{202e}",
    "\r",
    "\u{feff}",
];
/// Longest time for a text: minutes would be a way to stop a server, and seconds are a user's patience. Programs without optimisation are
/// given more.
const LONGEST: Duration = Duration::from_secs(if cfg!(debug_assertions) { 60 } else { 10 });

/// One of several.
fn one_of<'a>(choices: &[&'a str], chance: &mut Chance) -> &'a str {
    choices[chance.below(choices.len())]
}

/// Words, numbers, runs of blanks, and every other sign by itself.
fn parts(text: &str) -> Vec<&str> {
    let kind = |c: char| match c {
        c if c.is_alphanumeric() || matches!(c, '_' | '.') => 0,
        '\n' => 1,
        c if c.is_whitespace() => 2,
        _ => 3,
    };
    let mut found = Vec::new();
    let mut start = 0;
    let mut before = None;
    for (at, c) in text.char_indices() {
        if before.is_some_and(|before| before != kind(c) || before == 3) {
            found.push(&text[start..at]);
            start = at;
        }
        before = Some(kind(c));
    }
    found.push(&text[start..]);
    found
}

/// The text with one to four damages; words may come from `others`.
fn damaged(text: &str, others: &[&str], chance: &mut Chance) -> String {
    let mut all: Vec<&str> = parts(text);
    for _ in 0..=chance.below(4) {
        let at = chance.below(all.len());
        let span = at..(at + 1 + chance.below(12)).min(all.len());
        match chance.below(9) {
            0 => drop(all.drain(span)),
            1 => {
                let copy: Vec<&str> = all[span].to_vec();
                let times = [1, 2, 40][chance.below(3)];
                let more: Vec<&str> = std::iter::repeat_n(copy, times).flatten().collect();
                drop(all.splice(at..at, more));
            }
            2 => {
                let other = chance.below(all.len());
                all.swap(at, other);
            }
            3 | 4 => {
                let numbers: Vec<usize> =
                    (0..all.len()).filter(|i| all[*i].starts_with(|c: char| c.is_ascii_digit())).collect();
                if let Some(number) = numbers.get(chance.below(numbers.len())) {
                    all[*number] = one_of(&NUMBERS, chance);
                }
            }
            5 => all[at] = one_of(others, chance),
            6 => all[at] = one_of(&SIGNS, chance),
            7 => all.insert(at, one_of(&SIGNS, chance)),
            _ => all.truncate(at.max(1)),
        }
        if all.is_empty() {
            all.push("");
        }
    }
    all.concat()
}

/// What reads a kind of text.
type Reader = fn(&str, &Path) -> Result<(), Error>;

fn files(ending: &str, folders: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders: Vec<PathBuf> =
        folders.iter().map(|folder| Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).collect();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|found| found == ending) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Damages texts of a kind so many times and reads them.
fn read_damaged(kind: &str, corpus: &[PathBuf], times: u32, reader: Reader) {
    let texts: Vec<String> = corpus
        .iter()
        .filter_map(|path| std::fs::read_to_string(path).ok())
        .filter(|text| text.len() < 60_000)
        .collect();
    assert!(!texts.is_empty(), "no {kind} to damage");
    let words: Vec<&str> = texts.iter().flat_map(|text| parts(text)).filter(|part| part.len() > 1).collect();
    for number in 0..times {
        let mut chance = Chance::new(number, 1);
        let which = chance.below(texts.len());
        let text = damaged(&texts[which], &words, &mut chance);
        let began = Instant::now();
        let outcome = std::panic::catch_unwind(|| {
            if let Err(error) = reader(&text, &corpus[which]) {
                assert!(!render(&error, Paint::Plain).is_empty());
            }
        });
        let told = format!("{kind} {number}, made from {}", corpus[which].display());
        assert!(outcome.is_ok(), "{told}: it panics\n{text}");
        assert!(began.elapsed() < LONGEST, "{told}: it takes {:?}", began.elapsed());
    }
}

fn read_experiment(text: &str, path: &Path) -> Result<(), Error> {
    Document::parse("damaged.toml", text, path.parent().unwrap(), &[]).map(|_| ())
}

fn read_equations(text: &str, _: &Path) -> Result<(), Error> {
    equations::read(Arc::new(Source { name: "damaged".into(), text: text.to_owned() })).map(|_| ())
}

fn read_mesh(text: &str, path: &Path) -> Result<(), Error> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(path.file_name().unwrap());
    std::fs::write(&file, text).unwrap();
    read_surface(&file, 1.0).map(|_| ())
}

fn read_table(text: &str, _: &Path) -> Result<(), Error> {
    let as_tracks = tracks::parse("damaged.csv", text, &tracks::Options::default()).map(|_| ());
    let as_table = Table::parse("damaged.csv", text).map(|_| ());
    as_tracks.and(as_table)
}

fn read_claims(text: &str, _: &Path) -> Result<(), Error> {
    claims::parse("damaged.toml", text).map(|_| ())
}

/// All kinds, each so many times.
fn all(times: u32) {
    let experiments: Vec<PathBuf> = files("toml", &["experiments", "tests/messages", "tests/documents"]);
    let (claimed, experiments): (Vec<PathBuf>, Vec<PathBuf>) =
        experiments.into_iter().partition(|path| path.ends_with("expected.toml"));
    read_damaged("claims", &claimed, times / 4, read_claims);
    read_damaged("experiment", &experiments, times, read_experiment);
    read_damaged("EML", &files("eml", &["eml", "experiments", "tests/messages"]), times, read_equations);
    read_damaged("SBML", &files("xml", &["tests/messages"]), times, read_equations);
    for ending in ["obj", "ply", "stl"] {
        read_damaged(ending, &files(ending, &["tests/messages/meshes"]), times / 4, read_mesh);
    }
    read_damaged("table", &files("csv", &["experiments", "tests"]), times / 2, read_table);
}

#[test]
fn readers_bear_damaged_texts() {
    all(400);
}

#[test]
#[ignore = "slow: reads 450 000 damaged texts (6 min)"]
fn readers_bear_many_damaged_texts() {
    all(100_000);
}
