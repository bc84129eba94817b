//! The stages of chemistry in a step, and when systems exchange numbers with the model.

use super::super::constraints::enforce_constraints;
use super::super::contact::locate_contacts;
use super::super::model::Model;
use super::super::state::{State, vector};
use super::super::targets::measure_volumes;
use super::super::trouble::Trouble;
use super::super::velocity::measure_velocities;
use super::super::workspace::Workspace;
use super::carry::carry_links;
use super::model::{Members, Reactor};
use crate::error::Error;
use crate::ode::{Eventful, OdeTrouble};

/// Lets the links carry the numbers of the start, and executes the events of the start, in `state`; after an error that holds
/// anything.
pub fn begin_chemistry(model: &Model, state: &mut State, ws: &mut Workspace) -> Result<(), Trouble> {
    let time = state.time;
    // Links read what touches; no step has looked for it yet.
    locate_contacts(model, state, ws);
    ws.chemistry.exchange_values(&mut state.chemistry, time);
    carry_links(model, time, true, state, ws)?;
    // What events change at the start goes through the links at once, so that the start shows it.
    if begin_events(model, state)? {
        carry_links(model, time, true, state, ws)?;
    }
    ws.chemistry.exchange_values(&mut state.chemistry, time);
    state.chemistry.carried = true;
    impose(model, time, state, ws)
}

/// Chemistry over a step of mechanics that has just been made, `dt` long and from one state to another: intracellular and scene systems,
/// secretion, fields, then the links. After an error `to` holds anything.
pub fn advance_chemistry(
    model: &Model,
    dt: f64,
    from: &State,
    to: &mut State,
    ws: &mut Workspace,
) -> Result<(), Trouble> {
    to.chemistry.copy_from(&from.chemistry);
    if model.chemistry.is_empty() {
        return Ok(());
    }
    let (start, end) = (from.time, from.time + dt);
    ws.chemistry.exchange_values(&mut to.chemistry, start);
    advance_systems(model, end, to)?;
    deposit_secretion(model, dt, to, ws);
    advance_fields(model, dt, to, ws)?;
    carry_links(model, end, false, to, ws)?;
    ws.chemistry.exchange_values(&mut to.chemistry, end);
    impose(model, end, to, ws)?;
    if model.chemistry.imposes_atoms {
        measure_velocities(model, dt, from, to);
    }
    Ok(())
}

/// The next time after `time` at which a system exchanges numbers with the model, s; a step ends there.
pub fn next_exchange(model: &Model, time: f64) -> f64 {
    let next = |every: f64| ((time / every * (1.0 + 1e-12)).floor() + 1.0) * every;
    model.chemistry.reactors.iter().filter_map(|reactor| reactor.exchange).map(next).fold(f64::INFINITY, f64::min)
}

/// Whether a system exchanges numbers with the model at a time.
pub(super) fn is_due(reactor: &Reactor, time: f64) -> bool {
    reactor.exchange.is_none_or(|every| {
        let count = time / every;
        (count - count.round()).abs() <= 1e-9 * count.abs().max(1.0)
    })
}

/// Advances all systems that are due, each from the time that it has reached.
fn advance_systems(model: &Model, end: f64, state: &mut State) -> Result<(), Trouble> {
    let chemistry = &mut state.chemistry;
    for (number, reactor) in model.chemistry.reactors.iter().enumerate() {
        let from = chemistry.times[number];
        if !is_due(reactor, end) || from >= end {
            continue;
        }
        let population = &mut chemistry.populations[number];
        let window = (from / reactor.seconds, end / reactor.seconds);
        let advanced = match reactor.events.is_empty() {
            true => population.advance(&reactor.program, window.0, window.1, &reactor.tolerances),
            false => eventful(model, reactor).advance(population, &mut chemistry.events[number], window.0, window.1),
        };
        advanced.map_err(|trouble| system_trouble(model, reactor, &trouble))?;
        chemistry.times[number] = end;
    }
    Ok(())
}

