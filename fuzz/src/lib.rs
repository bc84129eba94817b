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

/// Lets the library work in this thread: what is slow is slow there, no time is lost with waking others up, and forked processes have no
/// other.
///
/// # Panics
/// If the library has begun to work already.
pub fn one_thread() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    pool.build_global().expect("nothing else runs yet");
}
