//! Which surfaces stick, how strongly and how far.

use super::bonds::BondKinetics;
use super::facing::Faced;
use super::points::points_of_facet;
use crate::contact::Scene;

/// How two surfaces stick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Cohesive {
    /// The largest traction, at half of the range, pN/µm².
    pub strength: f64,
    /// Work of separation, pN/µm.
    pub work: f64,
    /// Traction over the speed at which they slide along each other, pN·s/µm³, eq. (adhesion.19).
    pub friction: f64,
    /// How the bonds close and open that do all this; without, all are closed wherever surfaces are within the range.
    pub bonds: Option<BondKinetics>,
}

impl Cohesive {
    /// How far open they still attract each other, µm; 0 where they do not stick.
    pub fn range(&self) -> f64 {
        if self.strength > 0.0 { 2.0 * self.work / self.strength } else { 0.0 }
    }
}

/// Which kinds stick, and how finely their surfaces are looked at.
#[derive(Debug, Clone, PartialEq)]
pub struct CohesionTable {
    /// Of two kinds: `between[kind * kinds + other]`, symmetric.
    pub between: Vec<Cohesive>,
    /// Of a kind and an obstacle: `on_obstacles[kind * obstacles + obstacle]`.
    pub on_obstacles: Vec<Cohesive>,
    /// Points along a side of the facets of each kind, eq. (adhesion.18).
    pub points: Vec<u32>,
    /// Whether anything that sticks resists sliding, so that areas around atoms are needed.
    pub resists: bool,
}

/// The most points along a side of a facet.
const MOST_POINTS: u32 = 4;

/// Along a side of a facet as many points as are two within a range, where areas are measured; where surfaces attract each other one within
/// a range will do from two points on, eq. (adhesion.18).
fn points_along(edge: f64, range: f64, attracts: bool) -> u32 {
    let (one, two) = ((edge / range).ceil(), (2.0 * edge / range).ceil());
    let points = if attracts { two.min(one.max(2.0)) } else { two };
    (points as u32).clamp(1, MOST_POINTS)
}

impl CohesionTable {
    /// A table in which nothing sticks.
    pub fn new(kinds: usize, obstacles: usize) -> Self {
        let none = Cohesive::default();
        Self {
            between: vec![none; kinds * kinds],
            on_obstacles: vec![none; kinds * obstacles],
            points: vec![1; kinds],
            resists: true,
        }
    }

    /// A table in which all that is less than `range` (µm) apart is alike, of kinds with these mean edges (µm): to measure areas of contact.
    pub fn alike(edges: &[f64], obstacles: usize, range: f64) -> Self {
        let mut table = Self::new(edges.len(), obstacles);
        let cohesive = Cohesive { strength: 1.0, work: 0.5 * range, ..Cohesive::default() };
        table.between.fill(cohesive);
        table.on_obstacles.fill(cohesive);
        table.resolve_for(edges, false);
        table
    }

    /// Sets how two kinds stick to each other.
    pub fn stick(&mut self, kind: usize, other: usize, cohesive: Cohesive) {
        let kinds = self.points.len();
        self.between[kind * kinds + other] = cohesive;
        self.between[other * kinds + kind] = cohesive;
    }

    /// Sets how a kind sticks to an obstacle.
    pub fn stick_to_obstacle(&mut self, kind: usize, obstacle: usize, cohesive: Cohesive) {
        let obstacles = self.on_obstacles.len() / self.points.len();
        self.on_obstacles[kind * obstacles + obstacle] = cohesive;
    }

    /// Looks as finely at the facets of each kind, with these mean edges (µm), as its least range needs.
    pub fn resolve(&mut self, edges: &[f64]) {
        self.resolve_for(edges, true);
    }

    fn resolve_for(&mut self, edges: &[f64], attracts: bool) {
        let (kinds, obstacles) = (edges.len(), self.on_obstacles.len() / edges.len().max(1));
        for (kind, edge) in edges.iter().enumerate() {
            let between = &self.between[kind * kinds..(kind + 1) * kinds];
            let ranges =
                between.iter().chain(&self.on_obstacles[kind * obstacles..(kind + 1) * obstacles]).map(Cohesive::range);
            let least = ranges.filter(|range| *range > 0.0).fold(f64::INFINITY, f64::min);
            self.points[kind] = points_along(*edge, least, attracts);
        }
    }

    /// The farthest that anything attracts, µm.
    pub(in super::super) fn range(&self) -> f64 {
        self.between.iter().chain(&self.on_obstacles).map(Cohesive::range).fold(0.0, f64::max)
    }

    /// The most that a pull between cells on an area grows with its opening, over 2, pN/µm³: as much as strength over range.
    pub(in super::super) fn steepest(&self) -> f64 {
        let sticking = self.between.iter().filter(|cohesive| cohesive.range() > 0.0);
        sticking.map(|cohesive| cohesive.strength / cohesive.range()).fold(0.0, f64::max)
    }

    /// At how many points of its facets, on all sides, it is looked what attracts a body.
    pub fn points_of(&self, scene: &Scene, body: u32) -> usize {
        let of_facet = points_of_facet(self.points[scene.bodies[body as usize].shape as usize]).len();
        scene.sides_of(body) * scene.shape(body).facets.len() * of_facet
    }

    /// How a body and what it faces stick to each other.
    pub fn of(&self, scene: &Scene, body: u32, other: Faced) -> Cohesive {
        let kind = |body: u32| scene.bodies[body as usize].shape as usize;
        match other {
            Faced::Body(other) => self.between[kind(body) * self.points.len() + kind(other)],
            Faced::Obstacle(obstacle) => self.on_obstacles[kind(body) * scene.obstacles.len() + obstacle as usize],
        }
    }

    /// Whether any surfaces have bonds that close and open.
    pub fn has_bonds(&self) -> bool {
        self.between.iter().chain(&self.on_obstacles).any(|cohesive| cohesive.bonds.is_some())
    }

    /// Whether anything slides with friction.
    pub fn has_friction(&self) -> bool {
        self.between.iter().chain(&self.on_obstacles).any(|cohesive| cohesive.friction > 0.0)
    }
}
