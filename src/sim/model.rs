//! What an experiment means: kinds of cells, loads and planes in µm, s and pN. Nothing here changes during a run.

use super::chemistry::Chemistry;
use super::contact::ContactModel;
use crate::Vec3;
use crate::cell::motility::BrownianMotility;
use crate::geometry::{self, Surface, Topology};
use crate::mechanics::course::Course;
use crate::mechanics::elasticity::Elasticity;
use crate::mechanics::fibres::Fibres;
use crate::mechanics::implicit::Factor;
use crate::mechanics::integrator::Integrator;
use crate::mechanics::lanes::LANES;
use crate::mechanics::stiffness::StiffnessMatrix;

/// Rounds of the power iteration for the largest stiffness.
const POWER_ROUNDS: usize = 150;

/// The largest ratio of the true stiffness at rest to the constant one of the implicit step.
const LARGEST_RATIO: f64 = 0.75;

/// The compiled experiment.
#[derive(Debug, Clone)]
pub struct Model {
    /// Seed of all random numbers.
    pub seed: u64,
    /// The kinds of cells, in the order of the document.
    pub kinds: Vec<Kind>,
    /// Rigid planes that no atom passes.
    pub planes: Vec<Plane>,
    /// Contacts between cells, with themselves and with planes; none where cells pass through each other.
    pub contact: Option<ContactModel>,
    /// Acceleration of gravity, µm/s².
    pub gravity: Vec3,
    /// Systems of equations, fields, and what joins them to cells.
    pub chemistry: Chemistry,
    /// Scheme and step.
    pub integrator: Integrator,
    /// End of the run, s.
    pub until: f64,
    /// Times at which a course bends, rising; a step ends there.
    pub kinks: Vec<f64>,
    /// Cells that come and go at given times, in rising order of these; a step ends there.
    pub changes: Vec<PopulationChange>,
}

/// Cells of a kind that come or go between two steps.
#[derive(Debug, Clone, PartialEq)]
pub struct PopulationChange {
    /// When, s.
    pub time: f64,
    /// Number of the kind.
    pub kind: usize,
    /// What happens.
    pub change: Change,
}

/// What happens to the cells of a kind.
#[derive(Debug, Clone, PartialEq)]
pub enum Change {
    /// Cells at rest are added around these centres, µm.
    Add(Vec<Vec3>),
    /// Cells are removed.
    Remove(Removal),
}

/// Which cells of a kind are removed. Those that are drawn depend on the seed, on their ids and on the number of the change alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Removal {
    /// All.
    All,
    /// This share of them, from 0 to 1, drawn at random and rounded to a whole number of cells.
    Share(f64),
    /// So many, drawn at random; all, where there are fewer.
    Number(usize),
}

/// A rigid plane: the half space that its normal points into is free.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Name for pictures and messages.
    pub name: String,
    /// A point of the plane, µm.
    pub point: Vec3,
    /// Unit normal towards the free side.
    pub normal: Vec3,
}

/// The cells that share a mesh and a material.
#[derive(Debug, Clone)]
pub struct Kind {
    /// The type's name in the document.
    pub name: String,
    /// The mesh at rest, around its own origin, µm.
    pub rest: Surface,
    /// Whether the surface encloses a volume.
    pub closed: bool,
    /// Elastic forces.
    pub elasticity: Elasticity,
    /// The constant linear part of all forces, pN/µm.
    pub stiffness: StiffnessMatrix,
    /// Largest eigenvalue of the true stiffness at rest, pN/µm.
    pub largest_stiffness: f64,
    /// Drag of an atom, pN·s/µm.
    pub drag: f64,
    /// Mass of an atom, pN·s²/µm.
    pub mass: f64,
    /// One factor an atom and axis, 0 where held; empty when nothing is held.
    pub held: Vec<f64>,
    /// What the volume does.
    pub volume: VolumeRule,
    /// Loads.
    pub loads: Vec<Load>,
    /// Contractile fibres.
    pub fibres: Vec<Fibres>,
    /// Pairs of atoms whose links and fibres are drawn.
    pub drawn_links: Vec<[u32; 2]>,
    /// Brownian persistence.
    pub brownian: Option<BrownianMotility>,
    /// Whether chemistry adds a velocity to the walk.
    pub biased: bool,
    /// Central attraction.
    pub attraction: Option<Attraction>,
    /// Lanes of a block: [`LANES`], or 1 for a few cells.
    pub lanes: usize,
    /// Mean edge length at rest, µm.
    pub edge: f64,
}

