//! All cells that share a system of equations, advanced window by window.

use std::sync::Mutex;

use serde::{Deserialize, Serialize};

use super::Method;
use super::mask::Mask;
use super::narrow::Narrow;
use super::scratch::Scratch;
use crate::equations::program::{Lanes, Program, run};
use crate::equations::tree::QuantityId;

pub use crate::equations::program::LANES;

/// The states of cells that share a program. Arrays are `[block][number][lane]`.
#[derive(Debug, Serialize, Deserialize)]
pub struct Population {
    /// How the cells are advanced.
    pub(super) method: Method,
    pub(super) cells: usize,
    pub(super) variables: usize,
    pub(super) open: usize,
    pub(super) states: Vec<Lanes<LANES>>,
    pub(super) given: Vec<Lanes<LANES>>,
    pub(super) steps: Vec<Lanes<LANES>>,
    pub(super) errors: Vec<Lanes<LANES>>,
    /// Rates at the states for explicit pairs, where `known`: what comes out of them again, so that nothing depends on
    /// whether they are kept.
    #[serde(skip)]
    pub(super) rates: Vec<Lanes<LANES>>,
    #[serde(skip)]
    pub(super) known: Vec<Mask<LANES>>,
    /// The program that they and the scratch are of.
    #[serde(skip)]
    mark: u64,
    #[serde(skip)]
    pub(super) rooms: Vec<Mutex<Option<Box<Scratch<LANES>>>>>,
    /// Room for cells that are advanced one by one.
    #[serde(skip)]
    pub(super) narrow: Option<Box<Narrow>>,
}

impl Clone for Population {
    /// The same cells; scratch is not copied.
    fn clone(&self) -> Self {
        Self {
            method: self.method,
            cells: self.cells,
            variables: self.variables,
            open: self.open,
            states: self.states.clone(),
            given: self.given.clone(),
            steps: self.steps.clone(),
            errors: self.errors.clone(),
            rates: self.rates.clone(),
            known: self.known.clone(),
            mark: self.mark,
            rooms: Vec::new(),
            narrow: None,
        }
    }

    fn clone_from(&mut self, other: &Self) {
        (self.method, self.cells, self.variables, self.open) = (other.method, other.cells, other.variables, other.open);
        self.states.clone_from(&other.states);
        self.given.clone_from(&other.given);
        self.steps.clone_from(&other.steps);
        self.errors.clone_from(&other.errors);
        self.rates.clone_from(&other.rates);
        self.known.clone_from(&other.known);
        self.mark = other.mark;
    }
}

impl PartialEq for Population {
    /// Whether all cells are the same and will go on the same; scratch does not count.
    fn eq(&self, other: &Self) -> bool {
        self.has_shape_of(other)
            && self.method == other.method
            && self.states == other.states
            && self.given == other.given
            && self.steps == other.steps
            && self.errors == other.errors
    }
}

impl Population {
    /// Whether another population has as many cells, variables and open quantities.
    pub fn has_shape_of(&self, other: &Self) -> bool {
        (self.cells, self.variables, self.open) == (other.cells, other.variables, other.open)
    }

    /// Cells at the system's initial values.
    pub fn new(program: &Program, cells: usize, method: Method) -> Self {
        let blocks = cells.div_ceil(LANES);
        let initial = |numbers: &[QuantityId]| -> Vec<Lanes<LANES>> {
            (0..blocks).flat_map(|_| numbers.iter().map(|&q| [program.initial[q as usize]; LANES])).collect()
        };
        Self {
            method,
            cells,
            variables: program.size(),
            open: program.open.len(),
            states: initial(&program.variables),
            given: initial(&program.open),
            steps: vec![[0.0; LANES]; blocks],
            errors: vec![[1.0; LANES]; blocks],
            rates: Vec::new(),
            known: Vec::new(),
            mark: 0,
            rooms: Vec::new(),
            narrow: None,
        }
    }

    /// How many cells there are.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// A cell's value of the variable at a place of [`Program::variables`].
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
        let place = cell / LANES * self.variables + variable;
        let old = std::mem::replace(&mut self.states[place][cell % LANES], value);
        self.forget_rates_unless(old.to_bits() == value.to_bits(), cell);
    }

    /// A cell's value of the open quantity at a place of [`Program::open`].
    ///
    /// # Panics
    /// When there is no such cell or open quantity.
    pub fn given(&self, cell: usize, open: usize) -> f64 {
        assert!(open < self.open, "open quantity {open} of {}", self.open);
        self.given[cell / LANES * self.open + open][cell % LANES]
    }

    /// Sets a cell's value of an open quantity: it stands until it is set again.
    ///
    /// # Panics
    /// When there is no such cell or open quantity.
    pub fn set_given(&mut self, cell: usize, open: usize, value: f64) {
        assert!(open < self.open, "open quantity {open} of {}", self.open);
        let old = std::mem::replace(&mut self.given[cell / LANES * self.open + open][cell % LANES], value);
        self.forget_rates_unless(old.to_bits() == value.to_bits(), cell);
    }

    fn forget_rates_unless(&mut self, same: bool, cell: usize) {
        if let (false, Some(known)) = (same, self.known.get_mut(cell / LANES)) {
            known[cell % LANES] = 0;
        }
    }

    /// Makes sure that rates are kept where they can be, and that they and the scratch are the program's.
    pub(super) fn keep_rates(&mut self, program: &Program) {
        if self.mark != program.mark {
            self.mark = program.mark;
            self.rooms.clear();
            self.narrow = None;
            self.known.clear();
        }
        if !self.method.keeps_rates() {
            self.known.clear();
            self.rates.clear();
            return;
        }
        if !program.rates_stand_still {
            self.known.clear();
        } else if self.known.is_empty() {
            self.known.resize(self.steps.len(), [0; LANES]);
        }
        if self.rates.len() != self.states.len() {
            self.rates.resize(self.states.len(), [0.0; LANES]);
        }
    }

    /// The step that a cell will try next; 0 before its first window and for methods with fixed steps.
    pub fn next_step(&self, cell: usize) -> f64 {
        self.steps[cell / LANES][cell % LANES]
    }

    /// How the cells are advanced.
    pub(super) fn method(&self) -> Method {
        self.method
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
        let mut file = program.file::<LANES>();
        for (block, values) in values.chunks_mut(LANES).enumerate() {
            self.load(block, time, &mut file);
            run(&program.observe, &mut file);
            let register = program.observe.outputs[quantity as usize] as usize;
            values.copy_from_slice(&file[register][..values.len()]);
        }
    }

    fn load(&self, block: usize, time: f64, file: &mut [Lanes<LANES>]) {
        let (n, m) = (self.variables, self.open);
        file[0] = [time; LANES];
        file[1..=n].copy_from_slice(&self.states[block * n..(block + 1) * n]);
        file[1 + n..1 + n + m].copy_from_slice(&self.given[block * m..(block + 1) * m]);
    }
}
