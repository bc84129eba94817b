//! The pairs kept across steps: for every atom the facets, and for every edge the edges, that it may touch before it
//! has moved half of the margin.

use super::boxes::{Bounds, Pack, Steps};
use super::closest::{closest_on_facet, closest_on_segments};
use super::found::push;
use super::neighbours::Neighbours;
use super::scene::Scene;
use crate::Vec3;

/// Marks a word of a list that names the body to which the facets or edges after it belong.
pub(super) const BODY: u32 = 1 << 31;

/// Marks a word that names the atom or the edge whose list begins, counted from the first of its batch.
const OWNER: u32 = 1 << 30;

/// Bits of the number of a facet or an edge in its shape; its level stands above them.
pub(super) const NUMBER_BITS: u32 = 24;

/// The highest level of a pair.
const HIGHEST: f64 = 63.0;

/// The number of a facet or an edge in its shape.
#[inline]
pub(super) fn number(word: u32) -> u32 {
    word & ((1 << NUMBER_BITS) - 1)
}

/// How far a pair was from touching when it was collected, from 0 to 63.
#[inline]
pub(super) fn level(word: u32) -> u32 {
    word >> NUMBER_BITS
}

/// How far bodies have moved since the pairs were collected: pairs that cannot have come to touch are passed over.
pub(super) struct Moved<'a> {
    /// The farthest that an atom of each body has moved, µm.
    pub of_bodies: &'a [f64],
    /// Levels in a µm; 0 when pairs have none.
    pub scale: f64,
}

impl Moved<'_> {
    /// Nothing is known: no pair is passed over.
    pub const UNKNOWN: Self = Self { of_bodies: &[], scale: 0.0 };

    /// The highest level of a pair of two bodies that may touch now. One more than their motion says, so that rounding
    /// never hides a pair.
    #[inline]
    pub fn limit(&self, body: u32, other: u32) -> u32 {
        if self.scale == 0.0 {
            return u32::MAX;
        }
        ((self.of_bodies[body as usize] + self.of_bodies[other as usize]) * self.scale) as u32 + 1
    }
}

/// Levels in a µm for pairs that were collected with a margin.
pub(super) fn levels_over(margin: f64, range: f64) -> f64 {
    if margin > 1e-6 * range { HIGHEST / margin } else { 0.0 }
}

/// Boxes of all bodies as they were when the pairs were collected.
#[derive(Debug, Clone, Default)]
pub(super) struct Boxes {
    /// The packs of each batch.
    pub packs: Vec<Vec<Pack>>,
    /// One box per body.
    pub bounds: Vec<Bounds>,
    /// The steps in which packs are measured, one of each body.
    pub steps: Vec<Steps>,
    /// Who may touch whom.
    pub neighbours: Neighbours,
}

/// The pairs of the bodies of one batch. A list is words: the atom (or edge) that has it, marked, then a body, marked, then
/// facets (or edges) of that body as they are numbered in its shape, ascending, with their levels; then the next body.
/// Only those have a list that may touch something; lists follow each other by their owners.
#[derive(Debug, Clone, Default)]
pub(super) struct Lists {
    facets: Vec<u32>,
    edges: Vec<u32>,
    /// The farthest from which they were collected, and from which things touch, µm.
    reach: f64,
    range: f64,
    /// Levels in a µm.
    scale: f64,
    /// Scratch: the facets near one facet, as words.
    near: Vec<u32>,
}

impl Lists {
    /// The atoms that have a list of facets, counted from the first of the batch, and the lists.
    pub fn facets(&self) -> impl Iterator<Item = (u32, &[u32])> {
        by_owner(&self.facets)
    }

    /// The edges that have a list of edges, counted from the first of the batch, and the lists.
    pub fn edges(&self) -> impl Iterator<Item = (u32, &[u32])> {
        by_owner(&self.edges)
    }

    /// Words in both lists: pairs, and what they belong to.
    pub fn words(&self) -> usize {
        self.facets.len() + self.edges.len()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * (self.facets.capacity() + self.edges.capacity() + self.near.capacity())
    }

