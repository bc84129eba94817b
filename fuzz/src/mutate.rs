//! The mutator of texts.

use libfuzzer_sys::fuzzer_mutate;

use crate::chance::Chance;
use crate::damage::damaged;
use crate::shipped::Shipped;

/// How texts of a kind are changed where their structure is known.
pub type Change = fn(&str, &Shipped, &mut Chance) -> String;

/// Which stream of random numbers the mutators draw from.
pub const PURPOSE: u32 = 4;

/// Changes the text in `data[..size]`; how long it is then. A quarter of the changes are those of libFuzzer, which knows what the
/// program compares; the others are damage to words, and changes of the structure. Without a text it begins with one that is shipped.
pub fn mutate(data: &mut [u8], size: usize, most: usize, seed: u32, shipped: &Shipped, change: Change) -> usize {
    let mut chance = Chance::new(seed, PURPOSE);
    if size == 0 || chance.below(500) == 0 {
        return put(shipped.text(&mut chance).as_bytes(), data, most);
    }
    if chance.below(4) == 0 {
        return fuzzer_mutate(data, size, most);
    }
    let text = String::from_utf8_lossy(&data[..size]);
    let changed = match chance.below(2) {
        0 => damaged(&text, shipped.words(), &mut chance),
        _ => change(&text, shipped, &mut chance),
    };
    put(changed.as_bytes(), data, most)
}

/// Writes what was made into the buffer of libFuzzer, as much as it takes.
pub fn put(made: &[u8], data: &mut [u8], most: usize) -> usize {
    let size = made.len().min(most).min(data.len());
    data[..size].copy_from_slice(&made[..size]);
    size
}

/// How often something is repeated: once mostly, seldom so often that lists, tables and nesting get long.
pub fn times(chance: &mut Chance) -> usize {
    [1, 1, 2, 3, 40, 1500][chance.below(6)]
}
