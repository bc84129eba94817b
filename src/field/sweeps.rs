//! One step of diffusion and decay of all species: lines along x, then y, then z, sixteen at a time, over threads.
//!
//! With walls that hold zero, or none, the solves along the axes commute with each other and with the decay, so that
//! one sweep along each is as exact as the solves themselves, eq. (field.2).

use pulp::{Arch, Simd, WithSimd};
use rayon::iter::{IndexedParallelIterator, IntoParallelRefMutIterator, ParallelIterator};

use super::bundle::Lines;
use super::factors::Line;
use super::grid::Grid;
use super::limit::{clear_specks, limit, scratch};
use super::shared::Shared;
use super::species::Species;
use super::sweep::{WIDTH, section, sweep};
use crate::equations::Range;

/// Fewest values for which threads are worth waking.
const WORTH_THREADS: usize = 1 << 15;
/// Fewest values for which the memory is asked for lines in advance: those that no cache near a core holds.
const WORTH_ASKING: usize = 1 << 19;
/// Parts that the work of a phase is cut into when threads share it.
pub const PARTS: usize = 32;

/// Everything that one step size needs: factors of each species and axis.
#[derive(Debug, Clone)]
pub struct Factors {
    /// The step size, s.
    pub dt: f64,
    /// `[3 × species + axis]`.
    pub lines: Vec<Line>,
    /// What decay leaves of each species.
    pub decay: Vec<f64>,
}

impl Factors {
    /// Empty factors of these species.
    pub fn new(grid: &Grid, species: &[Species]) -> Self {
        let line = |species: &Species, axis: usize| Line::new(grid.cells[axis], species.walls[axis]);
        let lines = species.iter().flat_map(|species| (0..3).map(move |axis| line(species, axis))).collect();
        Self { dt: f64::NAN, lines, decay: vec![1.0; species.len()] }
    }

    /// Fills in the factors of a step size, without allocating.
    pub fn fill(&mut self, grid: &Grid, species: &[Species], dt: f64) {
        self.dt = dt;
        for (s, species) in species.iter().enumerate() {
            let moved = if species.carried { 0.0 } else { 1.0 };
            self.decay[s] = (-species.decay * moved * dt).exp();
            for axis in 0..3 {
                self.lines[3 * s + axis].fill(dt * species.diffusion * moved / grid.spacing[axis].powi(2));
            }
        }
    }
}

/// What a task does to its lines.
#[derive(Clone, Copy)]
struct Task<'a> {
    line: &'a Line,
    factor: f64,
    range: Range,
}

impl Task<'_> {
    /// Solves the lines.
    ///
    /// # Safety
    /// Nobody else holds a box of these lines.
    unsafe fn solve(self, values: &Shared, lines: Lines, scratch: &mut [f64]) {
        Arch::new().dispatch(Solve { task: self, values, lines, scratch });
    }
}

/// A task with its lines, which are its own, so that all of it is compiled for the widest registers.
struct Solve<'a> {
    task: Task<'a>,
    values: &'a Shared<'a>,
    lines: Lines,
    scratch: &'a mut [f64],
}

impl WithSimd for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { task: Task { line, factor, range }, values, lines, scratch } = self;
        let n = line.real.len();
        // SAFETY: nobody else holds a box of these lines, as the caller of `Task::solve` answers for.
        let columns = unsafe { lines.in_place(values) };
        let direct = columns.is_some() && line.ring.is_none();
        if columns.is_none() {
            // SAFETY: as above.
            unsafe { lines.gather(values, scratch) };
        }
        let next = (values.len() >= WORTH_ASKING).then(|| lines.next(values));
        let least = sweep(simd, line, factor, scratch, (columns, next));
        let result = 2 * section(n)..2 * section(n) + n * WIDTH;
        let negative = least < 0.0 && range == Range::NonNegative;
        if negative {
            if direct {
                // SAFETY: as above.
                unsafe { lines.gather(values, &mut scratch[result.clone()]) };
            }
            if !clear_specks(&mut scratch[result.clone()], least) {
                limit(line, factor, scratch);
            }
        }
        if negative || !direct {
            // SAFETY: as above.
            unsafe { lines.scatter(values, &scratch[result]) };
        }
    }
}

