//! Experiment documents: read, checked, compiled and begun, as `pseudopod check` and the start of `pseudopod run` do. The same texts are read as
//! studies and as claims, which are documents of their own.
#![no_main]

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use libfuzzer_sys::{Corpus, fuzz_mutator, fuzz_target};
use pseudopod::analysis::claims;
use pseudopod::experiment::{Document, Size};
use pseudopod::simulation::{Simulation, SimulationError};
use pseudopod::study::{Design, StudyDocument, points};
use pseudopod_fuzz::commands::told;
use pseudopod_fuzz::mutate::mutate;
use pseudopod_fuzz::shipped::{ROOT, Shipped};
use pseudopod_fuzz::toml::change;

static SHIPPED: LazyLock<Shipped> =
    LazyLock::new(|| Shipped::read("toml", &["experiments", "tests/messages", "tests/documents"]));

/// Memory that an experiment may ask for: more is refused before anything is made.
const MEMORY: u64 = 20_000_000;
/// Larger experiments are good, and take their time: to work out the stiffness of a fine mesh, and to look whether many cells overlap.
const MOST_ATOMS_OF_A_MESH: f64 = 64.0;
const MOST_ATOMS: f64 = 1_000.0;

/// The shipped folder with the most of the files that a text names, so that meshes, tables and equations are found.
fn folder_of(text: &str) -> &'static Path {
    let names: Vec<&str> = text.split('"').skip(1).step_by(2).filter(|name| name.contains('.')).take(20).collect();
    let there = |folder: &&PathBuf| names.iter().filter(|name| folder.join(name).is_file()).count();
    SHIPPED.folders.iter().max_by_key(there).map_or(&ROOT, PathBuf::as_path)
}

/// Points at random of a study that are worked out: more take their time.
const MOST_POINTS: u32 = 1_000;

/// Reads a text as a study, works out its points, and reads it as claims.
fn read_others(text: &str) {
    let read = StudyDocument::parse("fuzzed.toml", text, &ROOT).and_then(|study| match study.study.design {
        Design::LatinHypercube { number } | Design::Sobol { number } | Design::Saltelli { number }
            if number > MOST_POINTS =>
        {
            Ok(())
        }
        _ => points(&study).map(drop),
    });
    if let Err(error) = read {
        told(&error);
    }
    if let Err(error) = claims::parse("fuzzed.toml", text) {
        told(&error);
    }
}

fuzz_target!(init: pseudopod_fuzz::one_thread(), |data: &[u8]| -> Corpus {
    let Ok(text) = std::str::from_utf8(data) else { return Corpus::Reject };
    read_others(text);
    let mut document = match Document::parse("fuzzed.toml", text, folder_of(text), &[]) {
        Ok(document) => document,
        Err(error) => {
            told(&error);
            return Corpus::Keep;
        }
    };
    document.memory = Some(MEMORY);
    let size = Size::of_cells(&document);
    if size.finest > MOST_ATOMS_OF_A_MESH || size.atoms > MOST_ATOMS && size.memory < MEMORY as f64 {
        return Corpus::Reject;
    }
    match Simulation::from_document(&document) {
        Err(SimulationError::Input(error)) => told(&error),
        Err(error) => assert!(!error.to_string().is_empty()),
        Ok(_) => {}
    }
    Corpus::Keep
});

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, &SHIPPED, change)
});
