//! One step of the simulation, on one screen.

use super::chemistry::{advance_chemistry, begin_chemistry, next_exchange};
use super::constraints::make_exact;
use super::contact::{carry_forces, check_depth, find_contacts, hold_contacts, keep_contacts, look_for_depth, travel};
use super::gain::{energy_before, has_gained};
use super::implicit::advance_implicitly;
use super::inertial::{advance_freely, correct_velocities};
use super::model::Model;
use super::motility::advance_motility;
use super::pace::{end_at_kinks, is_shortest, judge, plan_next, plan_step};
use super::refresh::{cover_stiffening, refresh_stiffness};
use super::state::State;
use super::targets::measure_volumes;
use super::trouble::{Trouble, check_finite};
use super::workspace::Workspace;
use crate::mechanics::integrator::{Method, StepSize};

/// What a step did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepReport {
    /// Its size, s.
    pub dt: f64,
    /// Tries that the error estimate refused before it.
    pub refused: u32,
    /// Error estimate over the mean edge, 0 for schemes without one.
    pub error: f64,
    /// Whether contacts made this step or the one planned after it shorter than the error estimate would have.
    pub limited: bool,
}

/// How often an accepted step is made again.
const AGAIN: u32 = 10;

/// What sweeps may leave when a step is made again, over what they might before: forces that sweeps leave unfound do work.
const MORE_CARE: f64 = 0.1;

/// What a try says about its step.
struct Estimate {
    /// Error over the mean edge.
    error: f64,
    /// The same with what contacts say: a step in which an atom moves too far counts as one over the tolerance.
    with_contacts: f64,
}

/// Tries before a step is given up; each is at least 0.3 times the one before, so that 60 shrink it by 30 decades.
const TRIES: u32 = 60;

/// Moves the state by one step. After an error the state is the one before the step.
pub fn step(model: &Model, state: &mut State, ws: &mut Workspace) -> Result<StepReport, Trouble> {
    ws.rooms.suit(model);
    begin_chemistry(model, state, ws)?;
    if let Method::Implicit { .. } = model.integrator.method {
        refresh_stiffness(model, state, ws);
        cover_stiffening(model, state, ws);
    }
    remember(state, ws);
    find_contacts(model, state, ws);
    check_depth(model, state, ws)?;
    let energy = energy_before(model, state, ws);
    let planned = plan_step(model, state);
    let (mut dt, mut limited, mut again) = (planned, false, 0);
    for refused in 0..TRIES {
        let dt_now = end_at_kinks(model, state.time, dt);
        let Estimate { error, with_contacts } = match try_step(model, dt_now, state, ws) {
            Ok(estimate) => estimate,
            Err(trouble) if refused + 1 == TRIES || !may_be_mended(model, dt_now, &trouble) => {
                restore(state, ws);
                return Err(trouble);
            }
            Err(Trouble::Contact { .. }) => Estimate { error: 0.0, with_contacts: f64::INFINITY },
            Err(_) => Estimate { error: f64::INFINITY, with_contacts: f64::INFINITY },
        };
        let (mut accepted, mut next) = judge(model, dt_now, with_contacts);
        limited |= next < judge(model, dt_now, error).1;
        if accepted {
            let better = look_again(model, energy, dt_now, again, state, ws).inspect_err(|_| restore(state, ws))?;
            (accepted, next) = (better.is_none(), better.unwrap_or(next));
            (limited, again) = (limited || better.is_some_and(|better| better < dt_now), again + 1);
        }
        if accepted {
            let next_step = plan_next(model, planned, dt, dt_now, next);
            if let Err(trouble) = advance_chemistry(model, dt_now, state, ws) {
                restore(state, ws);
                return Err(trouble);
            }
            state.next_step = next_step;
            keep_contacts(model, state, ws);
            advance_clock(model, dt_now, state, ws);
            return Ok(StepReport { dt: dt_now, refused, error: with_contacts, limited });
        }
        restore(state, ws);
        carry_forces(model, state, ws);
        dt = next;
    }
    Err(Trouble::StepTooSmall { time: state.time, dt })
}

