//! The over-damped schemes: the linearly implicit step of first and second order, and explicit Euler.
//!
//! With A = ζ/dt + γK, K constant, the increment of the first-order step is `A Y = F(X)`, eq. (step.2), γ = 1. The
//! second-order step, eq. (step.3), is the two-stage W-method of Verwer et al. (1999), second order whatever K is:
//! `A Y₁ = F(X)`, `A Y₂ = F(X + Y₁) − 2 (ζ/dt) Y₁`, `X⁺ = X + 3/2 Y₁ + 1/2 Y₂`, and `(Y₁ + Y₂)/2` estimates the error.
//! Rigid motion is taken out of A, eq. (step.4). An incompressible cell's increments are those of the same system under
//! the linearised constraint, eq. (step.5): one more solve gives the displacement S that a unit of pressure causes.

use rayon::prelude::*;

use super::contact::pull_contacts;
use super::forces::Forces;
use super::model::{Kind, Model, VolumeRule};
use super::planes::{self, TouchScratch};
use super::state::State;
use super::workspace::{KindScratch, Solver, Workspace};
use crate::mechanics::integrator::Order;
use crate::mechanics::lanes::LANES;
use crate::mechanics::{rigid, volume};

/// γ of the two-stage scheme: with K at or above the true stiffness 1/2 damps every mode and keeps the error small;
/// it bears a K that is too small by a factor of two.
const GAMMA: f64 = 0.5;

/// γ for an order.
pub fn gamma(order: Order) -> f64 {
    match order {
        Order::First => 1.0,
        Order::Second => GAMMA,
    }
}

/// Which stage of a step a solve belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The first, or the only one.
    First,
    /// The second of [`Order::Second`].
    Second,
}

/// The displacement that a unit of pressure causes in every cell, eq. (step.5).
pub fn solve_swell(model: &Model, dt: f64, order: Order, ws: &mut Workspace) {
    let Workspace { kinds, rooms, .. } = ws;
    for (kind, w) in model.kinds.iter().zip(kinds) {
        if kind.volume == VolumeRule::Free {
            continue;
        }
        let solver = w.solver(kind, dt, gamma(order));
        let length = kind.block_len();
        (w.swell.par_chunks_exact_mut(length))
            .zip(w.start.par_chunks_exact(length).zip(w.gradient.par_chunks_exact(length)))
            .for_each(|(swell, (x, gradient))| {
                swell.copy_from_slice(gradient);
                rooms.enter(length, |[_, spare, spare2]| {
                    solve_block(kind, kind.lanes, &solver, x, swell, spare, spare2);
                });
            });
    }
}

/// One stage of a step for all cells: forces, the increments that they cause, and where these take the atoms; constraints hold to
/// first order. The first stage moves atoms to X + Y₁, the second to X + 3/2 Y₁ + 1/2 Y₂. Returns the largest error estimate
/// over the mean edge of its kind, 0 in the first stage. A block goes through all of it at once, so that what it needs stays near.
pub fn advance_stage(model: &Model, dt: f64, order: Order, stage: Stage, state: &mut State, ws: &mut Workspace) -> f64 {
    pull_contacts(model, state, &mut ws.contact);
    let time = if stage == Stage::First { state.time } else { state.time + dt };
    let Workspace { kinds, rooms, drive, contact, .. } = ws;
    let mut worst = 0.0;
    for (number, ((kind, now), w)) in model.kinds.iter().zip(&mut state.kinds).zip(kinds).enumerate() {
        let forces = Forces { model, number, time, controls: &state.chemistry.controls, drive, contact };
        let solver = w.solver(kind, dt, gamma(order));
        let scene = planes::Scene { model, kind, solver: &solver, stage, gamma: gamma(order) };
        let (length, lanes) = (kind.block_len(), kind.lanes);
        let KindScratch { first, start, gradient, swell, energy, volume, target, pressure, touch, .. } = w;
        let error = (now.positions.par_chunks_exact_mut(length))
            .zip(now.rest_volumes.par_chunks_exact(lanes))
            .zip(first.par_chunks_exact_mut(length).zip(start.par_chunks_exact(length)))
            .zip(gradient.par_chunks_exact(length).zip(swell.par_chunks_exact(length)))
            .zip(volume.par_chunks_exact(lanes).zip(target.par_chunks_exact(lanes)))
            .zip(energy.par_chunks_exact_mut(lanes).zip(pressure.par_chunks_exact_mut(lanes)).zip(touch))
            .enumerate()
            .map(|(number, (((((x, rest), (first, start)), (gradient, swell)), (volume, target)), others))| {
                let ((energy, pressure), touch) = others;
                let block = Block { start, gradient, swell, volume, target };
                rooms.enter(length, |[y, spare, spare2]| {
                    forces.on_block(number, (x, rest), (y, energy), spare);
                    if stage == Stage::Second {
                        carry_pressure(kind, x, pressure, y, spare);
                    }
                    block.solve(&scene, y, first, pressure, touch, [spare, spare2]);
                    block.go_on(stage, x, y, first)
                })
            })
            .reduce(|| 0.0, larger);
        worst = larger(worst, error / kind.edge);
    }
    worst
}

