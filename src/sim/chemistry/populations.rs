//! Systems that are no membranes' through a window: noise kicks, and then they go on without it, eq. (noise.2).

use super::super::model::Model;
use super::super::state::KindState;
use super::model::{Members, Reactor};
use super::state::ChemistryState;
use crate::ode::{Eventful, Numbers, OdeTrouble, PopulationScratch, Substep, Substeps, Work};

/// A system with events, as it is advanced in a run.
pub(super) fn eventful<'a>(model: &Model, reactor: &'a Reactor) -> Eventful<'a> {
    let span = model.until / reactor.seconds;
    let numbers = Numbers { seed: model.seed, system: &reactor.name };
    Eventful { program: &reactor.program, plan: &reactor.events, tolerances: reactor.tolerances, span, numbers }
}

/// Moves all members of a system through a window of its time. Returns the work of a method that chooses its steps.
pub(super) fn advance_population(
    model: &Model,
    (number, reactor): (usize, &Reactor),
    substeps: Substeps,
    (kinds, chemistry): (&[KindState], &mut ChemistryState),
    scratch: &mut PopulationScratch,
) -> Result<Work, OdeTrouble> {
    let numbers = Numbers { seed: model.seed, system: &reactor.name };
    let (population, mut work) = (&mut chemistry.populations[number], Work::default());
    for Substep { begin, end, length, kick } in substeps {
        if let (Some(kick), Some(noise)) = (kick, &reactor.noise) {
            population.kick(noise, numbers, ids(kinds, &reactor.members), (begin, kick), scratch)?;
        }
        if length <= 0.0 {
            continue;
        }
        let done = match reactor.events.is_empty() {
            true => population.advance_by_clock(&reactor.program, (begin, end), &reactor.tolerances, scratch)?,
            false => {
                let events = &mut chemistry.events[number];
                let ids = ids(kinds, &reactor.members);
                eventful(model, reactor).advance(population, events, ids, (begin, end), scratch)?
            }
        };
        if reactor.method.has_error() {
            work.add(done);
        }
    }
    Ok(work)
}

/// The ids of the cells that have a system, in the order of its members; 0 for the scene.
pub(super) fn ids<'a>(cells: &'a [KindState], members: &'a Members) -> impl Iterator<Item = u64> + 'a {
    let (kinds, scene) = match members {
        Members::Scene => (&[][..], Some(0)),
        Members::Kinds(kinds) => (&kinds[..], None),
    };
    kinds.iter().flat_map(|&kind| cells[kind].ids.iter().copied()).chain(scene)
}
