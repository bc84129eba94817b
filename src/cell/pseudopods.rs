//! Pseudopods: a cell waits, pushes its surface out towards one side, and draws itself after while its rear lets go.
//!
//! The cycle pause, protrusion, retraction of Promayon 2008 §5.4.3 (figure 44) is an explicit machine. Its times are those of the type, or
//! chemistry sets both activities (Rac in front, RhoA behind). A new pseudopod splits off from the last one at an angle, to the other side
//! more often than to the same, or starts anew in any direction (Bosgraaf and van Haastert 2009); among what it may be, a cue makes a choice
//! likelier by e to the power of its part along the direction, eq. (pseudopods.1). Others may begin beside it, and some are given up,
//! eq. (pseudopods.10).

use serde::{Deserialize, Serialize};

use super::turning::{Turning, anywhere};
use crate::Vec3;
use crate::random::{Purpose, Stream};

/// Directions that a cell chooses from.
const CANDIDATES: usize = 8;

/// Pseudopods that a cell may have at once at most.
pub const MOST: usize = 4;

/// Room for those beside the first: for all that there are where a step begins, and for those that may begin in it in their stead.
pub const BESIDE: usize = 2 * MOST - 1;

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

/// What chemistry tells the pseudopods of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Told {
    /// What makes directions likelier, eq. (pseudopods.1).
    pub cue: [f64; 3],
    /// How much the front is pushed, from 0 to 1; NaN where the cycle's times say that.
    pub protrusion: f64,
    /// The same of retraction.
    pub retraction: f64,
}

/// Where the cycle of a cell is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// Nothing is pushed or drawn.
    Pause,
    /// The front is pushed out.
    Protrusion,
    /// The rear lets go and is drawn after.
    Retraction,
}

impl Phase {
    const fn next(self) -> Self {
        match self {
            Self::Pause => Self::Protrusion,
            Self::Protrusion => Self::Retraction,
            Self::Retraction => Self::Pause,
        }
    }
}

/// What one pseudopod did in a step, in the mean.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Activity {
    /// Unit vector to which it points.
    pub direction: [f64; 3],
    /// How much the front was pushed, from 0 to 1.
    pub protrusion: f64,
    /// How much front and rear were drawn together, from 0 to 1.
    pub retraction: f64,
    /// Its number among those of the cell.
    pub number: u32,
}

/// A pseudopod that has been pushed out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EndedPseudopod {
    /// How long it was pushed, s.
    pub lifetime: f64,
    /// Unit vector to which it pointed.
    pub direction: [f64; 3],
    /// Angle from the one before, rad; none of the first of a cell.
    pub turn: Option<f64>,
    /// The side to which it split off from the one before: 1 left, -1 right, 0 where it started anew.
    pub side: i8,
    /// Whether there was no other when it began.
    pub alone: bool,
    /// Whether it is given up: drawn in while its own front lets go.
    pub abandoned: bool,
}

/// One pseudopod, or what is left of the last one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pod {
    /// What it does.
    pub phase: Phase,
    /// What is left of it, s.
    pub left: f64,
    /// Unit vector to which it points.
    pub direction: [f64; 3],
    /// The side to which it split off: 1 left, -1 right, 0 where it started anew.
    pub side: i8,
    /// Its number among those of the cell, from 1.
    pub number: u32,
    /// How long it has been pushed, s.
    pub age: f64,
    /// Angle between it and the one that began before it, rad; none of the first.
    pub turn: Option<f64>,
    /// Whether there was no other when it began.
    pub alone: bool,
    /// Whether it is given up.
    pub abandoned: bool,
}

/// Where the pseudopods of one cell are.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PodState {
    /// The one that comes after pauses, or what is left of it while the cell waits.
    pub pod: Pod,
    /// Those that began while there was another.
    pub beside: [Option<Pod>; BESIDE],
    /// For how long there are yet to be some, and fewer than may be, until another begins, s; infinity where none ever does.
    pub wait: f64,
    /// Unit vector to which the one pointed that began last, and its side: what the next one splits off from.
    pub last: ([f64; 3], i8),
    /// Pseudopods so far.
    pub number: u32,
    /// Draws made so far.
    pub draws: u64,
    /// What was done in the last step: by the pseudopod there was, by one that began, and by those beside.
    pub did: [Activity; BESIDE + 2],
}

