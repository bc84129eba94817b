//! The surfaces of the cells that there are, with what a model says of their contacts.

use std::ops::{Deref, Range};
use std::sync::Arc;

use super::laws::{Cohesive, Faced, Strength};
use super::model::ContactModel;
use crate::contact::{Scene, Sides};
use crate::sim::state::KindState;

/// The surfaces of the cells that there are: body `i` is cell `i`, shape `i` is kind `i`.
#[derive(Debug, Clone)]
pub(super) struct Surfaces {
    scene: Arc<Scene>,
    /// Number of the first atom of each kind among all atoms, and how many there are.
    first_atom: Arc<[usize]>,
}

/// Contacts of the cells that there are: what a model says of all contacts, and their surfaces.
#[derive(Debug, Clone)]
pub struct ContactScene<'a> {
    rules: &'a ContactModel,
    /// All surfaces and obstacles: body `i` is cell `i`, shape `i` is kind `i`.
    pub scene: Arc<Scene>,
    first_atom: Arc<[usize]>,
}

impl Deref for ContactScene<'_> {
    type Target = ContactModel;

    fn deref(&self) -> &ContactModel {
        self.rules
    }
}

impl Surfaces {
    /// Those of so many cells of each kind.
    pub fn of(rules: &ContactModel, cells: &[KindState]) -> Self {
        let bodies = cells.iter().enumerate().flat_map(|(kind, now)| std::iter::repeat_n(kind, now.cells()));
        let shape_of_body: Vec<usize> = bodies.collect();
        let scene = Scene::new(rules.shapes.clone(), &shape_of_body, rules.obstacles.clone(), rules.reach);
        let mut first_atom = vec![0];
        let mut end = 0;
        first_atom.extend(cells.iter().zip(&*rules.shapes).map(|(now, shape)| {
            end += now.cells() * shape.atoms;
            end
        }));
        Self { scene: Arc::new(scene), first_atom: first_atom.into() }
    }

    /// Whether they are those of so many cells of each kind.
    pub fn are_of(&self, cells: &[KindState]) -> bool {
        let counts = self.first_atom.windows(2).zip(&*self.scene.shapes);
        self.first_atom.len() == cells.len() + 1
            && counts.zip(cells).all(|((first, shape), now)| first[1] - first[0] == now.cells() * shape.atoms)
    }

    /// With what a model says.
    pub fn with<'a>(&self, rules: &'a ContactModel) -> ContactScene<'a> {
        ContactScene { rules, scene: self.scene.clone(), first_atom: self.first_atom.clone() }
    }
}

impl ContactModel {
    /// The surfaces of the cells that there are, made anew; the step keeps its own.
    pub fn scene_of(&self, cells: &[KindState]) -> ContactScene<'_> {
        Surfaces::of(self, cells).with(self)
    }
}

impl ContactScene<'_> {
    /// How strongly two bodies stick.
    pub(super) fn strength_between(&self, body: usize, other: usize) -> Strength {
        let [kind, other] = [body, other].map(|body| self.kind_of(body as u32));
        self.between[kind * self.areas.len() + other]
    }

    /// How strongly a body sticks to an obstacle.
    pub(super) fn strength_on(&self, body: usize, obstacle: u32) -> Strength {
        self.on_obstacles[self.kind_of(body as u32) * self.obstacles.len() + obstacle as usize]
    }

    /// How a body and what it faces stick to each other where the cohesive law draws them to each other; none where it does not.
    pub(super) fn cohesion_of(&self, body: u32, other: Faced) -> Option<Cohesive> {
        let cohesive = self.law.cohesion()?.of(&self.scene, body, other);
        (cohesive.range() > 0.0).then_some(cohesive)
    }

    /// The numbers of the atoms of a kind.
    pub(super) fn atoms_of(&self, kind: usize) -> Range<usize> {
        self.first_atom[kind]..self.first_atom[kind + 1]
    }

    /// The kind of an atom and the number of its cell within that.
    pub(super) fn owner(&self, atom: u32) -> (usize, usize) {
        let kind = self.first_atom.partition_point(|first| *first <= atom as usize) - 1;
        (kind, (atom as usize - self.first_atom[kind]) / self.areas[kind].len())
    }

    /// The body of an atom.
    pub(super) fn body_of(&self, atom: u32) -> u32 {
        self.scene.body_of_atom(atom)
    }

    /// Whether both sides of a body are outside.
    pub(super) fn is_thin(&self, body: u32) -> bool {
        self.scene.shape(body).sides == Sides::Both
    }

    /// The kind of a body.
    pub(super) fn kind_of(&self, body: u32) -> usize {
        self.scene.bodies[body as usize].shape as usize
    }
}
