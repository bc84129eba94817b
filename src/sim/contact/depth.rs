//! Whether contacts can be mended where a step begins, and whether cells have passed each other unnoticed.

use rayon::prelude::*;

use super::gather::gather_places;
use super::model::{ContactModel, Law};
use crate::Vec3;
use crate::contact::{Sides, closest_on_facet, winding_number};
use crate::geometry::bounding_box;
use crate::mechanics::integrator::StepSize;
use crate::sim::model::Model;
use crate::sim::state::State;
use crate::sim::trouble::Trouble;
use crate::sim::workspace::Workspace;

/// How deep one surface may be inside another where a step begins, over the depth to which contacts are found. Beyond
/// it a step may lose the contact, and the two would pass each other.
const DEEPEST: f64 = 0.5;

/// Refuses to go on where cells are too deep in each other: they have no room, and depths grow faster than they are
/// mended. Contacts must have been found for this step, and the state must still hold those of the step before.
///
/// # Errors
/// The two cells that are too deep in each other.
pub fn check_depth(model: &Model, state: &State, ws: &Workspace) -> Result<(), Trouble> {
    let Some(contact) = &model.contact else { return Ok(()) };
    let found = &ws.contact.found;
    let of_atoms = found.atoms.iter().map(|near| (near.gap, near.atom, near.body));
    let of_edges = found.edges.iter().map(|near| {
        let [own, other] = near.bodies;
        (near.gap, contact.scene.bodies[own as usize].first_atom, other)
    });
    let deepest = of_atoms.chain(of_edges).min_by(|one, other| one.0.total_cmp(&other.0));
    let most = contact.scene.reach.depth;
    let too_deep = deepest.filter(|(gap, ..)| -gap > DEEPEST * most).map(|(gap, atom, body)| (-gap, atom, body));
    let lost = || lost_inside(contact, state, ws).map(|(atom, body)| (most, atom, body));
    let Some((depth, atom, body)) = too_deep.or_else(lost) else { return Ok(()) };
    let cells = [contact.owner(atom), model.kind_of(body as usize)];
    let cells = cells.map(|(kind, cell)| (model.kinds[kind].name.clone(), cell));
    Err(Trouble::Pressed { cells, time: state.time, depth })
}

/// The depth from which on a fixed step is made shorter where it deepens, over the smallest mean edge: half of what is promised.
const DEEP: f64 = 0.01;

/// What a depth may grow by in such a step, over what it was.
const GROWS: f64 = 1.1;

/// The shortest part of a fixed step that is made shorter still, over the whole.
pub const SHORTEST: f64 = 0.01;

/// Whether cells are deep in each other after a fixed step, and deeper than before: something met within the step that no contact
/// at its begin told of. An adaptive step is short where things move fast. What is found here is what the next step begins with.
pub fn has_deepened(model: &Model, dt: f64, state: &State, ws: &mut Workspace) -> bool {
    let (Some(contact), StepSize::Fixed(whole)) = (&model.contact, model.integrator.size) else { return false };
    if contact.law != Law::Adhesives || dt < SHORTEST * whole {
        return false;
    }
    let s = &mut ws.contact;
    gather_places(model, contact, state, &mut s.places);
    s.detector.detect(&contact.scene, &s.places, &mut s.ahead);
    s.ahead_of = Some(fingerprint(&s.places));
    let edge = model.kinds.iter().map(|kind| kind.edge).fold(f64::INFINITY, f64::min);
    let [before, after] = [&s.found, &s.ahead].map(|found| (-found.smallest_gap()).max(0.0));
    after > DEEP * edge && after > GROWS * before
}

/// A number that other positions have by a chance of 10⁻¹⁹ only.
pub(super) fn fingerprint(places: &[Vec3]) -> u64 {
    let bits = places.iter().flat_map(|place| [place.x, place.y, place.z]).map(f64::to_bits);
    // The multiplier of Knuth's MMIX generator; a rotation mixes the high bits back in.
    bits.fold(places.len() as u64, |mixed, bits| (mixed.rotate_left(23) ^ bits).wrapping_mul(6_364_136_223_846_793_005))
}

