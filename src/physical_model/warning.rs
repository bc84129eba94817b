//! Where a document breaks the rules, and what was made of it.

use std::fmt;

/// So many warnings are kept of a document; the others are counted.
const MOST_WARNINGS: usize = 50;

/// A rule that a document breaks without leaving a doubt about what it means.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// The line, counted from 1.
    pub line: usize,
    /// What was found.
    pub found: String,
    /// What was done about it.
    pub done: &'static str,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "line {}: {}; {}", self.line, self.found, self.done)
    }
}

/// The warnings about a document.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Warnings {
    /// The first ones, in the order in which they were found.
    pub list: Vec<Warning>,
    /// How many more there were.
    pub left_out: usize,
}

impl Warnings {
    /// Adds a warning, or counts it where there are many.
    pub(super) fn add(&mut self, warning: impl FnOnce() -> Warning) {
        if self.list.len() < MOST_WARNINGS {
            self.list.push(warning());
        } else {
            self.left_out += 1;
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }
}
