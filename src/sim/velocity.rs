//! The mean velocity of each cell over a step, which links read and frames record.

use rayon::prelude::*;

use super::model::Model;
use super::state::State;
use crate::mechanics::lanes::LANES;

/// Sets the mean velocity of the atoms of every cell over a step of `dt` (s).
pub fn measure_velocities(model: &Model, dt: f64, from: &State, to: &mut State) {
    for ((kind, from), to) in model.kinds.iter().zip(&from.kinds).zip(&mut to.kinds) {
        let (length, lanes, over) = (kind.block_len(), kind.lanes, kind.atoms() as f64 * dt);
        (to.mean_velocities.par_chunks_mut(lanes))
            .zip(to.positions.par_chunks_exact(length).zip(from.positions.par_chunks_exact(length)))
            .for_each(|(velocities, (end, start))| {
                let (end, start) = (sums(end, lanes), sums(start, lanes));
                for (lane, velocity) in velocities.iter_mut().enumerate() {
                    *velocity = [0, 1, 2].map(|axis| (end[axis][lane] - start[axis][lane]) / over);
                }
            });
    }
}

/// The sum of the vectors of the atoms of each cell of a block.
fn sums(values: &[f64], lanes: usize) -> [[f64; LANES]; 3] {
    let mut sums = [[0.0; LANES]; 3];
    for atom in values.chunks_exact(3 * lanes) {
        for (sum, row) in sums.iter_mut().zip(atom.chunks_exact(lanes)) {
            sum.iter_mut().zip(row).for_each(|(sum, value)| *sum += value);
        }
    }
    sums
}
