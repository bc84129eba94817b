//! The volumes where a step begins, and those that it is to end with.

use rayon::prelude::*;

use super::model::{Kind, Model, VolumeRule};
use super::state::State;
use super::workspace::{KindScratch, Workspace};
use crate::mechanics::volume;

/// Measures the volume and its gradient at the start of the step and sets the targets for its end. With contacts a volume
/// that is off its target already where the step begins (a target that jumps) approaches it as fast as contacts can follow.
pub fn measure_volumes(model: &Model, end: f64, state: &State, ws: &mut Workspace) {
    for ((kind, now), w) in model.kinds.iter().zip(&state.kinds).zip(&mut ws.kinds) {
        let factor = match &kind.volume {
            VolumeRule::Free => continue,
            VolumeRule::Exact(course) | VolumeRule::Compressible { course, .. } => course.at(end),
        };
        w.target.iter_mut().zip(&now.rest_volumes).for_each(|(target, rest)| *target = rest * factor);
        (w.gradient.par_chunks_exact_mut(kind.block_len()))
            .zip(now.positions.par_chunks_exact(kind.block_len()))
            .zip(w.volume.par_chunks_exact_mut(kind.lanes))
            .for_each(|((gradient, x), volumes)| {
                volume::measure_block(&kind.rest.facets, x, &kind.held, gradient, volumes);
            });
        if let (Some(contact), VolumeRule::Exact(course)) = (&model.contact, &kind.volume) {
            approach_targets(kind, course.at(state.time), contact.scene.safe_travel(), &now.rest_volumes, w);
        }
    }
}

/// The part of the travel that is safe for contacts which a volume may take when its target has jumped.
const SHARE_OF_TRAVEL: f64 = 0.25;

/// Puts the targets of cells whose volume was off its target already where the step begins, by `factor` times their rest
/// volume, only so far away that no atom has to move farther than a part of `travel` (µm) for that, eq. (volume.5).
fn approach_targets(kind: &Kind, factor: f64, travel: f64, rest_volumes: &[f64], w: &mut KindScratch) {
    for (lane, rest) in rest_volumes.iter().enumerate() {
        let off = rest * factor - w.volume[lane];
        // As good as always. No contact is so near that this would be too far.
        if off.abs() <= 1e-9 * rest {
            continue;
        }
        let (block, lane_of_block) = (lane / kind.lanes, lane % kind.lanes);
        let gradient = &w.gradient[block * kind.block_len()..][..kind.block_len()];
        let (mut squared, mut largest) = (0.0, 0.0f64);
        for atom in gradient.chunks_exact(3 * kind.lanes) {
            let own = (0..3).map(|axis| atom[axis * kind.lanes + lane_of_block].powi(2)).sum::<f64>();
            squared += own;
            largest = largest.max(own);
        }
        // Moved along the gradient g, atom i goes by g_i |off| / |g|².
        let most = SHARE_OF_TRAVEL * travel * squared / largest.sqrt();
        if off.abs() > most {
            w.target[lane] -= off - most.copysign(off);
        }
    }
}
