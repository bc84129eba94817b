//! Closed surfaces that are round: they cannot touch themselves.

use super::scene::{Scene, centre};
use crate::Vec3;

/// The least cosine between the normal of a facet and the direction to it from the middle of its body at which that is far from touching itself,
/// eq. (contacts.15): walls of grooves are steeper.
pub(super) const ROUND: f64 = 0.25;

/// Whether all facets of a closed surface look so far away from a point within, eq. (contacts.15), that the surface, which each ray from there meets once, cannot touch itself.
pub(super) fn is_round(facets: &[[u32; 3]], at: impl Fn(usize) -> Vec3, middle: Vec3) -> bool {
    facets.iter().all(|facet| {
        let [normal, outwards] = faces(facet, &at, middle);
        normal.dot(&outwards) > ROUND * normal.norm() * outwards.norm()
    })
}

/// The least cosine of eq. (contacts.15), of which the surface is not through itself where it is positive; -1 where a facet has none.
pub(super) fn least_cosine(facets: &[[u32; 3]], at: impl Fn(usize) -> Vec3, middle: Vec3) -> f64 {
    let cosine = |facet: &[u32; 3]| {
        let [normal, outwards] = faces(facet, &at, middle);
        let cosine = normal.dot(&outwards) / (normal.norm() * outwards.norm());
        if cosine.is_nan() { -1.0 } else { cosine }
    };
    facets.iter().map(cosine).fold(1.0, f64::min)
}

/// The direction that a facet looks to, and that to it from a point within.
fn faces(facet: &[u32; 3], at: impl Fn(usize) -> Vec3, middle: Vec3) -> [Vec3; 2] {
    let [a, b, c] = facet.map(|atom| at(atom as usize) - middle);
    [(b - a).cross(&(c - a)), a + b + c]
}

impl Scene {
    /// Whether a body cannot touch itself where it is: its pairs with itself are not looked at.
    pub(super) fn is_round(&self, body: u32, positions: &[Vec3]) -> bool {
        let (shape, atoms) = (self.shape(body), self.of_body(body, positions));
        shape.closed && is_round(&shape.facets, |atom| atoms[atom], centre(atoms))
    }
}
