//! Changes of meshes: lines of atoms and facets, counts, and the numbers of binary files.

use std::sync::OnceLock;

use libfuzzer_sys::fuzzer_mutate;
use pseudopod::geometry::{SurfaceRules, read_checked_surface};

use crate::chance::Chance;
use crate::commands::told;
use crate::damage::one_of;
use crate::mutate::{put, times};
use crate::shipped::Shipped;

/// Numbers where atoms and facets are counted from 0 or 1, from the end, or not at all.
const NUMBERS: [&str; 14] = [
    "0",
    "1",
    "2",
    "3",
    "-1",
    "-2",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "1e30",
    "-1e-30",
    "nan",
    "18446744073709551616",
];

/// Floats and counts at their ends.
const EXTREMES: [u32; 10] =
    [0, 1, 2, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff, 0x7f80_0000, 0x7fc0_0000, 0x7f7f_ffff, 0x0000_8000];

/// One change of a mesh in a text.
pub fn change(text: &str, shipped: &Shipped, chance: &mut Chance) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    if lines.is_empty() {
        return shipped.text(chance).to_owned();
    }
    let (line, other) = (chance.below(lines.len()), chance.below(lines.len()));
    match chance.below(6) {
        0 => drop(lines.remove(line)),
        1 => {
            let copy = lines[line].clone();
            drop(lines.splice(other..other, std::iter::repeat_n(copy, times(chance))));
        }
        2 => lines.swap(line, other),
        3 => {
            let mut words: Vec<&str> = lines[line].split(' ').collect();
            let word = chance.below(words.len());
            words[word] = one_of(&NUMBERS, chance);
            lines[line] = words.join(" ");
        }
        4 => {
            let mut words: Vec<&str> = lines[line].split(' ').collect();
            let word = words[chance.below(words.len())];
            words.extend(std::iter::repeat_n(word, times(chance)));
            lines[line] = words.join(" ");
        }
        _ => {
            let others: Vec<&str> = shipped.text(chance).lines().collect();
            lines.extend(others.get(chance.below(others.len())).map(|line| (*line).to_owned()));
        }
    }
    lines.join("\n")
}

/// Changes the bytes of a binary mesh, after its head: numbers of four bytes, records, the end.
pub fn change_binary(bytes: &mut Vec<u8>, chance: &mut Chance) {
    let body = body_of(bytes);
    let at = body + 4 * chance.below((bytes.len() - body) / 4);
    match chance.below(5) {
        0 => bytes.truncate(at),
        // The number of facets stands first.
        1 => write(bytes, body, EXTREMES[chance.below(EXTREMES.len())]),
        2 => write(bytes, at, EXTREMES[chance.below(EXTREMES.len())]),
        3 => {
            let copy = bytes[at..(at + 50).min(bytes.len())].to_vec();
            bytes.extend(std::iter::repeat_n(copy, times(chance)).flatten());
        }
        _ => write(bytes, at, chance.below(64) as u32),
    }
}

/// Where the numbers of a binary mesh begin: behind the head of a PLY file, or after the 80 bytes of an STL file.
fn body_of(bytes: &[u8]) -> usize {
    const END: &[u8] = b"end_header\n";
    let end = bytes.windows(END.len()).position(|window| window == END);
    end.map_or(80, |at| at + END.len()).min(bytes.len())
}

fn write(bytes: &mut [u8], at: usize, number: u32) {
    if let Some(four) = bytes.get_mut(at..at + 4) {
        four.copy_from_slice(&number.to_le_bytes());
    }
}

/// Reads a mesh file of this name and checks it as the surface of a cell.
pub fn read(name: &str, bytes: &[u8]) {
    let path = crate::folder::write(name, bytes);
    if let Err(error) = read_checked_surface(&path, 1.0, &SurfaceRules::CELL) {
        told(&error);
    }
}

/// Changes a mesh of a format, which is its ending, as text or as bytes.
pub fn mutate(ending: &str, data: &mut [u8], size: usize, most: usize, seed: u32) -> usize {
    static SHIPPED: OnceLock<Shipped> = OnceLock::new();
    let shipped = SHIPPED.get_or_init(|| Shipped::read(ending, &["tests/messages/meshes", "fuzz/corpus"]));
    if size == 0 || std::str::from_utf8(&data[..size]).is_ok() {
        return crate::mutate::mutate(data, size, most, seed, shipped, change);
    }
    let mut chance = Chance::new(seed, crate::mutate::PURPOSE);
    if chance.below(4) == 0 {
        return fuzzer_mutate(data, size, most);
    }
    let mut bytes = data[..size].to_vec();
    change_binary(&mut bytes, &mut chance);
    put(&bytes, data, most)
}
