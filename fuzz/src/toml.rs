//! Changes of experiment documents: tables, keys, values with their units.

use std::ops::Range;

use crate::chance::Chance;
use crate::damage::{NUMBERS, one_of};
use crate::mutate::times;
use crate::shipped::Shipped;

/// Units of documents, and words that look like some.
const UNITS: [&str; 20] = [
    "um", "nm", "m", "um^2", "um^3", "s", "ms", "min", "h", "pN", "nN", "Pa", "pN/um", "uN/m", "pN s/um", "um/min",
    "um^2/s", "deg", "1/s", "furlong",
];

/// One change of a document.
pub fn change(text: &str, shipped: &Shipped, chance: &mut Chance) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    lines.push(String::new());
    let at = chance.below(lines.len());
    match chance.below(9) {
        0 => drop(lines.drain(table_around(&lines, at))),
        1 => {
            let copy = lines[table_around(&lines, at)].to_vec();
            lines.extend(std::iter::repeat_n(copy, times(chance).min(40)).flatten());
        }
        2 => {
            let others: Vec<String> = shipped.text(chance).lines().map(str::to_owned).collect();
            if !others.is_empty() {
                let table = table_around(&others, chance.below(others.len()));
                lines.extend_from_slice(&others[table]);
            }
        }
        3 => {
            let line = lines.remove(at);
            lines.insert(chance.below(lines.len() + 1), line);
        }
        4 => {
            if let (Some(one), Some(other)) = (keyed(&lines, chance), keyed(&lines, chance)) {
                let (first, second) = (value(&lines[one]).to_owned(), value(&lines[other]).to_owned());
                set(&mut lines[one], &second);
                set(&mut lines[other], &first);
            }
        }
        5 => {
            if let Some(line) = keyed(&lines, chance) {
                let found = value_elsewhere(&lines[line], shipped.text(chance), chance);
                set(&mut lines[line], &found);
            }
        }
        6 => {
            if let Some(line) = keyed(&lines, chance) {
                let quantity = format!("\"{} {}\"", one_of(&NUMBERS, chance), one_of(&UNITS, chance));
                set(&mut lines[line], &quantity);
            }
        }
        7 => {
            if let Some(line) = keyed(&lines, chance) {
                let list = vec![value(&lines[line]); times(chance)].join(", ");
                set(&mut lines[line], &format!("[{list}]"));
            }
        }
        _ => {
            if let Some(line) = keyed(&lines, chance) {
                let (depth, [open, close]) = (times(chance), [["[", "]"], ["{ a = ", " }"]][chance.below(2)]);
                let nested = format!("{}{}{}", open.repeat(depth), value(&lines[line]), close.repeat(depth));
                set(&mut lines[line], &nested);
            }
        }
    }
    lines.join("\n")
}

/// The lines of the table that a line stands in, with its head.
fn table_around(lines: &[String], line: usize) -> Range<usize> {
    let is_head = |line: &String| line.trim_start().starts_with('[');
    let start = lines[..=line].iter().rposition(is_head).unwrap_or(0);
    let end = lines[line + 1..].iter().position(is_head).map_or(lines.len(), |after| line + 1 + after);
    start..end
}

/// A line that gives a key a value.
fn keyed(lines: &[String], chance: &mut Chance) -> Option<usize> {
    let all: Vec<usize> = (0..lines.len()).filter(|line| lines[*line].contains('=')).collect();
    all.get(chance.below(all.len())).copied()
}

fn value(line: &str) -> &str {
    line.split_once('=').map_or("", |(_, value)| value.trim())
}

fn set(line: &mut String, value: &str) {
    let key = line.split_once('=').map_or("", |(key, _)| key).to_owned();
    *line = format!("{key}= {value}");
}

/// The value of a key of the same name in another document, or of any.
fn value_elsewhere(line: &str, other: &str, chance: &mut Chance) -> String {
    let key = |line: &str| line.split_once('=').map(|(key, _)| key.trim().to_owned());
    let all: Vec<&str> = other.lines().filter(|line| line.contains('=')).collect();
    let same = all.iter().find(|found| key(found) == key(line)).copied();
    same.or_else(|| all.get(chance.below(all.len())).copied()).map(value).unwrap_or_default().to_owned()
}
