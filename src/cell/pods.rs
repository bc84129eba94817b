//! What a cell remembers of its pseudopods, what it is told, and what it tells of them.

use serde::{Deserialize, Serialize};

use crate::Vec3;

/// Pseudopods that a cell may have at once at most.
pub const MOST: usize = 4;

/// Room for those beside the first: for all that there are where a step begins, and for those that may begin in it in their stead.
pub const BESIDE: usize = 2 * MOST - 1;

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
    pub(super) const fn next(self) -> Self {
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
    /// Share of its front that touched other cells where the last step ended; 0 without contact inhibition.
    pub met: f64,
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
    /// Mean of the directions to the atoms that touched other cells where the last step ended; 0 without contact inhibition.
    pub touched: [f64; 3],
    /// What was done in the last step: by the pseudopod there was, by one that began, and by those beside.
    pub did: [Activity; BESIDE + 2],
}

impl Told {
    /// Nothing is told.
    pub const NOTHING: Self = Self { cue: [0.0; 3], protrusion: f64::NAN, retraction: f64::NAN };

    /// Both activities, where chemistry sets one of them.
    pub(super) fn activities(&self) -> Option<[f64; 2]> {
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
    pub(super) fn end(&mut self) -> EndedPseudopod {
        let lifetime = std::mem::take(&mut self.age);
        let &mut Self { direction, turn, side, alone, abandoned, .. } = self;
        EndedPseudopod { lifetime, direction, turn, side, alone, abandoned }
    }

    /// What it did in a step of which it was pushed for a share, or drawn for a share.
    pub(super) fn did(&self) -> Activity {
        Activity { direction: self.direction, number: self.number, ..Activity::default() }
    }

    /// Goes on for a part of the step, a share of the whole.
    pub(super) fn advance(&mut self, did: &mut Activity, part: f64, dt: f64) {
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

    /// What is left of all phases, and until another begins, s.
    pub(super) fn clocks(&self) -> impl Iterator<Item = f64> {
        [self.pod.left, self.wait].into_iter().chain(self.beside.iter().flatten().map(|pod| pod.left))
    }

    /// The pseudopods that are there.
    pub(super) fn there(&self) -> impl Iterator<Item = &Pod> {
        [&self.pod].into_iter().chain(self.beside.iter().flatten()).filter(|pod| pod.is_there())
    }
}
