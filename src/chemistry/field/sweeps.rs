//! One step of diffusion and decay of all species: lines along x, then y, then z, sixteen at a time, over threads.
//!
//! With walls that hold zero, or none, the solves along the axes commute with each other and with the decay, so that
//! one sweep along each is as exact as the solves themselves, eq. (field.2).

use std::marker::PhantomData;

use rayon::iter::{IndexedParallelIterator, IntoParallelRefMutIterator, ParallelIterator};

use super::factors::Line;
use super::grid::Grid;
use super::limit::{clear_specks, limit, scratch};
use super::species::{Range, Species};
use super::sweep::{WIDTH, section, sweep};
use super::transpose::{transpose_in, transpose_out};

/// Fewest values for which threads are worth waking.
const WORTH_THREADS: usize = 1 << 15;
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
    /// Room for the factors of these species.
    pub fn new(grid: &Grid, species: &[Species]) -> Self {
        let line = |species: &Species, axis: usize| Line::new(grid.cells[axis], species.walls[axis]);
        let lines = species.iter().flat_map(|species| (0..3).map(move |axis| line(species, axis))).collect();
        Self { dt: f64::NAN, lines, decay: vec![1.0; species.len()] }
    }

    /// Fills in the factors of a step size, without allocating.
    pub fn fill(&mut self, grid: &Grid, species: &[Species], dt: f64) {
        self.dt = dt;
        for (s, species) in species.iter().enumerate() {
            self.decay[s] = (-species.decay * dt).exp();
            for axis in 0..3 {
                self.lines[3 * s + axis].fill(dt * species.diffusion / grid.spacing[axis].powi(2));
            }
        }
    }
}

/// The values of all species, shared among threads that write to parts of it that do not overlap.
pub struct Shared<'a> {
    first: *mut f64,
    len: usize,
    values: PhantomData<&'a mut [f64]>,
}

// SAFETY: the pointer is only reached through `part`, whose callers keep to parts of their own.
unsafe impl Sync for Shared<'_> {}

impl<'a> Shared<'a> {
    /// Takes the values until it is dropped.
    pub fn new(values: &'a mut [f64]) -> Self {
        Self { first: values.as_mut_ptr(), len: values.len(), values: PhantomData }
    }

    /// A part of the values.
    ///
    /// # Safety
    /// While the part is held nobody else holds one that overlaps it.
    #[allow(clippy::mut_from_ref)] // that is what the caller answers for
    pub unsafe fn part(&self, at: usize, len: usize) -> &mut [f64] {
        assert!(at + len <= self.len);
        // SAFETY: inside the values by the line above, and unshared by this function's contract.
        unsafe { std::slice::from_raw_parts_mut(self.first.add(at), len) }
    }
}

/// Sixteen lines or fewer, as they lie in memory.
#[derive(Clone, Copy)]
enum Lines {
    /// `count` rows of `n` boxes along x, one after the other.
    Rows { first: usize, n: usize, count: usize },
    /// `count` columns side by side, whose boxes are `stride` apart.
    Columns { first: usize, n: usize, stride: usize, count: usize },
}

impl Lines {
    /// Copies the lines to `[box][line]`, and zeros into lanes without a line.
    ///
    /// # Safety
    /// Nobody else holds a box of these lines.
    unsafe fn gather(self, values: &Shared, to: &mut [f64]) {
        let (rows, _) = to.as_chunks_mut::<WIDTH>();
        match self {
            Self::Rows { first, n, count } => {
                // SAFETY: the boxes are the caller's alone.
                let from = unsafe { values.part(first, n * count) };
                transpose_in(from, [n, count], rows);
            }
            Self::Columns { first, n, stride, count } => {
                for (i, row) in rows[..n].iter_mut().enumerate() {
                    // SAFETY: the boxes are the caller's alone.
                    let from = unsafe { values.part(first + i * stride, count) };
                    if let Ok(from) = <&[f64; WIDTH]>::try_from(&*from) {
                        *row = *from;
                    } else {
                        row[..count].copy_from_slice(from);
                        row[count..].fill(0.0);
                    }
                }
            }
        }
    }

