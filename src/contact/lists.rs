//! The pairs kept across steps: for every atom the facets, and for every edge the edges, that it may touch before it
//! has moved half of the margin.

use super::boxes::{Bounds, Pack};
use super::closest::{closest_on_facet, closest_on_segments};
use super::found::push;
use super::neighbours::Neighbours;
use super::scene::Scene;
use crate::Vec3;

/// Marks a word of a list that names the body to which the facets or edges after it belong.
pub(super) const BODY: u32 = 1 << 31;

/// Boxes of all bodies as they were when the pairs were collected.
#[derive(Debug, Clone, Default)]
pub(super) struct Boxes {
    /// The packs of each batch.
    pub packs: Vec<Vec<Pack>>,
    /// One box per body.
    pub bounds: Vec<Bounds>,
    /// Who may touch whom.
    pub neighbours: Neighbours,
}

/// The pairs of the bodies of one batch. A list is words: a body, marked, then facets (or edges) of that body as they
/// are numbered in its shape, ascending; then the next body.
#[derive(Debug, Clone, Default)]
pub(super) struct Lists {
    facets_first: Vec<u32>,
    facets: Vec<u32>,
    edges_first: Vec<u32>,
    edges: Vec<u32>,
    /// The farthest from which they were collected, µm.
    reach: f64,
    /// Scratch: the facets near one facet, as words.
    near: Vec<u32>,
}

impl Lists {
    /// The list of facets of an atom, counted from the first of the batch.
    pub fn facets(&self, atom: usize) -> &[u32] {
        &self.facets[self.facets_first[atom] as usize..self.facets_first[atom + 1] as usize]
    }

    /// The list of edges of an edge, counted from the first of the batch.
    pub fn edges(&self, edge: usize) -> &[u32] {
        &self.edges[self.edges_first[edge] as usize..self.edges_first[edge + 1] as usize]
    }

    /// Words in both lists: pairs, and bodies before them.
    pub fn words(&self) -> usize {
        self.facets.len() + self.edges.len()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * (self.facets_first.capacity() + self.facets.capacity())
            + 4 * (self.edges_first.capacity() + self.edges.capacity() + self.near.capacity())
    }

    /// Collects the pairs of a batch: all within `reach` (µm), eq. (contacts.5).
    pub fn collect(&mut self, scene: &Scene, batch: usize, positions: &[Vec3], boxes: &Boxes, reach: f64) {
        self.reach = reach;
        self.facets_first.clear();
        self.facets.clear();
        self.edges_first.clear();
        self.edges.clear();
        push(&mut self.facets_first, 0);
        push(&mut self.edges_first, 0);
        for body in scene.bodies_of(batch) {
            let shape = scene.shape(body);
            let here = scene.of_body(body, positions);
            let others = boxes.neighbours.of(body);
            let after = others.partition_point(|&other| other < body);
            for atom in 0..shape.atoms {
                let bounds = Bounds::around(&here[atom..=atom], self.reach);
                let own = std::iter::once(&body);
                for &other in others[..after].iter().chain(own).chain(&others[after..]) {
                    if bounds.meets(&boxes.bounds[other as usize]) {
                        self.collect_facets(scene, [body, other], atom, &bounds, positions, boxes);
                    }
                }
                push(&mut self.facets_first, self.facets.len() as u32);
            }
            for facet in 0..shape.facets.len() as u32 {
                self.collect_edges(scene, body, facet, &others[after..], positions, boxes);
            }
        }
    }

