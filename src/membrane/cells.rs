//! All cells of a kind: blocks side by side, and what they share with the population of their insides.

use std::sync::{Mutex, PoisonError};

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::failure::{Failure, MembraneTrouble};
use super::kick::Course;
use super::mesh::SurfaceMesh;
use super::scratch::{MembraneScratch, ThreadWork, Work};
use super::start::begin;
use super::state::MembraneCells;
use super::system::MembraneSystem;
use super::window::{Part, advance, display};
use crate::ode::{Piece, Population};

/// The shapes of the cells of a kind where a step begins and where it ends: positions `[block][atom][axis][lane]`, µm.
#[derive(Debug, Clone, Copy)]
pub struct Shapes<'a> {
    /// Neighbourhoods.
    pub mesh: &'a SurfaceMesh,
    /// Where the step begins.
    pub from: &'a [f64],
    /// Where it ends.
    pub to: &'a [f64],
}

/// What all blocks share.
struct Shared<'a> {
    shapes: &'a Shapes<'a>,
    task: Task<'a>,
    threads: &'a [Mutex<ThreadWork>],
}

/// What is done to a block.
#[derive(Clone, Copy)]
enum Task<'a> {
    /// Cells that have not started do, at this time, and sums are worked out.
    Begin(f64),
    /// Through a window of time.
    Advance(Course<'a>, &'a [Piece]),
    /// An expression that is shown, by its number, is worked out at this time.
    Show(usize, f64),
}

impl MembraneSystem {
    /// Gives cells that have not started their first values, pools included, and works out what is summed over their surfaces.
    /// The insides are the members of the population from `first` on.
    pub fn begin(
        &self,
        cells: &mut MembraneCells,
        (population, first): (&mut Population, usize),
        (mesh, positions): (&SurfaceMesh, &[f64]),
        time: f64,
        scratch: &mut MembraneScratch,
    ) {
        let shapes = Shapes { mesh, from: positions, to: positions };
        // Nothing fails where nothing moves.
        let _ = self.each_block(cells, (population, first), &shapes, Task::Begin(time), scratch);
    }

    /// Moves all cells of a kind through a window of the document's time while their surfaces go from one shape to another, eq.
    /// (surface.1) to (surface.6), kicked by noise. Nothing is allocated after the first window with the same scratch, and no result depends on the
    /// number of threads or on the other cells.
    ///
    /// # Errors
    /// The cell of the smallest number that could not be moved.
    pub fn advance(
        &self,
        cells: &mut MembraneCells,
        inside: (&mut Population, usize),
        shapes: &Shapes,
        course: Course,
        scratch: &mut MembraneScratch,
    ) -> Result<(), MembraneTrouble> {
        let mut pieces = std::mem::take(&mut scratch.pieces);
        pieces.clear();
        if let Some(clock) = &self.clock {
            let window = (course.substeps.from(), course.substeps.until());
            scratch.clock.each_piece(clock, window, |piece| pieces.push(piece));
        }
        let done = self.each_block(cells, inside, shapes, Task::Advance(course, &pieces), scratch);
        scratch.pieces = pieces;
        done
    }

    /// Works out an expression that is shown at all atoms of the cells where they stand, and hands over the number of each atom of each cell in
    /// turn.
    pub fn show(
        &self,
        cells: &mut MembraneCells,
        (population, first): (&mut Population, usize),
        (mesh, positions): (&SurfaceMesh, &[f64]),
        (number, time): (usize, f64),
        scratch: &mut MembraneScratch,
        mut take: impl FnMut(usize, &mut dyn Iterator<Item = f64>),
    ) {
        let shapes = Shapes { mesh, from: positions, to: positions };
        // Nothing fails where nothing moves.
        let _ = self.each_block(cells, (population, first), &shapes, Task::Show(number, time), scratch);
        let (atoms, lanes) = (cells.atoms, cells.lanes);
        for cell in 0..cells.cells {
            let block = &scratch.shown[cell / lanes * atoms * lanes..];
            take(cell, &mut (0..atoms).map(|atom| block[atom * lanes + cell % lanes]));
        }
    }

    fn each_block(
        &self,
        cells: &mut MembraneCells,
        (population, first): (&mut Population, usize),
        shapes: &Shapes,
        task: Task,
        scratch: &mut MembraneScratch,
    ) -> Result<(), MembraneTrouble> {
        if cells.cells == 0 {
            return Ok(());
        }
        let MembraneScratch { threads, inside, shown, failures, .. } = scratch;
        shown.resize(cells.areas.len(), 0.0);
        threads.resize_with(rayon::current_num_threads().max(threads.len()), Mutex::default);
        gather(cells, population, first, self.numbers(), inside);
        failures.clear();
        failures.resize(cells.blocks(), None);
        let shared = Shared { shapes, task, threads };
        if cells.lanes == 1 {
            self.blocks::<1>(cells, (inside, shown, failures), &shared, |work| &mut work.one);
        } else {
            self.blocks::<8>(cells, (inside, shown, failures), &shared, |work| &mut work.eight);
        }
        if !matches!(task, Task::Show(..)) {
            scatter(cells, population, first, self.numbers(), inside);
        }
        let failed = failures.iter().enumerate().find_map(|(block, failure)| Some((block, failure.as_ref()?)));
        failed.map_or(Ok(()), |(block, failure)| {
            let cell = block * cells.lanes + failure.lane;
            Err(MembraneTrouble { cell, time: failure.time, reason: failure.reason })
        })
    }

