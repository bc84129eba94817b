//! What stands beside fields while these are solved by themselves, without a run.

use super::beside::Beside;
use super::scene::{Scene, ScenePace, SceneScratch};
use crate::ode::{EventMemory, Eventful, Method, Numbers, Population, Tolerances};

/// What stands beside fields, and all that is known of it.
#[derive(Debug, Clone)]
pub struct SceneCourse<'a> {
    beside: &'a Beside,
    population: Population,
    memories: Vec<EventMemory>,
    pace: ScenePace,
    scratch: SceneScratch,
    span: f64,
    numbers: Numbers<'a>,
}

impl<'a> SceneCourse<'a> {
    /// At its start at a time, for a course of so long, both in the document's unit of time.
    pub fn new(beside: &'a Beside, (start, span): (f64, f64), numbers: Numbers<'a>) -> Self {
        let (population, memories) = beside.start(Method::Rosenbrock, start);
        let (pace, scratch) = (ScenePace::default(), SceneScratch::default());
        Self { beside, population, memories, pace, scratch, span, numbers }
    }

    /// It, to be moved with the fields; see [`FieldSystem::advance_with`](super::FieldSystem::advance_with).
    pub fn now(&mut self) -> Scene<'_> {
        let Beside { program, plan, .. } = self.beside;
        let (tolerances, span, numbers) = (Tolerances::default(), self.span, self.numbers);
        Scene {
            eventful: Eventful { program, plan, tolerances, span, numbers },
            population: &mut self.population,
            memories: &mut self.memories,
            pace: &mut self.pace,
            scratch: &mut self.scratch,
        }
    }

    /// Adds its numbers at a time, those of [`Beside::quantities`] in their order.
    pub fn values(&self, time: f64, to: &mut Vec<f64>) {
        for &quantity in &self.beside.quantities {
            let mut value = [f64::NAN];
            self.population.observe(&self.beside.program, quantity, time, &mut value);
            to.extend(value);
        }
    }
}
