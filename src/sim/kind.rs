//! The cells that share a mesh and a material.

use super::obstacle::Obstacle;
use crate::cell::Behaviour;
use crate::geometry::{self, Surface, Topology};
use crate::mechanics::Force;
use crate::mechanics::course::Course;
use crate::mechanics::fibres::Fibres;
use crate::mechanics::lanes::LANES;
use crate::mechanics::load::Load;
use crate::mechanics::moved::Moved;
use crate::mechanics::plate::Plate;
use crate::mechanics::pressure::Pressure;
use crate::mechanics::solid::Solid;
use crate::mechanics::stiffness::StiffnessMatrix;
use crate::mechanics::sum::stiffness;
use crate::mechanics::tangent::Tangent;
use crate::mechanics::torque::Torque;
use crate::mechanics::trap::Trap;
use crate::mechanics::viscosity::Viscosity;

/// The cells that share a mesh and a material.
#[derive(Debug, Clone)]
pub struct Kind {
    /// The type's name in the document.
    pub name: String,
    /// The mesh at rest, around its own origin, µm.
    pub rest: Surface,
    /// What fills it; nothing fills a surface.
    pub tetrahedra: Vec<[u32; 4]>,
    /// The edges of the surface.
    pub edges: Vec<[u32; 2]>,
    /// Whether the surface encloses a volume.
    pub closed: bool,
    /// All forces on its atoms but those of motility, contacts and the rule of its volume, in the order in which they are added up.
    pub forces: Vec<Force>,
    /// The constant linear part of all forces, pN/µm.
    pub stiffness: StiffnessMatrix,
    /// The least ratio of the true stiffness at rest to K, over all shapes that a cell can take; 0 where some have none.
    pub softest_ratio: f64,
    /// What resists being deformed at a rate: in the matrix of each cell, so that [`Kind::use_tangent`] must be called once it is set.
    pub viscosity: Option<Viscosity>,
    /// How each cell's own stiffness is made and factored, where K does not tell how stiff its shapes are.
    pub tangent: Option<Tangent>,
    /// Largest eigenvalue of the true stiffness at rest, pN/µm.
    pub largest_stiffness: f64,
    /// Drag of an atom, pN·s/µm.
    pub drag: f64,
    /// Mass of an atom, pN·s²/µm.
    pub mass: f64,
    /// One factor an atom and axis, 0 where held; empty when nothing is held.
    pub held: Vec<f64>,
    /// What of that is moved on courses.
    pub moved: Vec<Moved>,
    /// How its bodies move, where they never change their shape.
    pub rigid: Option<Rigid>,
    /// What the volume does.
    pub volume: VolumeRule,
    /// Pairs of atoms whose links and fibres are drawn.
    pub drawn_links: Vec<[u32; 2]>,
    /// What its cells do by themselves.
    pub behaviours: Vec<Behaviour>,
    /// Fibres made at run time that a cell has at most.
    pub fibre_budget: usize,
    /// What the stiffnesses of such fibres may sum up to at one atom, so that steps bear them, pN/µm, eq. (fibres.2).
    pub fibre_limit: f64,
    /// Lanes of a block: [`LANES`], or 1 for a few cells.
    pub lanes: usize,
    /// Mean edge length at rest, µm.
    pub edge: f64,
}

