//! A population through a window: side by side in tasks of blocks, or a few cells one by one.

use std::sync::PoisonError;

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::block;
use super::buffers::PopulationScratch;
use super::cells::{CellTrouble, Cells, Kept, kept_numbers};
use super::narrow::Narrow;
use super::population::{LANES, Population};
use super::scratch::Scratch;
use super::{Method, OdeTrouble, Tolerances, Work, lost};
use crate::equations::program::{Lanes, Program};

impl Population {
    /// Advances all cells through a window. Each cell has an error and a step of its own; its result does not depend on
    /// how many cells there are nor on the number of threads. Open quantities stand still within the window. Nothing is
    /// allocated after the first window with the same scratch.
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
        scratch: &mut PopulationScratch,
    ) -> Result<Work, OdeTrouble> {
        assert_eq!((self.variables, self.open), (program.size(), program.open.len()), "the population's own program");
        assert!(until > from, "a window from {from} until {until}");
        if self.variables == 0 || self.cells == 0 {
            return Ok(Work::default());
        }
        scratch.suit(program, self.method(), self.blocks());
        let result = if self.cells <= FEW {
            self.advance_one_by_one(program, (from, until), tolerances, scratch)
        } else {
            self.advance_side_by_side(program, (from, until), tolerances, scratch)
        };
        result.map_err(|trouble| trouble.of(program))
    }

    fn advance_one_by_one(
        &mut self,
        program: &Program,
        window: (f64, f64),
        tolerances: &Tolerances,
        scratch: &mut PopulationScratch,
    ) -> TaskResult {
        let method = self.method();
        let Self { states, steps, errors, open_values, .. } = self;
        let PopulationScratch { kept, narrow, .. } = scratch;
        let kept = (!kept.is_empty()).then_some(Kept { numbers: kept });
        let mut cells = Cells { count: self.cells, states, open_values, steps, errors, kept };
        let narrow = narrow.get_or_insert_with(|| Box::new(Narrow::new(program, method.is_implicit())));
        narrow.advance(program, method, &mut cells, window, tolerances)
    }

    fn advance_side_by_side(
        &mut self,
        program: &Program,
        window: (f64, f64),
        tolerances: &Tolerances,
        scratch: &mut PopulationScratch,
    ) -> TaskResult {
        let (method, cells, n, open) = (self.method(), self.cells, self.variables, self.open);
        scratch.suit_threads();
        let Self { states, steps, errors, open_values, .. } = self;
        let PopulationScratch { kept, threads, .. } = scratch;
        let blocks = blocks_a_task(steps.len(), rayon::current_num_threads());
        let one = |(task, (((states, steps), errors), kept)): (usize, Part)| {
            let own = &threads[rayon::current_thread_index().unwrap_or(0)];
            let mut own = own.lock().unwrap_or_else(PoisonError::into_inner);
            let scratch = own.block.get_or_insert_with(|| Box::new(Scratch::new(program, method.is_implicit())));
            program.set_constants(&mut scratch.file);
            let first = task * blocks;
            let open_values = &open_values[first * open..(first + steps.len()) * open];
            let count = (cells - first * LANES).min(steps.len() * LANES);
            let cells = Cells { count, states, open_values, steps, errors, kept };
            let result = Arch::new().dispatch(Task { program, method, scratch, cells, window, tolerances });
            result.map_err(|trouble| CellTrouble { cell: first * LANES + trouble.cell, ..trouble })
        };
        let tasks = states.par_chunks_mut(n * blocks).zip(steps.par_chunks_mut(blocks));
        let kept = kept.par_chunks_mut(kept_numbers(n, open) * blocks).map(|numbers| Some(Kept { numbers }));
        let unkept = if kept.len() > 0 { 0 } else { tasks.len() };
        let kept = kept.chain((0..unkept).into_par_iter().map(|_| None));
        let result = tasks.zip(errors.par_chunks_mut(blocks)).zip(kept).enumerate().map(one);
        result.reduce(|| Ok(Work::default()), first_trouble)
    }
}

/// What a task changes: states, steps, errors and kept rates.
type Part<'a> = (((&'a mut [Lanes<LANES>], &'a mut [Lanes<LANES>]), &'a mut [Lanes<LANES>]), Option<Kept<'a, LANES>>);

/// So few cells are sooner done one by one than side by side in lanes of which most are empty.
const FEW: usize = 2;

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

impl CellTrouble {
    #[cold]
    fn of(self, program: &Program) -> OdeTrouble {
        OdeTrouble {
            system: program.name.clone(),
            cell: Some(self.cell),
            time: self.time,
            variable: self.variable.map(|v| program.names[program.variables[v] as usize].clone()),
            reason: self.reason,
            detail: lost(program, self.unknown),
        }
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
