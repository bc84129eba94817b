//! Where the substances of membranes are: part of the state of a run, and so of a checkpoint.

use serde::{Deserialize, Serialize};

use crate::elementary::go_back;

/// What is on the surfaces of all cells with a system.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MembraneState {
    /// One entry for each kind that has the system, in the order of its members.
    pub kinds: Vec<MembraneCells>,
}

/// The surfaces of the cells of a kind, in blocks of lanes. Lanes beyond the last cell hold zeros.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MembraneCells {
    pub(super) lanes: usize,
    pub(super) atoms: usize,
    pub(super) variables: usize,
    pub(super) cells: usize,
    /// Densities: `[block][variable][atom][lane]`.
    pub(super) values: Vec<f64>,
    /// What is set of atoms from outside, in its unit: `[block][number][atom][lane]`.
    pub(super) given: Vec<f64>,
    /// What each of these is until it is set.
    pub(super) defaults: Vec<f64>,
    /// The areas of the atoms that these belong to, µm²: `[block][atom][lane]`; 0 where a cell has not started.
    pub(super) areas: Vec<f64>,
    /// The volumes of the cells that the pools belong to, µm³: `[block][lane]`.
    pub(super) volumes: Vec<f64>,
    /// The step that each cell tries next, in the document's unit of time; 0 where none is known.
    pub(super) steps: Vec<f64>,
}

impl MembraneCells {
    /// So many cells that have not started; `defaults` are what is set of atoms from outside until it is.
    pub fn new(lanes: usize, atoms: usize, variables: usize, cells: usize, defaults: Vec<f64>) -> Self {
        let mut new = Self { lanes, atoms, variables, cells, defaults, ..Self::default() };
        new.suit_blocks();
        (0..cells).for_each(|cell| new.reset_given(cell));
        new
    }

    /// Moves densities, what is given and the areas that they belong to back towards those of before: all the way where the share is 0, and
    /// not at all where it is 1.
    pub(crate) fn go_back_to(&mut self, before: &Self, share: f64) {
        let pairs = [(&mut self.values, &before.values), (&mut self.given, &before.given)];
        let shape = [(&mut self.areas, &before.areas), (&mut self.volumes, &before.volumes)];
        for (now, before) in pairs.into_iter().chain(shape) {
            go_back(now, before, share);
        }
    }

    /// How many cells there are.
    pub fn cells(&self) -> usize {
        self.cells
    }

    pub(super) fn blocks(&self) -> usize {
        self.cells.div_ceil(self.lanes)
    }

    fn suit_blocks(&mut self) {
        let lanes = self.blocks() * self.lanes;
        self.values.resize(lanes * self.variables * self.atoms, 0.0);
        self.given.resize(lanes * self.defaults.len() * self.atoms, 0.0);
        self.areas.resize(lanes * self.atoms, 0.0);
        self.volumes.resize(lanes, 0.0);
        self.steps.resize(lanes, 0.0);
    }

    /// The density of a variable at an atom of a cell, in the variable's unit.
    ///
    /// # Panics
    /// When there is no such cell, variable or atom.
    pub fn value(&self, cell: usize, variable: usize, atom: usize) -> f64 {
        assert!(cell < self.cells && variable < self.variables && atom < self.atoms, "no such cell, variable or atom");
        let (block, lane) = (cell / self.lanes, cell % self.lanes);
        self.values[((block * self.variables + variable) * self.atoms + atom) * self.lanes + lane]
    }

