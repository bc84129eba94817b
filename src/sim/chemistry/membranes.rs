//! Membranes in the step: the surfaces of the cells that have a system, kind after kind.

use super::super::kind::Kind;
use super::super::model::Model;
use super::super::state::State;
use super::model::{Members, Reactor};
use super::state::ChemistryState;
use crate::membrane::{MembraneCells, MembraneScratch, MembraneState, MembraneSystem, Shapes, SurfaceMesh};
use crate::ode::OdeTrouble;

/// What a system does on the membranes of its cells.
#[derive(Debug, Clone)]
pub struct Membrane {
    /// The compiled document.
    pub system: MembraneSystem,
    /// The surface of each kind that has it, in the order of its members.
    pub meshes: Vec<SurfaceMesh>,
}

impl Membrane {
    /// A system on the membranes of some kinds.
    pub fn new(system: MembraneSystem, kinds: &[usize], all: &[Kind]) -> Self {
        let mesh = |kind: &usize| SurfaceMesh::new(&all[*kind].rest, all[*kind].closed);
        Self { system, meshes: kinds.iter().map(mesh).collect() }
    }

    /// Surfaces of so many cells of each kind that have not started.
    pub(super) fn state(&self, members: &Members, kinds: &[Kind], cells: &[usize]) -> MembraneState {
        let Members::Kinds(own) = members else { return MembraneState::default() };
        let one = |&kind: &usize| {
            let (lanes, atoms) = (kinds[kind].lanes, kinds[kind].atoms());
            MembraneCells::new(lanes, atoms, self.system.variables(), cells[kind])
        };
        MembraneState { kinds: own.iter().map(one).collect() }
    }
}

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

/// Moves the membranes of a system through the step that leads from one state to another.
pub(super) fn advance_membrane(
    (number, reactor): (usize, &Reactor),
    membrane: &Membrane,
    window: (f64, f64),
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
        membrane.system.advance(cells, inside, &shapes, window, scratch).map_err(|trouble| OdeTrouble {
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
