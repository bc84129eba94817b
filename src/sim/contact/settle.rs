//! The shapes of virtual adhesives after exact volumes have moved their atoms.

use super::hold::put_back;
use super::scene::ContactScene;
use super::scratch::ContactScratch;
use crate::sim::model::Model;
use crate::sim::state::{State, vector};
use crate::sim::workspace::Workspace;

/// What exact volumes may leave of a change in the shape of an adhesive, over what a sweep may still move.
const SETTLED: f64 = 1e-3;

/// Gives adhesives their shapes back that exact volumes have changed; says whether there was something to do, so that volumes must
/// be made exact again.
pub fn settle_adhesives(model: &Model, from: &State, to: &mut State, ws: &mut Workspace) -> bool {
    let s = &mut ws.contact;
    let Some(contact) = &s.scene(model, &from.kinds) else { return false };
    if s.law.adhesives.atoms.is_empty() {
        return false;
    }
    take_displacements(model, contact, to, s);
    let moved = s.law.adhesives.align(&s.start, &mut s.moved) > SETTLED * contact.tolerance;
    if moved {
        put_back(model, contact, s, from, to);
    }
    moved
}

/// Displacements over the step as the atoms stand now; what is kept beside them stays.
fn take_displacements(model: &Model, contact: &ContactScene, to: &State, s: &mut ContactScratch) {
    for (number, (kind, now)) in model.kinds.iter().zip(&to.kinds).enumerate() {
        let range = contact.atoms_of(number);
        let (first, moved) = (range.start, &mut s.moved[range]);
        for (atom, moved) in moved.iter_mut().enumerate() {
            let displacement =
                vector(kind, &now.positions, atom / kind.atoms(), atom % kind.atoms()) - s.start[first + atom];
            (moved[0], moved[1], moved[2]) = (displacement.x, displacement.y, displacement.z);
        }
    }
}
