//! What is counted and looked up while a document is read.

use std::collections::{HashMap, HashSet};

/// Atoms and cells so far.
#[derive(Default)]
pub(super) struct Seen {
    /// The indices of atoms, and the bytes where they stand.
    pub atoms: HashMap<u32, u32>,
    /// The indices of cells.
    pub cells: HashSet<i64>,
    /// Cells in all.
    pub count: u64,
}
