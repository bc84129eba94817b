//! What populations work in: kept from window to window so that nothing is allocated meanwhile, and never saved.

use std::sync::{Mutex, PoisonError};

use super::cells::{UNKNOWN, kept_numbers};
use super::course::CourseBuffers;
use super::events::{EventBuffers, EventPlan};
use super::memory::EventMemory;
use super::narrow::Narrow;
use super::pieces::PieceBuffers;
use super::scratch::Scratch;
use super::stepper::StepperBuffers;
use super::{Method, OdeTrouble, Work};
use crate::equations::program::{LANES, Lanes, Program};
use crate::random::Normals;

/// Scratch of a population. No result depends on what is in it: it may be poisoned, made anew or used for another population at any
/// time. It is cheapest when the same population uses it window after window.
#[derive(Debug, Default)]
pub struct PopulationScratch {
    /// What the buffers were made for.
    key: Option<Key>,
    /// One for each thread.
    pub(super) threads: Vec<Mutex<ThreadBuffers>>,
    /// Cells at the end of a window with events.
    pub(super) arrived: Vec<Arrived>,
    /// The same for cells that are advanced one by one.
    pub(super) narrow: Option<Box<Narrow>>,
    /// Rates at which cells left their last window, with what they were worked out from; empty where the rates read the clock or the
    /// method does not begin with those at the end of the step before. See [`Kept`](super::cells::Kept).
    pub(super) kept: Vec<Lanes<LANES>>,
    /// Registers for looking at quantities.
    pub(super) file: Vec<Lanes<LANES>>,
    /// Registers for strengths of noise, and whose numbers kick the variables.
    pub(super) kicks: Vec<Lanes<LANES>>,
    pub(super) normals: Vec<Normals>,
    /// What tells when the clock switches something.
    pub(super) clock: Option<PieceBuffers>,
}

/// What one thread works in.
#[derive(Debug, Default)]
pub(super) struct ThreadBuffers {
    /// Registers, stages and matrices of one block of cells.
    pub block: Option<Box<Scratch<LANES>>>,
    /// For a cell with events.
    pub single: CellBuffers,
}

/// A cell at the end of a window.
#[derive(Debug, Default)]
pub(super) struct Arrived {
    /// The number of the cell, for choices between its events.
    pub id: u32,
    pub state: Vec<f64>,
    pub open: Vec<f64>,
    pub pace: (f64, f64),
    pub memory: EventMemory,
    pub work: Work,
    /// When the first event was executed; infinite where none was.
    pub first_event: f64,
    pub trouble: Option<OdeTrouble>,
}

/// What one thread works in, a cell after the other.
#[derive(Debug, Default)]
pub(super) struct CellBuffers {
    pub stepper: Option<StepperBuffers>,
    pub course: CourseBuffers,
    pub events: EventBuffers,
}

/// The program, and whether its linear systems are solved.
type Key = (u64, bool);

impl Clone for PopulationScratch {
    /// Empty scratch: nothing in it outlasts a window.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl PopulationScratch {
    /// Makes the buffers fit so many blocks of cells of a program. Nothing is allocated where they do.
    pub(super) fn suit(&mut self, program: &Program, method: Method, blocks: usize) {
        let key = Some((program.mark, method.is_implicit()));
        if self.key != key {
            // Noise, which comes first in a window, brings a program of its own.
            let (kicks, normals) = (std::mem::take(&mut self.kicks), std::mem::take(&mut self.normals));
            *self = Self { key, kicks, normals, ..Self::default() };
        }
        if self.file.is_empty() {
            self.file = program.file();
        }
        let keeps = method.keeps_rates() && program.rates_stand_still;
        let length = if keeps { blocks * kept_numbers(program.size(), program.open.len()) } else { 0 };
        if self.kept.len() != length {
            self.kept.clear();
            self.kept.resize(length, [UNKNOWN; LANES]);
        }
    }

    /// Makes buffers for all threads.
    pub(super) fn suit_threads(&mut self) {
        let threads = rayon::current_num_threads().max(self.threads.len());
        self.threads.resize_with(threads, Mutex::default);
    }

    /// Makes buffers for so many cells with events, in which each of these can wait once and be executed.
    pub(super) fn suit_events(&mut self, program: &Program, plan: &EventPlan, cells: usize) {
        self.suit_threads();
        for own in &mut self.threads {
            own.get_mut().unwrap_or_else(PoisonError::into_inner).single.events.suit(plan, program);
        }
        self.arrived.resize_with(cells, Arrived::default);
        self.arrived.iter_mut().for_each(|arrived| plan.suit(&mut arrived.memory));
    }

    /// When a cell of the population whose window was the last executed its first event in it; infinite where it executed none.
    pub fn first_event(&self, cell: usize) -> f64 {
        self.arrived.get(cell).map_or(f64::INFINITY, |arrived| arrived.first_event)
    }

    /// Forgets everything.
    pub fn poison(&mut self) {
        *self = Self::default();
    }
}
