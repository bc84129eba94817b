//! What is noted while formulas are read: faults, and how many nodes were made.

use super::xml::{Node, Page};
use std::cell::Cell;

/// Most nodes of all expressions together, functions expanded.
const SIZE_LIMIT: usize = 4_000_000;

/// The notes on the formulas of one model.
pub struct Notes<'p, 'a> {
    page: &'p Page<'a>,
    size: Cell<usize>,
}

impl<'p, 'a> Notes<'p, 'a> {
    /// No note yet; faults go to the page.
    pub fn new(page: &'p Page<'a>) -> Self {
        Self { page, size: Cell::new(0) }
    }

    /// Notes a fault.
    pub fn fault<T>(&self, node: Node<'_>, found: impl Into<String>, help: impl Into<String>) -> Option<T> {
        self.page.fault(node, found, help);
        None
    }

    /// Notes that the formulas are too large.
    pub fn too_large<T>(&self, node: Node<'a>) -> Option<T> {
        let help = "write long sums with one <plus/> for all terms, and fewer functions within functions";
        self.fault(node, "the formulas are too large or nested too deeply when functions are expanded", help)
    }

    /// Takes from the nodes that may be made.
    pub fn take(&self, count: usize) -> bool {
        self.size.set(self.size.get().saturating_add(count));
        self.size.get() <= SIZE_LIMIT
    }
}