    /// Collects the pairs of a batch: all within what matters now and a margin (µm), eq. (contacts.5).
    pub fn collect(&mut self, scene: &Scene, batch: usize, positions: &[Vec3], boxes: &Boxes, margin: f64) {
        self.range = scene.reach.range();
        self.reach = self.range + margin;
        self.scale = levels_over(margin, self.range);
        self.facets.clear();
        self.edges.clear();
        let (mut first_atom, mut first_edge) = (0, 0);
        for body in scene.bodies_of(batch) {
            let shape = scene.shape(body);
            let here = scene.of_body(body, positions);
            let others = boxes.neighbours.of(body);
            let after = others.partition_point(|&other| other < body);
            for atom in 0..shape.atoms {
                let bounds = Bounds::around(&here[atom..=atom], self.reach);
                let start = self.facets.len();
                push(&mut self.facets, OWNER | (first_atom + atom as u32));
                let own = std::iter::once(&body);
                for &other in others[..after].iter().chain(own).chain(&others[after..]) {
                    if bounds.meets(&boxes.bounds[other as usize]) {
                        self.collect_facets(scene, [body, other], atom, &bounds, positions, boxes);
                    }
                }
                close(&mut self.facets, start);
            }
            for facet in 0..shape.facets.len() as u32 {
                self.collect_edges(scene, [body, first_edge], facet, &others[after..], positions, boxes);
            }
            first_atom += shape.atoms as u32;
            first_edge += shape.edges.len() as u32;
        }
        give_back(&mut self.facets);
        give_back(&mut self.edges);
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
            let squared = closest_on_facet(place, shape.corners(facet, there)).offset.norm_squared();
            if squared <= farthest {
                push(&mut self.facets, facet | level_at(squared, self.range, self.scale));
            }
        });
        self.facets[start + 1..].sort_unstable_by_key(|word| number(*word));
        close(&mut self.facets, start);
    }

    /// The edges that the edges of one facet may touch: later ones of its own body and those of bodies after it. The
    /// second number is that of the body's first edge in the batch.
    fn collect_edges(
        &mut self,
        scene: &Scene,
        [body, first_edge]: [u32; 2],
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
                self.near[start + 1..].sort_unstable();
                close(&mut self.near, start);
            }
        }
        for edge in edges {
            let ends = shape.ends(edge, here);
            let (low, high) = (ends[0].inf(&ends[1]).add_scalar(-reach), ends[0].sup(&ends[1]).add_scalar(reach));
            let owner = self.edges.len();
            push(&mut self.edges, OWNER | (first_edge + edge));
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
                    let squared = closest_on_segments(ends, [a, b]).0;
                    if squared <= reach * reach {
                        push(&mut self.edges, candidate | level_at(squared, self.range, self.scale));
                    }
                }
                close(&mut self.edges, start);
            }
            close(&mut self.edges, owner);
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
    levels.visit(packs, &boxes.steps[body as usize], bounds, &mut |slot| found(order[slot]));
}

/// The level of a pair at a squared distance (µm²), in the bits of a word that it has.
#[inline]
fn level_at(squared: f64, range: f64, scale: f64) -> u32 {
    (((squared.sqrt() - range) * scale).clamp(0.0, HIGHEST) as u32) << NUMBER_BITS
}

/// Gives memory back that only a wider margin needed.
fn give_back(list: &mut Vec<u32>) {
    if list.capacity() > list.len() + list.len() / 2 + 64 {
        list.shrink_to(list.len() + list.len() / 8);
    }
}

/// Removes a mark with nothing after it.
fn close(list: &mut Vec<u32>, start: usize) {
    if list.len() == start + 1 {
        list.pop();
    }
}

/// The lists in a row of words, each with the atom or edge that has it.
fn by_owner(words: &[u32]) -> impl Iterator<Item = (u32, &[u32])> {
    words.chunk_by(|_, next| next >> 30 != 1).map(|list| (list[0] & !OWNER, &list[1..]))
}

/// The parts of a list: each body with its facets or edges.
pub(super) fn by_body(list: &[u32]) -> impl Iterator<Item = (u32, &[u32])> {
    list.chunk_by(|_, next| next & BODY == 0).map(|part| (part[0] & !BODY, &part[1..]))
}
