//! The stages of chemistry in a step.

use std::borrow::Cow;

use super::super::constraints::enforce_constraints;
use super::super::contact::locate_contacts;
use super::super::model::Model;
use super::super::state::State;
use super::super::targets::measure_volumes;
use super::super::trouble::Trouble;
use super::super::velocity::measure_velocities;
use super::super::workspace::Workspace;
use super::advance::{advance_system, system_trouble};
use super::carry::carry_links;
use super::correct::{has_changed, longest_next, moved, note_means, tell_means};
use super::fields::{look_at_fields, settle_fields};
use super::follow::{follow, is_releasing};
use super::membranes::begin_membranes;
use super::model::Reactor;
use super::populations::{advance_population, eventful, ids};
use super::release::move_fields;
use super::scratch::ChemistryScratch;
use super::state::ChemistryState;
use crate::ode::{PopulationScratch, Substeps};

/// Lets the links carry the numbers of the start, and executes the events of the start, in `state`; after an error that holds
/// anything.
pub fn begin_chemistry(model: &Model, state: &mut State, ws: &mut Workspace) -> Result<(), Trouble> {
    let time = state.time;
    ws.suit(model, state);
    // Links read what touches; no step has looked for it yet.
    locate_contacts(model, state, ws);
    begin_membranes(model, state, &mut ws.chemistry.membranes);
    ws.chemistry.exchange_values(&mut state.chemistry, time);
    // Links read sums over fields, too.
    look_at_fields(model, state, ws);
    carry_links(model, time, true, state, ws)?;
    // What events change at the start goes through the links at once, so that the start shows it.
    let events = begin_events(model, state, &mut ws.chemistry.populations)?;
    if settle_fields(model, state, ws)? || events {
        carry_links(model, time, true, state, ws)?;
    }
    ws.chemistry.exchange_values(&mut state.chemistry, time);
    state.chemistry.carried = true;
    impose(model, time, state, ws)
}

/// Chemistry over a step of mechanics that has just been made, `dt` long and from one state to another: intracellular and scene systems,
/// secretion, fields, then the links. After an error `to` holds anything. Returns how long the next step may be, s, for what these do to each other.
pub fn advance_chemistry(
    model: &Model,
    dt: f64,
    from: &State,
    to: &mut State,
    ws: &mut Workspace,
) -> Result<f64, Trouble> {
    to.chemistry.copy_from(&from.chemistry);
    let mut longest = f64::INFINITY;
    if model.chemistry.is_empty() {
        return Ok(longest);
    }
    let (end, chemistry) = (from.time + dt, &model.chemistry);
    to.chemistry.told_means = false;
    move_chemistry(model, dt, from, to, ws)?;
    // What links impose on atoms has changed shapes that a second time must begin with.
    if !chemistry.imposes_atoms && has_changed(chemistry, &from.chemistry, &to.chemistry) {
        let mut means = std::mem::take(&mut ws.chemistry.means);
        note_means(chemistry, &from.chemistry, &to.chemistry, &mut means);
        to.chemistry.copy_from(&from.chemistry);
        tell_means(chemistry, &means, &mut to.chemistry);
        ws.chemistry.means = means;
        to.chemistry.told_means = true;
        move_chemistry(model, dt, from, to, ws)?;
        longest = longest_next(dt, moved(chemistry, &from.chemistry, &ws.chemistry.means, &to.chemistry));
    }
    impose(model, end, to, ws)?;
    if model.chemistry.imposes_atoms {
        measure_velocities(model, dt, from, to);
    }
    Ok(longest)
}

