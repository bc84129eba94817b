//! Everything that can touch: the surfaces of cells, sheets and rigid bodies, one after the other, and rigid obstacles.

use std::sync::Arc;

use super::boxes::Levels;
use super::owners::Owners;
use super::shape::{Shape, Sides};
use crate::Vec3;
use crate::geometry::Obstacle;

/// How near is a contact. All are lengths in µm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// Pairs with a gap below this touch: what surfaces do to each other besides pushing goes by it, and what counts touches. At most the
    /// prediction. Default in experiments: a tenth of the mean edge.
    pub proximity: f64,
    /// Pairs with a gap below this are found as contacts, which keep apart what would meet in a step. It bounds steps and is no part of
    /// what cells do.
    pub prediction: f64,
    /// Atoms and edges that are inside another surface by no more than this are found. It must be less than the
    /// thickness of the thinnest surface.
    pub depth: f64,
    /// Pairs are collected from at least this much farther away, and collected again when an atom has moved half of
    /// what they were collected with: where atoms are fast, a detector takes more.
    pub margin: f64,
}

impl Reach {
    /// The farthest that matters now, µm.
    pub(super) fn range(&self) -> f64 {
        self.prediction.max(self.depth)
    }

    /// The largest displacement of atoms between two detections for which nothing is missed, µm: half of the smaller
    /// of prediction and depth, eq. (contacts.6).
    ///
    /// When no atom moves farther, whatever was outside and comes to touch was either a contact before or ends inside
    /// by no more than the depth, and is found there. Self-contact and sheets with two outer sides know no inside:
    /// only what was a contact before, and is held by it, cannot pass.
    pub fn safe_travel(&self) -> f64 {
        0.5 * self.prediction.min(self.depth)
    }

    /// Whether surfaces with such a gap (µm) touch.
    pub fn touches(&self, gap: f64) -> bool {
        gap < self.proximity
    }
}

/// One surface in a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Body {
    /// Index of its shape.
    pub shape: u32,
    /// Number of its first atom among all atoms.
    pub first_atom: u32,
    /// Number of its first facet among all facets.
    pub first_facet: u32,
    /// Number of its first edge among all edges.
    pub first_edge: u32,
    /// The batch of neighbouring numbers that it is worked on with.
    pub(super) batch: u32,
    /// Its first pack of boxes in that batch.
    pub(super) first_pack: u32,
}

/// Bodies whose numbers follow each other and that one thread works on: as many as make this many atoms. Part of no
/// result; small enough that 25 cells fill two threads.
const ATOMS_PER_BATCH: usize = 256;

/// What can touch, and from how far. It changes with the bodies that there are; meshes are shared.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The different meshes.
    pub shapes: Arc<[Shape]>,
    /// All surfaces; atoms, facets and edges are numbered through in this order.
    pub bodies: Vec<Body>,
    /// Rigid obstacles.
    pub obstacles: Vec<Obstacle>,
    /// How near is a contact.
    pub reach: Reach,
    /// Number of atoms of all bodies.
    pub atoms: usize,
    /// Number of facets of all bodies.
    pub facets: usize,
    /// Of atoms, of facets and of edges.
    owners: [Owners; 3],
    pub(super) levels: Vec<Levels>,
    /// The first body of each batch, and the number of bodies.
    pub(super) batches: Vec<u32>,
}

/// The mean of a body's atoms.
pub(super) fn centre(atoms: &[Vec3]) -> Vec3 {
    atoms.iter().sum::<Vec3>() / atoms.len().max(1) as f64
}

