//! The over-damped schemes: the linearly implicit step of first and second order, and explicit Euler.
//!
//! With A = ζ/dt + γK, K constant, the increment of the first-order step is `A Y = F(X)`, eq. (step.2), γ = 1. The
//! second-order step, eq. (step.3), is the two-stage W-method of Verwer et al. (1999), second order whatever K is:
//! `A Y₁ = F(X)`, `A Y₂ = F(X + Y₁) − 2 (ζ/dt) Y₁`, `X⁺ = X + 3/2 Y₁ + 1/2 Y₂`, and `(Y₁ + Y₂)/2` estimates the error.
//! Rigid motion is taken out of A, eq. (step.4). An incompressible cell's increments are those of the same system under
//! the linearised constraint, eq. (step.5): one more solve gives the displacement S that a unit of pressure causes.

use rayon::prelude::*;

use super::model::{Kind, Model, VolumeRule};
use super::planes;
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

/// Measures the volume and its gradient at the start of the step and sets the targets for its end. With contacts a volume
/// that is off its target already where the step begins (a target that jumps) approaches it as fast as contacts can follow.
pub fn measure_volumes(model: &Model, end: f64, state: &State, ws: &mut Workspace) {
    for ((kind, now), w) in model.kinds.iter().zip(&state.kinds).zip(&mut ws.kinds) {
        let factor = match &kind.volume {
            VolumeRule::Free => continue,
            VolumeRule::Exact(course) | VolumeRule::Compressible { course, .. } => course.at(end),
        };
        w.target.iter_mut().zip(&now.rest_volumes).for_each(|(target, rest)| *target = rest * factor);
        (w.gradient.par_chunks_exact_mut(kind.block_len()))
            .zip(now.positions.par_chunks_exact(kind.block_len()))
            .zip(w.volume.par_chunks_exact_mut(kind.lanes))
            .for_each(|((gradient, x), volumes)| {
                volume::measure_block(&kind.rest.facets, x, &kind.held, gradient, volumes);
            });
        if let (Some(contact), VolumeRule::Exact(course)) = (&model.contact, &kind.volume) {
            approach_targets(kind, course.at(state.time), contact.scene.safe_travel(), &now.rest_volumes, w);
        }
    }
}

/// The part of the travel that is safe for contacts which a volume may take when its target has jumped.
const SHARE_OF_TRAVEL: f64 = 0.25;

