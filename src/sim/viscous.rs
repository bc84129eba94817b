//! What is viscous in the stages of the implicit step and not in their matrix, eqs. (viscosity.3) and (viscosity.4).

use super::kind::VolumeRule;
use super::solver::Stage;
use super::stages::{Block, Step};
use crate::mechanics::integrator::Order;
use crate::mechanics::lanes::LANES;
use crate::mechanics::volume;

impl Step<'_> {
    /// What volumes lack after the first stage of viscous cells, as the gradient has turned meanwhile, eq. (viscosity.4): what the projection leaves to
    /// be made exact it makes so along the gradient, and not as such cells give way.
    pub(super) fn bulged(&self, block: &Block, stage: Stage, gradient: &mut [f64]) -> [f64; LANES] {
        let (kind, mut lacking) = (self.kind, [0.0; LANES]);
        if stage == Stage::Second && kind.viscosity.is_some() && matches!(kind.volume, VolumeRule::Exact(_)) {
            let lanes = kind.lanes;
            volume::measure_block(&kind.rest.facets, block.x, &[], gradient, &mut lacking[..lanes]);
            (0..lanes).for_each(|lane| lacking[lane] = block.target[lane] - lacking[lane]);
        }
        lacking
    }

    /// Adds to the forces of a stage what is viscous and known before it, eq. (viscosity.3): in the second what the first stage has moved, and what
    /// moved atoms do in this one. The rest is in the matrix.
    pub(super) fn resist(&self, block: &Block, stage: Stage, y: &mut [f64], first: &[f64], spare: &mut [f64]) {
        let Some(viscosity) = &self.kind.viscosity else { return };
        let (lanes, per_step) = (self.kind.lanes, 1.0 / self.dt);
        if stage == Stage::Second {
            viscosity.add_to(lanes, -per_step, [block.start, first], y);
            viscosity.add_to(lanes, -per_step, [block.x, first], y);
        }
        if let Some(displacements) = &self.displacements {
            spare.fill(0.0);
            displacements.set_increments(stage, block.start, spare);
            viscosity.add_to(lanes, -per_step, [block.start, spare], y);
        }
    }

    /// Adds the mean over the step of what is viscous to the forces on held atoms, once the increments of the last stage are known.
    pub(super) fn resist_on_held(
        &self,
        block: &mut Block,
        stage: Stage,
        (y, first): (&[f64], &[f64]),
        spare: &mut [f64],
    ) {
        let (Some(viscosity), Some(on_held)) = (&self.kind.viscosity, &mut block.on_held) else { return };
        let (lanes, per_step) = (self.kind.lanes, 1.0 / self.dt);
        match (self.order, stage) {
            (Order::First, _) => viscosity.add_to(lanes, -per_step, [block.start, y], on_held),
            (Order::Second, Stage::First) => {}
            (Order::Second, Stage::Second) => {
                let both = first.iter().zip(y);
                spare.iter_mut().zip(both).for_each(|(moved, (first, y))| *moved = 1.5 * first + 0.5 * y);
                viscosity.add_to(lanes, -0.5 * per_step, [block.start, spare], on_held);
                viscosity.add_to(lanes, -0.5 * per_step, [block.x, spare], on_held);
            }
        }
    }
}
