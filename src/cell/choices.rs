//! What is left to chance about pseudopods: how long they last, when another begins, where it goes, whether it is given up.
//!
//! All draws of a cell are of one stream, counted in its state, so that they do not depend on steps, threads or a kill.

use super::pseudopods::{Phase, Pod, PodState, Pseudopods, Told};
use crate::Vec3;
use crate::random::{Purpose, Stream};

/// Directions that a cell chooses from.
pub(super) const CANDIDATES: usize = 8;

impl Pseudopods {
    /// Draws how long a phase lasts.
    pub(super) fn duration(&self, seed: u64, cell: u64, phase: Phase, state: &mut PodState) -> f64 {
        let mut stream = Stream::new(seed, Purpose::Pseudopods, cell as u32, state.draws);
        let [vary, _] = stream.uniform_pair();
        state.draws = stream.draw;
        self.cycle.means[phase as usize] * (1.0 + self.cycle.variation * (2.0 * vary - 1.0))
    }

    /// Draws for how long there are to be pseudopods until another begins beside them: exponential.
    pub(super) fn wait_anew(&self, seed: u64, cell: u64, state: &mut PodState) {
        if self.several.most < 2 || self.several.rate <= 0.0 {
            state.wait = f64::INFINITY;
            return;
        }
        let mut stream = Stream::new(seed, Purpose::Pseudopods, cell as u32, state.draws);
        let [draw, _] = stream.uniform_pair();
        state.draws = stream.draw;
        state.wait = -(1.0 - draw).ln() / self.several.rate;
    }

    /// Whether a pseudopod whose protrusion ends is given up, eq. (pseudopods.10).
    pub(super) fn gives_up(&self, seed: u64, cell: u64, told: &Told, state: &mut PodState, pod: &Pod) -> bool {
        let Some(abandon) = self.abandon else { return false };
        let cue = Vec3::from(told.cue);
        let worth = |pod: &Pod| cue.dot(&Vec3::from(pod.direction));
        let rivals = state.there().filter(|other| !other.abandoned || other.number == pod.number);
        let all: f64 = rivals.map(|other| (worth(other) - worth(pod)).exp()).sum();
        let mut stream = Stream::new(seed, Purpose::Pseudopods, cell as u32, state.draws);
        let [draw, _] = stream.uniform_pair();
        state.draws = stream.draw;
        draw >= (1.0 - abandon) / all.max(1.0)
    }

    /// A new pseudopod that begins now. Where it goes is chosen by eq. (pseudopods.1): the greatest of the parts along the cue with Gumbel's
    /// noise is a choice by those chances.
    pub(super) fn begin(&self, seed: u64, cell: u64, told: &Told, state: &mut PodState) -> Pod {
        let mut stream = Stream::new(seed, Purpose::Pseudopods, cell as u32, state.draws);
        let (alone, (last, side), cue) = (state.there().next().is_none(), state.last, Vec3::from(told.cue));
        let last = Vec3::from(last);
        let mut most = f64::NEG_INFINITY;
        for _ in 0..CANDIDATES {
            let (direction, side) = self.turning.draw(&last, side, &mut stream);
            let [noise, _] = stream.uniform_pair();
            let worth = cue.dot(&direction) - (-noise.max(f64::MIN_POSITIVE).ln()).ln();
            if worth > most {
                (most, state.last) = (worth, (direction.into(), side));
            }
        }
        let (direction, side) = state.last;
        let cosine = last.dot(&Vec3::from(direction)).clamp(-1.0, 1.0);
        let turn = (state.number > 0).then(|| cosine.acos());
        state.number += 1;
        state.draws = stream.draw;
        let (phase, number) = (Phase::Protrusion, state.number);
        Pod { phase, left: 0.0, direction, side, number, age: 0.0, turn, alone, abandoned: false, met: 0.0 }
    }
}
