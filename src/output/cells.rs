//! Which cells there are in a frame, and what their types are.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::Layout;

/// A type of cells: all of one type have the same mesh.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CellType {
    /// Its name.
    pub name: String,
    /// Atoms of a cell.
    pub atoms: u32,
    /// Facets of a cell, outward, by the numbers of its own atoms.
    pub facets: Vec<[u32; 3]>,
    /// Internal links of a cell, drawn as lines, by the numbers of its own atoms.
    pub links: Vec<[u32; 2]>,
}

/// A cell of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Cell {
    /// Its id, which no other cell of the run ever has.
    pub id: u64,
    /// Index into [`Layout::types`].
    pub kind: u32,
    /// The cell that it was born from.
    pub parent: Option<u64>,
}

/// A cell that was recorded, and when.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Known {
    /// The cell.
    pub cell: Cell,
    /// From its first frame to the one after its last: it is there in all of them.
    pub frames: Range<usize>,
}

impl Layout {
    /// The atoms of each of these cells in the arrays of a frame that has them in this order.
    ///
    /// # Panics
    /// If a cell is of no type of the layout.
    pub fn atoms_of<'a>(&'a self, cells: &'a [Cell]) -> impl Iterator<Item = Range<usize>> + 'a {
        cells.iter().scan(0, |end, cell| {
            let first = *end;
            *end += self.types[cell.kind as usize].atoms as usize;
            Some(first..*end)
        })
    }

    /// Number of atoms of these cells.
    ///
    /// # Panics
    /// As [`Layout::atoms_of`].
    pub fn atoms(&self, cells: &[Cell]) -> usize {
        cells.iter().map(|cell| self.types[cell.kind as usize].atoms as usize).sum()
    }

    /// Facets of these cells by the numbers of the atoms of a frame that has them in this order.
    ///
    /// # Panics
    /// As [`Layout::atoms_of`].
    pub fn facets_of<'a>(&'a self, cells: &'a [Cell]) -> impl Iterator<Item = [u32; 3]> + 'a {
        self.atoms_of(cells).zip(cells).flat_map(|(atoms, cell)| {
            let facets = self.types[cell.kind as usize].facets.iter();
            facets.map(move |facet| facet.map(|atom| atom + atoms.start as u32))
        })
    }

    /// Names of the types.
    pub fn type_names(&self) -> Vec<String> {
        self.types.iter().map(|kind| kind.name.clone()).collect()
    }
}