/// Systems, secretion and fields over a step under what they are told where it begins, and then what links carry at its end.
fn move_chemistry(model: &Model, dt: f64, from: &State, to: &mut State, ws: &mut Workspace) -> Result<(), Trouble> {
    let (start, end) = (from.time, from.time + dt);
    ws.chemistry.exchange_values(&mut to.chemistry, start);
    let is_moved_here =
        |number: &usize| !is_releasing(model, *number) && model.chemistry.reactors[*number].is_moved_alone();
    for number in (0..model.chemistry.reactors.len()).filter(is_moved_here) {
        advance_system(model, number, end, from, to, &mut ws.chemistry)?;
    }
    follow(model, (start, dt), from, to, ws)?;
    move_fields(model, (start, dt), from, to, ws)?;
    carry_links(model, end, false, to, ws)?;
    ws.chemistry.exchange_values(&mut to.chemistry, end);
    Ok(())
}

/// Solves systems from where a step began to the time of a state within it, what they are told standing still as in the step: those without noise
/// that are no membranes', and that move in it at all. The others, and one that fails, are left as they are.
pub fn advance_systems_to(
    model: &Model,
    (from, to): (&ChemistryState, &ChemistryState),
    within: &mut State,
    scratch: &mut ChemistryScratch,
) {
    let time = within.time;
    let begun = if to.told_means { with_means(model, from, to) } else { Cow::Borrowed(from) };
    let from = &*begun;
    for (number, reactor) in model.chemistry.reactors.iter().enumerate() {
        let begun = from.times[number];
        let stands_still = begun == within.chemistry.times[number] || begun >= time;
        let is_alone = reactor.membrane.is_none() && reactor.noise.is_none() && reactor.is_moved_alone();
        if !from.carried || stands_still || !is_alone {
            continue;
        }
        let State { kinds, chemistry, .. } = &mut *within;
        let between = (chemistry.populations[number].clone(), chemistry.events[number].clone());
        (chemistry.populations[number], chemistry.events[number]) =
            (from.populations[number].clone(), from.events[number].clone());
        let substeps =
            Substeps::between(reactor.pace, from.kicks[number], begun / reactor.seconds, time / reactor.seconds);
        let solved = advance_population(
            model,
            (number, reactor),
            substeps,
            (kinds, chemistry),
            &mut scratch.populations[number],
        );
        match solved {
            Ok(_) => chemistry.times[number] = time,
            Err(_) => (chemistry.populations[number], chemistry.events[number]) = between,
        }
    }
}

/// The state where a step began, with the means that systems were told in it.
fn with_means<'a>(model: &Model, from: &ChemistryState, to: &ChemistryState) -> Cow<'a, ChemistryState> {
    let (mut begun, mut means) = (from.clone(), Vec::new());
    note_means(&model.chemistry, from, to, &mut means);
    tell_means(&model.chemistry, &means, &mut begun);
    Cow::Owned(begun)
}

/// Executes the events of the start. Returns whether there were any.
fn begin_events(model: &Model, state: &mut State, scratch: &mut [PopulationScratch]) -> Result<bool, Trouble> {
    let mut any = false;
    let begins_here = |reactor: &Reactor| !reactor.events.is_empty() && reactor.is_moved_alone();
    for (number, reactor) in model.chemistry.reactors.iter().enumerate().filter(|(_, r)| begins_here(r)) {
        let chemistry = &mut state.chemistry;
        let now = chemistry.times[number] / reactor.seconds;
        let (population, memories) = (&mut chemistry.populations[number], &mut chemistry.events[number]);
        let (ids, scratch) = (ids(&state.kinds, &reactor.members), &mut scratch[number]);
        let advanced = eventful(model, reactor).advance(population, memories, ids, (now, now), scratch);
        any |= advanced.map_err(|trouble| system_trouble(model, state, reactor, &trouble))?.events > 0;
    }
    Ok(any)
}

/// After links imposed positions of atoms: the volumes are exact again with these atoms where they are.
fn impose(model: &Model, time: f64, state: &mut State, ws: &mut Workspace) -> Result<(), Trouble> {
    if !model.chemistry.imposes_atoms {
        return Ok(());
    }
    measure_volumes(model, time, state, ws);
    enforce_constraints(model, time, state, ws)
}
