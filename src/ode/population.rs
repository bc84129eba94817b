//! All cells that share a system of equations, advanced window by window.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::Method;
use super::buffers::PopulationScratch;
use crate::elementary::go_back;
use crate::equations::program::{Lanes, Program, run};
use crate::equations::tree::QuantityId;

pub use crate::equations::program::LANES;

/// The states of cells that share a program. Arrays are `[block][number][lane]`. In lanes beyond the last cell everything is 0, and the error 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Population {
    /// How the cells are advanced.
    method: Method,
    pub(super) cells: usize,
    pub(super) variables: usize,
    pub(super) open: usize,
    pub(super) states: Vec<Lanes<LANES>>,
    pub(super) open_values: Vec<Lanes<LANES>>,
    /// The step that each cell tries next; 0 where none is known.
    pub(super) steps: Vec<Lanes<LANES>>,
    /// Error of each cell's last step.
    pub(super) errors: Vec<Lanes<LANES>>,
}

impl Population {
    /// No cells, of a system with so many variables and open quantities.
    pub(super) fn empty(variables: usize, open: usize, method: Method) -> Self {
        let (states, open_values, steps, errors) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { method, cells: 0, variables, open, states, open_values, steps, errors }
    }

    /// Whether another population has as many cells, variables and open quantities, and as many numbers of them: it may come from a file.
    pub fn has_shape_of(&self, other: &Self) -> bool {
        let counts = |of: &Self| [of.cells, of.variables, of.open];
        let lengths = |of: &Self| [&of.states, &of.open_values, &of.steps, &of.errors].map(Vec::len);
        counts(self) == counts(other) && lengths(self) == lengths(other)
    }

    /// Becomes another; where its numbers fit into what this one holds, nothing is allocated.
    pub fn copy_from(&mut self, other: &Self) {
        (self.method, self.cells, self.variables, self.open) = (other.method, other.cells, other.variables, other.open);
        self.states.clone_from(&other.states);
        self.open_values.clone_from(&other.open_values);
        self.steps.clone_from(&other.steps);
        self.errors.clone_from(&other.errors);
    }

    /// Moves variables and open quantities back towards those of a population with the same cells: all the way where the share is 0, and
    /// not at all where it is 1.
    pub(crate) fn go_back_to(&mut self, before: &Self, share: f64) {
        let pairs = [(&mut self.states, &before.states), (&mut self.open_values, &before.open_values)];
        for (now, before) in pairs {
            go_back(now.as_flattened_mut(), before.as_flattened(), share);
        }
    }

    /// How many cells there are.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// A cell's value of the variable at a position of [`Program::variables`].
    ///
    /// # Panics
    /// When there is no such cell or variable.
    pub fn state(&self, cell: usize, variable: usize) -> f64 {
        assert!(variable < self.variables, "variable {variable} of {}", self.variables);
        self.states[cell / LANES * self.variables + variable][cell % LANES]
    }

    /// Sets a cell's value of a variable.
    ///
    /// # Panics
    /// When there is no such cell or variable.
    pub fn set_state(&mut self, cell: usize, variable: usize, value: f64) {
        assert!(variable < self.variables, "variable {variable} of {}", self.variables);
        self.states[cell / LANES * self.variables + variable][cell % LANES] = value;
    }

    /// A cell's value of the open quantity at a position of [`Program::open`].
    ///
    /// # Panics
    /// When there is no such cell or open quantity.
    pub fn open_value(&self, cell: usize, open: usize) -> f64 {
        assert!(open < self.open, "open quantity {open} of {}", self.open);
        self.open_values[cell / LANES * self.open + open][cell % LANES]
    }

    /// Sets a cell's value of an open quantity: it stands until it is set again.
    ///
    /// # Panics
    /// When there is no such cell or open quantity.
    pub fn set_open(&mut self, cell: usize, open: usize, value: f64) {
        assert!(open < self.open, "open quantity {open} of {}", self.open);
        self.open_values[cell / LANES * self.open + open][cell % LANES] = value;
    }

    /// The step that a cell will try next; 0 before its first window and for methods with fixed steps.
    pub fn next_step(&self, cell: usize) -> f64 {
        self.steps[cell / LANES][cell % LANES]
    }

    /// How the cells are advanced.
    pub(super) fn method(&self) -> Method {
        self.method
    }

    /// How many blocks hold the cells.
    pub(super) fn blocks(&self) -> usize {
        self.steps.len()
    }

    /// The step that a cell will try next, and the error of its last.
    pub(super) fn pace(&self, cell: usize) -> (f64, f64) {
        (self.steps[cell / LANES][cell % LANES], self.errors[cell / LANES][cell % LANES])
    }

    /// Sets the step that a cell will try next, and the error of its last.
    pub(super) fn set_pace(&mut self, cell: usize, (step, error): (f64, f64)) {
        (self.steps[cell / LANES][cell % LANES], self.errors[cell / LANES][cell % LANES]) = (step, error);
    }

    /// Forgets a cell's step, after its state was set to something quite different.
    pub fn forget_step(&mut self, cell: usize) {
        self.set_pace(cell, (0.0, 1.0));
    }

    /// Writes the value of any quantity of all cells at a time, one number a cell.
    ///
    /// # Panics
    /// When `values` has another length than there are cells.
    pub fn observe(&self, program: &Program, quantity: QuantityId, time: f64, values: &mut [f64]) {
        assert_eq!(values.len(), self.cells, "one number a cell");
        self.each_block(program, time, &mut program.file(), |block| {
            values[block.cells.clone()].copy_from_slice(block.values(quantity));
        });
    }

    /// Shows the values of all quantities of the cells of each block at a time, by one evaluation of the equations a block. Nothing is
    /// allocated after the first time with the same scratch.
    pub fn observe_blocks(
        &self,
        program: &Program,
        time: f64,
        scratch: &mut PopulationScratch,
        each: impl FnMut(BlockView),
    ) {
        scratch.suit(program, self.method(), self.blocks());
        self.each_block(program, time, &mut scratch.file, each);
    }

    fn each_block(&self, program: &Program, time: f64, file: &mut [Lanes<LANES>], mut each: impl FnMut(BlockView)) {
        let (n, m) = (self.variables, self.open);
        for block in 0..self.blocks() {
            file[0] = [time; LANES];
            file[1..=n].copy_from_slice(&self.states[block * n..(block + 1) * n]);
            file[1 + n..1 + n + m].copy_from_slice(&self.open_values[block * m..(block + 1) * m]);
            run(&program.observe, file);
            each(BlockView { program, file, cells: block * LANES..self.cells.min((block + 1) * LANES) });
        }
    }
}

/// All quantities of the cells of a block at one time.
#[derive(Debug)]
pub struct BlockView<'a> {
    program: &'a Program,
    file: &'a [Lanes<LANES>],
    /// The numbers of the cells.
    pub cells: Range<usize>,
}

impl BlockView<'_> {
    /// The values of a quantity, one a cell.
    pub fn values(&self, quantity: QuantityId) -> &[f64] {
        let register = self.program.observe.outputs[quantity as usize] as usize;
        &self.file[register][..self.cells.len()]
    }
}
