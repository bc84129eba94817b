//! Whether contacts can be mended where a step begins.

use super::model::ContactModel;
use crate::contact::{Sides, winding_number};
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
    let (kind, other) = (contact.owner(atom), contact.kind_of(body));
    let cells = [kind, (other, body as usize - model.kinds[other].first_cell)];
    let cells = cells.map(|(kind, cell)| (model.kinds[kind].name.clone(), cell));
    Err(Trouble::Pressed { cells, time: state.time, depth })
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
