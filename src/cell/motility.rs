//! Brownian motility: a cell crawls straight ahead for a random while, turns anywhere, and crawls on.
//!
//! The straight runs last exponentially distributed times, eq. (motility.1), and the directions are uniform, eq.
//! (motility.3) in the plane and eq. (motility.4) in the volume. A step may contain any number of turns: what
//! [`advance`] returns is the mean velocity over the step, eq. (motility.5), so the places at the ends of the steps are
//! those of the continuous walk whatever the step.

use crate::Vec3;
use crate::error::{Error, Fault, Result};
use crate::random::{self, Purpose};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Where the directions lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Space {
    /// In the plane z = 0: a cell that crawls on a substrate.
    Plane,
    /// On the sphere: a cell that swims or crawls in a gel.
    Volume,
}

/// How a type of cell wanders.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BrownianMotility {
    /// Speed along a run, µm/s; not negative.
    pub speed: f64,
    /// Persistence p, the mean duration of a run, s; positive.
    pub persistence: f64,
    /// Where the directions lie.
    pub space: Space,
}

impl BrownianMotility {
    /// Finds values that no walk can have.
    ///
    /// # Errors
    /// When the speed is negative or not finite, or the persistence not positive or not finite.
    pub fn check(&self) -> Result<()> {
        let mut faults = Vec::new();
        if !(self.speed.is_finite() && self.speed >= 0.0) {
            let found = format!("the speed of Brownian motility is {} µm/s", self.speed);
            faults.push(Fault::new(found).help("a finite speed that is not negative was expected"));
        }
        if !(self.persistence.is_finite() && self.persistence > 0.0) {
            let found = format!("the persistence of Brownian motility is {} s", self.persistence);
            faults.push(Fault::new(found).help("a finite positive time was expected"));
        }
        if faults.is_empty() { Ok(()) } else { Err(Error::Input(faults)) }
    }
}

/// Where one cell stands in its walk; part of the state of a simulation and all that a resumed walk needs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Walk {
    /// Unit direction of the run in progress.
    pub direction: [f64; 3],
    /// Time until this run ends, s.
    pub time_left: f64,
    /// Whole duration of this run, s.
    pub run_duration: f64,
    /// Number of random draws made; a run takes two, its duration and its direction.
    pub draws: u64,
}

/// The walk of a cell at time zero, its first run just begun.
///
/// Because exponential runs have no memory, a walk that begins with a fresh run is the stationary walk: its velocity
/// is correlated as eq. (motility.6) from the very start.
///
/// * `cell` – the lasting number of the cell, which with `seed` names its random numbers.
pub fn start(motility: &BrownianMotility, seed: u64, cell: u64) -> Walk {
    let mut walk = Walk { direction: [0.0; 3], time_left: 0.0, run_duration: 0.0, draws: 0 };
    begin_run(motility, seed, cell, &mut walk);
    walk
}

/// Moves a walk on by `dt` and returns the mean velocity over that time, µm/s, eq. (motility.5).
///
/// * `dt` – duration of the step, s; at zero the velocity of the moment is returned.
/// * `walk` – read and moved on.
/// * `ended` – called for each run that ends within the step: its duration, s, and the time of its end counted from
///   the beginning of the step, s.
pub fn advance(
    motility: &BrownianMotility,
    seed: u64,
    cell: u64,
    dt: f64,
    walk: &mut Walk,
    mut ended: impl FnMut(f64, f64),
) -> Vec3 {
    debug_assert!(motility.persistence > 0.0, "a walk of persistence 0 turns for ever; check() finds this");
    if walk.time_left > dt || dt <= 0.0 {
        walk.time_left -= dt.max(0.0);
        return motility.speed * Vec3::from(walk.direction);
    }
    let mut path = Vec3::zeros();
    let mut gone = 0.0;
    while walk.time_left <= dt - gone {
        path += walk.time_left * Vec3::from(walk.direction);
        gone += walk.time_left;
        ended(walk.run_duration, gone);
        begin_run(motility, seed, cell, walk);
    }
    let rest = dt - gone;
    path += rest * Vec3::from(walk.direction);
    walk.time_left -= rest;
    path * (motility.speed / dt)
}

/// Draws the duration and the direction of the next run.
fn begin_run(motility: &BrownianMotility, seed: u64, cell: u64, walk: &mut Walk) {
    let [latency, _] = random::uniform_pair(random::draw(seed, Purpose::Motility, cell, walk.draws));
    let bits = random::draw(seed, Purpose::Motility, cell, walk.draws + 1);
    walk.draws += 2;
    // ln_1p keeps the short runs exact, which ln(1 − r) would round.
    walk.run_duration = -motility.persistence * (-latency).ln_1p();
    walk.time_left = walk.run_duration;
    walk.direction = direction(motility.space, random::uniform_pair(bits));
}

/// The direction that two numbers uniform in [0, 1) choose, eq. (motility.3) or eq. (motility.4).
fn direction(space: Space, [first, second]: [f64; 2]) -> [f64; 3] {
    let (sine, cosine) = (TAU * first).sin_cos();
    match space {
        Space::Plane => [cosine, sine, 0.0],
        Space::Volume => {
            let height = 2.0 * second - 1.0;
            let radius = (1.0 - height * height).sqrt();
            [radius * cosine, radius * sine, height]
        }
    }
}

#[cfg(test)]
#[path = "motility_tests.rs"]
mod tests;
