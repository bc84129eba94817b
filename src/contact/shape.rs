//! What contact needs to know of a mesh, made once and shared by all cells that have it: who is whose neighbour, what
//! is too near at rest to touch, and the order in which facets are boxed together.

use crate::Vec3;
use crate::geometry::{Surface, Topology};

/// No facet there: beyond the rim of an open surface.
pub(super) const NONE: u32 = u32::MAX;

/// Which sides of a surface are outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// Only the side to which the normals point: a closed surface, or a substrate. What is behind is inside.
    Outer,
    /// Both sides: a thin open sheet. Nothing is ever inside.
    Both,
}

/// A mesh as contact sees it.
#[derive(Debug, Clone)]
pub struct Shape {
    /// Number of atoms.
    pub atoms: usize,
    /// The three atoms of each facet.
    pub facets: Vec<[u32; 3]>,
    /// The two atoms of each edge, smaller first, in the order of the first facets that have them.
    pub edges: Vec<[u32; 2]>,
    /// Which sides are outside.
    pub sides: Sides,
    /// Whether the surface has no rim.
    pub closed: bool,
    /// The facet beyond each side of a facet, or `NONE`.
    pub(super) beyond: Vec<[u32; 3]>,
    /// The atoms across each edge (a, b): in the facet that runs from a to b and in the one from b to a, or `NONE`.
    pub(super) across: Vec<[u32; 2]>,
    /// The edges of each facet that no facet before it has: those from `first_edge[facet]` to before that of the next.
    first_edge: Vec<u32>,
    /// The facets around each atom, sorted: `around[around_first[atom]..around_first[atom + 1]]`.
    around_first: Vec<u32>,
    around: Vec<u32>,
    /// The facets that are too near each atom at rest to touch it, sorted, in the same form.
    near_first: Vec<u32>,
    near: Vec<u32>,
    /// The edges that are too near each edge at rest to touch it, sorted, in the same form.
    near_edges_first: Vec<u32>,
    near_edges: Vec<u32>,
    /// The facets whose every edge is too near every edge of a facet, sorted, in the same form.
    near_facets_first: Vec<u32>,
    near_facets: Vec<u32>,
    /// Facets in an order in which each eight in a row are neighbours at rest.
    pub(super) order: Vec<u32>,
}

impl Shape {
    /// Prepares a mesh at rest. `clearance` (µm) is how far along the mesh an atom does not touch its own surface: the
    /// facets around it, those that share an atom with them, and all that is connected to these and closer at rest.
    /// Choose it above the prediction, at which contacts are found, else a fine mesh touches itself at rest.
    ///
    /// # Panics
    /// When a facet names an atom that the surface does not have.
    pub fn new(rest: &Surface, sides: Sides, clearance: f64) -> Self {
        let topology = Topology::of(rest);
        let sorted_number = |a: u32, b: u32| topology.edges.binary_search(&[a.min(b), a.max(b)]).expect("a side");
        let mut beyond = vec![[NONE; 3]; rest.facets.len()];
        let (mut edges, mut across, mut first_edge) = (Vec::new(), Vec::new(), vec![0]);
        // For each edge in sorted order: its number, its first facet and the side it is of that.
        let mut known = vec![(NONE, NONE, 0); topology.edges.len()];
        for (number, facet) in rest.facets.iter().enumerate() {
            for side in 0..3 {
                let (from, to) = (facet[side], facet[(side + 1) % 3]);
                let (edge, first, its_side) = &mut known[sorted_number(from, to)];
                if *first == NONE {
                    (*edge, *first, *its_side) = (edges.len() as u32, number as u32, side);
                    edges.push([from.min(to), from.max(to)]);
                    across.push([NONE; 2]);
                } else {
                    beyond[number][side] = *first;
                    beyond[*first as usize][*its_side] = number as u32;
                }
                across[*edge as usize][usize::from(from > to)] = facet[(side + 2) % 3];
            }
            first_edge.push(edges.len() as u32);
        }
        let edge_number = |a: u32, b: u32| known[sorted_number(a, b)].0 as usize;
        let mut around = vec![Vec::new(); rest.positions.len()];
        for (number, facet) in rest.facets.iter().enumerate() {
            facet.iter().for_each(|&atom| around[atom as usize].push(number as u32));
        }
        let near: Vec<Vec<u32>> =
            (0..rest.positions.len()).map(|atom| near_at_rest(rest, &around, atom, clearance)).collect();
        let mut near_edges = vec![Vec::new(); edges.len()];
        for (number, edge) in edges.iter().enumerate() {
            for &facet in edge.iter().flat_map(|&end| &near[end as usize]) {
                let [a, b, c] = rest.facets[facet as usize];
                for other in [edge_number(a, b), edge_number(b, c), edge_number(c, a)] {
                    near_edges[number].push(other as u32);
                    near_edges[other].push(number as u32);
                }
            }
        }
        for list in &mut near_edges {
            list.sort_unstable();
            list.dedup();
        }
        let edges_of = |facet: u32| {
            let [a, b, c] = rest.facets[facet as usize];
            [edge_number(a, b), edge_number(b, c), edge_number(c, a)]
        };
        let all_near = |one: u32, other: u32| {
            edges_of(one).iter().all(|&edge| {
                edges_of(other).iter().all(|&other| near_edges[edge].binary_search(&(other as u32)).is_ok())
            })
        };
        let near_facets: Vec<Vec<u32>> = (0..rest.facets.len() as u32)
            .map(|one| {
                near[rest.facets[one as usize][0] as usize].iter().copied().filter(|&f| all_near(one, f)).collect()
            })
            .collect();
        let (near_facets_first, near_facets) = joined(&near_facets);
        let (near_edges_first, near_edges) = joined(&near_edges);
        let (around_first, around) = joined(&around);
        let (near_first, near) = joined(&near);
        Self {
            atoms: rest.positions.len(),
            facets: rest.facets.clone(),
            closed: topology.is_closed(),
            edges,
            sides,
            beyond,
            across,
            first_edge,
            around_first,
            around,
            near_first,
            near,
            near_edges_first,
            near_edges,
            near_facets_first,
            near_facets,
            order: order_by_position(rest),
        }
    }

