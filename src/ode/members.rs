//! Cells of a population come and go: later ones move by one, whole blocks are added and dropped, and nothing else changes.

use super::Method;
use super::population::{LANES, Population};
use crate::equations::program::{Lanes, Program};
use crate::equations::tree::QuantityId;

impl Population {
    /// Cells at the system's initial values.
    ///
    /// # Panics
    /// When the system looks back: such systems are solved alone.
    pub fn new(program: &Program, cells: usize, method: Method) -> Self {
        assert!(program.delays.is_empty(), "a system that looks back is solved alone");
        let mut population = Self::empty(program.size(), program.open.len(), method);
        population.cells = cells;
        population.resize_blocks();
        (0..cells).for_each(|cell| population.set_initial(program, cell));
        population
    }

    /// Adds a cell behind all others, with values of the variables and of the open quantities, in the order of [`Program::variables`]
    /// and [`Program::open`]. It tries its first step as cells do at the start.
    ///
    /// # Panics
    /// As [`Self::insert`].
    pub fn push(&mut self, program: &Program, variables: &[f64], open: &[f64]) {
        self.insert(program, self.cells, variables, open);
    }

    /// Adds a cell at the system's initial values behind all others.
    ///
    /// # Panics
    /// When the program is not that of the population.
    pub fn push_default(&mut self, program: &Program) {
        self.insert_default(program, self.cells);
    }

    /// As [`Self::push`], before the cell with this number; that and all later ones move up by one.
    ///
    /// # Panics
    /// When there are fewer cells, or the values are not those of the population's program.
    pub fn insert(&mut self, program: &Program, at: usize, variables: &[f64], open: &[f64]) {
        assert_eq!(
            (variables.len(), open.len()),
            (self.variables, self.open),
            "a value for each variable and open quantity"
        );
        self.insert_default(program, at);
        variables.iter().enumerate().for_each(|(variable, &value)| self.set_state(at, variable, value));
        open.iter().enumerate().for_each(|(open, &value)| self.set_open(at, open, value));
    }

    /// As [`Self::push_default`], before the cell with this number; that and all later ones move up by one.
    ///
    /// # Panics
    /// When there are fewer cells, or the program is not that of the population.
    pub fn insert_default(&mut self, program: &Program, at: usize) {
        assert!(at <= self.cells, "before cell {at} of {}", self.cells);
        assert_eq!((self.variables, self.open), (program.size(), program.open.len()), "the population's own program");
        self.cells += 1;
        self.resize_blocks();
        for cell in (at + 1..self.cells).rev() {
            self.copy_cell(cell - 1, cell);
        }
        self.set_initial(program, at);
        self.forget_step(at);
    }

    /// Gives a cell the system's initial values.
    fn set_initial(&mut self, program: &Program, cell: usize) {
        let initial = |quantity: &QuantityId| program.initial[*quantity as usize];
        program.variables.iter().enumerate().for_each(|(variable, q)| self.set_state(cell, variable, initial(q)));
        program.open.iter().enumerate().for_each(|(open, q)| self.set_open(cell, open, initial(q)));
    }

    /// Takes a cell out; later ones move down by one.
    ///
    /// # Panics
    /// When there is no such cell.
    pub fn remove(&mut self, cell: usize) {
        assert!(cell < self.cells, "cell {cell} of {}", self.cells);
        self.retain(|other| other != cell);
    }

    /// Keeps the cells of which this says so, in their order, and takes all others out.
    pub fn retain(&mut self, mut keep: impl FnMut(usize) -> bool) {
        let mut kept = 0;
        for cell in 0..self.cells {
            if keep(cell) {
                self.copy_cell(cell, kept);
                kept += 1;
            }
        }
        self.cells = kept;
        self.resize_blocks();
        // Lanes without a cell hold what they would in a population that never had more.
        for lane in kept..LANES * self.blocks() {
            (0..self.variables).for_each(|variable| self.set_state(lane, variable, 0.0));
            (0..self.open).for_each(|open| self.set_open(lane, open, 0.0));
            self.forget_step(lane);
        }
    }

    /// Adds blocks of lanes without cells, or drops them, until there are as many as the cells need.
    fn resize_blocks(&mut self) {
        let blocks = self.cells.div_ceil(LANES);
        self.states.resize(blocks * self.variables, [0.0; LANES]);
        self.open_values.resize(blocks * self.open, [0.0; LANES]);
        self.steps.resize(blocks, [0.0; LANES]);
        self.errors.resize(blocks, [1.0; LANES]);
    }

    /// Copies everything of a cell to the lane of another.
    fn copy_cell(&mut self, from: usize, to: usize) {
        if from == to {
            return;
        }
        let copy = |values: &mut [Lanes<LANES>], numbers: usize| {
            for number in 0..numbers {
                values[to / LANES * numbers + number][to % LANES] =
                    values[from / LANES * numbers + number][from % LANES];
            }
        };
        copy(&mut self.states, self.variables);
        copy(&mut self.open_values, self.open);
        copy(&mut self.steps, 1);
        copy(&mut self.errors, 1);
    }
}
