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

    /// A sentence that tells the first ones of a file; none where there is nothing to tell.
    pub fn in_a_sentence(&self, file: &str) -> Option<String> {
        const TOLD: usize = 3;
        let more = (self.list.len() + self.left_out).saturating_sub(TOLD);
        let mut parts: Vec<String> = self.list.iter().take(TOLD).map(ToString::to_string).collect();
        if more > 0 {
            parts.push(format!("and so {more} times more"));
        }
        (!parts.is_empty()).then(|| format!("{file} breaks the rules: {}", parts.join("; ")))
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }
}
