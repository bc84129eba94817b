//! A window of reactions.

use std::sync::{Mutex, PoisonError};

use super::broken::Broken;
use super::grid::Grid;
use super::react::Chunk;
use super::reactor::Reactor;

/// A window of reactions.
pub struct Course<'a> {
    reactor: &'a Reactor,
    grid: &'a Grid,
    inputs: &'a [f64],
    /// Whether steps that fail are taken again: then the shortest counts, and else the first.
    adaptive: bool,
    broken: Mutex<Option<Broken>>,
}

impl<'a> Course<'a> {
    /// A window with these inputs.
    pub fn new(reactor: &'a Reactor, grid: &'a Grid, inputs: &'a [f64], adaptive: bool) -> Self {
        Self { reactor, grid, inputs, adaptive, broken: Mutex::new(None) }
    }

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
