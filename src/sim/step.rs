//! One step of the simulation, on one screen.
//!
//! A step is a transaction: its stages read the state where it begins and write the one where it ends, which lies in the workspace. That
//! becomes the state when all is done, and else is scratch.

use std::borrow::Cow;

use super::chemistry::{advance_chemistry, begin_chemistry as carry_first, next_exchange};
use super::constraints::make_exact;
use super::contact::{
    carry_forces, check_depth, hold_contacts, keep_contacts, locate_contacts, look_for_depth, travel, turn_over_bonds,
};
use super::dissipation::note_dissipation;
use super::elasticity::gather_elasticity;
use super::fibres::act_fibres;
use super::finite::check_finite;
use super::gain::{energy_before, has_gained};
use super::inertial::correct_velocities;
use super::meet::note_meetings;
use super::model::Model;
use super::motility::advance_behaviours;
use super::motion::move_freely;
use super::pierced::{check_pierced, travel_past};
use super::plan::{Estimate, Flaw, Halt, Plan, StepReport};
use super::protrude::{find_grips, push_pseudopods, release_rears};
use super::refresh::fit_stiffness;
use super::rest::note_balance;
use super::state::State;
use super::traction::{begin_tractions, keep_tractions};
use super::trouble::Trouble;
use super::upright::{change_of_volumes, check_upright};
use super::velocity::measure_velocities;
use super::workspace::Workspace;

/// Moves the state by one step.
///
/// # Errors
/// Why the step could not be made; the state is the one before it, to the last byte.
pub fn step(model: &Model, state: &mut State, ws: &mut Workspace) -> Result<StepReport, Trouble> {
    let mut next = std::mem::take(&mut ws.next);
    let done = begun(model, state, ws).and_then(|from| make_step(model, &from, &mut next, ws));
    if done.is_ok() {
        std::mem::swap(state, &mut next);
    }
    ws.next = next;
    done
}

/// Lets the links carry the numbers of the start, once, and executes the events of the start; a step does so by itself.
///
/// # Errors
/// A link or an event that fails; the state is as it was.
pub fn begin_chemistry(model: &Model, state: &mut State, ws: &mut Workspace) -> Result<(), Trouble> {
    if let Cow::Owned(begun) = begun(model, state, ws)? {
        *state = begun;
    }
    Ok(())
}

/// The state with the start of chemistry made: another one in the first step of a run.
fn begun<'a>(model: &Model, state: &'a State, ws: &mut Workspace) -> Result<Cow<'a, State>, Trouble> {
    if model.chemistry.is_empty() || state.chemistry.carried {
        return Ok(Cow::Borrowed(state));
    }
    let mut begun = state.clone();
    carry_first(model, &mut begun, ws)?;
    gather_elasticity(model, &mut begun);
    Ok(Cow::Owned(begun))
}

/// Makes the state to which a step leads.
fn make_step(model: &Model, from: &State, to: &mut State, ws: &mut Workspace) -> Result<StepReport, Trouble> {
    let mut plan = prepare(model, from, to, ws)?;
    loop {
        let outcome = attempt(model, &plan, from, to, ws);
        if plan.allows(model, outcome)? && plan.accepts(model, inspect(model, &plan, from, to, ws))? {
            break;
        }
    }
    check_pierced(model, from.time + plan.dt, to)?;
    keep_contacts(model, from, to, ws);
    measure_velocities(model, plan.dt, from, to);
    keep_tractions(model, plan.dt, from, to, ws);
    note_dissipation(model, plan.dt, from, to, ws);
    note_balance(model, plan.dt, from, to, ws);
    let longest = advance_chemistry(model, plan.dt, from, to, ws)?;
    release_rears(model, to);
    note_meetings(model, to, ws);
    gather_elasticity(model, to);
    advance_clock(model, &plan, longest, to);
    Ok(plan.report())
}

/// What is the same for all attempts.
fn prepare(model: &Model, from: &State, to: &mut State, ws: &mut Workspace) -> Result<Plan, Trouble> {
    ws.suit(model, from);
    to.begin_from(from);
    fit_stiffness(model, from, to, ws);
    locate_contacts(model, from, ws);
    check_depth(model, from, ws)?;
    find_grips(model, from, ws);
    Ok(Plan::new(model, from, energy_before(model, from, ws)))
}

/// The stages of an attempt.
fn attempt(model: &Model, plan: &Plan, from: &State, to: &mut State, ws: &mut Workspace) -> Result<Estimate, Halt> {
    let (dt, end) = (plan.dt, from.time + plan.dt);
    carry_forces(model, from, ws);
    begin_tractions(model, from, ws);
    advance_behaviours(model, dt, from, to, ws);
    act_fibres(model, from, to, ws);
    push_pseudopods(model, from, to, ws);
    let error = move_freely(model, dt, from, to, ws);
    check_finite(model, end, to)?;
    plan.check_error(model, error)?;
    hold_contacts(model, dt, plan.sweep_rules(), from, to, ws)?;
    make_exact(model, end, from, to, ws)?;
    correct_velocities(model, dt, to, ws);
    check_finite(model, end, to)?;
    check_upright(model, end, to)?;
    let error = error.max(turn_over_bonds(model, dt, from, to, ws)).max(change_of_volumes(model, from, to));
    Ok(Estimate { error, travel: travel(model, from, to, ws).or_farther(travel_past(model, from, to, end)) })
}

/// Looks at where an attempt ends that its error allows.
fn inspect(model: &Model, plan: &Plan, from: &State, to: &mut State, ws: &mut Workspace) -> Option<Flaw> {
    if plan.may_repeat(model) && has_gained(model, plan.dt, plan.energy, from, to, ws) {
        return Some(Flaw::GainedEnergy);
    }
    let deepened = look_for_depth(model, from, to, ws)?;
    Some(Flaw::Deepened(deepened.breaks_promise().then(|| deepened.trouble(model, from))))
}

/// The clock shows exactly when something is to happen, whatever round-off the steps before have left; the next step
/// is no longer than chemistry allows.
fn advance_clock(model: &Model, plan: &Plan, longest: f64, to: &mut State) {
    to.time += plan.dt;
    let slack = model.clock_slack();
    let exchange = next_exchange(model, to.time - 2.0 * slack);
    if let Some(instant) = model.instants().chain([exchange]).find(|instant| (instant - to.time).abs() <= slack) {
        to.time = instant;
    }
    to.step += 1;
    to.next_step = plan.next_step(model, longest);
}
