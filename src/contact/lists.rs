//! The pairs kept across steps: for every atom the facets, and for every edge the edges, that it may touch before it
//! has moved half of the margin.

use super::boxes::{Bounds, Pack, Steps};
use super::closest::{closest_on_facet, closest_on_segments};
use super::motion::Motion;
use super::neighbours::Neighbours;
use super::ridge::Ridge;
use super::scene::Scene;
use super::shape::Shape;
use super::turned::turned_for;
use super::words::{HIGHEST, Words};
use crate::Vec3;

/// How far bodies have moved since the pairs were collected: pairs that cannot have come to touch are passed over.
pub(super) struct Moved<'a> {
    /// How each body has moved.
    pub of_bodies: &'a [Motion],
    /// Levels in a µm; 0 when pairs have none.
    pub scale: f64,
}

impl Moved<'_> {
    /// The highest level of a pair of two bodies that may touch now, by their motion beside each other since pairs were collected,
    /// eq. (contacts.11). One more than that says, so that rounding never hides a pair.
    #[inline]
    pub fn limit(&self, bodies: [u32; 2]) -> u32 {
        if self.scale == 0.0 {
            return HIGHEST;
        }
        let [one, other] = bodies.map(|body| &self.of_bodies[body as usize]);
        (one.beside(other) * self.scale) as u32 + 1
    }
}

/// Levels in a µm for pairs that were collected with a margin.
pub(super) fn levels_over(margin: f64, range: f64) -> f64 {
    if margin > 1e-6 * range { f64::from(HIGHEST) / margin } else { 0.0 }
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

/// The pairs of the bodies of one batch.
#[derive(Debug, Clone, Default)]
pub(super) struct Lists {
    /// For atoms, counted from the first of the batch, the facets.
    pub facets: Words,
    /// For edges, counted from the first of the batch, the edges.
    pub edges: Words,
    /// The farthest from which they were collected, and from which things touch, µm.
    pub(super) reach: f64,
    range: f64,
    /// Levels in a µm.
    scale: f64,
    /// Scratch: the facets near one facet: of each body its index among the neighbours, how many facets, and these.
    pub(super) near: Vec<u32>,
    /// Scratch: the pairs with one other body, as (number, level).
    pub(super) pairs: Vec<(u32, u32)>,
}

impl Lists {
    /// Words in both lists: pairs, and what they belong to.
    pub fn words(&self) -> usize {
        self.facets.len() + self.edges.len()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.facets.bytes() + self.edges.bytes() + 4 * self.near.capacity() + 8 * self.pairs.capacity()
    }

    /// Collects the pairs of a batch: all within what matters now and a margin (µm), eq. (contacts.5), but those of round bodies with themselves.
    pub fn collect(
        &mut self,
        scene: &Scene,
        batch: usize,
        positions: &[Vec3],
        boxes: &Boxes,
        (margin, round): (f64, &[bool]),
    ) {
        self.range = scene.reach.range();
        self.reach = self.range + margin;
        self.scale = levels_over(margin, self.range);
        self.facets.clear();
        self.edges.clear();
        let (mut first_atom, mut first_edge) = (0, 0);
        for body in scene.bodies_of(batch) {
            let shape = scene.shape(body);
            let here = scene.of_body(body, positions);
            let neighbours = boxes.neighbours.of(body);
            let may_touch = |other: u32| other != body || !round[body as usize];
            for atom in (0..shape.atoms).filter(|atom| shape.is_outer(*atom)) {
                let bounds = Bounds::around(&here[atom..=atom], self.reach);
                for (&other, position) in neighbours.iter().zip(0..) {
                    if may_touch(other) && bounds.meets(&boxes.bounds[other as usize]) {
                        let there = scene.of_body(other, positions);
                        self.collect_facets(scene, [body, other], atom, &bounds, [here, there], boxes);
                        self.facets.add(first_atom + atom as u32, position, &self.pairs);
                    }
                }
            }
            for facet in 0..shape.facets.len() as u32 {
                self.gather_near(scene, body, facet, here, boxes, |position| may_touch(neighbours[position]));
                let near = std::mem::take(&mut self.near);
                for edge in shape.edges_of(facet) {
                    let first = Edge::of(shape, here, edge, self.reach);
                    let mut rest = &near[..];
                    while let Some((position, facets)) = next_near(&mut rest) {
                        let other = neighbours[position as usize];
                        let there = scene.of_body(other, positions);
                        self.collect_edges(scene, [body, other], &first, facets, there);
                        self.edges.add(first_edge + edge, position, &self.pairs);
                    }
                }
                self.near = near;
            }
            first_atom += shape.atoms as u32;
            first_edge += shape.edges.len() as u32;
        }
        self.facets.release_spare();
        self.edges.release_spare();
    }

    /// Writes the facets of one other body (or its own) that an atom may touch over `pairs`; positions are of the atoms of both.
    pub(super) fn collect_facets(
        &mut self,
        scene: &Scene,
        [body, other]: [u32; 2],
        atom: usize,
        bounds: &Bounds,
        [here, there]: [&[Vec3]; 2],
        boxes: &Boxes,
    ) {
        let (shape, position) = (scene.shape(other), here[atom]);
        let farthest = self.reach.powi(2);
        self.pairs.clear();
        visit(scene, other, boxes, bounds, &mut |facet| {
            if other == body && shape.is_near(atom as u32, facet) {
                return;
            }
            let squared = closest_on_facet(position, shape.corners(facet, there)).offset.norm_squared();
            if squared <= farthest {
                self.pairs.push((facet, level_at(squared, self.range, self.scale)));
            }
        });
        self.pairs.sort_unstable();
    }

    /// Writes the facets near one of a body whose atoms are `here` over `near`, if it has edges of its own: those of its own body and
    /// of bodies after it, as far as they are wanted by their index among the neighbours.
    pub(super) fn gather_near(
        &mut self,
        scene: &Scene,
        body: u32,
        facet: u32,
        here: &[Vec3],
        boxes: &Boxes,
        is_wanted: impl Fn(usize) -> bool,
    ) {
        self.near.clear();
        let shape = scene.shape(body);
        if shape.edges_of(facet).is_empty() {
            return;
        }
        let bounds = Bounds::around(&shape.corners(facet, here), self.reach);
        for (&other, position) in boxes.neighbours.of(body).iter().zip(0..).filter(|(other, _)| **other >= body) {
            if is_wanted(position as usize) && bounds.meets(&boxes.bounds[other as usize]) {
                let start = self.near.len();
                self.near.extend([position, 0]);
                visit(scene, other, boxes, &bounds, &mut |candidate| {
                    if other != body || !shape.are_facets_near(facet, candidate) {
                        self.near.push(candidate);
                    }
                });
                self.near[start + 2..].sort_unstable();
                self.near[start + 1] = (self.near.len() - start - 2) as u32;
            }
        }
    }

    /// Writes the edges of some facets of a body (or its own), whose atoms are `there`, that an edge may touch over `pairs`.
    pub(super) fn collect_edges(
        &mut self,
        scene: &Scene,
        [body, other]: [u32; 2],
        first: &Edge,
        facets: &[u32],
        there: &[Vec3],
    ) {
        let (shape, reach) = (scene.shape(other), self.reach);
        let Edge { number, ends, ridge, low, high } = first;
        self.pairs.clear();
        for candidate in facets.iter().flat_map(|&facet| shape.edges_of(facet)) {
            let [a, b] = shape.ends(candidate, there);
            let apart = |axis: usize| {
                let (less, more) = if a[axis] < b[axis] { (a[axis], b[axis]) } else { (b[axis], a[axis]) };
                (less > high[axis]) | (more < low[axis])
            };
            let apart = apart(0) | apart(1) | apart(2);
            if apart || other == body && (candidate <= *number || shape.are_edges_near(*number, candidate)) {
                continue;
            }
            let squared = closest_on_segments(*ends, [a, b]).0;
            if squared <= reach * reach {
                let turned = turned_for(ridge, &Ridge::of(shape, there, candidate), reach - self.range);
                let level = level_at(squared, self.range, self.scale).max((turned * self.scale) as u32);
                self.pairs.push((candidate, level));
            }
        }
    }
}

/// An edge whose pairs are collected.
pub(super) struct Edge<'a> {
    number: u32,
    ends: [Vec3; 2],
    ridge: Ridge<'a>,
    /// The box around it, grown by the reach.
    low: Vec3,
    high: Vec3,
}

