//! Cells on which nothing acts from outside do not gain energy, whatever contacts do.
//!
//! In a step that is long beside the relaxation of a cell contacts push what the elastic forces answer only in the next one.
//! Where that would leave more energy than there was, the step is made again, shorter.

use super::contact::{energy_of_compliance, energy_of_law};
use super::forces::measure_energy;
use super::kind::{Kind, VolumeRule};
use super::model::Model;
use super::state::{KindState, State};
use super::workspace::Workspace;
use crate::mechanics::Force;
use crate::mechanics::integrator::Method;

/// What a step may gain by round-off, over the energy there is.
const ROUND_OFF: f64 = 1e-9;

/// What a step may gain by what its sweeps leave, over the energy of the stiffest cell deformed by that much.
const LEFT: f64 = 1e-5;

/// What a volume may be off its target without pressure doing work to put that right, over the target.
const VOLUME_OFF: f64 = 1e-9;

/// The energy where a step begins, pN·µm; none where something may do work on the cells: loads that are not zero, forces that a program exerts,
/// gravity, motility, chemistry, grips that move, the energy that contacts release, volumes that change, elastic forces without an energy.
pub fn energy_before(model: &Model, state: &State, ws: &mut Workspace) -> Option<f64> {
    is_left_alone(model, state).then(|| {
        measure_energy(model, state.time, &state.chemistry.controls, &state.kinds, ws);
        energy(&state.kinds, ws) + state.contact.stored() + energy_of_law(model, &state.kinds, &mut ws.contact)
    })
}

/// Whether a step of `dt` (s) has left more energy than there was, beyond round-off and what sweeps leave.
pub fn has_gained(model: &Model, dt: f64, before: Option<f64>, from: &State, to: &State, ws: &mut Workspace) -> bool {
    let (Some(before), Some(contact)) = (before, &model.contact) else { return false };
    if !had_their_volumes(model, ws) {
        return false;
    }
    measure_energy(model, from.time + dt, &from.chemistry.controls, &to.kinds, ws);
    let stiffest = model.kinds.iter().map(|kind| kind.largest_stiffness).fold(0.0, f64::max);
    let left = LEFT * stiffest * contact.tolerance * contact.tolerance;
    let after = energy(&to.kinds, ws) + energy_of_compliance(&ws.contact);
    after + energy_of_law(model, &to.kinds, &mut ws.contact) > before + ROUND_OFF * before.abs() + left
}

fn is_left_alone(model: &Model, state: &State) -> bool {
    let sticks_only = |contact: &super::contact::ContactModel| {
        let strengths = contact.between.iter().chain(&contact.on_obstacles);
        contact.law.is_passive() && strengths.into_iter().all(|strength| strength.energy == 0.0)
    };
    // A step never runs over a bend of a course. What a program sets of loads may be anything.
    let is_idle = |force: &Force| match force {
        Force::Load(load) => state.chemistry.controls.forces.is_empty() && load.force.is_zero_from(state.time),
        Force::Pressure(own) => own.pressure.is_zero_from(state.time),
        Force::Torque(own) => own.torque.is_zero_from(state.time),
        _ => false,
    };
    let is_alone = |(kind, now): (&Kind, &KindState)| {
        let steady = kind.volume.course().is_none_or(|course| course.kinks().next().is_none());
        let is_quiet = |force: &Force| force.is_elastic() && force.is_conservative() || is_idle(force);
        let rests = kind.moved.iter().all(|moved| moved.rests_from(state.time));
        steady && rests && !now.is_driven(kind) && now.fibres.is_empty() && kind.forces.iter().all(is_quiet)
    };
    matches!(model.integrator.method, Method::Implicit { .. } | Method::Explicit)
        && model.contact.as_ref().is_some_and(sticks_only)
        && model.chemistry.is_empty()
        && state.chemistry.controls.atom_forces.is_empty()
        && model.kinds.iter().zip(&state.kinds).all(is_alone)
}

/// Whether all exact volumes were where they are to be when the step began.
fn had_their_volumes(model: &Model, ws: &Workspace) -> bool {
    model.kinds.iter().zip(&ws.kinds).all(|(kind, w)| {
        let is_there = |(volume, target): (&f64, &f64)| (volume - target).abs() <= VOLUME_OFF * target;
        !matches!(kind.volume, VolumeRule::Exact(_)) || w.volume.iter().zip(&w.target).all(is_there)
    })
}

/// The energy of all cells as it was measured last, pN·µm.
fn energy(cells: &[KindState], ws: &Workspace) -> f64 {
    cells.iter().zip(&ws.kinds).map(|(now, w)| w.energy[..now.cells()].iter().sum::<f64>()).sum()
}
