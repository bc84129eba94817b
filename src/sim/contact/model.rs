//! Who can touch whom, and how strongly they stick.

use super::law::{Law, LinkTable, Strength};
use crate::contact::{self, Reach, Scene, Shape, Sides};
use crate::geometry;
use crate::mechanics::integrator::StepSize;
use crate::sim::controls::Controls;
use crate::sim::model::{Kind, Plane};

/// Contacts of a model.
#[derive(Debug, Clone)]
pub struct ContactModel {
    /// All surfaces and planes: body `i` is cell `i`, shape `i` is kind `i`.
    pub scene: Scene,
    /// What keeps surfaces together.
    pub law: Law,
    /// Strength between kinds: `between[kind * kinds + other]`, symmetric.
    pub between: Vec<Strength>,
    /// Strength between kinds and planes: `on_planes[kind * planes + plane]`.
    pub on_planes: Vec<Strength>,
    /// What a sweep may still move at the end, µm.
    pub tolerance: f64,
    /// Sweeps after which a step is given up.
    pub most_sweeps: u32,
    /// Area at rest of each atom of each kind, µm².
    pub(super) areas: Vec<Vec<f64>>,
    /// Number of the first atom of each kind among all atoms.
    pub(super) first_atom: Vec<usize>,
}

/// Sweeps over the contacts after which a step is given up; a shorter one costs less than more of them.
const MOST_SWEEPS: u32 = 200;

/// The same for fixed steps, which cannot be made shorter: contacts that are almost the same may need a thousand.
const MOST_SWEEPS_FIXED: u32 = 4000;

/// What a sweep may still move, over the mean edge, where steps are fixed.
const TOLERANCE: f64 = 1e-4;

/// What a sweep may still move, over the error that an adaptive step may make.
const SHARE_OF_ERROR: f64 = 0.3;

impl ContactModel {
    /// Contacts of all cells of these kinds with each other, with themselves and with planes, without any strength.
    pub fn new(kinds: &[Kind], planes: &[Plane], reach: Reach) -> Self {
        let sides = |kind: &Kind| if kind.closed { Sides::Outer } else { Sides::Both };
        let shapes = kinds.iter().map(|kind| Shape::new(&kind.rest, sides(kind), 1.5 * reach.proximity)).collect();
        let shape_of_body: Vec<usize> =
            kinds.iter().enumerate().flat_map(|(number, kind)| std::iter::repeat_n(number, kind.cells)).collect();
        let plane = |plane: &Plane| contact::Plane { point: plane.point, normal: plane.normal };
        let scene = Scene::new(shapes, &shape_of_body, planes.iter().map(plane).collect(), reach);
        let edge = kinds.iter().map(|kind| kind.edge).fold(f64::INFINITY, f64::min);
        let mut first_atom = vec![0];
        for kind in kinds {
            first_atom.push(first_atom[first_atom.len() - 1] + kind.cells * kind.atoms());
        }
        Self {
            scene,
            law: Law::default(),
            between: vec![Strength::default(); kinds.len() * kinds.len()],
            on_planes: vec![Strength::default(); kinds.len() * planes.len()],
            tolerance: TOLERANCE * edge,
            most_sweeps: MOST_SWEEPS,
            areas: kinds.iter().map(|kind| geometry::atom_areas(&kind.rest)).collect(),
            first_atom,
        }
    }

    /// The same with sweeps that suit the steps: no more exact than adaptive steps are, and as many as fixed steps need.
    pub fn suited_to(mut self, steps: StepSize) -> Self {
        match steps {
            StepSize::Adaptive { tolerance, .. } => self.tolerance *= SHARE_OF_ERROR * tolerance / TOLERANCE,
            StepSize::Fixed(_) => self.most_sweeps = MOST_SWEEPS_FIXED,
        }
        self
    }

    /// Sets the strength between two kinds, both ways.
    pub fn stick(&mut self, kind: usize, other: usize, strength: Strength) {
        let kinds = self.areas.len();
        self.between[kind * kinds + other] = strength;
        self.between[other * kinds + kind] = strength;
    }

    /// Sets the strength between a kind and a plane.
    pub fn stick_to_plane(&mut self, kind: usize, plane: usize, strength: Strength) {
        let planes = self.scene.planes.len();
        self.on_planes[kind * planes + plane] = strength;
    }

    /// The stiffness of the springs between two bodies, pN/µm.
    pub(super) fn link_stiffness(&self, table: &LinkTable, bodies: [u32; 2], controls: &Controls) -> f64 {
        let [kind, other] = bodies.map(|body| self.kind_of(body));
        let factors = bodies.map(|body| controls.adhesion_of(body as usize));
        table.stiffness[kind * self.areas.len() + other] * factors[0] * factors[1]
    }

    /// How strongly two bodies stick.
    pub(super) fn strength_between(&self, body: usize, other: usize) -> Strength {
        let [kind, other] = [body, other].map(|body| self.kind_of(body as u32));
        self.between[kind * self.areas.len() + other]
    }

    /// How strongly a body sticks to a plane.
    pub(super) fn strength_on(&self, body: usize, plane: u32) -> Strength {
        self.on_planes[self.kind_of(body as u32) * self.scene.planes.len() + plane as usize]
    }

    /// The numbers of the atoms of a kind.
    pub(super) fn atoms_of(&self, kind: usize) -> std::ops::Range<usize> {
        self.first_atom[kind]..self.first_atom[kind + 1]
    }

    /// The area at rest of an atom, µm².
    pub fn area_of(&self, atom: u32) -> f64 {
        let kind = self.owner(atom).0;
        self.areas[kind][(atom as usize - self.first_atom[kind]) % self.areas[kind].len()]
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
