//! One system through a window of the step.

use super::super::model::Model;
use super::super::state::State;
use super::super::trouble::Trouble;
use super::census::cell_of_member;
use super::exchange::is_due;
use super::membranes::advance_membrane;
use super::model::Reactor;
use super::populations::advance_population;
use super::scratch::ChemistryScratch;
use crate::ode::{Numbers, OdeTrouble, Substeps, Work};

/// Advances a system, if it is due, from the time that it has reached. Returns the work of a method that chooses its steps.
///
/// # Errors
/// It fails.
pub fn advance_system(
    model: &Model,
    number: usize,
    end: f64,
    before: &State,
    state: &mut State,
    scratch: &mut ChemistryScratch,
) -> Result<Work, Trouble> {
    let (reactor, from) = (&model.chemistry.reactors[number], state.chemistry.times[number]);
    if !is_due(reactor, end) || from >= end {
        return Ok(Work::default());
    }
    let (begin, until) = (from / reactor.seconds, end / reactor.seconds);
    let substeps = Substeps::between(reactor.pace, state.chemistry.kicks[number], begin, until);
    let advanced = match &reactor.membrane {
        Some(membrane) => {
            let numbers = Numbers { seed: model.seed, system: &reactor.name };
            let scratch = &mut scratch.membranes[number];
            advance_membrane((number, reactor), membrane, (substeps, numbers), before, state, scratch)
                .map(|()| Work::default())
        }
        None => {
            let (State { kinds, chemistry, .. }, scratch) = (&mut *state, &mut scratch.populations[number]);
            advance_population(model, (number, reactor), substeps, (kinds, chemistry), scratch)
        }
    };
    let work = advanced.map_err(|trouble| system_trouble(model, state, reactor, &trouble))?;
    state.chemistry.times[number] = end;
    state.chemistry.kicks[number] = substeps.kicks_at_end();
    Ok(work)
}

/// Which cell of which type, when and in which variable.
pub fn system_trouble(model: &Model, state: &State, reactor: &Reactor, trouble: &OdeTrouble) -> Trouble {
    let cell = trouble.cell.and_then(|member| cell_of_member(&state.kinds, &reactor.members, member));
    let owner = cell.map(|cell| state.kind_of(cell)).map(|(kind, cell)| (model.kinds[kind].name.clone(), cell));
    Trouble::System {
        system: reactor.name.clone(),
        owner,
        time: trouble.time * reactor.seconds,
        variable: trouble.variable.clone(),
        reason: trouble.reason,
        detail: trouble.detail.clone(),
    }
}
