//! The schemes with inertia, `m ẍ = F − k_a ẋ`, eq. (step.6): explicit and semi-implicit Euler, velocity Verlet with the
//! drag inside, and the classical Runge–Kutta scheme of fourth order; and over-damped explicit Euler, eq. (step.1).

use super::forces::sum_forces;
use super::kind::{Kind, VolumeRule};
use super::model::Model;
use super::state::State;
use super::targets::measure_volumes;
use super::workspace::Workspace;
use crate::mechanics::integrator::Method;
use crate::mechanics::volume;

/// Moves all atoms freely by one step of an explicit scheme.
pub fn advance_explicitly(model: &Model, dt: f64, from: &State, to: &mut State, ws: &mut Workspace) {
    measure_volumes(model, from.time + dt, from, ws);
    for (now, next) in from.kinds.iter().zip(&mut to.kinds) {
        next.positions.copy_from_slice(&now.positions);
        next.velocities.copy_from_slice(&now.velocities);
    }
    move_atoms(model, dt, from, to, ws);
    keep_free_positions(to, ws);
}

/// Keeps the positions of the schemes with inertia for the correction of velocities.
fn keep_free_positions(to: &State, ws: &mut Workspace) {
    for (now, w) in to.kinds.iter().zip(&mut ws.kinds).filter(|(now, _)| !now.velocities.is_empty()) {
        w.free.clone_from(&now.positions);
    }
}

/// Moves atoms that stand where the step begins.
fn move_atoms(model: &Model, dt: f64, from: &State, to: &mut State, ws: &mut Workspace) {
    let (start, controls) = (from.time, &from.chemistry.controls);
    if model.integrator.method == Method::RungeKutta4 {
        return runge_kutta(model, dt, from, to, ws);
    }
    // Verlet moves by the mean of the forces where the step begins and where it ends.
    let share = if model.integrator.method == Method::Verlet { 0.5 } else { 1.0 };
    sum_forces(model, (start, share), controls, &to.kinds, ws);
    match model.integrator.method {
        Method::Explicit => each(model, to, ws, |kind, x, _, f| {
            let mobility = dt / kind.drag;
            x.iter_mut().zip(f).for_each(|(x, f)| *x += mobility * f);
        }),
        Method::Euler => each(model, to, ws, |kind, x, v, f| {
            for ((x, v), f) in x.iter_mut().zip(v).zip(f) {
                *x += dt * *v;
                *v += dt * (f - kind.drag * *v) / kind.mass;
            }
        }),
        Method::SemiImplicitEuler => each(model, to, ws, |kind, x, v, f| {
            for ((x, v), f) in x.iter_mut().zip(v).zip(f) {
                *v += dt * (f - kind.drag * *v) / kind.mass;
                *x += dt * *v;
            }
        }),
        Method::Verlet => {
            each(model, to, ws, |kind, x, v, f| {
                let (kick, slow) = (0.5 * dt / kind.mass, 1.0 / (1.0 + 0.5 * dt * kind.drag / kind.mass));
                for ((x, v), f) in x.iter_mut().zip(v).zip(f) {
                    *v = (*v + kick * f) * slow;
                    *x += dt * *v;
                }
            });
            sum_forces(model, (start + dt, share), controls, &to.kinds, ws);
            each(model, to, ws, |kind, _, v, f| {
                let (kick, keep) = (0.5 * dt / kind.mass, 1.0 - 0.5 * dt * kind.drag / kind.mass);
                v.iter_mut().zip(f).for_each(|(v, f)| *v = *v * keep + kick * f);
            });
        }
        Method::RungeKutta4 | Method::Implicit { .. } => unreachable!("these schemes have their own stages"),
    }
}

/// Runs work over the arrays of every kind: positions, velocities and forces, with held atoms kept still.
fn each(model: &Model, to: &mut State, ws: &mut Workspace, work: impl Fn(&Kind, &mut [f64], &mut [f64], &[f64])) {
    for ((kind, now), w) in model.kinds.iter().zip(&mut to.kinds).zip(&mut ws.kinds) {
        if kind.is_held() {
            for block in w.force.chunks_exact_mut(kind.block_len()) {
                volume::hold(kind.lanes, &kind.held, block);
            }
        }
        work(kind, &mut now.positions, &mut now.velocities, &w.force);
    }
}

/// The classical scheme; `rates` sums the velocities and `accelerations` the accelerations of the four stages.
fn runge_kutta(model: &Model, dt: f64, from: &State, to: &mut State, ws: &mut Workspace) {
    let (start, controls) = (from.time, &from.chemistry.controls);
    // (weight of the stage in the sum, time and step from the start at which the next stage is taken)
    let stages = [(1.0, Some(0.5)), (2.0, Some(0.5)), (2.0, Some(1.0)), (1.0, None)];
    for (number, (weight, next)) in stages.into_iter().enumerate() {
        let at = if number == 0 { 0.0 } else { stages[number - 1].1.unwrap_or(1.0) };
        sum_forces(model, (start + at * dt, weight / 6.0), controls, &to.kinds, ws);
        let cells = from.kinds.iter().zip(&mut to.kinds);
        for ((kind, (begun, now)), w) in model.kinds.iter().zip(cells).zip(&mut ws.kinds) {
            if kind.is_held() {
                for block in w.force.chunks_exact_mut(kind.block_len()) {
                    volume::hold(kind.lanes, &kind.held, block);
                }
            }
            if number == 0 {
                for sum in [&mut w.rates, &mut w.accelerations] {
                    sum.clear();
                    sum.resize(now.positions.len(), 0.0);
                }
            }
            for i in 0..now.positions.len() {
                let (rate, acceleration) =
                    (now.velocities[i], (w.force[i] - kind.drag * now.velocities[i]) / kind.mass);
                w.rates[i] += weight * rate;
                w.accelerations[i] += weight * acceleration;
                let (move_by, x_rate, v_rate) = match next {
                    Some(part) => (part * dt, rate, acceleration),
                    None => (dt / 6.0, w.rates[i], w.accelerations[i]),
                };
                now.positions[i] = begun.positions[i] + move_by * x_rate;
                now.velocities[i] = begun.velocities[i] + move_by * v_rate;
            }
        }
    }
}

/// Corrects the velocities, where atoms have some, by what the constraints moved, eq. (step.7).
pub fn correct_velocities(model: &Model, dt: f64, to: &mut State, ws: &Workspace) {
    for ((kind, now), w) in model.kinds.iter().zip(&mut to.kinds).zip(&ws.kinds) {
        let constrained = !model.obstacles.is_empty() || matches!(kind.volume, VolumeRule::Exact(_));
        if constrained {
            for ((v, x), free) in now.velocities.iter_mut().zip(&now.positions).zip(&w.free) {
                *v += (x - free) / dt;
            }
        }
    }
}
