//! The texts that the repository ships: what fuzzing begins with, and where words, lines and elements are taken from.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use crate::chance::Chance;
use crate::damage::{files, parts};

/// The root of the repository.
pub static ROOT: LazyLock<&Path> =
    LazyLock::new(|| Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the folder stands in the repository"));

/// Longest text that is begun with: long ones are slow, and say the same again.
const LONGEST: usize = 30_000;

/// How documents ask for spheres that are finer than need be.
const FINE: [&str; 4] = ["level = 2", "level = 3", "level = 4", "level = 5"];

/// Texts of one kind.
pub struct Shipped {
    texts: Vec<&'static str>,
    words: Vec<&'static str>,
    /// The folders that the texts stand in, each once.
    pub folders: Vec<PathBuf>,
}

impl Shipped {
    /// The texts of an ending in these folders of the repository.
    ///
    /// # Panics
    /// If there are none.
    pub fn read(ending: &str, folders: &[&str]) -> Self {
        let found = files(&ROOT, ending, folders);
        let mut folders: Vec<PathBuf> = found.iter().filter_map(|path| Some(path.parent()?.to_path_buf())).collect();
        folders.dedup();
        let texts = found.iter().filter_map(|path| std::fs::read_to_string(path).ok());
        // Meshes are as coarse as they can be, so that what is said of them is soon worked out; `fuzz/run` does the same.
        let texts = texts.map(|text| FINE.iter().fold(text, |text, fine| text.replace(fine, "level = 1")));
        // They are needed until the fuzzer ends.
        let texts: Vec<&str> = texts.filter(|text| text.len() < LONGEST).map(|text| &*text.leak()).collect();
        assert!(!texts.is_empty(), "no {ending} in {folders:?}");
        let words = texts.iter().flat_map(|text| parts(text)).filter(|part| part.len() > 1).collect();
        Self { texts, words, folders }
    }

    /// One of the texts.
    pub fn text(&self, chance: &mut Chance) -> &'static str {
        self.texts[chance.below(self.texts.len())]
    }

    /// All words and numbers in them.
    pub fn words(&self) -> &[&'static str] {
        &self.words
    }
}
