//! Pseudopods: a cell waits, pushes its surface out towards one side, and draws itself after while its rear lets go.
//!
//! The cycle pause, protrusion, retraction of Promayon 2008 §5.4.3 (figure 44) is an explicit machine. Its times are those of the type, or
//! chemistry sets both activities (Rac in front, RhoA behind). A new pseudopod splits off from the last one at an angle, to the other side
//! more often than to the same, or starts anew in any direction (Bosgraaf and van Haastert 2009); among what it may be, a cue makes a choice
//! likelier by e to the power of its part along the direction, eq. (pseudopods.1). Others may begin beside it, and some are given up,
//! eq. (pseudopods.10).

use super::inhibition::Inhibition;
use super::turning::{Turning, anywhere};
use crate::random::{Purpose, Stream};

pub use super::pods::{Activity, BESIDE, EndedPseudopod, MOST, Phase, Pod, PodState, Told};

/// What pseudopods of a kind do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pseudopods {
    /// Pressure on the surface at the axis of a pseudopod, pN/µm².
    pub pressure: f64,
    /// Cosine of half the opening of the cone in which the surface is pushed.
    pub least_cosine: f64,
    /// How far the front gets ahead of a ball of the cell's volume until no pressure is left, µm; infinity where it stays.
    pub reach: f64,
    /// Tension between front and rear while a pseudopod retracts, pN.
    pub contraction: f64,
    /// Fibres that draw front and rear together in place of that tension, if there are any.
    pub fibres: Option<PodFibres>,
    /// What of its adhesion the rear lets go meanwhile, from 0 to 1.
    pub release: f64,
    /// When the cycle goes on.
    pub cycle: Cycle,
    /// Where pseudopods go.
    pub turning: Turning,
    /// How many there are at once.
    pub several: Several,
    /// Share of those that are given up when their protrusion ends, where any are, eq. (pseudopods.10).
    pub abandon: Option<f64>,
    /// What the cell makes of meeting others.
    pub inhibition: Option<Inhibition>,
}

/// How many pseudopods there are at once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Several {
    /// How many at most, up to [`MOST`].
    pub most: usize,
    /// How often another begins while there are some and not so many, 1/s.
    pub rate: f64,
}

impl Several {
    /// One after the other.
    pub const ONE: Self = Self { most: 1, rate: 0.0 };
}

/// The fibres that a pseudopod makes while it retracts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PodFibres {
    /// How many.
    pub number: usize,
    /// Stiffness of each at full activation, pN/µm.
    pub stiffness: f64,
}

/// How long the phases are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycle {
    /// Mean durations of pause, protrusion and retraction, s.
    pub means: [f64; 3],
    /// How far durations vary, over their mean, both ways; below 1.
    pub variation: f64,
}

impl Pseudopods {
    /// The cell waits for its first pseudopod, at most for a whole cycle, so that cells do not go in step.
    pub fn start(&self, seed: u64, cell: u64) -> PodState {
        let mut stream = Stream::new(seed, Purpose::Pseudopods, cell as u32, 0);
        let [share, angle] = stream.uniform_pair();
        let [height, _] = stream.uniform_pair();
        let direction = anywhere(self.turning.space, angle, height).into();
        let left = share * self.cycle.means.iter().sum::<f64>();
        let (phase, alone, abandoned) = (Phase::Pause, true, false);
        let mut state = PodState {
            pod: Pod { phase, left, direction, side: 0, number: 0, age: 0.0, turn: None, alone, abandoned, met: 0.0 },
            beside: [None; BESIDE],
            wait: f64::INFINITY,
            last: (direction, 0),
            number: 0,
            draws: stream.draw,
            touched: [0.0; 3],
            did: Default::default(),
        };
        self.wait_anew(seed, cell, &mut state);
        state
    }

    /// Goes on by `dt` (s); at zero nothing changes. `ended(pseudopod, offset)` is told of every one whose protrusion ends, `offset` seconds
    /// after the start.
    pub fn advance(
        &self,
        seed: u64,
        cell: u64,
        told: &Told,
        state: &mut PodState,
        dt: f64,
        mut ended: impl FnMut(EndedPseudopod, f64),
    ) {
        if dt <= 0.0 {
            return;
        }
        state.did = Default::default();
        let told = &self.inhibition.map_or(*told, |inhibition| inhibition.heed(told, state));
        let stopped = self.stop_fronts(seed, cell, state, |pod| ended(pod, 0.0));
        state.did[..2].fill(state.pod.did());
        if let Some([protrusion, retraction]) = told.activities() {
            // A front that was stopped is not pushed on; if one is still to be pushed, that is another, in the next step.
            let protrusion = if stopped { 0.0 } else { protrusion };
            return self.follow(seed, cell, told, state, (dt, [protrusion, retraction]), ended);
        }
        let (mut left, mut one) = (dt, 0);
        loop {
            let waits = state.pod.phase == Phase::Pause && state.there().next().is_some();
            let may_begin = self.may_begin(state);
            let clocks = [(state.pod.left, !waits), (state.wait, may_begin)];
            let clocks = clocks.into_iter().chain(state.beside.iter().flatten().map(|pod| (pod.left, true)));
            let part = clocks.filter(|(_, runs)| *runs).fold(left, |part, (clock, _)| part.min(clock));
            let PodState { pod, beside, wait, did, .. } = state;
            if !waits {
                pod.advance(&mut did[one], part, dt);
            }
            for (pod, did) in beside.iter_mut().zip(&mut did[2..]) {
                if let Some(pod) = pod {
                    (did.direction, did.number) = (pod.direction, pod.number);
                    pod.advance(did, part, dt);
                }
            }
            *wait -= if may_begin { part } else { 0.0 };
            left -= part;
            if left <= 0.0 {
                return;
            }
            if !waits && state.pod.left <= 0.0 {
                one = self.go_on(seed, cell, told, state, one, |pod| ended(pod, dt - left));
            }
            self.go_on_beside(seed, cell, told, state, |pod| ended(pod, dt - left));
            if may_begin && state.wait <= 0.0 {
                self.begin_beside(seed, cell, told, state);
            }
        }
    }