/// Whether a shorter step may do where this one failed: an adaptive one always, a fixed one where contacts did not come to rest.
fn may_be_mended(model: &Model, dt: f64, trouble: &Trouble) -> bool {
    match model.integrator.size {
        StepSize::Adaptive { .. } => true,
        StepSize::Fixed(_) => matches!(trouble, Trouble::Contact { .. }) && !is_shortest(model, dt),
    }
}

/// The time in which an accepted step is to be made again, with more care: where cells left alone would gain energy, or the step would
/// end with cells deep in each other.
///
/// # Errors
/// The cells that are deeper in each other than is promised, however short the step.
fn look_again(
    model: &Model,
    energy: Option<f64>,
    dt: f64,
    again: u32,
    state: &State,
    ws: &mut Workspace,
) -> Result<Option<f64>, Trouble> {
    let may_be_shorter = again < AGAIN && !is_shortest(model, dt);
    if may_be_shorter && has_gained(model, energy, dt, state, ws) {
        ws.contact.care *= MORE_CARE;
        // At first without mending depths, which takes work however short a step is.
        return Ok(Some(if again == 0 { dt } else { 0.5 * dt }));
    }
    match look_for_depth(model, state, ws) {
        Some(_) if may_be_shorter => Ok(Some(0.5 * dt)),
        Some(deepened) if deepened.breaks_promise() => Err(deepened.trouble(model, state.time)),
        _ => Ok(None),
    }
}

/// The stages of a step.
fn try_step(model: &Model, dt: f64, state: &mut State, ws: &mut Workspace) -> Result<Estimate, Trouble> {
    let end = state.time + dt;
    advance_motility(model, dt, state, ws);
    let error = match model.integrator.method {
        Method::Implicit { order } => advance_implicitly(model, dt, order, state, ws),
        _ => {
            measure_volumes(model, end, state, ws);
            advance_freely(model, dt, state, ws);
            0.0
        }
    };
    keep_free_positions(state, ws);
    check_finite(model, end, state)?;
    hold_contacts(model, dt, state, ws)?;
    make_exact(model, state, ws).map_err(|failure| Trouble::of_volume(model, end, failure))?;
    if model.integrator.method.is_inertial() {
        correct_velocities(model, dt, state, ws);
    }
    check_finite(model, end, state)?;
    limit_travel(model, dt, error, state, ws)
}

/// Adds what contacts say about the step.
fn limit_travel(model: &Model, dt: f64, error: f64, state: &State, ws: &Workspace) -> Result<Estimate, Trouble> {
    let share = travel(model, state, ws);
    match model.integrator.size {
        StepSize::Adaptive { tolerance, .. } => {
            Ok(Estimate { error, with_contacts: error.max(tolerance * share * share) })
        }
        StepSize::Fixed(_) if share > 1.0 => Err(Trouble::TooFast { time: state.time + dt, share }),
        StepSize::Fixed(_) => Ok(Estimate { error, with_contacts: error }),
    }
}

fn remember(state: &State, ws: &mut Workspace) {
    for (now, w) in state.kinds.iter().zip(&mut ws.kinds) {
        w.start.copy_from_slice(&now.positions);
        w.start_velocity.copy_from_slice(&now.velocities);
    }
}

fn restore(state: &mut State, ws: &Workspace) {
    for (now, w) in state.kinds.iter_mut().zip(&ws.kinds) {
        now.positions.copy_from_slice(&w.start);
        now.velocities.copy_from_slice(&w.start_velocity);
    }
}

/// Keeps the freely moved positions for the correction of velocities.
fn keep_free_positions(state: &State, ws: &mut Workspace) {
    for (now, w) in state.kinds.iter().zip(&mut ws.kinds) {
        if !now.velocities.is_empty() {
            w.force.copy_from_slice(&now.positions);
        }
    }
}

fn advance_clock(model: &Model, dt: f64, state: &mut State, ws: &mut Workspace) {
    state.time += dt;
    let slack = 1e-12 * model.until;
    let exchange = next_exchange(model, state.time - 2.0 * slack);
    let mut kinks = model.kinks.iter().copied().chain([model.until, exchange]);
    if let Some(kink) = kinks.find(|kink| (kink - state.time).abs() <= slack) {
        state.time = kink;
    }
    state.step += 1;
    if !ws.walks.is_empty() {
        state.walks.copy_from_slice(&ws.walks);
        state.ended_runs.append(&mut ws.ended_runs);
    }
}
