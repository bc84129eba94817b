//! What forces are still out of balance where a step of a filled body ends, and how it settles by that, eq. (solids.8).

use super::kind::VolumeRule;
use super::pressure::constrain;
use super::scheme::{larger, root_mean_square};
use super::solver::{System, solve_turning};
use super::stages::{Block, Step};
use crate::mechanics::lanes::LANES;

/// What of the way that stiff shapes go to settle counts as an error: once they have gone it, another tenth of it is left at most.
const LEFT: f64 = 0.1;

impl Step<'_> {
    /// Whether what is out of balance at the end of a step is known before contacts and obstacles hold the body: obstacles push within the stages, and
    /// the matrix of what is viscous is that of the shape where the step begins.
    pub(super) fn settles(&self, block: &Block) -> bool {
        let kind = self.kind;
        let is_filled = !kind.tetrahedra.is_empty() && kind.tangent.is_some() && kind.viscosity.is_none();
        is_filled && block.second.is_none() && self.model.obstacles.is_empty()
    }

    /// Lets a block settle, and returns the error of the step, µm: that of the scheme as it is filtered, and a tenth of what was left of stiff
    /// shapes. `second` holds the increments of the second stage and `first` those of the first; both are overwritten.
    pub(super) fn settle(
        &self,
        block: &mut Block,
        (system, turning): (&System, &[f64]),
        (gradient, swell): (&[f64], &[f64]),
        [second, first, spare, spare2]: [&mut [f64]; 4],
    ) -> f64 {
        let (kind, lanes) = (self.kind, self.kind.lanes);
        let (estimate, y) = (first, second);
        estimate.iter_mut().zip(&*y).for_each(|(first, second)| *first = 0.5 * (*first + second));
        let (time, mut energy) = (self.start + self.dt, [0.0; LANES]);
        self.forces.on_block(block.number, time, (&*block.x, block.rest), (&mut *y, &mut energy[..lanes]), spare);
        let rate = 1.0 / system.mobility();
        let moved = block.x.iter().zip(block.start).zip(&*estimate);
        y.iter_mut().zip(moved).for_each(|(y, ((x, start), half))| *y -= rate * (x - start - half));
        self.give_way(block, (system, turning), (gradient, swell), y, [&mut *spare, &mut *spare2]);
        block.x.iter_mut().zip(&*y).for_each(|(x, y)| *x += y);
        system.filter(kind, (block.start, turning), estimate, spare, spare2);
        larger(root_mean_square(kind, estimate), LEFT * root_mean_square(kind, y))
    }

    /// Turns forces into the displacement that they cause, in place, with volumes kept where they are kept exactly.
    fn give_way(
        &self,
        block: &Block,
        (system, turning): (&System, &[f64]),
        (gradient, swell): (&[f64], &[f64]),
        y: &mut [f64],
        [spare, spare2]: [&mut [f64]; 2],
    ) {
        let (kind, lanes) = (self.kind, self.kind.lanes);
        solve_turning(kind, lanes, system, (block.start, turning), y, spare, spare2);
        if let VolumeRule::Exact(_) = kind.volume {
            let (wanted, mut pressure) = ([0.0; LANES], [0.0; LANES]);
            let gamma = super::scheme::gamma(kind, self.order);
            constrain(kind, gamma, gradient, swell, &wanted[..lanes], block.target, y, &mut pressure[..lanes]);
        }
    }
}
