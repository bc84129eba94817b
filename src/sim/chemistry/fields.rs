//! Fields in the step, with what stands beside them.

use super::super::model::Model;
use super::super::state::State;
use super::super::trouble::Trouble;
use super::super::workspace::Workspace;
use super::populations::eventful;
use super::state::{ChemistryState, FieldState};
use crate::error::Error;
use crate::field::{Fields, Scene};
use crate::ode::{Numbers, Substeps};

/// Noise, diffusion, decay and reactions of a field.
pub(super) fn advance_field(
    (model, number): (&Model, usize),
    (start, dt): (f64, f64),
    state: &mut State,
    ws: &mut Workspace,
) -> Result<(), Trouble> {
    let reactor = &model.chemistry.fields[number];
    ws.chemistry.fields[number].set_pace(state.chemistry.fields[number].pace);
    let numbers = Numbers { seed: model.seed, system: &reactor.name };
    let substeps = Substeps::new(reactor.pace, state.chemistry.fields[number].kicks, start, dt);
    for part in substeps {
        let (fields, inputs) = (&mut ws.chemistry.fields[number], &state.chemistry.fields[number].inputs);
        if let Some(kick) = part.kick {
            reactor.system.kick(fields, inputs, kick, numbers).map_err(trouble)?;
        }
        let stepping = reactor.stepping.of(part.length);
        let moved = match reactor.scene {
            None => reactor.system.advance(fields, part.length, inputs, stepping),
            Some(beside) => {
                let (fields, inputs, scene) = beside_fields(model, (number, beside), state, ws);
                reactor.system.advance_with(fields, part.length, inputs, stepping, scene)
            }
        };
        moved.map_err(trouble)?;
    }
    let now = &mut state.chemistry.fields[number];
    (now.pace, now.kicks) = (ws.chemistry.fields[number].pace(), substeps.kicks_at_end());
    if let Some(beside) = reactor.scene {
        state.chemistry.times[beside] = start + dt;
    }
    Ok(())
}

fn trouble(error: Error) -> Trouble {
    match error {
        Error::Numbers { message, .. } => Trouble::Field { message },
        error => Trouble::Field { message: error.to_string() },
    }
}

/// Lets fields and what stands beside them see each other as they are.
pub fn look_at_fields(model: &Model, state: &mut State, ws: &mut Workspace) {
    for (number, reactor) in model.chemistry.fields.iter().enumerate() {
        if let Some(beside) = reactor.scene {
            let (fields, now, scene) = beside_fields(model, (number, beside), state, ws);
            reactor.system.look(fields, now, scene);
        }
    }
}

/// The same, and executes the events that are due. Returns whether there were any.
///
/// # Errors
/// Events without end, or values that cannot be.
pub fn settle_fields(model: &Model, state: &mut State, ws: &mut Workspace) -> Result<bool, Trouble> {
    let mut any = false;
    for (number, reactor) in model.chemistry.fields.iter().enumerate() {
        if let Some(beside) = reactor.scene {
            let (fields, inputs, scene) = beside_fields(model, (number, beside), state, ws);
            any |= reactor.system.settle(fields, inputs, scene).map_err(trouble)?;
        }
    }
    Ok(any)
}

/// Fields, their inputs and what stands beside them, to be moved together.
fn beside_fields<'a>(
    model: &'a Model,
    (field, beside): (usize, usize),
    state: &'a mut State,
    ws: &'a mut Workspace,
) -> (&'a mut Fields, &'a mut [f64], Scene<'a>) {
    let ChemistryState { populations, events, fields, .. } = &mut state.chemistry;
    let FieldState { inputs, scene: pace, .. } = &mut fields[field];
    let scene = Scene {
        eventful: eventful(model, &model.chemistry.reactors[beside]),
        population: &mut populations[beside],
        memories: &mut events[beside],
        pace,
        scratch: &mut ws.chemistry.scenes[field],
    };
    (&mut ws.chemistry.fields[field], inputs, scene)
}
