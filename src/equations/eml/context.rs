//! Collects faults with their locations, so that a reader hears of all of them.

use crate::equations::fault::at_location;
use crate::error::words::meant;
use crate::error::{Error, Fault, Location, Source};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The source and the faults found so far.
pub(super) struct Context {
    pub(super) source: Arc<Source>,
    /// The folder from which files that the document names are found, if it has one.
    pub(super) folder: Option<PathBuf>,
    faults: Vec<Fault>,
    /// Where each line begins.
    lines: Vec<usize>,
    /// Faults beyond [`MOST_FAULTS`].
    untold: usize,
}

/// The most faults that are told: nobody reads more, and each carries its line of the text.
const MOST_FAULTS: usize = 100;
/// The most words among which the one that was meant is looked for.
const MOST_KNOWN: usize = 5000;

impl Context {
    pub(super) fn new(source: Arc<Source>, folder: Option<&Path>) -> Self {
        let ends = source.text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        let lines = std::iter::once(0).chain(ends.map(|(at, _)| at + 1)).collect();
        Self { source, folder: folder.map(Path::to_owned), faults: Vec::new(), lines, untold: 0 }
    }

    /// A location in the source.
    pub(super) fn location(&self, at: Range<usize>, label: &str) -> Location {
        Location { source: self.source.clone(), start: at.start, length: at.len(), label: label.to_owned() }
    }

    /// A fault: what was found, a few words beside the location, what to do.
    pub(super) fn fault(&mut self, at: Range<usize>, message: &str, label: &str, help: &str) {
        if self.faults.len() >= MOST_FAULTS {
            self.untold += 1;
            return;
        }
        self.faults.push(at_location(&self.source, at, message.to_owned(), label, help));
    }

    /// A fault in another text.
    pub(super) fn fault_elsewhere(&mut self, fault: Fault) {
        self.faults.push(fault);
    }

    /// A fault without a location.
    pub(super) fn lost(&mut self, message: impl Into<String>, help: &str) {
        self.faults.push(Fault::new(message).help(help));
    }

    /// The word that was meant; not looked for once enough faults are told.
    pub(super) fn meant<'a>(&self, word: &str, known: impl Iterator<Item = &'a str>) -> Option<String> {
        if self.faults.len() >= MOST_FAULTS {
            return None;
        }
        meant(word, known.take(MOST_KNOWN)).map(str::to_owned)
    }

    pub(super) fn is_clean(&self) -> bool {
        self.faults.is_empty()
    }

    /// The line of a position, from 1.
    pub(super) fn line(&self, position: usize) -> usize {
        self.lines.partition_point(|start| *start <= position)
    }

    /// All faults in the order of the text.
    pub(super) fn error(mut self) -> Error {
        self.faults.sort_by_key(|fault| fault.location.as_ref().map_or(0, |location| location.start));
        if self.untold > 0 {
            let message = format!("{} more faults are not told", self.untold);
            self.faults.push(Fault::new(message).help("correct these first"));
        }
        Error::Input(self.faults)
    }
}
