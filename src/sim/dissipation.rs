//! What viscous membranes have turned into heat, for the account of energy.

use rayon::prelude::*;

use super::model::Model;
use super::state::State;
use super::workspace::Workspace;
use crate::mechanics::lanes::LANES;

/// Adds what the step of `dt` (s) that led from one state to another has lost to viscosity, cell by cell: the power in the shape between both at the
/// mean velocities, eq. (viscosity.5).
pub fn note_dissipation(model: &Model, dt: f64, from: &State, to: &mut State, ws: &Workspace) {
    for ((kind, from), to) in model.kinds.iter().zip(&from.kinds).zip(&mut to.kinds) {
        let Some(viscosity) = &kind.viscosity else { continue };
        let (length, lanes) = (kind.block_len(), kind.lanes);
        let ends = from.positions.par_chunks_exact(length).zip(to.positions.par_chunks_exact(length));
        ends.zip(to.dissipated.par_chunks_mut(lanes)).for_each(|((start, end), dissipated)| {
            ws.buffers.enter(length, |[middle, gone, force, ..]| {
                for (number, (start, end)) in start.iter().zip(end).enumerate() {
                    (middle[number], gone[number], force[number]) = (0.5 * (start + end), end - start, 0.0);
                }
                viscosity.add_to(lanes, 1.0 / dt, [middle, gone], force);
                let mut lost = [0.0; LANES];
                for (force, gone) in force.chunks_exact(lanes).zip(gone.chunks_exact(lanes)) {
                    (0..lanes).for_each(|lane| lost[lane] += force[lane] * gone[lane]);
                }
                dissipated.iter_mut().zip(lost).for_each(|(dissipated, lost)| *dissipated += lost);
            });
        });
    }
}