/// What the stages of a block have in common.
struct Block<'a> {
    /// Positions where the step begins.
    start: &'a [f64],
    gradient: &'a [f64],
    swell: &'a [f64],
    volume: &'a [f64],
    target: &'a [f64],
}

impl Block<'_> {
    /// Turns forces into the increments of a stage, in place.
    fn solve(
        &self,
        scene: &planes::Scene,
        y: &mut [f64],
        first: &[f64],
        pressure: &mut [f64],
        touch: &mut TouchScratch,
        [spare, spare2]: [&mut [f64]; 2],
    ) {
        let &Self { start, gradient, swell, volume, target } = self;
        let &planes::Scene { kind, solver, stage, gamma, .. } = scene;
        if stage == Stage::Second {
            let back = 2.0 / solver.mobility;
            y.iter_mut().zip(first).for_each(|(y, k)| *y -= back * k);
        }
        solve_block(kind, kind.lanes, solver, start, y, spare, spare2);
        let mut wanted = [0.0; LANES];
        for lane in 0..kind.lanes {
            let missing = target[lane] - volume[lane];
            wanted[lane] = if stage == Stage::First { missing } else { -missing };
        }
        constrain(kind, gamma, gradient, swell, &wanted[..kind.lanes], target, y, pressure);
        planes::correct_block(scene, start, first, gradient, swell, target, y, pressure, touch);
    }

    /// Moves atoms by the increments of a stage, and keeps those of the first. Returns the largest error estimate, µm.
    fn go_on(&self, stage: Stage, x: &mut [f64], y: &[f64], first: &mut [f64]) -> f64 {
        if stage == Stage::First {
            first.copy_from_slice(y);
            for ((x, start), y) in x.iter_mut().zip(self.start).zip(y) {
                *x = start + y;
            }
            return 0.0;
        }
        let mut largest = 0.0;
        for (((x, start), y1), y2) in x.iter_mut().zip(self.start).zip(&*first).zip(y) {
            *x = start + 1.5 * y1 + 0.5 * y2;
            largest = larger(largest, (0.5 * (y1 + y2)).abs());
        }
        largest
    }
}

/// Solves A Y = F for a block of `lanes` cells with rigid motion taken out, eq. (step.4); F is replaced by Y.
pub fn solve_block(
    kind: &Kind,
    lanes: usize,
    solver: &Solver,
    x: &[f64],
    y: &mut [f64],
    spare: &mut [f64],
    spare2: &mut [f64],
) {
    if kind.is_held() {
        volume::hold(lanes, &kind.held, y);
        solver.solve(lanes, y, spare);
    } else {
        rigid::split_block(lanes, kind.atoms(), x, y, spare, solver.mobility);
        solver.solve(lanes, y, spare2);
        rigid::join_block(lanes, kind.atoms(), x, y, spare);
    }
}

/// The pressure multiplier of eq. (step.5): how much of `swell` is added to meet the wanted change of volume, or, in a
/// compressible cell, how much the pressure's own stiffness takes back.
pub fn pressure(kind: &Kind, gamma: f64, along: f64, swelling: f64, wanted: f64, target: f64) -> f64 {
    match &kind.volume {
        VolumeRule::Free => 0.0,
        VolumeRule::Exact(_) => (wanted - along) / swelling,
        VolumeRule::Compressible { modulus, .. } => -along / (swelling + target / (modulus * gamma)),
    }
}

/// Adds the first stage's pressure to the forces of the second, along the gradient where the atoms now are: the
/// gradient turns with the cell, and without this the scheme would be of first order in an incompressible cell.
fn carry_pressure(kind: &Kind, x: &[f64], pressure: &[f64], f: &mut [f64], gradient: &mut [f64]) {
    if !matches!(kind.volume, VolumeRule::Exact(_)) {
        return;
    }
    let lanes = kind.lanes;
    let mut volumes = [0.0; LANES];
    volume::measure_block(&kind.rest.facets, x, &kind.held, gradient, &mut volumes[..lanes]);
    for (f, g) in f.chunks_exact_mut(lanes).zip(gradient.chunks_exact(lanes)) {
        for lane in 0..lanes {
            f[lane] += pressure[lane] * g[lane];
        }
    }
}

fn constrain(
    kind: &Kind,
    gamma: f64,
    gradient: &[f64],
    swell: &[f64],
    wanted: &[f64],
    target: &[f64],
    y: &mut [f64],
    factor: &mut [f64],
) {
    if kind.volume == VolumeRule::Free {
        return;
    }
    let lanes = kind.lanes;
    let (mut along, mut swelling) = ([0.0; LANES], [0.0; LANES]);
    for ((g, s), y) in gradient.chunks_exact(lanes).zip(swell.chunks_exact(lanes)).zip(y.chunks_exact(lanes)) {
        for lane in 0..lanes {
            along[lane] += g[lane] * y[lane];
            swelling[lane] += g[lane] * s[lane];
        }
    }
    for lane in 0..lanes {
        factor[lane] = pressure(kind, gamma, along[lane], swelling[lane], wanted[lane], target[lane]);
    }
    for (y, s) in y.chunks_exact_mut(lanes).zip(swell.chunks_exact(lanes)) {
        for lane in 0..lanes {
            y[lane] += factor[lane] * s[lane];
        }
    }
}

/// The larger of two numbers, or whatever is not a number.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}