/// Puts the targets of cells whose volume was off its target already where the step begins, by `factor` times their rest
/// volume, only so far away that no atom has to move farther than a part of `travel` (µm) for that, eq. (volume.5).
fn approach_targets(kind: &Kind, factor: f64, travel: f64, rest_volumes: &[f64], w: &mut KindScratch) {
    for (lane, rest) in rest_volumes.iter().enumerate() {
        let off = rest * factor - w.volume[lane];
        // As good as always. No contact is so near that this would be too far.
        if off.abs() <= 1e-9 * rest {
            continue;
        }
        let (block, lane_of_block) = (lane / kind.lanes, lane % kind.lanes);
        let gradient = &w.gradient[block * kind.block_len()..][..kind.block_len()];
        let (mut squared, mut largest) = (0.0, 0.0f64);
        for atom in gradient.chunks_exact(3 * kind.lanes) {
            let own = (0..3).map(|axis| atom[axis * kind.lanes + lane_of_block].powi(2)).sum::<f64>();
            squared += own;
            largest = largest.max(own);
        }
        // Moved along the gradient g, atom i goes by g_i |off| / |g|².
        let most = SHARE_OF_TRAVEL * travel * squared / largest.sqrt();
        if off.abs() > most {
            w.target[lane] -= off - most.copysign(off);
        }
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
    for (kind, w) in model.kinds.iter().zip(&mut ws.kinds) {
        if kind.volume == VolumeRule::Free {
            continue;
        }
        let solver = w.solver(kind, dt, gamma(order));
        w.swell.copy_from_slice(&w.gradient);
        let length = kind.block_len();
        (w.swell.par_chunks_exact_mut(length))
            .zip(w.start.par_chunks_exact(length))
            .zip(w.spare.par_chunks_exact_mut(length))
            .zip(w.spare2.par_chunks_exact_mut(length))
            .for_each(|(((swell, x), spare), spare2)| solve_block(kind, kind.lanes, &solver, x, swell, spare, spare2));
    }
}

/// Turns the forces of every kind into the increments of a stage, in place; constraints hold to first order.
pub fn solve_increments(model: &Model, dt: f64, order: Order, stage: Stage, state: &State, ws: &mut Workspace) {
    for (number, (kind, w)) in model.kinds.iter().zip(&mut ws.kinds).enumerate() {
        let solver = w.solver(kind, dt, gamma(order));
        let (length, lanes) = (kind.block_len(), kind.lanes);
        if stage == Stage::Second {
            carry_pressure(kind, &state.kinds[number].positions, w);
        }
        let KindScratch {
            force, first, start, gradient, swell, spare, spare2, volume, target, pressure, touch, ..
        } = w;
        (force.par_chunks_exact_mut(length))
            .zip(first.par_chunks_exact(length))
            .zip(start.par_chunks_exact(length))
            .zip(gradient.par_chunks_exact(length).zip(swell.par_chunks_exact(length)))
            .zip(spare.par_chunks_exact_mut(length).zip(spare2.par_chunks_exact_mut(length)))
            .zip(volume.par_chunks_exact(lanes).zip(target.par_chunks_exact(lanes)))
            .zip(pressure.par_chunks_exact_mut(lanes).zip(touch))
            .for_each(
                |((((((y, first), x), (gradient, swell)), (spare, spare2)), (volume, target)), (pressure, touch))| {
                    if stage == Stage::Second {
                        let back = 2.0 / solver.mobility;
                        y.iter_mut().zip(first).for_each(|(y, k)| *y -= back * k);
                    }
                    solve_block(kind, kind.lanes, &solver, x, y, spare, spare2);
                    let mut wanted = [0.0; LANES];
                    for lane in 0..lanes {
                        let missing = target[lane] - volume[lane];
                        wanted[lane] = if stage == Stage::First { missing } else { -missing };
                    }
                    constrain(kind, gamma(order), gradient, swell, &wanted[..lanes], target, y, pressure);
                    let scene = planes::Scene { model, kind, solver: &solver, stage, gamma: gamma(order) };
                    planes::correct_block(&scene, x, first, gradient, swell, target, y, pressure, touch);
                },
            );
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
fn carry_pressure(kind: &Kind, positions: &[f64], w: &mut KindScratch) {
    if !matches!(kind.volume, VolumeRule::Exact(_)) {
        return;
    }
    let (length, lanes) = (kind.block_len(), kind.lanes);
    (w.force.par_chunks_exact_mut(length))
        .zip(positions.par_chunks_exact(length))
        .zip(w.spare.par_chunks_exact_mut(length))
        .zip(w.pressure.par_chunks_exact(lanes))
        .for_each(|(((f, x), gradient), pressure)| {
            let mut volumes = [0.0; LANES];
            volume::measure_block(&kind.rest.facets, x, &kind.held, gradient, &mut volumes[..lanes]);
            for (f, g) in f.chunks_exact_mut(lanes).zip(gradient.chunks_exact(lanes)) {
                for lane in 0..lanes {
                    f[lane] += pressure[lane] * g[lane];
                }
            }
        });
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

/// Moves atoms to X + Y₁ and keeps Y₁.
pub fn move_first(model: &Model, state: &mut State, ws: &mut Workspace) {
    for ((kind, now), w) in model.kinds.iter().zip(&mut state.kinds).zip(&mut ws.kinds) {
        std::mem::swap(&mut w.first, &mut w.force);
        (now.positions.par_chunks_exact_mut(kind.block_len()))
            .zip(w.start.par_chunks_exact(kind.block_len()))
            .zip(w.first.par_chunks_exact(kind.block_len()))
            .for_each(|((x, start), y)| {
                for ((x, start), y) in x.iter_mut().zip(start).zip(y) {
                    *x = start + y;
                }
            });
    }
}

/// Moves atoms to X + 3/2 Y₁ + 1/2 Y₂ and returns the largest error estimate over the mean edge of its kind.
pub fn move_second(model: &Model, state: &mut State, ws: &Workspace) -> f64 {
    let mut worst = 0.0;
    for ((kind, now), w) in model.kinds.iter().zip(&mut state.kinds).zip(&ws.kinds) {
        let error = (now.positions.par_chunks_exact_mut(kind.block_len()))
            .zip(w.start.par_chunks_exact(kind.block_len()))
            .zip(w.first.par_chunks_exact(kind.block_len()).zip(w.force.par_chunks_exact(kind.block_len())))
            .map(|((x, start), (first, second))| {
                let mut largest = 0.0;
                for (((x, start), y1), y2) in x.iter_mut().zip(start).zip(first).zip(second) {
                    *x = start + 1.5 * y1 + 0.5 * y2;
                    largest = larger(largest, (0.5 * (y1 + y2)).abs());
                }
                largest
            })
            .reduce(|| 0.0, larger);
        worst = larger(worst, error / kind.edge);
    }
    worst
}

/// The larger of two numbers, or whatever is not a number.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}