    /// The densities of a variable on a cell, atom after atom, in the variable's unit.
    pub fn values(&self, cell: usize, variable: usize) -> impl Iterator<Item = f64> + '_ {
        (0..self.atoms).map(move |atom| self.value(cell, variable, atom))
    }

    /// The densities of a variable on the cells of a block, `[atom][lane]`: what is read by whoever works on blocks of cells.
    pub fn block(&self, block: usize, variable: usize) -> &[f64] {
        let length = self.atoms * self.lanes;
        let first = (block * self.variables + variable) * length;
        &self.values[first..first + length]
    }

    /// Sets the density of a variable at an atom of a cell.
    ///
    /// # Panics
    /// As [`Self::value`].
    pub fn set_value(&mut self, cell: usize, variable: usize, atom: usize, value: f64) {
        assert!(cell < self.cells && variable < self.variables && atom < self.atoms, "no such cell, variable or atom");
        let (block, lane) = (cell / self.lanes, cell % self.lanes);
        self.values[((block * self.variables + variable) * self.atoms + atom) * self.lanes + lane] = value;
        self.steps[cell] = 0.0;
    }

    /// Sets what is given of an atom of a cell from outside.
    ///
    /// # Panics
    /// When there is no such cell, number or atom.
    pub fn set_given(&mut self, cell: usize, number: usize, atom: usize, value: f64) {
        assert!(cell < self.cells && number < self.defaults.len() && atom < self.atoms, "no such cell, number or atom");
        let (block, lane) = (cell / self.lanes, cell % self.lanes);
        self.given[((block * self.defaults.len() + number) * self.atoms + atom) * self.lanes + lane] = value;
    }

    fn reset_given(&mut self, cell: usize) {
        for number in 0..self.defaults.len() {
            (0..self.atoms).for_each(|atom| self.set_given(cell, number, atom, self.defaults[number]));
        }
    }

    /// The area that a value at an atom belongs to, µm².
    pub fn area(&self, cell: usize, atom: usize) -> f64 {
        self.areas[(cell / self.lanes * self.atoms + atom) * self.lanes + cell % self.lanes]
    }

    /// Sum of area times density over the surface of a cell.
    pub fn amount(&self, cell: usize, variable: usize) -> f64 {
        (0..self.atoms).map(|atom| self.area(cell, atom) * self.value(cell, variable, atom)).sum()
    }

    /// Whether another has as many cells, variables, given numbers, atoms and lanes.
    pub fn has_shape_of(&self, other: &Self) -> bool {
        let shape = |of: &Self| [of.lanes, of.atoms, of.variables, of.cells, of.defaults.len()];
        let lengths = |of: &Self| [&of.values, &of.given, &of.areas, &of.volumes, &of.steps].map(Vec::len);
        shape(self) == shape(other) && lengths(self) == lengths(other)
    }

    /// Adds a cell that has not started, before the one with this number.
    pub fn insert(&mut self, at: usize) {
        self.cells += 1;
        self.suit_blocks();
        for cell in (at + 1..self.cells).rev() {
            self.copy(cell - 1, cell);
        }
        self.clear(at);
        self.reset_given(at);
    }

    /// Keeps some cells, in their order.
    pub fn retain(&mut self, keep: impl Fn(usize) -> bool) {
        let mut kept = 0;
        for cell in 0..self.cells {
            if keep(cell) {
                self.copy(cell, kept);
                kept += 1;
            }
        }
        (kept..self.cells).for_each(|cell| self.clear(cell));
        self.cells = kept;
        self.suit_blocks();
    }

    /// Shows each array with how many numbers of it a cell has, and where a cell's numbers stand in it.
    fn each(&mut self, mut change: impl FnMut(&mut [f64], usize)) {
        let rows = [self.variables * self.atoms, self.defaults.len() * self.atoms, self.atoms, 1, 1];
        let arrays = [&mut self.values, &mut self.given, &mut self.areas, &mut self.volumes, &mut self.steps];
        arrays.into_iter().zip(rows).for_each(|(array, rows)| change(array, rows));
    }

    fn copy(&mut self, from: usize, to: usize) {
        let lanes = self.lanes;
        let index = |cell: usize, rows: usize, row: usize| (cell / lanes * rows + row) * lanes + cell % lanes;
        self.each(|array, rows| (0..rows).for_each(|row| array[index(to, rows, row)] = array[index(from, rows, row)]));
    }

    fn clear(&mut self, cell: usize) {
        let lanes = self.lanes;
        let index = |rows: usize, row: usize| (cell / lanes * rows + row) * lanes + cell % lanes;
        self.each(|array, rows| (0..rows).for_each(|row| array[index(rows, row)] = 0.0));
    }

    /// Becomes another; where its numbers fit into what this one holds, nothing is allocated.
    pub fn copy_from(&mut self, other: &Self) {
        (self.lanes, self.atoms, self.variables, self.cells) = (other.lanes, other.atoms, other.variables, other.cells);
        self.values.clone_from(&other.values);
        self.given.clone_from(&other.given);
        self.defaults.clone_from(&other.defaults);
        self.areas.clone_from(&other.areas);
        self.volumes.clone_from(&other.volumes);
        self.steps.clone_from(&other.steps);
    }
}
