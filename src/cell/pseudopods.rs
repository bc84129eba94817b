//! Pseudopods: a cell waits, pushes its surface out towards one side, and draws itself after while its rear lets go.
//!
//! The cycle pause, protrusion, retraction of Promayon 2008 §5.4.3 (figure 44) is an explicit machine. Its times are those of the type, or
//! chemistry sets both activities (Rac in front, RhoA behind). A new pseudopod splits off from the last one at an angle, to the other side
//! more often than to the same, or starts anew in any direction (Bosgraaf and van Haastert 2009); among what it may be, a cue makes a choice
//! likelier by e to the power of its part along the direction, eq. (pseudopods.1).

use serde::{Deserialize, Serialize};

use super::motility::Space;
use crate::Vec3;
use crate::random::{Purpose, Stream};

/// Directions that a cell chooses from.
const CANDIDATES: usize = 8;

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
    /// What of its adhesion the rear lets go meanwhile, from 0 to 1.
    pub release: f64,
    /// When the cycle goes on.
    pub cycle: Cycle,
    /// Where pseudopods go.
    pub turning: Turning,
}

/// How long the phases are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycle {
    /// Mean durations of pause, protrusion and retraction, s.
    pub means: [f64; 3],
    /// How far durations vary, over their mean, both ways; below 1.
    pub variation: f64,
}

/// Where a new pseudopod goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turning {
    /// Share of pseudopods that split off from the last.
    pub split: f64,
    /// Angle between such a one and the last, rad.
    pub angle: f64,
    /// Standard deviation of that angle, rad.
    pub spread: f64,
    /// Share of those that go to the other side than the last did.
    pub alternation: f64,
    /// Where directions may point.
    pub space: Space,
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
}

/// Where the pseudopods of one cell are.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PodState {
    /// What the cell does.
    pub phase: Phase,
    /// What is left of it, s.
    pub left: f64,
    /// Unit vector to which the present pseudopod points, or the last one.
    pub direction: [f64; 3],
    /// The side to which it split off: 1 left, -1 right, 0 where it started anew.
    pub side: i8,
    /// Pseudopods so far.
    pub number: u32,
    /// How long the present one has been pushed, s.
    pub age: f64,
    /// Angle between the present one, or the last, and the one before, rad; none of the first.
    pub turn: Option<f64>,
    /// Draws made so far.
    pub draws: u64,
    /// What was done in the last step: by the pseudopod there was, and by one that began.
    pub did: [Activity; 2],
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

impl PodState {
    /// How much the rear lets go now, from 0 to 1.
    pub fn releases(&self, told: &Told) -> f64 {
        match told.activities() {
            Some([_, retraction]) => retraction,
            None => f64::from(u8::from(self.phase == Phase::Retraction)),
        }
    }

    /// What is told of the present pseudopod when its protrusion ends.
    fn end(&mut self) -> EndedPseudopod {
        let lifetime = std::mem::take(&mut self.age);
        EndedPseudopod { lifetime, direction: self.direction, turn: self.turn, side: self.side }
    }
}