impl<'a> Edge<'a> {
    /// An edge of a body whose atoms are `here`.
    pub fn of(shape: &'a Shape, here: &'a [Vec3], number: u32, reach: f64) -> Self {
        let ends = shape.ends(number, here);
        let (low, high) = (ends[0].inf(&ends[1]).add_scalar(-reach), ends[0].sup(&ends[1]).add_scalar(reach));
        Self { number, ends, ridge: Ridge::of(shape, here, number), low, high }
    }
}

/// The next body of a list of near facets, by its index among the neighbours, and its facets.
pub(super) fn next_near<'a>(rest: &mut &'a [u32]) -> Option<(u32, &'a [u32])> {
    let [position, count, others @ ..] = *rest else { return None };
    let (facets, next) = others.split_at(*count as usize);
    *rest = next;
    Some((*position, facets))
}

/// Calls `found` with every facet of a body whose box meets `bounds`.
#[inline]
pub(super) fn visit(scene: &Scene, body: u32, boxes: &Boxes, bounds: &Bounds, found: &mut impl FnMut(u32)) {
    let of = &scene.bodies[body as usize];
    let levels = &scene.levels[of.shape as usize];
    let packs = &boxes.packs[of.batch as usize][of.first_pack as usize..][..levels.packs()];
    let order = &scene.shapes[of.shape as usize].order;
    levels.visit(packs, &boxes.steps[body as usize], bounds, &mut |slot| found(order[slot]));
}

/// The level of a pair at a squared distance, µm².
#[inline]
fn level_at(squared: f64, range: f64, scale: f64) -> u32 {
    ((squared.sqrt() - range) * scale).clamp(0.0, f64::from(HIGHEST)) as u32
}
