//! What is measured of a simulation at one instant.

use super::error::SimulationError;
use super::id::CellId;
use crate::output::{Frame, Layout};

/// All that is measured at one instant, apart from the simulation: it can be kept, or sent to another thread.
#[derive(Debug, Clone)]
pub struct Snapshot {
    pub(super) layout: Layout,
    pub(super) frame: Frame,
}

impl Snapshot {
    /// Simulated time, s.
    pub fn time(&self) -> f64 {
        self.frame.time
    }

    /// Steps made.
    pub fn steps(&self) -> u64 {
        self.frame.step
    }

    /// The cells that there were, in the order of positions and series.
    pub fn cells(&self) -> impl ExactSizeIterator<Item = CellId> + '_ {
        self.frame.cells.iter().map(|cell| CellId::new(cell.id))
    }

    /// Positions of all atoms, µm, in the order of [`Simulation::positions_into`](super::Simulation::positions_into).
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.frame.positions
    }

    /// A series, as [`Simulation::series`](super::Simulation::series) has it.
    ///
    /// # Errors
    /// [`SimulationError::Unknown`] for a name that is not among [`Simulation::series_infos`](super::Simulation::series_infos).
    pub fn series(&self, name: &str) -> Result<Vec<f64>, SimulationError> {
        self.frame.series(&self.layout, name).ok_or_else(|| unknown(&self.layout, name))
    }
}

/// The error of a series that is not there.
pub(super) fn unknown(layout: &Layout, name: &str) -> SimulationError {
    let known = layout.series().into_iter().map(|info| info.name).collect();
    SimulationError::Unknown { what: "series", name: name.to_owned(), known }
}
