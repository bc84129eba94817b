//! What stands beside fields, as it is moved, and what it is moved in.

use super::beside::PartSum;
use crate::ode::{EventMemory, Eventful, Population, PopulationScratch};

/// What stands beside fields while they are moved.
#[derive(Debug)]
pub struct Scene<'a> {
    /// How it is solved; its program and its events are those of [`Beside`].
    pub eventful: Eventful<'a>,
    /// A population of one.
    pub population: &'a mut Population,
    /// What it knows of its events; empty where it has none.
    pub memories: &'a mut [EventMemory],
    /// The pace of the last window, to be kept with the rest.
    pub pace: &'a mut ScenePace,
    /// What it works in.
    pub scratch: &'a mut SceneScratch,
}

/// The step that is tried next, and the last one of the fields in it, s; 0 where none is known.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct ScenePace {
    /// The step of both together.
    pub step: f64,
    /// The step of the fields.
    pub inner: f64,
}

/// What fields and what stands beside them work in. It says nothing about either.
#[derive(Debug, Clone, Default)]
pub struct SceneScratch {
    pub(super) solver: PopulationScratch,
    /// Where a step begins, what is tried, and where the step came to in one piece.
    pub(super) before: Kept,
    pub(super) trial: Kept,
    pub(super) whole: Kept,
    /// The fields where half a step begins whose sums are looked at in its middle.
    pub(super) middle: Vec<f64>,
    pub(super) sums: Vec<PartSum>,
    pub(super) totals: Vec<f64>,
    pub(super) totals_after: Vec<f64>,
    pub(super) set: Vec<f64>,
}

/// A state of both, or what there is of it.
#[derive(Debug, Clone, Default)]
pub(super) struct Kept {
    pub population: Option<Population>,
    pub memories: Vec<EventMemory>,
    pub values: Vec<f64>,
    pub inputs: Vec<f64>,
    pub sizes: Vec<[f64; 2]>,
}

impl Kept {
    pub fn take(&mut self, population: &Population, memories: &[EventMemory]) {
        match &mut self.population {
            Some(kept) => kept.copy_from(population),
            None => self.population = Some(population.clone()),
        }
        if self.memories.len() != memories.len() {
            self.memories = memories.to_vec();
        }
        self.memories.iter_mut().zip(memories).for_each(|(to, from)| to.copy_from(from));
    }

    pub fn population(&self) -> &Population {
        self.population.as_ref().expect("it was taken")
    }
}