    /// Copies the lines back.
    ///
    /// # Safety
    /// Nobody else holds a box of these lines.
    unsafe fn scatter(self, values: &Shared, from: &[f64]) {
        let (rows, _) = from.as_chunks::<WIDTH>();
        match self {
            Self::Rows { first, n, count } => {
                // SAFETY: the boxes are the caller's alone.
                let to = unsafe { values.part(first, n * count) };
                transpose_out(rows, [n, count], to);
            }
            Self::Columns { first, n, stride, count } => {
                for (i, row) in rows[..n].iter().enumerate() {
                    // SAFETY: the boxes are the caller's alone.
                    let to = unsafe { values.part(first + i * stride, count) };
                    if let Ok(to) = <&mut [f64; WIDTH]>::try_from(&mut *to) {
                        *to = *row;
                    } else {
                        to.copy_from_slice(&row[..count]);
                    }
                }
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
        let n = self.line.real.len();
        // SAFETY: this function's contract.
        unsafe { lines.gather(values, scratch) };
        let least = sweep(self.line, self.factor, scratch);
        if least < 0.0 && self.range == Range::NonNegative && !clear_specks(&mut scratch[..n * WIDTH], least) {
            // SAFETY: this function's contract.
            unsafe { lines.gather(values, &mut scratch[2 * section(n)..3 * section(n)]) };
            limit(self.line, self.factor, scratch);
        }
        // SAFETY: this function's contract.
        unsafe { lines.scatter(values, scratch) };
    }
}

/// Scratch of one part of the work.
pub fn room(grid: &Grid) -> Vec<f64> {
    vec![0.0; scratch(*grid.cells.iter().max().expect("three axes")) + 8]
}

/// The same from where a line of the cache begins, so that no register is loaded from two of them.
fn aligned(room: &mut [f64]) -> &mut [f64] {
    let skip = room.as_ptr().align_offset(64).min(8);
    &mut room[skip..]
}

/// Does `count` tasks, each with scratch that no other task uses meanwhile.
fn share(count: usize, threads: bool, rooms: &mut [Vec<f64>], work: impl Fn(usize, &mut [f64]) + Sync) {
    let parts = rooms.len();
    if threads {
        rooms.par_iter_mut().enumerate().for_each(|(part, room)| {
            let room = aligned(room);
            (part * count / parts..(part + 1) * count / parts).for_each(|task| work(task, room));
        });
    } else {
        let room = aligned(&mut rooms[0]);
        (0..count).for_each(|task| work(task, room));
    }
}

/// One step of diffusion and decay. `ranges[s]` says which species are kept from going below zero.
pub fn diffuse(grid: &Grid, factors: &Factors, ranges: &[Range], values: &mut [f64], rooms: &mut [Vec<f64>]) {
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
    let rows = |task: Task, from: usize, to: usize, room: &mut [f64]| {
        for first in (from..to).step_by(WIDTH) {
            let lines = Lines::Rows { first: first * nx, n: nx, count: WIDTH.min(to - first) };
            // SAFETY: no other task has these rows.
            unsafe { task.solve(shared, lines, room) };
        }
    };
    let columns = |task: Task, at: usize, n: usize, stride: usize, count: usize, room: &mut [f64]| {
        let lines = Lines::Columns { first: at, n, stride, count };
        // SAFETY: no other task has these columns.
        unsafe { task.solve(shared, lines, room) };
    };
    let blocks = |lines: usize| lines.div_ceil(WIDTH);
    if nz == 1 {
        share(species * blocks(ny), threads, rooms, |job, room| {
            let (s, block) = (job / blocks(ny), job % blocks(ny) * WIDTH);
            let Some(task) = task(s, 0) else { return };
            rows(task, s * ny + block, s * ny + ny.min(block + WIDTH), room);
        });
        share(species * blocks(nx), threads, rooms, |job, room| {
            let (s, block) = (job / blocks(nx), job % blocks(nx) * WIDTH);
            let Some(task) = task(s, 1) else { return };
            columns(task, s * len + block, ny, nx, WIDTH.min(nx - block), room);
        });
    } else {
        share(species * nz, threads, rooms, |plane, room| {
            let s = plane / nz;
            if let Some(task) = task(s, 0) {
                rows(task, plane * ny, (plane + 1) * ny, room);
            }
            let Some(task) = task(s, 1) else { return };
            for block in (0..nx).step_by(WIDTH) {
                columns(task, plane * nx * ny + block, ny, nx, WIDTH.min(nx - block), room);
            }
        });
        let across = nx * ny;
        share(species * blocks(across), threads, rooms, |job, room| {
            let (s, block) = (job / blocks(across), job % blocks(across) * WIDTH);
            let Some(task) = task(s, 2) else { return };
            columns(task, s * len + block, nz, across, WIDTH.min(across - block), room);
        });
    }
    for (s, values) in values.chunks_exact_mut(len).enumerate() {
        if last(s).is_none() && factors.decay[s] != 1.0 {
            values.iter_mut().for_each(|value| *value *= factors.decay[s]);
        }
    }
}
