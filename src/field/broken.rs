//! A window of reactions, and where and when its values first stopped being numbers.

use std::sync::{Mutex, PoisonError};

use super::grid::Grid;
use super::react::Chunk;
use super::reactor::Reactor;
use super::species::Species;
use crate::error::{Error, short};

/// A value that a step of reactions made of finite ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Broken {
    /// The species.
    pub species: usize,
    /// Its value.
    pub value: f64,
    /// The largest value that the box had before.
    pub before: f64,
    /// The box.
    pub at: usize,
    /// Start of the step, s.
    pub time: f64,
    /// The step, s.
    pub dt: f64,
}

impl Broken {
    /// What the user is told.
    pub fn error(&self, document: &str, species: &[Species], grid: &Grid) -> Error {
        let (name, time, place) = (&species[self.species].name, short(self.time), grid.told(self.at));
        Error::Numbers {
            message: format!(
                "document '{document}': its reactions make field '{name}' {} at {place} µm, after t = {time} s",
                self.value
            ),
            help: "look for growth without bound, a division by zero or a root of a negative number; take smaller steps, or \
                   for stiff reactions scheme=\"rosenbrock\""
                .into(),
            kept: None,
        }
    }
}

/// A window of reactions.
pub struct Course<'a> {
    pub(super) reactor: &'a Reactor,
    pub(super) grid: &'a Grid,
    pub(super) inputs: &'a [f64],
    /// Whether steps that fail are taken again: then the shortest counts, and else the first.
    pub(super) adaptive: bool,
    pub(super) broken: Mutex<Option<Broken>>,
}

impl Course<'_> {
    /// Lets the boxes of a chunk react.
    pub fn react(&self, chunk: &mut Chunk) {
        let Some(found) = self.reactor.react(self.grid, self.inputs, chunk) else { return };
        // Which thread comes first must not matter. Where several boxes break at once, the largest value has led.
        let order = |one: &Broken| (if self.adaptive { one.dt } else { 0.0 }, one.time, -one.before, one.at);
        let mut broken = self.broken.lock().unwrap_or_else(PoisonError::into_inner);
        if broken.is_none_or(|known| order(&found) < order(&known)) {
            *broken = Some(found);
        }
    }

    /// The value that broke the window.
    pub fn broken(&self) -> Option<Broken> {
        *self.broken.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
