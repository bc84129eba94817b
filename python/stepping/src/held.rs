//! A simulation and the positions that Python was shown of it.

use std::sync::Arc;

use pseudopod::{Simulation, SimulationError};

/// What is behind the lock.
pub struct Held {
    pub simulation: Simulation,
    /// The positions of this instant, if `is_shown`, and those that were shown before.
    positions: [Arc<Vec<[f64; 3]>>; 2],
    is_shown: bool,
}

impl Held {
    pub fn new(simulation: Simulation) -> Self {
        Self { simulation, positions: Default::default(), is_shown: false }
    }

    /// The simulation, to be changed: atoms may be elsewhere afterwards.
    pub fn moved(&mut self) -> &mut Simulation {
        self.is_shown = false;
        &mut self.simulation
    }

    /// The positions of this instant, µm. They are written once for each instant in which somebody looks, into memory that no array
    /// shows any more, or else into new.
    pub fn positions(&mut self) -> Result<Arc<Vec<[f64; 3]>>, SimulationError> {
        if !self.is_shown {
            self.positions.swap(0, 1);
            let atoms = self.simulation.atom_count();
            if Arc::get_mut(&mut self.positions[0]).is_none() {
                self.positions[0] = Arc::default();
            }
            // A new one is held here alone, and so nothing is copied.
            let now = Arc::make_mut(&mut self.positions[0]);
            now.resize(atoms, [0.0; 3]);
            self.simulation.positions_into(now)?;
            self.is_shown = true;
        }
        Ok(self.positions[0].clone())
    }
}
