//! The cells that share a mesh and a material.

use crate::Vec3;
use crate::cell::Behaviour;
use crate::geometry::{self, Surface, Topology};
use crate::mechanics::Force;
use crate::mechanics::course::Course;
use crate::mechanics::fibres::Fibres;
use crate::mechanics::implicit::Factor;
use crate::mechanics::lanes::LANES;
use crate::mechanics::load::Load;
use crate::mechanics::stiffness::StiffnessMatrix;
use crate::mechanics::sum::{measure_elastic, stiffness};

/// Rounds of the power iteration for the largest stiffness.
const POWER_ROUNDS: usize = 150;

/// The largest ratio of the true stiffness at rest to the constant one of the implicit step.
const LARGEST_RATIO: f64 = 0.75;

/// The cells that share a mesh and a material.
#[derive(Debug, Clone)]
pub struct Kind {
    /// The type's name in the document.
    pub name: String,
    /// The mesh at rest, around its own origin, µm.
    pub rest: Surface,
    /// Whether the surface encloses a volume.
    pub closed: bool,
    /// All forces on its atoms but those of motility, contacts and the rule of its volume, in the order in which they are added up.
    pub forces: Vec<Force>,
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
    /// Pairs of atoms whose links and fibres are drawn.
    pub drawn_links: Vec<[u32; 2]>,
    /// What its cells do by themselves.
    pub behaviours: Vec<Behaviour>,
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

impl VolumeRule {
    /// The course of the rest volumes' factor; none where nothing keeps the volume.
    pub fn course(&self) -> Option<&Course> {
        match self {
            Self::Free => None,
            Self::Exact(course) | Self::Compressible { course, .. } => Some(course),
        }
    }
}

impl Kind {
    /// One cell of a mesh and the forces on it, without motility: drag and mass of an atom 1, exact volume where the mesh is
    /// closed. The stiffness is that of the elastic forces as they are; see [`Kind::bound_stiffness`].
    pub fn new(name: &str, rest: Surface, forces: Vec<Force>) -> Self {
        let closed = !rest.facets.is_empty() && Topology::of(&rest).is_closed();
        let stiffness = stiffness(&forces, &rest.positions, &rest.positions);
        Self {
            name: name.to_owned(),
            closed,
            largest_stiffness: stiffness.largest(),
            stiffness,
            forces,
            drag: 1.0,
            mass: 1.0,
            held: Vec::new(),
            volume: if closed { VolumeRule::Exact(Course::constant(1.0)) } else { VolumeRule::Free },
            drawn_links: Vec::new(),
            behaviours: Vec::new(),
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

    /// Largest eigenvalue of the true stiffness at rest, pN/µm: of elastic forces by power iteration on differences, of all others
    /// (fibres at full activation) by the sum of a bound of each; what explicit schemes need to know.
    pub fn measure_largest_stiffness(&self) -> f64 {
        // Power iteration approaches from below; two percent cover what is left after the last round.
        let elastic = 1.02 * self.power_iteration(&self.rest.positions, |_| ());
        // Each by itself, so that what one bound is does not depend on which atoms others act on; those that are driven first.
        let bounds = |driven: bool| -> f64 {
            let forces = self.forces.iter().filter(|force| force.handle().is_some() == driven);
            forces.filter_map(Force::largest_stiffness).sum()
        };
        elastic + bounds(true) + bounds(false)
    }

    /// Sets the stiffness K of the implicit step to the one that fits the rest shape; see [`Kind::stiffness_at`].
    pub fn bound_stiffness(&mut self) {
        self.stiffness = self.stiffness_at(&self.rest.positions);
    }

    /// The stiffness K of the implicit step for a cell in the shape `x` (µm): the linear part of its elastic forces there,
    /// raised until the true stiffness J there is nowhere more than [`LARGEST_RATIO`] times as large, since the scheme
    /// bears a K that is too small by two and cells go on deforming; then that of all other forces.
    pub fn stiffness_at(&self, x: &[Vec3]) -> StiffnessMatrix {
        let mut matrix = stiffness(&self.forces, &self.rest.positions, x);
        let free = vec![false; self.atoms()];
        // A little of the identity makes K invertible; J does not resist what K does not resist.
        let inverse = Factor::new(&matrix, 1e-5 * matrix.largest().max(f64::MIN_POSITIVE), 1.0, &free);
        let mut scratch = vec![0.0; 3 * self.atoms()];
        let ratio = self.power_iteration(x, |v| inverse.solve(3, v, &mut scratch));
        if ratio > LARGEST_RATIO {
            matrix.scale(ratio / LARGEST_RATIO);
        }
        let others = self.forces.iter().filter(|force| !force.is_elastic());
        others.for_each(|force| force.add_stiffness(&self.rest.positions, x, &mut matrix));
        matrix
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
                measure_elastic(&self.forces, 1, &moved, &mut f, &mut [0.0]);
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

    /// Whether its cells do something of which the speed may be set.
    pub fn has_speed(&self) -> bool {
        self.behaviours.iter().any(|behaviour| behaviour.speed().is_some())
    }

    /// Whether links set a velocity of its cells.
    pub fn is_biased(&self) -> bool {
        self.behaviours.contains(&Behaviour::Bias)
    }

    /// Lets links set a velocity of its cells.
    pub fn make_biased(&mut self) {
        if !self.is_biased() {
            self.behaviours.push(Behaviour::Bias);
        }
    }

    /// Its loads.
    pub fn loads(&self) -> impl Iterator<Item = &Load> {
        self.forces.iter().filter_map(|force| match force {
            Force::Load(load) => Some(load),
            _ => None,
        })
    }

    /// Its fibres.
    pub fn fibres(&self) -> impl Iterator<Item = &Fibres> {
        self.forces.iter().filter_map(|force| match force {
            Force::Fibres(fibres) => Some(fibres),
            _ => None,
        })
    }

    /// Names of its forces with a handle, by the number of the handle in [`CONTROLLED`](crate::mechanics::CONTROLLED).
    pub fn controlled(&self, handle: usize) -> impl Iterator<Item = &str> {
        let handles = self.forces.iter().filter_map(Force::handle);
        handles.filter(move |(number, _)| *number == handle).map(|(_, name)| name)
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

/// All times after the start at which a course of some kind bends, rising.
pub fn kinks(kinds: &[Kind]) -> Vec<f64> {
    let of_kind = |kind: &Kind| -> Vec<f64> {
        let volume = kind.volume.course().into_iter().flat_map(Course::kinks);
        kind.forces.iter().flat_map(Force::kinks).chain(volume).collect()
    };
    let mut kinks: Vec<f64> = kinds.iter().flat_map(of_kind).filter(|kink| *kink > 0.0).collect();
    kinks.sort_by(f64::total_cmp);
    kinks.dedup();
    kinks
}
