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
    /// The two atoms of each edge, smaller first, sorted.
    pub edges: Vec<[u32; 2]>,
    /// Which sides are outside.
    pub sides: Sides,
    /// Whether the surface has no rim.
    pub closed: bool,
    /// The facet beyond each side of a facet, or `NONE`.
    pub(super) beyond: Vec<[u32; 3]>,
    /// The atoms across each edge (a, b): in the facet that runs from a to b and in the one from b to a, or `NONE`.
    pub(super) across: Vec<[u32; 2]>,
    /// The edges of each facet that no facet before it has; `NONE` where there are fewer than three.
    pub(super) own_edges: Vec<[u32; 3]>,
    /// The facets around each atom, sorted: `around[around_first[atom]..around_first[atom + 1]]`.
    around_first: Vec<u32>,
    around: Vec<u32>,
    /// The facets that are too near each atom at rest to touch it, sorted, in the same form.
    near_first: Vec<u32>,
    near: Vec<u32>,
    /// Facets in an order in which each eight in a row are neighbours at rest.
    pub(super) order: Vec<u32>,
}

impl Shape {
    /// Prepares a mesh at rest. `clearance` (µm) is how far along the mesh an atom does not touch its own surface: the
    /// facets around it, those that share an atom with them, and all that is connected to these and closer at rest.
    /// Choose it above the proximity at which contacts are found, else a fine mesh touches itself at rest.
    ///
    /// # Panics
    /// When a facet names an atom that the surface does not have.
    pub fn new(rest: &Surface, sides: Sides, clearance: f64) -> Self {
        let topology = Topology::of(rest);
        let edge_number = |a: u32, b: u32| topology.edges.binary_search(&[a.min(b), a.max(b)]).expect("a side is an edge");
        let mut beyond = vec![[NONE; 3]; rest.facets.len()];
        let mut across = vec![[NONE; 2]; topology.edges.len()];
        let mut own_edges = vec![[NONE; 3]; rest.facets.len()];
        let mut first_facet = vec![NONE; topology.edges.len()];
        for (number, facet) in rest.facets.iter().enumerate() {
            for side in 0..3 {
                let (from, to) = (facet[side], facet[(side + 1) % 3]);
                let edge = edge_number(from, to);
                across[edge][usize::from(from > to)] = facet[(side + 2) % 3];
                if first_facet[edge] == NONE {
                    first_facet[edge] = number as u32;
                    own_edges[number][side] = edge as u32;
                } else {
                    let other = first_facet[edge] as usize;
                    beyond[number][side] = other as u32;
                    let [a, b] = topology.edges[edge];
                    let side_of_other = (0..3).find(|&k| {
                        let ends = [rest.facets[other][k], rest.facets[other][(k + 1) % 3]];
                        ends == [a, b] || ends == [b, a]
                    });
                    beyond[other][side_of_other.expect("the other facet has the edge")] = number as u32;
                }
            }
        }
        let mut around = vec![Vec::new(); rest.positions.len()];
        for (number, facet) in rest.facets.iter().enumerate() {
            facet.iter().for_each(|&atom| around[atom as usize].push(number as u32));
        }
        let near: Vec<Vec<u32>> =
            (0..rest.positions.len()).map(|atom| near_at_rest(rest, &around, atom, clearance)).collect();
        let (around_first, around) = joined(&around);
        let (near_first, near) = joined(&near);
        Self {
            atoms: rest.positions.len(),
            facets: rest.facets.clone(),
            closed: topology.is_closed(),
            edges: topology.edges,
            sides,
            beyond,
            across,
            own_edges,
            around_first,
            around,
            near_first,
            near,
            order: order_by_place(rest),
        }
    }

    /// The facets around an atom, sorted.
    pub(super) fn around(&self, atom: usize) -> &[u32] {
        &self.around[self.around_first[atom] as usize..self.around_first[atom + 1] as usize]
    }

    /// The facets of its own surface that an atom never touches, sorted.
    pub fn near(&self, atom: usize) -> &[u32] {
        &self.near[self.near_first[atom] as usize..self.near_first[atom + 1] as usize]
    }

    /// Whether a facet is too near an atom of the same surface at rest to touch it.
    pub(super) fn is_near(&self, atom: u32, facet: u32) -> bool {
        self.near(atom as usize).binary_search(&facet).is_ok()
    }

    /// Whether two edges of the same surface are too near each other at rest to touch: a facet around an end of one is
    /// near an end of the other.
    pub(super) fn are_edges_near(&self, first: u32, second: u32) -> bool {
        let [first, second] = [self.edges[first as usize], self.edges[second as usize]];
        let facets_of = |[a, b]: [u32; 2]| {
            self.around(a as usize).iter().filter(move |&&facet| self.facets[facet as usize].contains(&b))
        };
        let near = |ends: [u32; 2], other| facets_of(other).any(|&facet| ends.iter().any(|&end| self.is_near(end, facet)));
        near(first, second) || near(second, first)
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
    let place = rest.positions[atom];
    let is_close = |facet: u32| {
        super::closest::closest_on_facet(place, rest.corners(rest.facets[facet as usize])).offset.norm() < clearance
    };
    let neighbours = |facet: u32| rest.facets[facet as usize].iter().flat_map(|&corner| &around[corner as usize]);
    let mut near: Vec<u32> = around[atom].iter().flat_map(|&facet| neighbours(facet)).copied().collect();
    near.sort_unstable();
    near.dedup();
    let mut edge_of_search = near.clone();
    while let Some(facet) = edge_of_search.pop() {
        for &next in neighbours(facet) {
            if let Err(place) = near.binary_search(&next)
                && is_close(next)
            {
                near.insert(place, next);
                edge_of_search.push(next);
            }
        }
    }
    near
}

/// The facets in an order in which each 8, 64, 512 … in a row are neighbours: halved along the longest extent of their
/// centres until eight are left.
fn order_by_place(rest: &Surface) -> Vec<u32> {
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