    /// Whether an atom is on the surface; those inside a filled body touch nothing.
    #[inline]
    pub fn is_outer(&self, atom: usize) -> bool {
        self.around_first[atom] < self.around_first[atom + 1]
    }

    /// The facets around an atom, sorted.
    pub fn around(&self, atom: usize) -> &[u32] {
        &self.around[self.around_first[atom] as usize..self.around_first[atom + 1] as usize]
    }

    /// The positions of a facet's corners, of the positions of the body's atoms. (Written out: `map` over an array is
    /// not inlined here, and this is the innermost loop.)
    #[inline]
    pub(super) fn corners(&self, facet: u32, positions: &[Vec3]) -> [Vec3; 3] {
        let [a, b, c] = self.facets[facet as usize];
        [positions[a as usize], positions[b as usize], positions[c as usize]]
    }

    /// The positions of an edge's ends.
    #[inline]
    pub(super) fn ends(&self, edge: u32, positions: &[Vec3]) -> [Vec3; 2] {
        let [a, b] = self.edges[edge as usize];
        [positions[a as usize], positions[b as usize]]
    }

    /// The edges of a facet that no facet before it has.
    pub(super) fn edges_of(&self, facet: u32) -> std::ops::Range<u32> {
        self.first_edge[facet as usize]..self.first_edge[facet as usize + 1]
    }

    /// The facets of its own surface that an atom never touches, sorted.
    pub fn near(&self, atom: usize) -> &[u32] {
        &self.near[self.near_first[atom] as usize..self.near_first[atom + 1] as usize]
    }

    /// Whether a facet is too near an atom of the same surface at rest to touch it.
    pub(super) fn is_near(&self, atom: u32, facet: u32) -> bool {
        self.near(atom as usize).binary_search(&facet).is_ok()
    }

    /// Whether no edge of one facet can touch an edge of the other, both of the same surface: see `are_edges_near`.
    pub(super) fn are_facets_near(&self, first: u32, second: u32) -> bool {
        let [start, end] = [first, first + 1].map(|facet| self.near_facets_first[facet as usize] as usize);
        self.near_facets[start..end].binary_search(&second).is_ok()
    }

    /// Whether two edges of the same surface are too near each other at rest to touch: a facet with one of them is near
    /// an end of the other.
    pub(super) fn are_edges_near(&self, first: u32, second: u32) -> bool {
        let range = self.near_edges_first[first as usize] as usize..self.near_edges_first[first as usize + 1] as usize;
        self.near_edges[range].binary_search(&second).is_ok()
    }
}

/// Lists one after the other, with where each starts.
fn joined(lists: &[Vec<u32>]) -> (Vec<u32>, Vec<u32>) {
    let mut first = vec![0];
    let mut all = Vec::new();
    for list in lists {
        all.extend(list);
        first.push(all.len() as u32);
    }
    (first, all)
}

/// The facets that an atom never touches: see [`Shape::new`].
fn near_at_rest(rest: &Surface, around: &[Vec<u32>], atom: usize, clearance: f64) -> Vec<u32> {
    let position = rest.positions[atom];
    let is_close = |facet: u32| {
        super::closest::closest_on_facet(position, rest.corners(rest.facets[facet as usize])).offset.norm() < clearance
    };
    let neighbours = |facet: u32| rest.facets[facet as usize].iter().flat_map(|&corner| &around[corner as usize]);
    let mut near: Vec<u32> = around[atom].iter().flat_map(|&facet| neighbours(facet)).copied().collect();
    near.sort_unstable();
    near.dedup();
    let mut edge_of_search = near.clone();
    while let Some(facet) = edge_of_search.pop() {
        for &next in neighbours(facet) {
            if let Err(position) = near.binary_search(&next)
                && is_close(next)
            {
                near.insert(position, next);
                edge_of_search.push(next);
            }
        }
    }
    near
}

/// The facets in an order in which each 8, 64, 512 … in a row are neighbours: halved along the longest extent of their
/// centres until eight are left.
fn order_by_position(rest: &Surface) -> Vec<u32> {
    let centres: Vec<Vec3> = rest.facets.iter().map(|&facet| rest.corners(facet).iter().sum::<Vec3>() / 3.0).collect();
    let mut order: Vec<u32> = (0..centres.len() as u32).collect();
    let mut parts = vec![(0, order.len())];
    while let Some((start, end)) = parts.pop() {
        if end - start <= 8 {
            continue;
        }
        let part = &mut order[start..end];
        let low = part.iter().fold(Vec3::repeat(f64::INFINITY), |low, &facet| low.inf(&centres[facet as usize]));
        let high = part.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |high, &facet| high.sup(&centres[facet as usize]));
        let axis = (high - low).imax();
        part.sort_unstable_by(|&left, &right| {
            centres[left as usize][axis].total_cmp(&centres[right as usize][axis]).then(left.cmp(&right))
        });
        let mut unit = 8;
        while 8 * unit < part.len() {
            unit *= 8;
        }
        let half = (part.len().div_ceil(unit)).div_ceil(2) * unit;
        parts.push((start, start + half));
        parts.push((start + half, end));
    }
    order
}