/// Executes the events of the start. Returns whether there were any.
fn begin_events(model: &Model, state: &mut State) -> Result<bool, Trouble> {
    let chemistry = &mut state.chemistry;
    let mut any = false;
    for (number, reactor) in model.chemistry.reactors.iter().enumerate().filter(|(_, r)| !r.events.is_empty()) {
        let now = chemistry.times[number] / reactor.seconds;
        let (population, memories) = (&mut chemistry.populations[number], &mut chemistry.events[number]);
        let advanced = eventful(model, reactor).advance(population, memories, now, now);
        any |= advanced.map_err(|trouble| system_trouble(model, reactor, &trouble))?.events > 0;
    }
    Ok(any)
}

/// A system with events, as it is advanced in a run.
fn eventful<'a>(model: &Model, reactor: &'a Reactor) -> Eventful<'a> {
    let span = model.until / reactor.seconds;
    Eventful { program: &reactor.program, plan: &reactor.events, tolerances: reactor.tolerances, span }
}

/// Which cell of which type, when and in which variable.
fn system_trouble(model: &Model, reactor: &Reactor, trouble: &OdeTrouble) -> Trouble {
    let cell = match (&reactor.members, trouble.cell) {
        (Members::Cells(cells), Some(member)) => cells.get(member).map(|&cell| cell as usize),
        _ => None,
    };
    let owner = cell.and_then(|cell| {
        let kind = model.kinds.iter().find(|kind| (kind.first_cell..kind.first_cell + kind.cells).contains(&cell))?;
        Some((kind.name.clone(), cell - kind.first_cell))
    });
    Trouble::System {
        system: reactor.name.clone(),
        owner,
        time: trouble.time * reactor.seconds,
        variable: trouble.variable.clone(),
        reason: trouble.reason,
        detail: trouble.detail.clone(),
    }
}

/// Releases into the fields what cells secrete in a step, spread evenly over the atoms.
fn deposit_secretion(model: &Model, dt: f64, state: &State, ws: &mut Workspace) {
    let scratch = &mut ws.chemistry;
    for (&(field, species), rates) in model.chemistry.secreted.iter().zip(&state.chemistry.controls.secretion) {
        for (kind, now) in model.kinds.iter().zip(&state.kinds) {
            let atoms = kind.atoms();
            scratch.amounts.clear();
            scratch.places.clear();
            for cell in 0..kind.cells {
                let rate = rates[kind.first_cell + cell];
                if rate != 0.0 {
                    scratch.places.extend((0..atoms).map(|atom| vector(kind, &now.positions, cell, atom)));
                    scratch.amounts.resize(scratch.places.len(), rate * dt / atoms as f64);
                }
            }
            scratch.fields[field].deposit_all(species, &scratch.places, &scratch.amounts);
        }
    }
}

/// Diffusion, decay and reactions of all fields.
fn advance_fields(model: &Model, dt: f64, state: &mut State, ws: &mut Workspace) -> Result<(), Trouble> {
    for ((reactor, fields), now) in
        model.chemistry.fields.iter().zip(&mut ws.chemistry.fields).zip(&mut state.chemistry.fields)
    {
        fields.set_pace(now.pace);
        match reactor.system.advance(fields, dt, &now.inputs, reactor.stepping.of(dt)) {
            Ok(_) => now.pace = fields.pace(),
            Err(Error::Numbers { message, .. }) => return Err(Trouble::Field { message }),
            Err(error) => return Err(Trouble::Field { message: error.to_string() }),
        }
    }
    Ok(())
}

/// After links imposed positions of atoms: the volumes are exact again with these atoms where they are.
fn impose(model: &Model, time: f64, state: &mut State, ws: &mut Workspace) -> Result<(), Trouble> {
    if !model.chemistry.imposes_atoms {
        return Ok(());
    }
    measure_volumes(model, time, state, ws);
    enforce_constraints(model, time, state, ws)
}