/// How bodies move that never change their shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rigid {
    /// Whether they turn; else they only go.
    pub turns: bool,
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
        let topology = Topology::of(&rest);
        let closed = !rest.facets.is_empty() && topology.is_closed();
        let stiffness = stiffness(&forces, &rest.positions, &rest.positions);
        Self {
            name: name.to_owned(),
            tetrahedra: forces.iter().find_map(solid).map_or(Vec::new(), |solid| solid.tetrahedra().collect()),
            edges: topology.edges,
            closed,
            largest_stiffness: stiffness.largest(),
            stiffness,
            softest_ratio: 0.0,
            viscosity: None,
            tangent: None,
            forces,
            drag: 1.0,
            mass: 1.0,
            held: Vec::new(),
            moved: Vec::new(),
            rigid: None,
            volume: if closed { VolumeRule::Exact(Course::constant(1.0)) } else { VolumeRule::Free },
            drawn_links: Vec::new(),
            behaviours: Vec::new(),
            fibre_budget: 0,
            fibre_limit: 0.0,
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

    /// Whether its cells do something of which the speed may be set.
    pub fn has_speed(&self) -> bool {
        self.behaviours.iter().any(|behaviour| behaviour.speed().is_some())
    }

    /// Whether its cells have pseudopods.
    pub fn has_pseudopods(&self) -> bool {
        self.behaviours.iter().any(|behaviour| matches!(behaviour, Behaviour::Pseudopods(_)))
    }

    /// Whether its cells have several pseudopods at once.
    pub fn has_several_pseudopods(&self) -> bool {
        self.behaviours
            .iter()
            .any(|behaviour| matches!(behaviour, Behaviour::Pseudopods(pods) if pods.several.most > 1))
    }

    /// What the stiffnesses of the fibres of its pseudopods sum up to at one atom at most, pN/µm: those of one pseudopod have atoms of their
    /// own.
    pub fn pod_fibre_stiffness(&self) -> f64 {
        let of = |behaviour: &Behaviour| match behaviour {
            Behaviour::Pseudopods(pods) => {
                pods.fibres.map_or(0.0, |fibres| pods.several.most as f64 * fibres.stiffness)
            }
            _ => 0.0,
        };
        self.behaviours.iter().map(of).sum()
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

    /// The elastic materials that fill its cells.
    pub fn solids(&self) -> impl Iterator<Item = &Solid> {
        self.forces.iter().filter_map(solid)
    }

    /// Its traps.
    pub fn traps(&self) -> impl Iterator<Item = &Trap> {
        self.forces.iter().filter_map(|force| match force {
            Force::Trap(trap) => Some(trap),
            _ => None,
        })
    }

    /// Flexible plates that its cells are bonded to.
    pub fn plates(&self) -> impl Iterator<Item = &Plate> {
        self.forces.iter().filter_map(|force| match force {
            Force::Plate(plate) => Some(plate),
            _ => None,
        })
    }

    /// Pressures on its cells.
    pub fn pressures(&self) -> impl Iterator<Item = &Pressure> {
        self.forces.iter().filter_map(|force| match force {
            Force::Pressure(pressure) => Some(pressure),
            _ => None,
        })
    }

    /// Torques on its cells.
    pub fn torques(&self) -> impl Iterator<Item = &Torque> {
        self.forces.iter().filter_map(|force| match force {
            Force::Torque(torque) => Some(torque),
            _ => None,
        })
    }

    /// How stiffly traps draw its bodies as a whole, pN/µm.
    pub fn drawn(&self) -> f64 {
        self.traps().map(|trap| trap.stiffness).sum()
    }

    /// Whether its bodies turn where something turns them.
    pub fn may_turn(&self) -> bool {
        !self.is_held() && self.rigid.is_none_or(|rigid| rigid.turns)
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
    /// Which atoms are held, along all axes alike; none where some are held along some axes only.
    pub fn held_alike(&self) -> Option<Vec<bool>> {
        let held = |atom: usize| {
            let factors = self.held.get(3 * atom..3 * atom + 3).unwrap_or(&[1.0; 3]);
            factors.iter().all(|factor| *factor == factors[0]).then_some(factors[0] == 0.0)
        };
        (0..self.atoms()).map(held).collect()
    }
    /// Adds `factor` times V(x) v to `f`, V that of a viscous membrane whose atoms are at `x` (µm); nothing where none is.
    pub fn add_resistance(&self, lanes: usize, factor: f64, [x, v]: [&[f64]; 2], f: &mut [f64]) {
        if let Some(viscosity) = &self.viscosity {
            viscosity.add_to(lanes, factor, [x, v], f);
        }
    }
    /// Whether its surface resists shear and change of area as a membrane does.
    pub fn has_membrane(&self) -> bool {
        self.forces.iter().any(|force| matches!(force, Force::Membrane(_)))
    }
    /// Whether any atom is held.
    pub fn is_held(&self) -> bool {
        !self.held.is_empty()
    }
}

/// The material that a force is, if it is one.
fn solid(force: &Force) -> Option<&Solid> {
    match force {
        Force::Solid(solid) => Some(solid),
        _ => None,
    }
}

/// All times after the start at which a course of some kind or obstacle bends, rising.
pub fn kinks(kinds: &[Kind], obstacles: &[Obstacle]) -> Vec<f64> {
    let of_kind = |kind: &Kind| -> Vec<f64> {
        let volume = kind.volume.course().into_iter().flat_map(Course::kinks);
        let moved = kind.moved.iter().flat_map(Moved::courses).flat_map(Course::kinks);
        kind.forces.iter().flat_map(Force::kinks).chain(volume).chain(moved).collect()
    };
    let going = obstacles.iter().filter_map(|obstacle| obstacle.going.as_ref());
    let of_obstacles = going.flat_map(|going| going.displacement.kinks());
    let mut kinks: Vec<f64> = kinds.iter().flat_map(of_kind).chain(of_obstacles).filter(|kink| *kink > 0.0).collect();
    kinks.sort_by(f64::total_cmp);
    kinks.dedup();
    kinks
}