/// What the volume of a closed cell does.
#[derive(Debug, Clone, PartialEq)]
pub enum VolumeRule {
    /// Nothing keeps it.
    Free,
    /// Exactly the cell's rest volume times the course.
    Exact(Course),
    /// Energy `½ K (V − V₀)²/V₀`, eq. (volume.4).
    Compressible {
        /// K, Pa.
        modulus: f64,
        /// Factor of the rest volume.
        course: Course,
    },
}

/// A force with a course in time, spread over some atoms of every cell of a kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// Its name; the series is `load.<name>`.
    pub name: String,
    /// Atoms and their shares, which sum to one.
    pub atoms: Vec<(u32, f64)>,
    /// Unit direction.
    pub direction: Vec3,
    /// Total force, pN.
    pub force: Course,
}

/// A linear pull of every atom to a point, a stand-in for a diffusing attractant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attraction {
    /// The point, µm.
    pub to: Vec3,
    /// Stiffness an atom, pN/µm.
    pub stiffness: f64,
}

impl Kind {
    /// One cell of a mesh and its elastic forces, without loads or motility: drag and mass of an atom 1, exact volume
    /// where the mesh is closed.
    pub fn new(name: &str, rest: Surface, elasticity: Elasticity) -> Self {
        let closed = !rest.facets.is_empty() && Topology::of(&rest).is_closed();
        let stiffness = elasticity.stiffness(&rest.positions, &rest.positions);
        Self {
            name: name.to_owned(),
            closed,
            largest_stiffness: stiffness.largest(),
            stiffness,
            elasticity,
            drag: 1.0,
            mass: 1.0,
            held: Vec::new(),
            volume: if closed { VolumeRule::Exact(Course::constant(1.0)) } else { VolumeRule::Free },
            loads: Vec::new(),
            fibres: Vec::new(),
            drawn_links: Vec::new(),
            brownian: None,
            biased: false,
            attraction: None,
            lanes: 1,
            edge: geometry::mean_edge_length(&rest),
            rest,
        }
    }

    /// The same kind with the lanes that are best for so many cells. Results do not depend on it but by round-off.
    pub fn for_cells(self, cells: usize) -> Self {
        Self { lanes: Self::best_lanes(cells), ..self }
    }

    /// Volume of the mesh at rest, µm³; 0 of an open surface.
    pub fn rest_volume(&self) -> f64 {
        if self.closed { geometry::volume(&self.rest) } else { 0.0 }
    }

    /// Largest eigenvalue of the true stiffness at rest, attraction and active fibres included, pN/µm, by power iteration on differences
    /// of the force; what explicit schemes need to know.
    pub fn measure_largest_stiffness(&self) -> f64 {
        // Power iteration approaches from below; two percent cover what is left after the last round.
        let largest = self.power_iteration(&self.rest.positions, |_| ());
        let of_fibres: f64 = self.fibres.iter().map(Fibres::largest_stiffness).sum();
        1.02 * largest + of_fibres + self.attraction.map_or(0.0, |attraction| attraction.stiffness)
    }

    /// Sets the stiffness K of the implicit step to the one that fits the rest shape; see [`Kind::stiffness_at`].
    pub fn bound_stiffness(&mut self) {
        self.stiffness = self.stiffness_at(&self.rest.positions);
    }

