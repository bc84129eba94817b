//! Populations whose system has events: each cell alone on the way that single solves take, window by window.

use rayon::prelude::*;

use super::course::{Course, LONGEST_SHARE};
use super::events::{EventMemory, EventPlan, Events};
use super::population::Population;
use super::stepper::Stepper;
use super::{OdeTrouble, Tolerances, Work};
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
}

/// A cell at the end of a window.
struct Arrived {
    state: Vec<f64>,
    open: Vec<f64>,
    pace: (f64, f64),
    memory: EventMemory,
    work: Work,
}

impl<'a> Eventful<'a> {
    /// Advances all cells through a window, as [`Population::advance`] does for systems without events. `memories`
    /// holds one entry a cell. Triggers that have turned true since the last window, because an open quantity was set
    /// or because nothing was before, fire at `from`; what is due at `until` is executed. A window of no length
    /// does only that.
    ///
    /// # Errors
    /// The cell of the smallest number that could not be advanced. Cells in trouble keep the state of the window's
    /// begin; all others have reached the end.
    ///
    /// # Panics
    /// When the population is of another program, or there is not one memory a cell.
    pub fn advance(
        &self,
        population: &mut Population,
        memories: &mut [EventMemory],
        from: f64,
        until: f64,
    ) -> Result<Work, OdeTrouble> {
        assert_eq!(memories.len(), population.cells(), "one memory a cell");
        let stepper = || {
            let mut stepper = Stepper::new(self.program, population.method(), self.tolerances, from);
            stepper.longest = LONGEST_SHARE * self.span;
            stepper
        };
        let one = |stepper: &mut Stepper<'a>, (cell, memory): (usize, &EventMemory)| {
            let state = (0..self.program.size()).map(|place| population.state(cell, place));
            let open = (0..self.program.open.len()).map(|place| population.given(cell, place));
            stepper.resume(from, state, open, population.pace(cell));
            self.one(stepper, memory, until).map_err(|trouble| OdeTrouble { cell: Some(cell), ..trouble })
        };
        let cells = memories.par_iter().enumerate();
        let arrived: Vec<_> = cells.map_init(stepper, one).collect();
        let (mut work, mut trouble) = (Work::default(), None);
        for ((cell, memory), arrived) in memories.iter_mut().enumerate().zip(arrived) {
            match arrived {
                Ok(arrived) => {
                    arrived.state.iter().enumerate().for_each(|(place, &x)| population.set_state(cell, place, x));
                    arrived.open.iter().enumerate().for_each(|(place, &x)| population.set_given(cell, place, x));
                    population.set_pace(cell, arrived.pace);
                    *memory = arrived.memory;
                    work.add(arrived.work);
                }
                Err(found) => trouble = trouble.or(Some(found)),
            }
        }
        trouble.map_or(Ok(work), Err)
    }

    /// One cell from the stepper's present until a time.
    fn one(&self, stepper: &mut Stepper<'a>, memory: &EventMemory, until: f64) -> Result<Arrived, OdeTrouble> {
        let mut events = Events::new(self.plan, memory.clone());
        Course::new(stepper, &mut events, until, &[], &mut |_, _| ()).run()?;
        Ok(Arrived {
            state: (0..self.program.size()).map(|place| stepper.state(place)).collect(),
            open: stepper.open.clone(),
            pace: stepper.pace(),
            memory: events.into_memory(),
            work: stepper.work,
        })
    }
}
