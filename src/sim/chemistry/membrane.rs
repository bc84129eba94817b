//! What a system does on the membranes of its cells, as the Model holds it.

use super::super::kind::Kind;
use crate::membrane::{MembraneCells, MembraneState, MembraneSystem, SurfaceMesh};

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

    /// Surfaces of so many cells of each kind that have not started; `own` are the kinds that have the system.
    pub(super) fn state(&self, own: &[usize], kinds: &[Kind], cells: &[usize]) -> MembraneState {
        let one = |&kind: &usize| {
            let (lanes, atoms) = (kinds[kind].lanes, kinds[kind].atoms());
            MembraneCells::new(lanes, atoms, self.system.variables(), cells[kind], self.system.defaults())
        };
        MembraneState { kinds: own.iter().map(one).collect() }
    }
}