    /// The facets of one other body (or its own) that an atom may touch.
    fn collect_facets(
        &mut self,
        scene: &Scene,
        [body, other]: [u32; 2],
        atom: usize,
        bounds: &Bounds,
        positions: &[Vec3],
        boxes: &Boxes,
    ) {
        let (shape, there) = (scene.shape(other), scene.of_body(other, positions));
        let place = scene.of_body(body, positions)[atom];
        let farthest = self.reach.powi(2);
        let start = self.facets.len();
        push(&mut self.facets, other | BODY);
        visit(scene, other, boxes, bounds, &mut |facet| {
            if other == body && shape.is_near(atom as u32, facet) {
                return;
            }
            if closest_on_facet(place, shape.corners(facet, there)).offset.norm_squared() <= farthest {
                push(&mut self.facets, facet);
            }
        });
        close(&mut self.facets, start);
    }

    /// The edges that the edges of one facet may touch: later ones of its own body and those of bodies after it.
    fn collect_edges(
        &mut self,
        scene: &Scene,
        body: u32,
        facet: u32,
        after: &[u32],
        positions: &[Vec3],
        boxes: &Boxes,
    ) {
        let shape = scene.shape(body);
        let edges = shape.edges_of(facet);
        if edges.is_empty() {
            return;
        }
        let here = scene.of_body(body, positions);
        let reach = self.reach;
        let bounds = Bounds::around(&shape.corners(facet, here), reach);
        self.near.clear();
        for &other in std::iter::once(&body).chain(after) {
            if bounds.meets(&boxes.bounds[other as usize]) {
                let start = self.near.len();
                push(&mut self.near, other | BODY);
                visit(scene, other, boxes, &bounds, &mut |candidate| {
                    if other != body || !shape.are_facets_near(facet, candidate) {
                        push(&mut self.near, candidate);
                    }
                });
                close(&mut self.near, start);
            }
        }
        for edge in edges {
            let ends = shape.ends(edge, here);
            let (low, high) = (ends[0].inf(&ends[1]).add_scalar(-reach), ends[0].sup(&ends[1]).add_scalar(reach));
            for (other, facets) in by_body(&self.near) {
                let (shape, there) = (scene.shape(other), scene.of_body(other, positions));
                let start = self.edges.len();
                push(&mut self.edges, other | BODY);
                for candidate in facets.iter().flat_map(|&facet| shape.edges_of(facet)) {
                    let [a, b] = shape.ends(candidate, there);
                    let apart = |axis: usize| {
                        let (less, more) = if a[axis] < b[axis] { (a[axis], b[axis]) } else { (b[axis], a[axis]) };
                        (less > high[axis]) | (more < low[axis])
                    };
                    let apart = apart(0) | apart(1) | apart(2);
                    if apart || other == body && (candidate <= edge || shape.are_edges_near(edge, candidate)) {
                        continue;
                    }
                    if closest_on_segments(ends, [a, b]).0 <= reach * reach {
                        push(&mut self.edges, candidate);
                    }
                }
                if self.edges.len() == start + 1 {
                    self.edges.pop();
                }
            }
            push(&mut self.edges_first, self.edges.len() as u32);
        }
    }
}

/// Calls `found` with every facet of a body whose box meets `bounds`.
#[inline]
fn visit(scene: &Scene, body: u32, boxes: &Boxes, bounds: &Bounds, found: &mut impl FnMut(u32)) {
    let of = &scene.bodies[body as usize];
    let levels = &scene.levels[of.shape as usize];
    let packs = &boxes.packs[of.batch as usize][of.first_pack as usize..][..levels.packs()];
    let order = &scene.shapes[of.shape as usize].order;
    levels.visit(packs, bounds, &mut |slot| found(order[slot]));
}

/// Sorts what was found for one body, and removes its mark when that is nothing.
fn close(list: &mut Vec<u32>, start: usize) {
    if list.len() == start + 1 {
        list.pop();
    } else {
        list[start + 1..].sort_unstable();
    }
}

/// The parts of a list: each body with its facets or edges.
pub(super) fn by_body(list: &[u32]) -> impl Iterator<Item = (u32, &[u32])> {
    list.chunk_by(|_, next| next & BODY == 0).map(|part| (part[0] & !BODY, &part[1..]))
}
