//! All cells that share a system of equations, advanced window by window.

use std::sync::{Mutex, PoisonError};

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::block::{self, CellTrouble};
use super::cells::{Cells, Kept};
use super::mask::Mask;
use super::scratch::Scratch;
use super::{Method, OdeTrouble, Tolerances, Work};
use crate::chemistry::program::{Lanes, Program, run};
use crate::chemistry::tree::QuantityId;

/// Cells side by side in a block.
pub const LANES: usize = 16;

/// The states of cells that share a program. Arrays are `[block][number][lane]`.
#[derive(Debug, Serialize, Deserialize)]
pub struct Population {
    /// How the cells are advanced.
    method: Method,
    cells: usize,
    variables: usize,
    open: usize,
    states: Vec<Lanes<LANES>>,
    given: Vec<Lanes<LANES>>,
    steps: Vec<Lanes<LANES>>,
    errors: Vec<Lanes<LANES>>,
    /// Rates at the states for the explicit pair, where `known`: what comes out of them again, so that nothing depends on
    /// whether they are kept.
    #[serde(skip)]
    rates: Vec<Lanes<LANES>>,
    #[serde(skip)]
    known: Vec<Mask<LANES>>,
    /// The program that they and the scratch are of.
    #[serde(skip)]
    mark: u64,
    #[serde(skip)]
    rooms: Vec<Mutex<Option<Box<Scratch<LANES>>>>>,
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
    fn keep_rates(&mut self, program: &Program) {
        if self.mark != program.mark {
            self.mark = program.mark;
            self.rooms.clear();
            self.known.clear();
        }
        if self.method != Method::Rk45 || !program.rates_stand_still {
            self.known.clear();
            self.rates.clear();
        } else if self.known.is_empty() {
            self.known.resize(self.steps.len(), [0; LANES]);
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

    /// Advances all cells through a window. Each cell has an error and a step of its own; its result does not depend on
    /// how many cells there are nor on the number of threads. Open quantities stand still within the window. Nothing is
    /// allocated after the first window.
    ///
    /// # Errors
    /// The cell of the smallest number that could not be advanced. Cells in trouble keep their last good state; all
    /// others have reached the end.
    ///
    /// # Panics
    /// When the program is not that of the population in the number of variables and open quantities, or the window
    /// is empty.
    pub fn advance(
        &mut self,
        program: &Program,
        from: f64,
        until: f64,
        tolerances: &Tolerances,
    ) -> Result<Work, OdeTrouble> {
        assert_eq!((self.variables, self.open), (program.size(), program.open.len()), "the population's own program");
        assert!(until > from, "a window from {from} until {until}");
        let n = self.variables;
        if n == 0 || self.cells == 0 {
            return Ok(Work::default());
        }
        self.keep_rates(program);
        let threads = rayon::current_num_threads();
        while self.rooms.len() < threads {
            self.rooms.push(Mutex::new(None));
        }
        let Self { states, steps, errors, given, rates, known, rooms, .. } = self;
        let (method, cells, open) = (self.method, self.cells, self.open);
        let blocks = blocks_a_task(steps.len(), threads);
        let one = |(task, (((states, steps), errors), kept)): (usize, Part)| {
            let room = &rooms[rayon::current_thread_index().unwrap_or(0)];
            let mut room = room.lock().unwrap_or_else(PoisonError::into_inner);
            let scratch = room.get_or_insert_with(|| Box::new(Scratch::new(program, method == Method::Rosenbrock)));
            program.set_constants(&mut scratch.file);
            let first = task * blocks;
            let given = &given[first * open..(first + steps.len()) * open];
            let count = (cells - first * LANES).min(steps.len() * LANES);
            let cells = Cells { count, states, given, steps, errors, kept };
            let result =
                Arch::new().dispatch(Task { program, method, scratch, cells, window: (from, until), tolerances });
            result.map_err(|trouble| CellTrouble { cell: first * LANES + trouble.cell, ..trouble })
        };
        let tasks = states.par_chunks_mut(n * blocks).zip(steps.par_chunks_mut(blocks));
        let kept = rates.par_chunks_mut(n * blocks).zip(known.par_chunks_mut(blocks));
        let kept = kept.map(|(rates, known)| Some(Kept { rates, known }));
        let unkept = if kept.len() > 0 { 0 } else { tasks.len() };
        let kept = kept.chain((0..unkept).into_par_iter().map(|_| None));
        let result = tasks.zip(errors.par_chunks_mut(blocks)).zip(kept).enumerate().map(one);
        result.reduce(|| Ok(Work::default()), first_trouble).map_err(|trouble| OdeTrouble {
            system: program.name.clone(),
            cell: Some(trouble.cell),
            time: trouble.time,
            variable: trouble.variable.map(|v| program.names[program.variables[v] as usize].clone()),
            reason: trouble.reason,
            detail: String::new(),
        })
    }

    fn load(&self, block: usize, time: f64, file: &mut [Lanes<LANES>]) {
        let (n, m) = (self.variables, self.open);
        file[0] = [time; LANES];
        file[1..=n].copy_from_slice(&self.states[block * n..(block + 1) * n]);
        file[1 + n..1 + n + m].copy_from_slice(&self.given[block * m..(block + 1) * m]);
    }
}

/// What a task changes: states, steps, errors and kept rates.
type Part<'a> = (((&'a mut [Lanes<LANES>], &'a mut [Lanes<LANES>]), &'a mut [Lanes<LANES>]), Option<Kept<'a, LANES>>);

/// Tasks of so many blocks have enough cells to fill lanes that are done early.
const MOST_BLOCKS: usize = 256;

/// How many blocks a task takes: several tasks a thread, so that the threads end together.
fn blocks_a_task(blocks: usize, threads: usize) -> usize {
    let tasks = if threads == 1 { 1 } else { 4 * threads };
    blocks.div_ceil(tasks).clamp(1, MOST_BLOCKS)
}

/// What one task needs, as an object with a method of its own: only so is all of it compiled for the wide registers.
struct Task<'a> {
    program: &'a Program,
    method: Method,
    scratch: &'a mut Scratch<LANES>,
    cells: Cells<'a, LANES>,
    window: (f64, f64),
    tolerances: &'a Tolerances,
}

impl WithSimd for Task<'_> {
    type Output = TaskResult;
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> TaskResult {
        let Self { program, method, scratch, mut cells, window, tolerances } = self;
        block::advance(simd, program, method, scratch, &mut cells, window, tolerances)
    }
}

type TaskResult = Result<Work, CellTrouble>;

/// The sum of the work, or the trouble of the smaller cell.
fn first_trouble(a: TaskResult, b: TaskResult) -> TaskResult {
    match (a, b) {
        (Ok(mut a), Ok(b)) => {
            a.add(b);
            Ok(a)
        }
        (Err(a), Err(b)) => Err(if b.cell < a.cell { b } else { a }),
        (Err(trouble), Ok(_)) | (Ok(_), Err(trouble)) => Err(trouble),
    }
}
