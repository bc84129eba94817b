//! Why contacts could not keep two cells apart, from what the cells look like.

use super::gather::gather_positions;
use super::scene::ContactScene;
use crate::Vec3;
use crate::contact::{Contacts, Detector};
use crate::geometry::{Flap, Topology};
use crate::sim::kind::Kind;
use crate::sim::model::Model;
use crate::sim::state::State;
use crate::sim::trouble::Trouble;

/// What to do about trouble, in the light of the state that it came from.
pub fn help_at(trouble: &Trouble, model: &Model, state: &State) -> &'static str {
    let (Trouble::Contact { cells, .. } | Trouble::Pressed { cells, .. }) = trouble else { return trouble.help() };
    match cause_of(model, state, cells) {
        Cause::Crowded => {
            "cells are pressed together harder than their volumes allow: give them more space or weaker loads, or \
             let run.integrator make shorter steps (a smaller step where you set one, else max_step or tolerance)"
        }
        Cause::Folded => {
            "the surface of one of these cells is folded: it is too soft for what moves it. Raise its stiffness \
             (shape_memory, or shear, area and bending of its membrane), pull or press it more gently, or let \
             run.integrator make shorter steps (a smaller step where you set one, else max_step or tolerance)"
        }
        Cause::Open => {
            "nothing presses these cells together from around; they move or yield faster than contacts follow: let \
             run.integrator make shorter steps (a smaller step where you set one, else max_step or tolerance), pull \
             more gently, or raise their stiffness"
        }
    }
}

/// What kept contacts from holding.
enum Cause {
    /// The surface of a cell is folded.
    Folded,
    /// A cell has others, or obstacles, on most of its surface.
    Crowded,
    /// Neither: cells in the open that move or yield too fast.
    Open,
}

/// The part of a cell's atoms from which on it counts as surrounded.
const SURROUNDED: f64 = 0.6;

/// The cosine of the angle between the normals of two facets, 110°, from which on the edge between them is a fold. The barrier
/// against folds acts from 90° on where a document names no angle, so that what holds its shape stays below.
const FOLDED: f64 = -0.34;

/// The cause for two cells (type and number), or twice the same, in this state.
fn cause_of(model: &Model, state: &State, cells: &[(String, usize); 2]) -> Cause {
    let Some(contact) = &model.contact.as_ref().map(|contact| contact.scene_of(&state.kinds)) else {
        return Cause::Open;
    };
    let bodies = cells.each_ref().map(|(name, cell)| {
        let kind = model.kinds.iter().position(|kind| kind.name == *name);
        (kind.map_or(0, |kind| state.kinds[kind].first_cell) + cell) as u32
    });
    let is_folded = |body: u32| {
        let (kind, cell) = state.kind_of(body as usize);
        folds(&model.kinds[kind], &state.kinds[kind].cell(&model.kinds[kind], cell))
    };
    if bodies.into_iter().any(is_folded) {
        return Cause::Folded;
    }
    let contact = &contact.scene_of(&state.kinds);
    let (mut positions, mut found) = (Vec::new(), Contacts::default());
    gather_positions(model, contact, &state.kinds, &mut positions);
    Detector::default().detect(&contact.scene, &positions, &mut found);
    found.keep_touching(&contact.scene.reach);
    let is_surrounded = |body: u32| surrounded(contact, &found, body) > SURROUNDED;
    if bodies.into_iter().any(is_surrounded) { Cause::Crowded } else { Cause::Open }
}

/// The part of a cell's atoms that touch another cell or an obstacle.
fn surrounded(contact: &ContactScene, found: &Contacts, body: u32) -> f64 {
    let scene = &contact.scene;
    let others = found.atoms.iter().filter(|near| near.body(scene) != body).map(|near| near.atom);
    let mut touching: Vec<u32> = others.chain(found.obstacles.iter().map(|near| near.atom)).collect();
    touching.retain(|atom| scene.body_of_atom(*atom) == body);
    touching.sort_unstable();
    touching.dedup();
    touching.len() as f64 / scene.shape(body).atoms as f64
}

/// Whether a surface has a fold that it has not at rest.
fn folds(kind: &Kind, positions: &[Vec3]) -> bool {
    let cosine = |x: &[Vec3], flap: &Flap| {
        let [a, b, c, d] = [flap.a, flap.b, flap.c, flap.d].map(|atom| x[atom as usize]);
        let (left, right) = ((b - a).cross(&(c - a)), (a - b).cross(&(d - b)));
        left.dot(&right) / (left.norm() * right.norm())
    };
    let flaps = Topology::of(&kind.rest).flaps;
    flaps.iter().any(|flap| cosine(positions, flap) < FOLDED && cosine(&kind.rest.positions, flap) >= FOLDED)
}
