//! What links read of cells, measured from the blocks without a copy of any surface.

use rayon::prelude::*;

use super::super::contact::{ContactScene, near_cell};
use super::super::kind::Kind;
use super::super::model::Model;
use super::super::obstacle::Obstacle;
use super::super::state::{State, vector};
use crate::Vec3;
use crate::cell::ends::Reading;
use crate::contact::AtomContact;

/// An atom touches an obstacle when it is nearer to it than this part of the mean edge: obstacles put atoms exactly on them, but where cells touch
/// each other, too, atoms that are pressed on an obstacle are off it by what sweeps leave, some 10⁻⁴ of an edge.
const TOUCHING: f64 = 1e-3;

/// Measures of one cell at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CellNumbers {
    /// Centre of volume, or of the atoms of an open surface, µm.
    centre: Vec3,
    /// Mean velocity of the atoms over the last step, µm/s.
    velocity: Vec3,
    /// µm³, 0 for an open surface.
    volume: f64,
    /// µm².
    area: f64,
    /// Extents of the bounding box, µm.
    size: Vec3,
    /// Part of the atoms near another cell, as it is recorded.
    contact_share: f64,
    /// Part of the atoms on an obstacle.
    plane_share: f64,
    /// Volume and area of the mesh at rest.
    rest: [f64; 2],
}

impl CellNumbers {
    pub(super) fn poisoned() -> Self {
        let none = Vec3::repeat(f64::NAN);
        Self { centre: none, velocity: none, volume: f64::NAN, area: f64::NAN, ..Self::default() }
    }

    /// A reading; positions of atoms are read elsewhere.
    pub(super) fn read(&self, reading: Reading) -> f64 {
        let strain = |now: f64, rest: f64| if rest > 0.0 { (now - rest) / rest } else { 0.0 };
        match reading {
            Reading::Position(axis) => self.centre[axis],
            Reading::Velocity(axis) => self.velocity[axis],
            Reading::Speed => self.velocity.norm(),
            Reading::Volume => self.volume,
            Reading::VolumeStrain => strain(self.volume, self.rest[0]),
            Reading::Area => self.area,
            Reading::AreaStrain => strain(self.area, self.rest[1]),
            Reading::Size(axis) => self.size[axis],
            Reading::ContactShare => self.contact_share,
            Reading::PlaneShare => self.plane_share,
            Reading::Atom(..) => f64::NAN,
        }
    }
}

/// Measures all cells. What touches is what was found last: under
/// adhesives where the step ended, and else where it began.
pub(super) fn measure_cells(
    model: &Model,
    state: &State,
    contact: Option<&ContactScene>,
    found: &[AtomContact],
    cells: &mut [CellNumbers],
) {
    for ((kind, now), rest) in model.kinds.iter().zip(&state.kinds).zip(&model.chemistry.rest) {
        let out = &mut cells[now.numbers()];
        out.par_iter_mut().enumerate().for_each(|(cell, out)| {
            let (first, near) = near_cell(kind, now, found, cell);
            *out = measure(model, kind, &now.positions, cell, |atom| {
                let at = near.partition_point(|contact| contact.atom < first + atom);
                let mut of_atom = near[at..].iter().take_while(|contact| contact.atom == first + atom);
                let own = now.first_cell + cell;
                contact.is_some_and(|ContactScene { scene, .. }| {
                    of_atom.any(|near| scene.reach.touches(near.gap) && near.body(scene) as usize != own)
                })
            });
            out.rest = *rest;
            out.velocity = Vec3::from(now.mean_velocities[cell]);
        });
    }
}

/// Whether an atom of a kind stands on one of these obstacles.
pub(super) fn is_on_obstacle(obstacles: &[Obstacle], kind: &Kind, atom: &Vec3) -> bool {
    obstacles.iter().any(|obstacle| obstacle.surface.gap(atom) < TOUCHING * kind.edge)
}

fn measure(model: &Model, kind: &Kind, x: &[f64], cell: usize, is_near: impl Fn(u32) -> bool) -> CellNumbers {
    let position = |atom: usize| vector(kind, x, cell, atom);
    let base = position(0);
    let (mut low, mut high, mut sum) = (base, base, Vec3::zeros());
    let (mut near_cells, mut on_obstacles) = (0_usize, 0_usize);
    for atom in 0..kind.atoms() {
        let p = position(atom);
        (low, high, sum) = (low.inf(&p), high.sup(&p), sum + (p - base));
        on_obstacles += usize::from(is_on_obstacle(&model.obstacles, kind, &p));
        near_cells += usize::from(is_near(atom as u32));
    }
    let (mut area, mut volume, mut moment) = (0.0, 0.0, Vec3::zeros());
    for facet in &kind.rest.facets {
        let [a, b, c] = facet.map(|atom| position(atom as usize) - base);
        area += 0.5 * (b - a).cross(&(c - a)).norm();
        // The tetrahedron with the first atom: its volume, and its centre a quarter of the way to a + b + c.
        let part = a.dot(&b.cross(&c)) / 6.0;
        volume += part;
        moment += 0.25 * part * (a + b + c);
    }
    let atoms = kind.atoms() as f64;
    CellNumbers {
        centre: base + if kind.closed { moment / volume } else { sum / atoms },
        volume: if kind.closed { volume } else { 0.0 },
        area,
        size: high - low,
        contact_share: near_cells as f64 / atoms,
        plane_share: on_obstacles as f64 / atoms,
        ..CellNumbers::default()
    }
}
