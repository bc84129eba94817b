//! The facets of an instant, and which of them are near which.

use super::super::super::vectors::gather_corners;
use super::facet::{Facet, apart, nearer};
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
        facets.clear();
        facets.extend((0..scene.bodies.len() as u32).flat_map(|body| {
            let first = scene.bodies[body as usize].first_atom;
            let corners = move |facet: &[u32; 3]| gather_corners(positions, facet.map(|atom| first + atom));
            scene.shape(body).facets.iter().map(move |facet| Facet::of(&corners(facet)))
        }));
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
        of_facets.clear();
        of_facets.extend(facets.iter().zip(&*then).map(|(now, then)| nearer(now, then, range)));
    }
}