impl Told {
    /// Nothing is told.
    pub const NOTHING: Self = Self { cue: [0.0; 3], protrusion: f64::NAN, retraction: f64::NAN };

    /// Both activities, where chemistry sets one of them.
    fn activities(&self) -> Option<[f64; 2]> {
        let both = [self.protrusion, self.retraction];
        let or_none = |value: f64| if value.is_nan() { 0.0 } else { value };
        (!both.iter().all(|value| value.is_nan())).then(|| both.map(or_none))
    }
}

impl Pod {
    /// Whether it is there: it is pushed or drawn.
    fn is_there(&self) -> bool {
        self.phase != Phase::Pause
    }

    /// What is told of it when its protrusion ends.
    fn end(&mut self) -> EndedPseudopod {
        let lifetime = std::mem::take(&mut self.age);
        let &mut Self { direction, turn, side, alone, abandoned, .. } = self;
        EndedPseudopod { lifetime, direction, turn, side, alone, abandoned }
    }

    /// What it did in a step of which it was pushed for a share, or drawn for a share.
    fn did(&self) -> Activity {
        Activity { direction: self.direction, number: self.number, ..Activity::default() }
    }

    /// Goes on for a part of the step, a share of the whole.
    fn advance(&mut self, did: &mut Activity, part: f64, dt: f64) {
        match self.phase {
            Phase::Pause => {}
            Phase::Protrusion => {
                did.protrusion += part / dt;
                self.age += part;
            }
            Phase::Retraction => did.retraction += part / dt,
        }
        self.left -= part;
    }
}

impl PodState {
    /// How much each pseudopod lets its rear go now, from 0 to 1, and to where its front is. One that is given up lets its front go.
    pub fn releases(&self, told: &Told) -> impl Iterator<Item = (Vec3, f64)> {
        let of_first = match told.activities() {
            Some([_, retraction]) => retraction,
            None => f64::from(u8::from(self.pod.phase == Phase::Retraction)),
        };
        let front = |pod: &Pod| Vec3::from(pod.direction) * if pod.abandoned { -1.0 } else { 1.0 };
        let beside = self.beside.into_iter().flatten().filter(|pod| pod.phase == Phase::Retraction);
        [(front(&self.pod), of_first)].into_iter().chain(beside.map(move |pod| (front(&pod), 1.0)))
    }

    /// The pseudopods that are there.
    fn there(&self) -> impl Iterator<Item = &Pod> {
        [&self.pod].into_iter().chain(self.beside.iter().flatten()).filter(|pod| pod.is_there())
    }
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
            pod: Pod { phase, left, direction, side: 0, number: 0, age: 0.0, turn: None, alone, abandoned },
            beside: [None; BESIDE],
            wait: f64::INFINITY,
            last: (direction, 0),
            number: 0,
            draws: stream.draw,
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
        state.did[..2].fill(state.pod.did());
        if let Some([protrusion, retraction]) = told.activities() {
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

    /// Draws how long a phase lasts.
    fn duration(&self, seed: u64, cell: u64, phase: Phase, state: &mut PodState) -> f64 {
        let mut stream = Stream::new(seed, Purpose::Pseudopods, cell as u32, state.draws);
        let [vary, _] = stream.uniform_pair();
        state.draws = stream.draw;
        self.cycle.means[phase as usize] * (1.0 + self.cycle.variation * (2.0 * vary - 1.0))
    }

    /// Draws for how long there are to be pseudopods until another begins beside them: exponential.
    fn wait_anew(&self, seed: u64, cell: u64, state: &mut PodState) {
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
    fn gives_up(&self, seed: u64, cell: u64, told: &Told, state: &mut PodState, pod: &Pod) -> bool {
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
    fn begin(&self, seed: u64, cell: u64, told: &Told, state: &mut PodState) -> Pod {
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
        Pod { phase, left: 0.0, direction, side, number, age: 0.0, turn, alone, abandoned: false }
    }
}

#[cfg(test)]
#[path = "pseudopods_tests.rs"]
mod tests;
