//! The volumes where a step begins, and those that it is to end with.

use rayon::prelude::*;

use super::kind::{Kind, VolumeRule};
use super::model::Model;
use super::state::State;
use super::workspace::Workspace;
use crate::mechanics::volume;

/// Measures the volumes at the start of the step and sets the targets for its end.
pub fn measure_volumes(model: &Model, end: f64, state: &State, ws: &mut Workspace) {
    let Workspace { kinds, buffers, .. } = ws;
    for ((kind, now), w) in model.kinds.iter().zip(&state.kinds).zip(kinds) {
        let Some(targets) = Targets::of(model, kind, [state.time, end]) else { continue };
        let (length, lanes) = (kind.block_len(), kind.lanes);
        (now.positions.par_chunks_exact(length).zip(now.rest_volumes.par_chunks_exact(lanes)))
            .zip(w.volume.par_chunks_exact_mut(lanes).zip(w.target.par_chunks_exact_mut(lanes)))
            .for_each(|((x, rest), (volume, target))| {
                buffers.enter(length, |[gradient, ..]| targets.on_block(x, rest, gradient, volume, target));
            });
    }
}

/// What the volumes of a kind are to be where a step ends.
pub struct Targets<'a> {
    kind: &'a Kind,
    /// Over the rest volumes.
    factor: f64,
    /// With contacts: what they are to be where the step begins, over the rest volumes, and the travel that is safe, µm.
    approach: Option<(f64, f64)>,
}

/// The part of the travel that is safe for contacts which a volume may take when its target has jumped.
const SHARE_OF_TRAVEL: f64 = 0.25;

impl<'a> Targets<'a> {
    /// Those of a step from one time to another; none of a kind whose volume is free.
    pub fn of(model: &Model, kind: &'a Kind, [start, end]: [f64; 2]) -> Option<Self> {
        let (course, is_exact) = match &kind.volume {
            VolumeRule::Free => return None,
            VolumeRule::Exact(course) => (course, true),
            VolumeRule::Compressible { course, .. } => (course, false),
        };
        let contact = model.contact.as_ref().filter(|_| is_exact);
        let approach = contact.map(|contact| (course.at(start), contact.reach.safe_travel()));
        Some(Self { kind, factor: course.at(end), approach })
    }

    /// Measures the volumes of a block and their gradient where the step begins, and sets the targets. With contacts a volume that is off
    /// its target already there (a target that jumps) approaches it as fast as contacts can follow.
    pub fn on_block(&self, x: &[f64], rest: &[f64], gradient: &mut [f64], volume: &mut [f64], target: &mut [f64]) {
        volume::measure_block(&self.kind.rest.facets, x, &self.kind.held, gradient, volume);
        for (lane, (target, rest)) in target.iter_mut().zip(rest).enumerate() {
            *target = rest * self.factor;
            let Some((factor, travel)) = self.approach else { continue };
            let off = rest * factor - volume[lane];
            // As good as always. No contact is so near that this would be too far.
            if off.abs() > 1e-9 * rest {
                let most = SHARE_OF_TRAVEL * travel * self.change_over_travel(gradient, lane);
                *target -= if off.abs() > most { off - most.copysign(off) } else { 0.0 };
            }
        }
    }

    /// By how much a volume changes, to first order, over the displacement of the atom that goes farthest when all move along the gradient, µm²,
    /// eq. (volume.5).
    fn change_over_travel(&self, gradient: &[f64], lane: usize) -> f64 {
        let (mut squared, mut largest) = (0.0, 0.0f64);
        for atom in gradient.chunks_exact(3 * self.kind.lanes) {
            let own = (0..3).map(|axis| atom[axis * self.kind.lanes + lane].powi(2)).sum::<f64>();
            squared += own;
            largest = largest.max(own);
        }
        // Moved along the gradient g, atom i goes by g_i |off| / |g|².
        squared / largest.sqrt()
    }
}
