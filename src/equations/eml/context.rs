//! Collects faults with their locations, so that a reader hears of all of them.
//!
//! A document and those that it includes are numbered through, byte by byte: a range of bytes tells its text, too.

use crate::equations::files::{Files, NamedFile};
use crate::error::words::meant;
use crate::error::{Error, Fault, Location, Source};
use std::collections::HashSet;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// The texts and the faults found so far.
pub(super) struct Context {
    /// The document, and behind it those that it includes.
    texts: Vec<Included>,
    /// Where the files are that these name.
    pub(super) files: Files,
    /// Elements and terms of sums that repetition has made.
    pub(super) repeated: usize,
    faults: Vec<Fault>,
    /// Faults beyond [`MOST_FAULTS`].
    untold: usize,
}

/// A text that is read.
struct Included {
    source: Arc<Source>,
    /// The number of its first byte.
    first: usize,
    /// The folder that its paths start from, seen from that of the document.
    folder: PathBuf,
    /// Where each line begins.
    lines: Vec<usize>,
}

/// The most faults that are told: nobody reads more, and each carries its line of the text.
const MOST_FAULTS: usize = 100;
/// The most words among which the one that was meant is looked for.
const MOST_KNOWN: usize = 5000;

impl Context {
    pub(super) fn new(source: Arc<Source>, files: Files) -> Self {
        let mut context = Self { texts: Vec::new(), files, repeated: 0, faults: Vec::new(), untold: 0 };
        context.add(source, PathBuf::new());
        context
    }

    /// Adds a text, whose paths start from a folder; returns the number of its first byte.
    pub(super) fn add(&mut self, source: Arc<Source>, folder: PathBuf) -> usize {
        // A text ends at a byte of its own, at which faults may stand.
        let first = self.texts.last().map_or(0, |last| last.first + last.source.text.len() + 1);
        let ends = source.text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        let lines = std::iter::once(0).chain(ends.map(|(at, _)| at + 1)).collect();
        self.texts.push(Included { source, first, folder, lines });
        first
    }

    /// The text that a byte stands in.
    fn text(&self, position: usize) -> &Included {
        &self.texts[self.texts.partition_point(|text| text.first <= position).max(1) - 1]
    }

    /// The text that a byte stands in, and the number of its first byte.
    pub(super) fn source(&self, position: usize) -> (&Arc<Source>, usize) {
        let text = self.text(position);
        (&text.source, text.first)
    }

    /// A path that stands at a byte, seen from the folder of the document.
    pub(super) fn path(&self, position: usize, written: &str) -> PathBuf {
        self.text(position).folder.join(written)
    }

    /// The documents that have been included.
    pub(super) fn included(&self) -> Vec<NamedFile> {
        let of = |text: &Included| NamedFile {
            path: PathBuf::from(&text.source.name),
            text: Some(text.source.text.clone()),
        };
        self.texts[1..].iter().map(of).collect()
    }

    /// How many bytes all texts have.
    pub(super) fn length(&self) -> usize {
        self.texts.iter().map(|text| text.source.text.len()).sum()
    }

    /// A location in the texts.
    pub(super) fn location(&self, at: Range<usize>, label: &str) -> Location {
        let text = self.text(at.start);
        let (source, start) = (text.source.clone(), at.start - text.first);
        Location { source, start, length: at.len(), label: label.to_owned() }
    }

    /// A fault: what was found, a few words beside the location, what to do.
    pub(super) fn fault(&mut self, at: Range<usize>, message: &str, label: &str, help: &str) {
        if self.faults.len() >= MOST_FAULTS {
            self.untold += 1;
            return;
        }
        let location = self.location(at, label);
        self.faults.push(Fault::new(message).at(location).help(help));
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

    /// A byte in words for one that reads a fault elsewhere: "line 3", or "line 3 of parts.eml" where that is another text.
    pub(super) fn line(&self, position: usize, seen_from: usize) -> String {
        let text = self.text(position);
        let line = text.lines.partition_point(|start| *start <= position - text.first);
        match text.first == self.text(seen_from).first {
            true => format!("line {line}"),
            false => format!("line {line} of {}", text.source.name),
        }
    }

    /// All faults in the order of the texts.
    pub(super) fn error(mut self) -> Error {
        // Those of other files, such as of tables, come last.
        let text = |location: &Location| self.texts.iter().position(|text| Arc::ptr_eq(&text.source, &location.source));
        let order = |location: &Location| (text(location).unwrap_or(usize::MAX), location.start);
        self.faults.sort_by_key(|fault| fault.location.as_ref().map_or((0, 0), order));
        // What is included twice has its faults once.
        let mut told = HashSet::new();
        self.faults.retain(|fault| {
            let at = fault.location.as_ref().map(|location| (location.source.name.clone(), location.start));
            at.is_none() || told.insert((at, fault.message.clone()))
        });
        if self.untold > 0 {
            let message = format!("{} more faults are not told", self.untold);
            self.faults.push(Fault::new(message).help("correct these first"));
        }
        Error::Input(self.faults)
    }
}