    /// The stiffness K of the implicit step for a cell in the shape `x` (µm): the linear part of its forces there,
    /// raised until the true stiffness J there is nowhere more than [`LARGEST_RATIO`] times as large, since the scheme
    /// bears a K that is too small by two and cells go on deforming.
    pub fn stiffness_at(&self, x: &[Vec3]) -> StiffnessMatrix {
        let mut stiffness = self.elasticity.stiffness(&self.rest.positions, x);
        let free = vec![false; self.atoms()];
        // A whiff of the identity makes K invertible; J does not resist what K does not resist.
        let inverse = Factor::new(&stiffness, 1e-5 * stiffness.largest().max(f64::MIN_POSITIVE), 1.0, &free);
        let mut scratch = vec![0.0; 3 * self.atoms()];
        let ratio = self.power_iteration(x, |v| inverse.solve(3, v, &mut scratch));
        if ratio > LARGEST_RATIO {
            stiffness.scale(ratio / LARGEST_RATIO);
        }
        self.fibres.iter().for_each(|fibres| fibres.add_stiffness(&mut stiffness));
        if let Some(attraction) = self.attraction {
            (0..self.atoms()).for_each(|atom| stiffness.add(atom, atom, attraction.stiffness));
        }
        stiffness
    }

    /// The largest eigenvalue of P J, J the stiffness in the shape `x` and P the change that `precondition` makes in place.
    fn power_iteration(&self, x: &[Vec3], mut precondition: impl FnMut(&mut [f64])) -> f64 {
        let x: Vec<f64> = x.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
        let epsilon = 1e-6 * self.edge;
        // Any vector will do that is not an eigenvector of a smaller value; this one has no symmetry.
        let mut v: Vec<f64> = (0..x.len()).map(|i| ((i * 7919 + 13) % 101) as f64 / 50.5 - 1.0).collect();
        let mut largest: f64 = 0.0;
        for round in 0..POWER_ROUNDS {
            crate::mechanics::volume::hold(1, &self.held, &mut v);
            let size = v.iter().map(|a| a * a).sum::<f64>().sqrt();
            if size == 0.0 {
                break;
            }
            v.iter_mut().for_each(|a| *a /= size);
            let force = |sign: f64| {
                let moved: Vec<f64> = x.iter().zip(&v).map(|(x, v)| x + sign * epsilon * v).collect();
                let mut f = vec![0.0; x.len()];
                self.elasticity.add_forces(1, &moved, &mut f, &mut [0.0]);
                f
            };
            let (plus, minus) = (force(1.0), force(-1.0));
            let mut next: Vec<f64> = minus.iter().zip(&plus).map(|(m, p)| (m - p) / (2.0 * epsilon)).collect();
            precondition(&mut next);
            let before = largest;
            largest = next.iter().zip(&v).map(|(a, b)| a * b).sum::<f64>();
            v = next;
            if round > 20 && (largest - before).abs() < 1e-4 * largest {
                break;
            }
        }
        largest
    }

    /// Atoms of a cell.
    pub fn atoms(&self) -> usize {
        self.rest.positions.len()
    }
    /// Numbers in a block: 3 · atoms · lanes.
    pub fn block_len(&self) -> usize {
        3 * self.atoms() * self.lanes
    }
    /// The lanes that a number of cells is best run on: single cells run alone, more fill blocks.
    pub fn best_lanes(cells: usize) -> usize {
        if cells < 3 { 1 } else { LANES }
    }
    /// Whether any atom is held.
    pub fn is_held(&self) -> bool {
        !self.held.is_empty()
    }
}

impl Model {
    /// A model of these kinds alone: no planes, gravity, chemistry or bends.
    pub fn of(kinds: Vec<Kind>, integrator: Integrator, until: f64) -> Self {
        Self {
            seed: 1,
            kinds,
            planes: Vec::new(),
            contact: None,
            gravity: Vec3::zeros(),
            chemistry: Chemistry::default(),
            integrator,
            until,
            kinks: Vec::new(),
            changes: Vec::new(),
        }
    }

    /// Times at which something happens, s, in no order: a step ends there.
    pub fn instants(&self) -> impl Iterator<Item = f64> {
        let changes = self.changes.iter().map(|change| change.time);
        self.kinks.iter().copied().chain([self.until]).chain(changes)
    }

    /// What the clock cannot tell apart, s: the round-off of adding many steps.
    pub fn clock_slack(&self) -> f64 {
        1e-12 * self.until
    }
}