    /// Pools, and what is open of the inside.
    fn numbers(&self) -> (usize, usize) {
        (self.inside.size(), self.inside.open.len())
    }

    fn blocks<const L: usize>(
        &self,
        cells: &mut MembraneCells,
        (inside, shown, failures): (&mut [f64], &mut [f64], &mut [Option<Failure>]),
        &Shared { shapes, task, threads }: &Shared,
        of_lanes: impl Fn(&mut ThreadWork) -> &mut Option<Box<Work<L>>> + Sync,
    ) {
        let (atoms, all, count) = (shapes.mesh.atoms, self.numbers(), cells.cells);
        let (values, areas, length) = (L * self.variables() * atoms, L * atoms, L * self.given.len() * atoms);
        let given = &cells.given;
        let parts = cells.values.par_chunks_mut(values).zip(cells.areas.par_chunks_mut(areas));
        let parts = parts.zip(cells.volumes.par_chunks_mut(L)).zip(cells.steps.par_chunks_mut(L));
        let parts = parts.zip(inside.par_chunks_mut(L * (all.0 + all.1))).zip(shown.par_chunks_mut(areas));
        let parts = parts.zip(failures.par_iter_mut());
        parts.enumerate().for_each(|(block, ((((((values, areas), volume), steps), inside), shown), failure))| {
            let work = &threads[rayon::current_thread_index().unwrap_or(0)];
            let mut work = work.lock().unwrap_or_else(PoisonError::into_inner);
            let work = of_lanes(&mut work).get_or_insert_with(Box::default);
            work.suit(self, shapes.mesh);
            let own = block * 3 * areas.len()..(block + 1) * 3 * areas.len();
            *failure = Arch::new().dispatch(Block {
                system: self,
                mesh: shapes.mesh,
                part: Part {
                    values: lanes_mut(values),
                    given: given[block * length..(block + 1) * length].as_chunks().0,
                    areas: lanes_mut(areas),
                    volume: &mut lanes_mut(volume)[0],
                    steps: &mut lanes_mut(steps)[0],
                    inside: lanes_mut(inside),
                    cells: (count - block * L).min(L),
                },
                shapes: (shapes.from[own.clone()].as_chunks().0, shapes.to[own].as_chunks().0),
                task,
                number: block,
                shown: lanes_mut(shown),
                work,
            });
        });
    }
}

fn lanes_mut<const L: usize>(numbers: &mut [f64]) -> &mut [[f64; L]] {
    numbers.as_chunks_mut().0
}

/// A block as an object with a method of its own: only so is all of it compiled for the wide registers.
struct Block<'a, const L: usize> {
    system: &'a MembraneSystem,
    mesh: &'a SurfaceMesh,
    part: Part<'a, L>,
    shapes: (&'a [[f64; L]], &'a [[f64; L]]),
    task: Task<'a>,
    number: usize,
    shown: &'a mut [[f64; L]],
    work: &'a mut Work<L>,
}

impl<const L: usize> WithSimd for Block<'_, L> {
    type Output = Option<Failure>;
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self { system, mesh, mut part, shapes, task, number: block, shown, work } = self;
        match task {
            Task::Begin(time) => {
                begin(simd, system, mesh, &mut part, shapes.1, time, work);
                None
            }
            Task::Show(number, time) => {
                display(simd, system, mesh, (&part, shown), shapes.1, (number, time), work);
                None
            }
            Task::Advance(course, pieces) => {
                advance(simd, system, mesh, &mut part, shapes, (&course, pieces, block), work)
            }
        }
    }
}

/// Where a number of a cell's inside stands.
fn index(cells: &MembraneCells, (pools, open): (usize, usize), cell: usize, number: usize) -> usize {
    (cell / cells.lanes * (pools + open) + number) * cells.lanes + cell % cells.lanes
}

fn gather(cells: &MembraneCells, from: &Population, first: usize, numbers: (usize, usize), inside: &mut Vec<f64>) {
    inside.clear();
    inside.resize(cells.blocks() * cells.lanes * (numbers.0 + numbers.1), 0.0);
    for cell in 0..cells.cells {
        for pool in 0..numbers.0 {
            inside[index(cells, numbers, cell, pool)] = from.state(first + cell, pool);
        }
        for open in 0..numbers.1 {
            inside[index(cells, numbers, cell, numbers.0 + open)] = from.open_value(first + cell, open);
        }
    }
}

fn scatter(cells: &MembraneCells, to: &mut Population, first: usize, numbers: (usize, usize), inside: &[f64]) {
    for cell in 0..cells.cells {
        for pool in 0..numbers.0 {
            to.set_state(first + cell, pool, inside[index(cells, numbers, cell, pool)]);
        }
        for open in 0..numbers.1 {
            to.set_open(first + cell, open, inside[index(cells, numbers, cell, numbers.0 + open)]);
        }
    }
}
