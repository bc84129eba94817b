//! The facets of an instant, and which of them are near which.

use rayon::prelude::*;

use super::super::super::vectors::gather_corners;
use super::facet::{Facet, apart, apart_at_once, nearer};
use crate::Vec3;
use crate::contact::{NearFacets, Scene};

/// The facets at an instant, and which are near which.
#[derive(Debug, Clone, Default)]
pub struct Surroundings {
    pub near: NearFacets,
    /// All facets.
    pub facets: Vec<Facet>,
    /// What they were when it was looked for what is near.
    then: Vec<Facet>,
    /// By how much each may have come nearer to others since then, µm.
    pub nearer: Vec<f64>,
}

impl Surroundings {
    /// Those at these positions, of facets nearer than `range` (µm) to each other. Where they are followed from instant to instant,
    /// what is near is looked for some way farther and kept as long as it will do.
    pub fn find(&mut self, scene: &Scene, positions: &[Vec3], range: f64, are_followed: bool) {
        let Self { near, facets, then, nearer: of_facets } = self;
        see_facets(scene, positions, facets);
        let apart = if are_followed { apart } else { apart_at_once };
        // Rounded so that it is less than it was.
        let apart = |own: u32, other: u32| {
            let has_two = scene.sides_of(scene.body_of_facet(own)) == 2;
            let [own, other] = [own, other].map(|facet| &facets[facet as usize]);
            let before = apart(own, own.normal, other, range);
            (if has_two { before.min(apart(own, -own.normal, other, range)) } else { before } - 1e-5) as f32
        };
        let are_new = if are_followed {
            near.follow(scene, positions, range, apart)
        } else {
            near.find(scene, positions, range, apart);
            true
        };
        if are_new {
            then.clone_from(facets);
        }
        let come_nearer = facets.par_iter().zip(&*then).with_min_len(FACETS_PER_JOB);
        come_nearer.map(|(now, then)| nearer(now, then, range)).collect_into_vec(of_facets);
    }
}

/// Facets that a thread sees at once, at least.
const FACETS_PER_JOB: usize = 512;

/// Sees all facets at these positions.
fn see_facets(scene: &Scene, positions: &[Vec3], facets: &mut Vec<Facet>) {
    let facet = |number: usize| {
        let atoms = scene.facet_atoms(scene.body_of_facet(number as u32), number as u32);
        Facet::of(&gather_corners(positions, atoms))
    };
    (0..scene.facets).into_par_iter().with_min_len(FACETS_PER_JOB).map(facet).collect_into_vec(facets);
}
