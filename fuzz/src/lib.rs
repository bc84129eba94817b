//! What the fuzz targets share: how inputs of each kind are changed, what they are made from, and how they are read.
//!
//! A target is a reader of the program and a mutator that knows what it reads. Texts are changed by line, key, element, cell and
//! word; what the program itself writes (results, logs, checkpoints) by a list of edits of files that a small run makes when the fuzzer
//! starts, with checksums that are right again afterwards. CONTRIBUTING.md says how to run them.

pub mod apart;
pub mod base;
pub mod commands;
pub mod container;
pub mod edits;
pub mod equations;
pub mod folder;
pub mod memory;
pub mod mesh;
pub mod mutate;
pub mod shipped;
pub mod sums;
pub mod table;
pub mod toml;
pub mod xml;

#[path = "../../tests/support/chance.rs"]
pub mod chance;
#[path = "../../tests/support/damage.rs"]
pub mod damage;

/// Lets the library work with one thread: what is slow is slow there, and forked processes have no other.
pub fn one_thread() {
    // SAFETY: nothing else runs yet.
    unsafe { std::env::set_var("RAYON_NUM_THREADS", "1") };
}