impl Pseudopods {
    /// The cell waits for its first pseudopod, at most for a whole cycle, so that cells do not go in step.
    pub fn start(&self, seed: u64, cell: u64) -> PodState {
        let mut stream = Stream::new(seed, Purpose::Pseudopods, cell as u32, 0);
        let [share, angle] = stream.uniform_pair();
        let [height, _] = stream.uniform_pair();
        PodState {
            phase: Phase::Pause,
            left: share * self.cycle.means.iter().sum::<f64>(),
            direction: anywhere(self.turning.space, angle, height).into(),
            side: 0,
            number: 0,
            age: 0.0,
            turn: None,
            draws: stream.draw,
            did: Default::default(),
        }
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
        state.did = [Activity { direction: state.direction, ..Activity::default() }; 2];
        if let Some([protrusion, retraction]) = told.activities() {
            let phase = match (protrusion > 0.0, retraction > 0.0) {
                (true, _) => Phase::Protrusion,
                (_, true) => Phase::Retraction,
                _ => Phase::Pause,
            };
            match (state.phase == Phase::Protrusion, phase == Phase::Protrusion) {
                (false, true) => self.begin(seed, cell, told, state),
                (true, false) => ended(state.end(), 0.0),
                _ => {}
            }
            state.phase = phase;
            state.age += if phase == Phase::Protrusion { dt } else { 0.0 };
            state.did[0] = Activity { direction: state.direction, protrusion, retraction };
            return;
        }
        let (mut left, mut one) = (dt, 0);
        loop {
            let part = left.min(state.left);
            let did = &mut state.did[one];
            match state.phase {
                Phase::Pause => {}
                Phase::Protrusion => {
                    did.protrusion += part / dt;
                    state.age += part;
                }
                Phase::Retraction => did.retraction += part / dt,
            }
            state.left -= part;
            left -= part;
            if state.left > 0.0 || left <= 0.0 {
                return;
            }
            if state.phase == Phase::Protrusion {
                ended(state.end(), dt - left);
            }
            state.phase = state.phase.next();
            let mut stream = Stream::new(seed, Purpose::Pseudopods, cell as u32, state.draws);
            let [vary, _] = stream.uniform_pair();
            state.draws = stream.draw;
            state.left = self.cycle.means[state.phase as usize] * (1.0 + self.cycle.variation * (2.0 * vary - 1.0));
            if state.phase == Phase::Protrusion {
                self.begin(seed, cell, told, state);
                one = 1;
                state.did[1].direction = state.direction;
            }
        }
    }

    /// Chooses where a new pseudopod goes, eq. (pseudopods.1): the greatest of the parts along the cue with Gumbel's noise is a choice by
    /// those chances.
    fn begin(&self, seed: u64, cell: u64, told: &Told, state: &mut PodState) {
        let mut stream = Stream::new(seed, Purpose::Pseudopods, cell as u32, state.draws);
        let (last, side, cue) = (Vec3::from(state.direction), state.side, Vec3::from(told.cue));
        let mut most = f64::NEG_INFINITY;
        for _ in 0..CANDIDATES {
            let (direction, side) = self.turning.draw(&last, side, &mut stream);
            let [noise, _] = stream.uniform_pair();
            let worth = cue.dot(&direction) - (-noise.max(f64::MIN_POSITIVE).ln()).ln();
            if worth > most {
                (most, state.direction, state.side) = (worth, direction.into(), side);
            }
        }
        let cosine = last.dot(&Vec3::from(state.direction)).clamp(-1.0, 1.0);
        state.turn = (state.number > 0).then(|| cosine.acos());
        state.number += 1;
        state.draws = stream.draw;
    }
}

impl Turning {
    /// One direction that a new pseudopod may take, and to which side of the last that is.
    fn draw(&self, last: &Vec3, side: i8, stream: &mut Stream) -> (Vec3, i8) {
        let [[splits, turns], [angle, height], [radius, phase]] = [(); 3].map(|()| stream.uniform_pair());
        if splits >= self.split {
            return (anywhere(self.space, angle, height), 0);
        }
        let other = if side == 0 { if angle < 0.5 { 1 } else { -1 } } else { -side };
        let side = if turns < self.alternation { other } else { -other };
        let normal = (-2.0 * (1.0 - radius).ln()).sqrt() * (std::f64::consts::TAU * phase).cos();
        let (sine, cosine) = (self.angle + self.spread * normal).sin_cos();
        let across = match self.space {
            Space::Plane => f64::from(side) * Vec3::new(-last.y, last.x, 0.0),
            Space::Volume => {
                let any = if last.x.abs() < 0.7 { Vec3::x() } else { Vec3::y() };
                let one = last.cross(&any).normalize();
                let (sine, cosine) = (std::f64::consts::TAU * height).sin_cos();
                cosine * one + sine * last.cross(&one)
            }
        };
        ((cosine * last + sine * across).normalize(), side)
    }
}

/// A direction by two numbers uniform in [0, 1).
fn anywhere(space: Space, angle: f64, height: f64) -> Vec3 {
    let (sine, cosine) = (std::f64::consts::TAU * angle).sin_cos();
    match space {
        Space::Plane => Vec3::new(cosine, sine, 0.0),
        Space::Volume => {
            let z = 2.0 * height - 1.0;
            let across = (1.0 - z * z).sqrt();
            Vec3::new(across * cosine, across * sine, z)
        }
    }
}

#[cfg(test)]
#[path = "pseudopods_tests.rs"]
mod tests;
