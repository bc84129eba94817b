//! Membranes in the step: the surfaces of the cells that have a system, kind after kind.

use super::super::model::Model;
use super::super::state::State;
use super::membrane::Membrane;
use super::model::{Members, Reactor};
use super::state::ChemistryState;
use crate::membrane::{Course, MembraneScratch, Shapes};
use crate::ode::{Numbers, OdeTrouble, Substeps};

/// Gives the membranes of cells that have not started their first values, and works out what is summed over these.
pub fn begin_membranes(model: &Model, state: &mut State, scratch: &mut [MembraneScratch]) {
    let State { kinds, chemistry, .. } = state;
    let ChemistryState { populations, membranes, times, .. } = chemistry;
    for (number, reactor) in model.chemistry.reactors.iter().enumerate() {
        let (Some(membrane), Members::Kinds(own)) = (&reactor.membrane, &reactor.members) else { continue };
        let mut first = 0;
        for (at, &kind) in own.iter().enumerate() {
            let cells = &mut membranes[number].kinds[at];
            let shape = (&membrane.meshes[at], &kinds[kind].positions[..]);
            let inside = (&mut populations[number], first);
            membrane.system.begin(cells, inside, shape, times[number] / reactor.seconds, &mut scratch[number]);
            first += cells.cells();
        }
    }
}

/// Moves the membranes of a system through the window of the step that leads from one state to another.
pub(super) fn advance_membrane(
    (number, reactor): (usize, &Reactor),
    membrane: &Membrane,
    (substeps, numbers): (Substeps, Numbers),
    from: &State,
    to: &mut State,
    scratch: &mut MembraneScratch,
) -> Result<(), OdeTrouble> {
    let Members::Kinds(own) = &reactor.members else { return Ok(()) };
    let State { kinds, chemistry, .. } = to;
    let mut first = 0;
    for (at, &kind) in own.iter().enumerate() {
        let cells = &mut chemistry.membranes[number].kinds[at];
        let shapes =
            Shapes { mesh: &membrane.meshes[at], from: &from.kinds[kind].positions, to: &kinds[kind].positions };
        let inside = (&mut chemistry.populations[number], first);
        let course = Course { substeps, numbers, ids: &kinds[kind].ids };
        membrane.system.advance(cells, inside, &shapes, course, scratch).map_err(|trouble| OdeTrouble {
            system: reactor.name.clone(),
            cell: Some(first + trouble.cell),
            time: trouble.time,
            variable: None,
            reason: trouble.reason,
            detail: "on its membrane".to_owned(),
        })?;
        first += cells.cells();
    }
    Ok(())
}