impl Scene {
    /// A scene in which body `i` has shape `shape_of_body[i]`.
    ///
    /// # Panics
    /// When a body names a shape that is not there, when a length of `reach` is negative or not finite, or when there
    /// are 2³¹ facets or edges or more.
    pub fn new(
        shapes: impl Into<Arc<[Shape]>>,
        shape_of_body: &[usize],
        obstacles: Vec<Obstacle>,
        reach: Reach,
    ) -> Self {
        let shapes = shapes.into();
        let lengths = [reach.proximity, reach.prediction, reach.depth, reach.margin];
        assert!(lengths.iter().all(|length| length.is_finite() && *length >= 0.0), "a reach below zero: {reach:?}");
        let levels: Vec<Levels> = shapes.iter().map(|shape| Levels::of(shape.facets.len())).collect();
        let mut bodies = Vec::with_capacity(shape_of_body.len());
        let mut batches = vec![0];
        let (mut atoms, mut facets, mut edges, mut packs, mut atoms_of_batch) = (0, 0, 0, 0, 0);
        let number = |count: usize| u32::try_from(count).ok().filter(|n| n >> 31 == 0).expect("fewer than 2^31 edges");
        for (body, &shape) in shape_of_body.iter().enumerate() {
            if atoms_of_batch >= ATOMS_PER_BATCH {
                batches.push(body as u32);
                (atoms_of_batch, packs) = (0, 0);
            }
            bodies.push(Body {
                shape: shape as u32,
                first_atom: number(atoms),
                first_facet: number(facets),
                first_edge: number(edges),
                batch: batches.len() as u32 - 1,
                first_pack: number(packs),
            });
            atoms_of_batch += shapes[shape].atoms;
            atoms += shapes[shape].atoms;
            facets += shapes[shape].facets.len();
            edges += shapes[shape].edges.len();
            packs += levels[shape].packs();
        }
        number(facets.max(edges));
        batches.push(bodies.len() as u32);
        let owners = [0, 1, 2].map(|what| {
            let count = |shape: &usize| [shapes[*shape].atoms, shapes[*shape].facets.len(), shapes[*shape].edges.len()];
            Owners::of(shape_of_body.iter().map(|shape| count(shape)[what]))
        });
        Self { shapes, bodies, obstacles, reach, atoms, facets, owners, levels, batches }
    }

    /// The mesh of a body.
    pub fn shape(&self, body: u32) -> &Shape {
        &self.shapes[self.bodies[body as usize].shape as usize]
    }

    /// The sides of a body's surface that others may touch: 1 or 2.
    pub fn sides_of(&self, body: u32) -> usize {
        if self.shape(body).sides == Sides::Both { 2 } else { 1 }
    }

    /// The body of an atom.
    pub fn body_of_atom(&self, atom: u32) -> u32 {
        self.owners[0].body(atom)
    }

    /// The body of a facet.
    pub fn body_of_facet(&self, facet: u32) -> u32 {
        self.owners[1].body(facet)
    }

    /// The body of an edge.
    pub fn body_of_edge(&self, edge: u32) -> u32 {
        self.owners[2].body(edge)
    }

    /// The three atoms of a facet of a body, both numbered through the scene.
    pub fn facet_atoms(&self, body: u32, facet: u32) -> [u32; 3] {
        let of = self.bodies[body as usize];
        self.shape(body).facets[(facet - of.first_facet) as usize].map(|atom| atom + of.first_atom)
    }

    /// The two atoms of an edge of a body, both numbered through the scene.
    pub fn edge_atoms(&self, body: u32, edge: u32) -> [u32; 2] {
        let of = self.bodies[body as usize];
        self.shape(body).edges[(edge - of.first_edge) as usize].map(|atom| atom + of.first_atom)
    }

    /// The positions of a body's atoms, of the positions of all.
    pub(super) fn of_body<'a>(&self, body: u32, positions: &'a [Vec3]) -> &'a [Vec3] {
        let first = self.bodies[body as usize].first_atom as usize;
        &positions[first..first + self.shape(body).atoms]
    }

    /// Batches of bodies whose numbers follow each other, each to be worked on by one thread.
    pub fn batches(&self) -> usize {
        self.batches.len() - 1
    }

    /// The batch of a body.
    pub fn batch_of(&self, body: u32) -> u32 {
        self.bodies[body as usize].batch
    }

    /// The numbers of the atoms of a batch.
    pub fn atoms_of(&self, batch: usize) -> std::ops::Range<usize> {
        let first = |body: u32| self.bodies.get(body as usize).map_or(self.atoms, |body| body.first_atom as usize);
        first(self.batches[batch])..first(self.batches[batch + 1])
    }

    /// The numbers of bodies of a batch.
    pub fn bodies_of(&self, batch: usize) -> std::ops::Range<u32> {
        self.batches[batch]..self.batches[batch + 1]
    }

    /// That of its [`Reach`].
    pub fn safe_travel(&self) -> f64 {
        self.reach.safe_travel()
    }
}