/// Scratch of one part of the work.
pub fn sweep_buffer(grid: &Grid) -> Vec<f64> {
    vec![0.0; scratch(*grid.cells.iter().max().expect("three axes")) + 8]
}

/// The same from where a line of the cache begins, so that no register is loaded from two of them.
fn aligned(buffer: &mut [f64]) -> &mut [f64] {
    let skip = buffer.as_ptr().align_offset(64).min(8);
    &mut buffer[skip..]
}

/// Does `count` tasks, each with scratch that no other task uses meanwhile.
fn share(count: usize, threads: bool, buffers: &mut [Vec<f64>], work: impl Fn(usize, &mut [f64]) + Sync) {
    let parts = buffers.len();
    if threads {
        buffers.par_iter_mut().enumerate().for_each(|(part, buffer)| {
            let buffer = aligned(buffer);
            (part * count / parts..(part + 1) * count / parts).for_each(|task| work(task, buffer));
        });
    } else {
        let buffer = aligned(&mut buffers[0]);
        (0..count).for_each(|task| work(task, buffer));
    }
}

/// One step of diffusion and decay. `ranges[s]` says which species are kept from going below zero.
pub fn diffuse(grid: &Grid, factors: &Factors, ranges: &[Range], values: &mut [f64], buffers: &mut [Vec<f64>]) {
    let ([nx, ny, nz], len, species) = (grid.cells, grid.len(), ranges.len());
    let threads = values.len() >= WORTH_THREADS && rayon::current_num_threads() > 1;
    let shared = &Shared::new(values);
    // Decay rides on the last sweep of a species; one that has none is scaled at the end.
    let last = |s: usize| (0..3).rev().find(|axis| factors.lines[3 * s + axis].ratio > 0.0);
    let task = |s: usize, axis: usize| {
        let line = &factors.lines[3 * s + axis];
        let factor = if last(s) == Some(axis) { factors.decay[s] } else { 1.0 };
        (line.ratio > 0.0).then_some(Task { line, factor, range: ranges[s] })
    };
    let rows = |task: Task, from: usize, to: usize, buffer: &mut [f64]| {
        for first in (from..to).step_by(WIDTH) {
            let lines = Lines::Rows { first: first * nx, n: nx, count: WIDTH.min(to - first) };
            // SAFETY: no other task has these rows.
            unsafe { task.solve(shared, lines, buffer) };
        }
    };
    let columns = |task: Task, at: usize, n: usize, stride: usize, count: usize, buffer: &mut [f64]| {
        let lines = Lines::Columns { first: at, n, stride, count };
        // SAFETY: no other task has these columns.
        unsafe { task.solve(shared, lines, buffer) };
    };
    let blocks = |lines: usize| lines.div_ceil(WIDTH);
    if nz == 1 {
        share(species * blocks(ny), threads, buffers, |job, buffer| {
            let (s, block) = (job / blocks(ny), job % blocks(ny) * WIDTH);
            let Some(task) = task(s, 0) else { return };
            rows(task, s * ny + block, s * ny + ny.min(block + WIDTH), buffer);
        });
        share(species * blocks(nx), threads, buffers, |job, buffer| {
            let (s, block) = (job / blocks(nx), job % blocks(nx) * WIDTH);
            let Some(task) = task(s, 1) else { return };
            columns(task, s * len + block, ny, nx, WIDTH.min(nx - block), buffer);
        });
    } else {
        share(species * nz, threads, buffers, |plane, buffer| {
            let s = plane / nz;
            if let Some(task) = task(s, 0) {
                rows(task, plane * ny, (plane + 1) * ny, buffer);
            }
            let Some(task) = task(s, 1) else { return };
            for block in (0..nx).step_by(WIDTH) {
                columns(task, plane * nx * ny + block, ny, nx, WIDTH.min(nx - block), buffer);
            }
        });
        let across = nx * ny;
        share(species * blocks(across), threads, buffers, |job, buffer| {
            let (s, block) = (job / blocks(across), job % blocks(across) * WIDTH);
            let Some(task) = task(s, 2) else { return };
            columns(task, s * len + block, nz, across, WIDTH.min(across - block), buffer);
        });
    }
    for (s, values) in values.chunks_exact_mut(len).enumerate() {
        if last(s).is_none() && factors.decay[s] != 1.0 {
            values.iter_mut().for_each(|value| *value *= factors.decay[s]);
        }
    }
}
