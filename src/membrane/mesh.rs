//! Which atoms of a surface are neighbours.

use std::collections::BTreeMap;

use crate::geometry::Surface;

/// Atoms, facets and edges of the surface of a kind of cells, as substances on it see them.
#[derive(Debug, Clone, Default)]
pub struct SurfaceMesh {
    /// Atoms.
    pub(super) atoms: usize,
    /// Their three atoms.
    pub(super) facets: Vec<[u32; 3]>,
    /// The edge opposite each of the three atoms.
    pub(super) facet_edges: Vec<[u32; 3]>,
    /// Edges.
    pub(super) edges: usize,
    /// Where the neighbours of an atom begin in `near`; one more than there are atoms.
    pub(super) starts: Vec<u32>,
    /// Neighbours and the edges that lead to them, rising.
    pub(super) near: Vec<[u32; 2]>,
    /// Whether the surface encloses a volume.
    pub(super) closed: bool,
}

impl SurfaceMesh {
    /// The neighbourhoods of a surface.
    pub fn new(surface: &Surface, closed: bool) -> Self {
        let atoms = surface.positions.len();
        let mut numbers: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let sides = |facet: &[u32; 3]| [[facet[1], facet[2]], [facet[2], facet[0]], [facet[0], facet[1]]];
        let ordered = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        for side in surface.facets.iter().flat_map(sides) {
            numbers.insert(ordered(side), 0);
        }
        for (number, edge) in (0..).zip(numbers.values_mut()) {
            *edge = number;
        }
        let mut of: Vec<Vec<[u32; 2]>> = vec![Vec::new(); atoms];
        for (&[a, b], &edge) in &numbers {
            of[a as usize].push([b, edge]);
            of[b as usize].push([a, edge]);
        }
        let mut mesh = Self { atoms, edges: numbers.len(), closed, ..Self::default() };
        for near in &mut of {
            near.sort_unstable();
            mesh.starts.push(mesh.near.len() as u32);
            mesh.near.append(near);
        }
        mesh.starts.push(mesh.near.len() as u32);
        mesh.facets = surface.facets.clone();
        mesh.facet_edges =
            surface.facets.iter().map(|facet| sides(facet).map(|side| numbers[&ordered(side)])).collect();
        mesh
    }

    /// Atoms of a cell.
    pub fn atoms(&self) -> usize {
        self.atoms
    }

    /// Whether the surface encloses a volume.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// The neighbours of an atom, each with the edge that leads to it.
    #[inline(always)]
    pub(super) fn near(&self, atom: usize) -> &[[u32; 2]] {
        &self.near[self.starts[atom] as usize..self.starts[atom + 1] as usize]
    }
}
