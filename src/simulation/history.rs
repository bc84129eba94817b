//! Series that are kept as a simulation goes.

use std::sync::Arc;

use super::id::CellId;

/// Series kept as a simulation goes, see [`Simulation::keep`](super::Simulation::keep).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct History {
    pub(super) names: Vec<String>,
    pub(super) every: f64,
    pub(super) times: Vec<f64>,
    /// For each time the cells that there were; times with the same cells share them.
    pub(super) cells: Vec<Arc<[CellId]>>,
    /// For each name, for each time: one number for each cell, or one of the scene.
    pub(super) values: Vec<Vec<Vec<f64>>>,
}

impl History {
    /// Names of the series.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The times at which they were kept, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The cells that there were at one of the times, in the order of the numbers of series.
    ///
    /// # Panics
    /// If there is no such time.
    pub fn cells(&self, time: usize) -> &[CellId] {
        &self.cells[time]
    }

    /// The numbers of a series: for each time one for each cell, or a single one of the scene; none for a series that was
    /// not kept.
    pub fn values(&self, name: &str) -> Option<&[Vec<f64>]> {
        self.names.iter().position(|known| known == name).map(|number| self.values[number].as_slice())
    }
}

/// Whether a multiple of `interval` lies in (before, after].
pub fn passed(before: f64, after: f64, interval: f64) -> bool {
    // The slack lets a clock that adds many steps reach a multiple that it misses by round-off.
    let count = |time: f64| (time / interval * (1.0 + 1e-12)).floor();
    count(after) > count(before)
}