    /// Gives up those that have met other cells: their fronts let go, and they are drawn in. Whether the first is one of them.
    fn stop_fronts(&self, seed: u64, cell: u64, state: &mut PodState, mut ended: impl FnMut(EndedPseudopod)) -> bool {
        let (Some(Inhibition { share, .. }), mut first) = (self.inhibition, false) else { return false };
        for slot in 0..=state.beside.len() {
            let beside = slot.checked_sub(1);
            let pod = beside.map_or(Some(state.pod), |slot| state.beside[slot]);
            let Some(mut pod) = pod.filter(|pod| pod.phase == Phase::Protrusion && pod.met >= share) else { continue };
            pod.abandoned = true;
            ended(pod.end());
            (pod.phase, pod.left) = (Phase::Retraction, self.duration(seed, cell, Phase::Retraction, state));
            match beside {
                Some(slot) => state.beside[slot] = Some(pod),
                None => (state.pod, first) = (pod, true),
            }
        }
        first
    }

    /// What chemistry sets of the activities is what a single pseudopod does.
    fn follow(
        &self,
        seed: u64,
        cell: u64,
        told: &Told,
        state: &mut PodState,
        (dt, [protrusion, retraction]): (f64, [f64; 2]),
        mut ended: impl FnMut(EndedPseudopod, f64),
    ) {
        let phase = match (protrusion > 0.0, retraction > 0.0) {
            (true, _) => Phase::Protrusion,
            (_, true) => Phase::Retraction,
            _ => Phase::Pause,
        };
        state.beside = [None; BESIDE];
        match (state.pod.phase == Phase::Protrusion, phase == Phase::Protrusion) {
            (false, true) => {
                let begun = self.begin(seed, cell, told, state);
                state.pod = Pod { left: state.pod.left, ..begun };
            }
            (true, false) => {
                let pod = state.pod;
                state.pod.abandoned = self.gives_up(seed, cell, told, state, &pod);
                ended(state.pod.end(), 0.0);
            }
            _ => {}
        }
        state.pod.phase = phase;
        state.pod.age += if phase == Phase::Protrusion { dt } else { 0.0 };
        state.did[0] = Activity { protrusion, retraction, ..state.pod.did() };
        state.did[1] = state.pod.did();
    }

    /// Lets the pseudopod that comes after pauses enter its next phase; returns which of its activities is meant from now on.
    fn go_on(
        &self,
        seed: u64,
        cell: u64,
        told: &Told,
        state: &mut PodState,
        one: usize,
        mut ended: impl FnMut(EndedPseudopod),
    ) -> usize {
        if state.pod.phase == Phase::Protrusion {
            let pod = state.pod;
            state.pod.abandoned = self.gives_up(seed, cell, told, state, &pod);
            ended(state.pod.end());
        }
        let phase = state.pod.phase.next();
        let left = self.duration(seed, cell, phase, state);
        (state.pod.phase, state.pod.left) = (phase, left);
        if phase != Phase::Protrusion {
            return one;
        }
        // It waited until there was no other.
        state.pod.phase = Phase::Pause;
        state.pod = Pod { left, ..self.begin(seed, cell, told, state) };
        state.did[1] = state.pod.did();
        1
    }

    /// The same for those beside it: they are gone when they have been drawn in.
    fn go_on_beside(
        &self,
        seed: u64,
        cell: u64,
        told: &Told,
        state: &mut PodState,
        mut ended: impl FnMut(EndedPseudopod),
    ) {
        for slot in 0..state.beside.len() {
            let Some(mut pod) = state.beside[slot].filter(|pod| pod.left <= 0.0) else { continue };
            state.beside[slot] = None;
            if pod.phase == Phase::Protrusion {
                state.beside[slot] = Some(pod);
                pod.abandoned = self.gives_up(seed, cell, told, state, &pod);
                ended(pod.end());
                let left = self.duration(seed, cell, Phase::Retraction, state);
                (pod.phase, pod.left) = (Phase::Retraction, left);
                state.beside[slot] = Some(pod);
            }
        }
    }

    /// Whether another may begin now beside those that there are.
    fn may_begin(&self, state: &PodState) -> bool {
        (1..self.several.most).contains(&state.there().count()) && Self::free_slot(state).is_some()
    }

    /// Where one beside is kept: what was used in the step is not used again in it, so that each activity is that of one pseudopod.
    fn free_slot(state: &PodState) -> Option<usize> {
        (0..state.beside.len()).find(|slot| state.beside[*slot].is_none() && state.did[2 + slot].number == 0)
    }

    /// Lets one begin beside those that there are.
    fn begin_beside(&self, seed: u64, cell: u64, told: &Told, state: &mut PodState) {
        let Some(slot) = Self::free_slot(state) else { return };
        let left = self.duration(seed, cell, Phase::Protrusion, state);
        state.beside[slot] = Some(Pod { left, ..self.begin(seed, cell, told, state) });
        self.wait_anew(seed, cell, state);
    }
}

#[cfg(test)]
#[path = "pseudopods_tests.rs"]
mod tests;