/// An atom that touched a body in the step before, and is now so deep in it that no contact is found, with the body.
fn lost_inside(contact: &ContactModel, state: &State, ws: &Workspace) -> Option<(u32, u32)> {
    let (found, scene) = (&ws.contact.found.atoms, &contact.scene);
    let is_found = |atom: u32, body: u32| {
        let at = found.partition_point(|near| near.atom < atom);
        found[at..].iter().take_while(|near| near.atom == atom).any(|near| near.body == body)
    };
    let is_inside = |atom: u32, body: u32| {
        let (shape, first) = (scene.shape(body), scene.bodies[body as usize].first_atom as usize);
        let own = (first..first + shape.atoms).contains(&(atom as usize));
        let closed = shape.closed && shape.sides == Sides::Outer;
        let there = &ws.contact.start[first..first + shape.atoms];
        closed && !own && winding_number(ws.contact.start[atom as usize], there, &shape.facets) > 0.5
    };
    let mut touched = state.contact.atoms.iter().map(|bond| (bond.atom, bond.body));
    touched.find(|&(atom, body)| !is_found(atom, body) && is_inside(atom, body))
}

/// Refuses a state in which an atom is farther inside another cell than contacts are found. Contacts look at what is near; where
/// cells are crushed beyond what they can resolve, as in a box that is too small, surfaces may slip through each other
/// by ways that no contact sees. This looks at all atoms, slowly: for the instants that are recorded.
///
/// # Errors
/// The first two cells that are inside each other.
pub fn check_passed(model: &Model, state: &State) -> Result<(), Trouble> {
    let Some(contact) = &model.contact else { return Ok(()) };
    let scene = &contact.scene;
    let mut places = Vec::new();
    gather_places(model, contact, state, &mut places);
    let atoms_of = |body: u32| {
        let first = scene.bodies[body as usize].first_atom as usize;
        first..first + scene.shape(body).atoms
    };
    let bodies = 0..scene.bodies.len() as u32;
    let boxes: Vec<(Vec3, Vec3)> =
        bodies.clone().map(|body| bounding_box(&places[atoms_of(body)]).unwrap_or_default()).collect();
    let depth_in = |atom: usize, other: u32| {
        let (shape, there) = (scene.shape(other), &places[atoms_of(other)]);
        let (low, high) = &boxes[other as usize];
        let outside = (0..3).any(|axis| places[atom][axis] < low[axis] || places[atom][axis] > high[axis]);
        if outside || winding_number(places[atom], there, &shape.facets) < 0.5 {
            return 0.0;
        }
        let corners = shape.facets.iter().map(|facet| facet.map(|corner| there[corner as usize]));
        let distances = corners.map(|corners| closest_on_facet(places[atom], corners).offset.norm());
        distances.fold(f64::INFINITY, f64::min)
    };
    let passed = bodies.clone().into_par_iter().find_map_first(|body| {
        let meets = |other: &u32| {
            let ((low, high), (from, to)) = (&boxes[body as usize], &boxes[*other as usize]);
            let shape = scene.shape(*other);
            let solid = shape.closed && shape.sides == Sides::Outer;
            *other != body && solid && (0..3).all(|axis| low[axis] <= to[axis] && from[axis] <= high[axis])
        };
        bodies.clone().filter(meets).find_map(|other| {
            let deep = atoms_of(body).map(|atom| depth_in(atom, other)).find(|depth| *depth > scene.reach.depth);
            deep.map(|depth| (body, other, depth))
        })
    });
    let Some((body, other, depth)) = passed else { return Ok(()) };
    let cells = [body, other].map(|body| model.kind_of(body as usize));
    let cells = cells.map(|(kind, cell)| (model.kinds[kind].name.clone(), cell));
    Err(Trouble::Pressed { cells, time: state.time, depth })
}
