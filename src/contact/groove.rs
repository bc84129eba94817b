//! The other walls of a groove: facets that an atom will touch when it slides on along the one that it touches now.

use super::closest::closest_on_facet;
use super::found::{AtomContact, Contacts, Facing};
use super::scene::Scene;
use super::shape::NONE;
use crate::Vec3;

/// A facet that rises by no more than this sine lies in the plane of the one beside it, as far as normals of seven digits tell.
const FLAT: f64 = 1e-6;

/// How far behind the plane of a wall an atom may be that it holds, over the prediction: what sweeps leave. One that is farther behind has not
/// come through the wall, which held it; it has come around a corner, and what it is nearest to tells how deep it is.
const PASSED: f64 = 0.01;

/// Adds to contacts with surfaces that have two outsides the facets beside them that rise towards the atom, where it is nearer to the
/// side that they share than `within` (µm). The region in front of a groove is that in front of the planes of both walls, eq. (contacts.10), so that
/// the second plane is no obstacle before its facet is one; found by the point where the distance is least, an atom at a
/// small gap has one wall in one step and the other in the next.
pub fn add_walls_of_grooves(scene: &Scene, positions: &[Vec3], within: f64, contacts: &mut Contacts) {
    let count = contacts.atoms.len();
    for number in 0..count {
        let near = contacts.atoms[number];
        if near.facing == Facing::Any {
            continue;
        }
        let number = near.body(scene);
        let body = &scene.bodies[number as usize];
        let (shape, there) = (scene.shape(number), scene.of_body(number, positions));
        let own = near.atom.checked_sub(body.first_atom).filter(|atom| (*atom as usize) < shape.atoms);
        let (facet, position) = (near.facet - body.first_facet, positions[near.atom as usize]);
        let corners = shape.corners(facet, there);
        for side in 0..3 {
            let other = shape.beyond[facet as usize][side];
            if other == NONE || own.is_some_and(|atom| shape.is_near(atom, other)) {
                continue;
            }
            let (start, along) = (corners[side], corners[(side + 1) % 3] - corners[side]);
            let across = near.normal.wide().cross(&along).normalize();
            if across.dot(&(position - start)).abs() > within {
                continue;
            }
            let known = body.first_facet + other;
            let found = &contacts.atoms[..count];
            if found.binary_search_by_key(&(near.atom, known), |one| (one.atom, one.facet)).is_ok() {
                continue;
            }
            let wall = wall(&near, shape.corners(other, there), &start, &along, position, known);
            let farthest = scene.reach.prediction;
            let is_near = |wall: &AtomContact| (-PASSED * farthest..farthest).contains(&wall.gap);
            contacts.atoms.extend(wall.filter(is_near));
        }
    }
    if contacts.atoms.len() > count {
        // Two walls may have added the same third: it is the same contact.
        contacts.atoms.sort_unstable_by_key(|near| (near.atom, near.facet));
        contacts.atoms.dedup_by_key(|near| (near.atom, near.facet));
    }
}

/// The contact with the facet beyond a side, if that rises towards the atom.
fn wall(
    near: &AtomContact,
    corners: [Vec3; 3],
    start: &Vec3,
    along: &Vec3,
    position: Vec3,
    facet: u32,
) -> Option<AtomContact> {
    let [a, b, c] = corners;
    let front = (b - a).cross(&(c - a)).try_normalize(0.0)?;
    let normal = if near.facing == Facing::Back { -front } else { front };
    // The corner that is not on the side is farthest from it.
    let off_side = |corner: &Vec3| (corner - start).cross(along).norm_squared();
    let third = corners.into_iter().max_by(|one, other| off_side(one).total_cmp(&off_side(other)))?;
    let facing = near.normal.wide();
    let up = third - start;
    let rises = facing.dot(&up) > FLAT * up.norm() && normal.dot(&facing) > 0.0;
    let point = closest_on_facet(position, corners);
    let second_weights = point.weights.map(|weight| weight as f32);
    let (gap, feature) = (normal.dot(&(position - a)), point.feature);
    rises.then_some(AtomContact { facet, feature, second_weights, gap, normal: normal.into(), ..*near })
}
