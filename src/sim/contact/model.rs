//! Who can touch whom, and how strongly they stick.

use std::sync::Arc;

use super::laws::{CohesionTable, Law, Strength};
use crate::contact::{Reach, Shape, Sides};
use crate::geometry;
use crate::mechanics::integrator::StepSize;
use crate::sim::kind::Kind;
use crate::sim::obstacle::Obstacle;

/// Contacts of a model.
#[derive(Debug, Clone)]
pub struct ContactModel {
    /// The mesh of each kind.
    pub shapes: Arc<[Shape]>,
    /// Rigid obstacles.
    pub obstacles: Vec<geometry::Obstacle>,
    /// How near is a contact.
    pub reach: Reach,
    /// What keeps surfaces together.
    pub law: Law,
    /// Strength between kinds: `between[kind * kinds + other]`, symmetric.
    pub between: Vec<Strength>,
    /// Strength between kinds and obstacles: `on_obstacles[kind * obstacles + obstacle]`.
    pub on_obstacles: Vec<Strength>,
    /// How areas of contact are measured: what is nearer than its range is in contact.
    pub area: CohesionTable,
    /// What a sweep may still move at the end, µm.
    pub tolerance: f64,
    /// Sweeps after which a step is given up.
    pub most_sweeps: u32,
    /// Area at rest of each atom of each kind, µm².
    pub(super) areas: Vec<Vec<f64>>,
}

/// How near surfaces are that count as area of contact, µm: what a light microscope does not tell apart.
pub const AREA_WITHIN: f64 = 0.3;

/// Sweeps over the contacts after which a step is given up; a shorter one costs less than more of them.
const MOST_SWEEPS: u32 = 200;

/// The same for fixed steps, which cannot be made shorter: contacts that are almost the same may need a thousand.
const MOST_SWEEPS_FIXED: u32 = 4000;

/// What a sweep may still move, over the mean edge, where steps are fixed.
const TOLERANCE: f64 = 1e-4;

/// What a sweep may still move, over the error that an adaptive step may make.
const SHARE_OF_ERROR: f64 = 0.3;

impl ContactModel {
    /// Contacts of all cells of these kinds with each other, with themselves and with obstacles, without any strength.
    pub fn new(kinds: &[Kind], obstacles: &[Obstacle], reach: Reach) -> Self {
        let sides = |kind: &Kind| if kind.closed { Sides::Outer } else { Sides::Both };
        let shapes = kinds.iter().map(|kind| Shape::new(&kind.rest, sides(kind), 1.5 * reach.prediction));
        let edges: Vec<f64> = kinds.iter().map(|kind| kind.edge).collect();
        let edge = edges.iter().copied().fold(f64::INFINITY, f64::min);
        Self {
            shapes: shapes.collect(),
            obstacles: obstacles.iter().map(|obstacle| obstacle.surface.clone()).collect(),
            reach,
            law: Law::default(),
            between: vec![Strength::default(); kinds.len() * kinds.len()],
            on_obstacles: vec![Strength::default(); kinds.len() * obstacles.len()],
            area: CohesionTable::alike(&edges, obstacles.len(), AREA_WITHIN),
            tolerance: TOLERANCE * edge,
            most_sweeps: MOST_SWEEPS,
            areas: kinds.iter().map(|kind| geometry::atom_areas(&kind.rest)).collect(),
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

    /// Sets the strength between a kind and an obstacle.
    pub fn stick_to_obstacle(&mut self, kind: usize, obstacle: usize, strength: Strength) {
        let obstacles = self.obstacles.len();
        self.on_obstacles[kind * obstacles + obstacle] = strength;
    }
}
