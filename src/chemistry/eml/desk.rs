//! Collects faults with their places, so that a reader hears of all of them.

use crate::error::{Error, Fault, Place, Source};
use std::ops::Range;
use std::sync::Arc;

/// The source and the faults found so far.
pub(super) struct Desk {
    pub(super) source: Arc<Source>,
    faults: Vec<Fault>,
}

impl Desk {
    pub(super) fn new(source: Arc<Source>) -> Self {
        Self { source, faults: Vec::new() }
    }

    /// A place in the source.
    pub(super) fn place(&self, at: Range<usize>, label: &str) -> Place {
        Place { source: self.source.clone(), start: at.start, length: at.len(), label: label.to_owned() }
    }

    /// A fault: what was found, a few words beside the place, what to do.
    pub(super) fn fault(&mut self, at: Range<usize>, message: &str, label: &str, help: &str) {
        let place = self.place(at, label);
        self.faults.push(Fault::new(message).at(place).help(help));
    }

    /// A fault without a place.
    pub(super) fn lost(&mut self, message: impl Into<String>, help: &str) {
        self.faults.push(Fault::new(message).help(help));
    }

    pub(super) fn is_clean(&self) -> bool {
        self.faults.is_empty()
    }

    /// The line of a position, from 1.
    pub(super) fn line(&self, position: usize) -> usize {
        1 + self.source.text[..position].bytes().filter(|byte| *byte == b'\n').count()
    }

    /// All faults in the order of the text.
    pub(super) fn error(mut self) -> Error {
        self.faults.sort_by_key(|fault| fault.place.as_ref().map_or(0, |place| place.start));
        Error::Input(self.faults)
    }
}
