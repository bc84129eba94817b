//! Areas of contact, whatever law acts: what of each surface has another one before it within a reach, eq. (adhesion.8).

use rayon::prelude::*;

use super::patch::Partner;
use super::search::{Around, Seen};
use super::surroundings::Surroundings;
use super::table::CohesionTable;
use crate::Vec3;
use crate::contact::Scene;
use crate::sim::controls::Controls;

/// What is needed to measure areas of contact.
#[derive(Debug, Clone, Default)]
pub struct AreaScratch {
    around: Surroundings,
    of_batches: Vec<OfBatch>,
}

/// What a batch of bodies looks at; a body, what it is in contact with and how much of the body.
type OfBatch = (Around, Vec<(u32, u32, f64)>);

impl CohesionTable {
    /// Adds the areas of contact where all surfaces look alike at these positions: a body, then another one, or the number of bodies and
    /// that of an obstacle, the first less than the second, and the area that the first has of it, µm². Parts of a surface count where the
    /// opening to the other is less than the range, as seen from there, and for the nearest of several alone.
    pub fn add_areas(
        &self,
        scene: &Scene,
        positions: &[Vec3],
        scratch: &mut AreaScratch,
        to: &mut Vec<(u32, u32, f64)>,
    ) {
        let (range, controls, bodies) = (self.range(), Controls::default(), scene.bodies.len() as u32);
        scratch.around.find(scene, positions, range, false);
        let AreaScratch { around: Surroundings { near, facets, nearer, .. }, of_batches } = scratch;
        let seen = Seen { table: self, scene, controls: &controls, positions, facets, nearer, range };
        of_batches.resize_with(scene.batches(), OfBatch::default);
        of_batches.par_iter_mut().enumerate().for_each(|(batch, (around, areas))| {
            areas.clear();
            for body in scene.bodies_of(batch) {
                let first = areas.len();
                seen.find(body, near.of_body(scene, body), &mut [], around, |_, patch| {
                    let area = patch.area_within(scene, positions);
                    let (other, area) = match patch.other {
                        Partner::Facet([atom, ..], _) => (scene.body_of_atom(atom), 0.5 * area),
                        Partner::Obstacle(obstacle) => (bodies + obstacle, area),
                    };
                    match areas[first..].iter_mut().find(|known| known.1 == other) {
                        Some(known) => known.2 += area,
                        None => areas.push((body, other, area)),
                    }
                });
            }
        });
        let areas = of_batches.iter().flat_map(|(_, areas)| areas).filter(|(_, _, area)| *area > 0.0);
        to.extend(areas.map(|&(body, other, area)| (body.min(other), body.max(other), area)));
    }
}
