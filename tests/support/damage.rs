//! Damage that readers of texts have to bear, done where they decide: words and numbers are swapped, doubled, left out or made
//! extreme, ends cut off. The tests use it, and so do the fuzzers (`fuzz/`).

use std::path::{Path, PathBuf};

use crate::chance::Chance;

/// What stands in place of a number.
pub const NUMBERS: [&str; 14] = [
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
pub const SIGNS: [&str; 24] = [
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

/// One of several.
pub fn one_of<'a>(choices: &[&'a str], chance: &mut Chance) -> &'a str {
    choices[chance.below(choices.len())]
}

/// Words, numbers, runs of blanks, and every other sign by itself.
pub fn parts(text: &str) -> Vec<&str> {
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
pub fn damaged(text: &str, others: &[&str], chance: &mut Chance) -> String {
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

/// The files of an ending in folders of the repository, in order.
pub fn files(root: &Path, ending: &str, folders: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders: Vec<PathBuf> = folders.iter().map(|folder| root.join(folder)).collect();
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
