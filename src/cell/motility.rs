//! Brownian persistence: a cell keeps its direction for a while, then takes another at random.
//!
//! A run lasts `t = −p ln(1 − r)`, eq. (motility.1), p the persistence and r uniform in [0, 1); then the direction is
//! uniform on the circle or the sphere. With speed v this is exactly Fürth's walk,
//! `MSD(t) = 2 v² p (t − p (1 − e^{−t/p}))`, eq. (motility.2). A step may hold any number of turns: the mean velocity over it
//! is the integral of the walk, so that positions do not depend on the step.
//! Source: Promayon 2008 §5.4.1; Fürth 1920.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Vec3;
use crate::random::{Purpose, Stream};

/// Where the directions of motility lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Space {
    /// In the plane x, y.
    #[default]
    Plane,
    /// Anywhere on the sphere.
    Volume,
}

impl Space {
    /// Number of axes along which directions and distances have a part.
    pub const fn axes(self) -> usize {
        match self {
            Self::Plane => 2,
            Self::Volume => 3,
        }
    }
}

/// The walk of a kind of cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BrownianMotility {
    /// Speed, µm/s.
    pub speed: f64,
    /// Persistence p, the mean duration of a run, s.
    pub persistence: f64,
    /// Where directions may point.
    pub space: Space,
}

/// Where the walk of one cell is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Walk {
    /// Unit direction of the run.
    pub direction: [f64; 3],
    /// Whole duration of the run, s.
    pub duration: f64,
    /// What is left of it, s.
    pub left: f64,
    /// Draws made so far.
    pub draws: u64,
}

impl BrownianMotility {
    /// The first run of a cell.
    pub fn start(&self, seed: u64, cell: u64) -> Walk {
        let mut walk = Walk { direction: [0.0; 3], duration: 0.0, left: 0.0, draws: 0 };
        self.turn(seed, cell, &mut walk);
        walk
    }

    /// Takes a new direction and a new latency, eq. (motility.1).
    fn turn(&self, seed: u64, cell: u64, walk: &mut Walk) {
        let mut stream = Stream::new(seed, Purpose::Motility, cell as u32, walk.draws);
        let [latency, angle] = stream.uniform_pair();
        let turn = std::f64::consts::TAU * angle;
        walk.direction = match self.space {
            Space::Plane => [turn.cos(), turn.sin(), 0.0],
            Space::Volume => {
                let [height, _] = stream.uniform_pair();
                let z = 2.0 * height - 1.0;
                let across = (1.0 - z * z).sqrt();
                [across * turn.cos(), across * turn.sin(), z]
            }
        };
        walk.duration = -self.persistence * (-latency).ln_1p();
        walk.left = walk.duration;
        walk.draws = stream.draw;
    }

    /// Advances a walk by `dt` (s) and returns its mean velocity meanwhile, µm/s. `ended(duration, offset)` is told of
    /// every run that ends, `offset` seconds after the start of the step. At `dt` zero the velocity of the moment is
    /// returned and nothing changes.
    pub fn advance(&self, seed: u64, cell: u64, walk: &mut Walk, dt: f64, mut ended: impl FnMut(f64, f64)) -> Vec3 {
        if walk.left > dt || dt <= 0.0 {
            walk.left -= dt.max(0.0);
            return self.speed * Vec3::from(walk.direction);
        }
        let (mut travelled, mut passed) = (Vec3::zeros(), 0.0);
        while passed + walk.left <= dt {
            travelled += walk.left * Vec3::from(walk.direction);
            passed += walk.left;
            ended(walk.duration, passed);
            self.turn(seed, cell, walk);
        }
        let rest = dt - passed;
        travelled += rest * Vec3::from(walk.direction);
        walk.left -= rest;
        travelled * (self.speed / dt)
    }
}

/// Fürth's mean squared displacement after `lag` (s) of a walk of `speed` (µm/s) and `persistence` (s, positive), µm²,
/// eq. (motility.2).
pub fn furth(lag: f64, speed: f64, persistence: f64) -> f64 {
    let x = lag / persistence;
    // x − (1 − e⁻ˣ), by its series where the terms would cancel.
    let shape = if x < 1e-3 { x * x * (0.5 - x / 6.0 * (1.0 - x / 4.0)) } else { x + (-x).exp_m1() };
    2.0 * (speed * persistence).powi(2) * shape
}

#[cfg(test)]
#[path = "motility_tests.rs"]
mod tests;
