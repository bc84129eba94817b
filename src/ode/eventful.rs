//! Populations whose system has events: each cell by itself on the course that single solves take, window by window.

use std::sync::PoisonError;

use rayon::prelude::*;

use super::buffers::{Arrived, CellBuffers, PopulationScratch};
use super::course::{Course, LONGEST_SHARE};
use super::events::{Chooser, EventPlan, Events};
use super::memory::EventMemory;
use super::population::Population;
use super::stepper::{Stepper, StepperBuffers};
use super::switches::LOOKS_IN_WINDOW;
use super::{Numbers, OdeTrouble, Tolerances, Work};
use crate::equations::program::Program;

/// A system with events, and how it is advanced.
#[derive(Debug, Clone, Copy)]
pub struct Eventful<'a> {
    /// The equations, from [`EventPlan::compile`].
    pub program: &'a Program,
    /// The events.
    pub plan: &'a EventPlan,
    /// Tolerances of a method with an error estimate.
    pub tolerances: Tolerances,
    /// The whole time, of which windows are parts, in the system's unit: with events no step is longer than a fiftieth
    /// of it.
    pub span: f64,
    /// What chooses between events of one time and one priority.
    pub numbers: Numbers<'a>,
}

impl Eventful<'_> {
    /// Advances all cells through a window, as [`Population::advance`] does for systems without events. `memories`
    /// holds one entry a cell, `ids` one number a cell, which is never that of another. Triggers that have turned true since the last window, because an open quantity was set
    /// or because nothing was before, fire at `from`; what is due at `until` is executed. A window of no length
    /// does only that. Nothing is allocated after the first window with the same scratch, unless an event
    /// that waits fires again.
    ///
    /// # Errors
    /// The cell of the smallest number that could not be advanced. Cells in trouble keep the state of the window's
    /// begin; all others have reached the end.
    ///
    /// # Panics
    /// When the population is of another program, or there is not one memory and one number a cell.
    pub fn advance(
        &self,
        population: &mut Population,
        memories: &mut [EventMemory],
        ids: impl Iterator<Item = u64>,
        (from, until): (f64, f64),
        scratch: &mut PopulationScratch,
    ) -> Result<Work, OdeTrouble> {
        assert_eq!(memories.len(), population.cells(), "one memory a cell");
        scratch.suit(self.program, population.method(), population.blocks());
        scratch.suit_events(self.program, self.plan, memories.len());
        let PopulationScratch { threads, arrived, .. } = scratch;
        let mut given = 0;
        for (arrived, id) in arrived.iter_mut().zip(ids) {
            (arrived.id, given) = (id as u32, given + 1);
        }
        assert_eq!(given, memories.len(), "one number a cell");
        let before = &*population;
        arrived.par_iter_mut().zip(memories.par_iter()).enumerate().for_each(|(cell, (arrived, memory))| {
            let own = &threads[rayon::current_thread_index().unwrap_or(0)];
            let mut own = own.lock().unwrap_or_else(PoisonError::into_inner);
            arrived.memory.copy_from(memory);
            self.one(before, cell, (from, until), arrived, &mut own.single);
        });
        let (mut work, mut trouble) = (Work::default(), None);
        for (cell, (memory, arrived)) in memories.iter_mut().zip(arrived).enumerate() {
            if let Some(found) = arrived.trouble.take() {
                trouble = trouble.or(Some(OdeTrouble { cell: Some(cell), ..found }));
                continue;
            }
            arrived.state.iter().enumerate().for_each(|(position, &x)| population.set_state(cell, position, x));
            arrived.open.iter().enumerate().for_each(|(position, &x)| population.set_open(cell, position, x));
            population.set_pace(cell, arrived.pace);
            std::mem::swap(memory, &mut arrived.memory);
            work.add(arrived.work);
        }
        trouble.map_or(Ok(work), Err)
    }

    /// One cell through a window.
    fn one(
        &self,
        population: &Population,
        cell: usize,
        (from, until): (f64, f64),
        arrived: &mut Arrived,
        buffers: &mut CellBuffers,
    ) {
        let (program, method) = (self.program, population.method());
        let CellBuffers { stepper, course, events } = buffers;
        let known = stepper.take().unwrap_or_else(|| StepperBuffers::new(program, method.is_implicit()));
        let mut own = Stepper::within(known, program, method, self.tolerances);
        let state = (0..program.size()).map(|position| population.state(cell, position));
        let open = (0..program.open.len()).map(|position| population.open_value(cell, position));
        own.resume(from, state, open, population.pace(cell));
        own.longest = LONGEST_SHARE * self.span;
        let chooser = Chooser { choices: self.numbers.choices(), cell: arrived.id };
        let mut events = Events::new(self.plan, &mut arrived.memory, events, chooser);
        arrived.trouble =
            Course::new(&mut own, &mut events, (until, LOOKS_IN_WINDOW), &[], &mut |_, _| (), course).run().err();
        own.state_into(&mut arrived.state);
        arrived.open.clone_from(&own.open);
        (arrived.pace, arrived.work, arrived.first_event) = (own.pace(), own.work, own.first_event);
        *stepper = Some(own.into_buffers());
    }
}
