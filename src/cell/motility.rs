//! Brownian persistence: a cell keeps its direction for a while, then takes another at random.
//!
//! A run lasts `t = −p ln(1 − r)`, eq. (motility.1), p the persistence and r uniform in [0, 1); then the direction is
//! uniform on the circle or the sphere. With speed v this is exactly Fürth's walk,
//! `MSD(t) = 2 v² p (t − p (1 − e^{−t/p}))`, eq. (motility.2). A step may hold any number of turns: the mean velocity over it
//! is the integral of the walk, so that positions do not depend on the step.
//! Source: Promayon 2008 §5.4.1; Fürth 1920.

use serde::{Deserialize, Serialize};

use crate::Vec3;
use crate::random::{Purpose, Stream};

/// Where directions may point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Space {
    /// In the xy plane.
    Plane,
    /// In all directions.
    Volume,
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
    /// every run that ends, `offset` seconds after the start of the step.
    pub fn advance(&self, seed: u64, cell: u64, walk: &mut Walk, dt: f64, mut ended: impl FnMut(f64, f64)) -> Vec3 {
        let (mut way, mut passed) = (Vec3::zeros(), 0.0);
        while passed + walk.left <= dt {
            way += walk.left * Vec3::from(walk.direction);
            passed += walk.left;
            ended(walk.duration, passed);
            self.turn(seed, cell, walk);
        }
        let rest = dt - passed;
        way += rest * Vec3::from(walk.direction);
        walk.left -= rest;
        way * (self.speed / dt)
    }
}

/// Fürth's mean squared displacement after `lag` (s), µm², eq. (motility.2).
pub fn furth(lag: f64, speed: f64, persistence: f64) -> f64 {
    2.0 * speed * speed * persistence * (lag - persistence * (1.0 - (-lag / persistence).exp()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const WALK: BrownianMotility = BrownianMotility { speed: 2.0, persistence: 3.0, space: Space::Plane };

    fn path(motility: &BrownianMotility, cell: u64, dt: f64, steps: usize) -> Vec<Vec3> {
        let mut walk = motility.start(7, cell);
        let mut place = Vec3::zeros();
        (0..steps)
            .map(|_| {
                place += dt * motility.advance(7, cell, &mut walk, dt, |_, _| {});
                place
            })
            .collect()
    }

    #[test]
    fn positions_do_not_depend_on_the_step() {
        for space in [Space::Plane, Space::Volume] {
            let walk = BrownianMotility { space, ..WALK };
            let (fine, coarse) = (path(&walk, 3, 0.03, 900), path(&walk, 3, 9.0, 3));
            for i in 0..3 {
                assert!((fine[300 * i + 299] - coarse[i]).norm() < 1e-9, "{:?} {:?}", fine[300 * i + 299], coarse[i]);
            }
        }
    }

    #[test]
    fn two_thousand_walkers_agree_with_furth_in_plane_and_volume() {
        for space in [Space::Plane, Space::Volume] {
            let motility = BrownianMotility { space, ..WALK };
            let paths: Vec<Vec<Vec3>> = (0..2000).map(|cell| path(&motility, cell, 0.75, 40)).collect();
            for lag in [1, 2, 3, 4, 6, 8, 12, 16, 20, 28, 40] {
                let squares: Vec<f64> = paths.iter().map(|path| path[lag - 1].norm_squared()).collect();
                let mean = squares.iter().sum::<f64>() / 2000.0;
                let variance = squares.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / 1999.0;
                let deviation = (mean - furth(0.75 * lag as f64, 2.0, 3.0)) / (variance / 2000.0).sqrt();
                assert!(deviation.abs() < 3.0, "{space:?} lag {lag}: {deviation} standard errors");
            }
        }
    }
}
