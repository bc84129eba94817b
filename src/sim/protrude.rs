//! The stages in which cells push and draw their own atoms: by pseudopods, or where chemistry sets it.

use rayon::prelude::*;

use super::atom_controls::AtomControls;
use super::contact::ContactScratch;
use super::kind::Kind;
use super::model::Model;
use super::skeleton::Positions;
use super::state::State;
use super::workspace::Workspace;
use crate::Vec3;
use crate::cell::pseudopods::Pseudopods;
use crate::cell::{Behaviour, BehaviourState};

/// The sliding speed at which friction counts as grip, µm/s.
const SLIDING: f64 = 1.0;

/// Cells that a thread looks at at once, at least.
const CELLS_PER_JOB: usize = 16;

/// Whether any cell pushes its surface by itself: by pseudopods, or where chemistry sets it.
fn any_pushes(model: &Model, from: &State) -> bool {
    model.kinds.iter().any(Kind::has_pseudopods) || from.chemistry.controls.of_atoms.iter().any(AtomControls::push)
}

/// The pseudopods of a kind, and the number of that behaviour.
pub(super) fn pseudopods_of(kind: &Kind) -> Option<(usize, &Pseudopods)> {
    kind.behaviours.iter().enumerate().find_map(|(number, behaviour)| match behaviour {
        Behaviour::Pseudopods(pods) => Some((number, pods)),
        _ => None,
    })
}

/// Finds how much each atom grips what its cell touches where a step begins: the most that its contacts bear across, pN, with what friction
/// bears at 1 µm/s.
pub fn find_grips(model: &Model, from: &State, ws: &mut Workspace) {
    if !any_pushes(model, from) {
        return;
    }
    let Workspace { contact, grips, .. } = ws;
    grips.clear();
    grips.resize(from.atoms(model), 0.0);
    // Scratch of contacts may hold those of another model.
    if model.contact.is_some() {
        add_grips(contact, grips);
    }
}

/// Adds what contacts bear, in the order in which they were found, however they are swept.
fn add_grips(contact: &ContactScratch, grips: &mut [f64]) {
    for number in 0..contact.rows.len() {
        let row = &contact.rows[contact.row_of(number)];
        let across = f64::from(row.shear) + SLIDING * f64::from(row.friction);
        for (atom, weight) in row.atoms.iter().zip(row.weights()) {
            grips[*atom as usize] += weight.abs() * across;
        }
    }
}

/// Finds the forces with which pseudopods, and what chemistry sets of atoms, push and draw atoms in a step, pN, in the order of cells; none in
/// a model without them.
pub fn push_pseudopods(model: &Model, from: &State, to: &State, ws: &mut Workspace) {
    let Workspace { pushes, grips, .. } = ws;
    if !any_pushes(model, from) {
        return;
    }
    pushes.clear();
    pushes.resize(from.atoms(model), Vec3::zeros());
    for ((kind, now), controls) in model.kinds.iter().zip(&from.kinds).zip(&from.chemistry.controls.of_atoms) {
        if controls.push() {
            let atoms = now.atoms(kind);
            let cells = pushes[atoms.clone()].par_chunks_mut(kind.atoms()).zip(grips[atoms].par_chunks(kind.atoms()));
            cells.with_min_len(CELLS_PER_JOB).enumerate().for_each(|(cell, (push, grips))| {
                let positions = Positions { kind, now, cell };
                let own = cell * kind.atoms()..(cell + 1) * kind.atoms();
                if let Some(pressures) = controls.protrusion.get(own.clone()) {
                    positions.press(pressures, grips, push);
                }
                if let Some(tensions) = controls.tension.get(own) {
                    positions.tighten(tensions, push);
                }
            });
        }
    }
    for ((kind, now), next) in model.kinds.iter().zip(&from.kinds).zip(&to.kinds) {
        let Some((number, pods)) = pseudopods_of(kind) else { continue };
        let (atoms, states) = (now.atoms(kind), &next.behaviours[number]);
        let cells = pushes[atoms.clone()].par_chunks_mut(kind.atoms()).zip(grips[atoms].par_chunks(kind.atoms()));
        cells.with_min_len(CELLS_PER_JOB).zip(states).enumerate().for_each(|(cell, ((push, grips), state))| {
            let BehaviourState::Pseudopods(state) = state else { return };
            let positions = Positions { kind, now, cell };
            for did in state.did.iter().filter(|did| did.protrusion > 0.0 || did.retraction > 0.0) {
                positions.push(pods, did, grips, push);
            }
        });
    }
}

/// Sets how much each atom sticks where a step ends, eq. (pseudopods.6).
pub fn release_rears(model: &Model, to: &mut State) {
    let of_atoms = to.atoms(model);
    let State { kinds, chemistry, .. } = to;
    let mut of_all = std::mem::take(&mut chemistry.controls.adhesion_of_atoms);
    let controls = &chemistry.controls;
    of_all.clear();
    let is_set = |own: &AtomControls| !own.adhesion.is_empty();
    let any = model.kinds.iter().any(Kind::has_pseudopods) || controls.of_atoms.iter().any(is_set);
    of_all.resize(if any { of_atoms } else { 0 }, 1.0);
    for (kind, now) in model.kinds.iter().zip(&*kinds) {
        let Some((number, pods)) = pseudopods_of(kind) else { continue };
        let factors = of_all[now.atoms(kind)].chunks_mut(kind.atoms());
        for (cell, (factors, state)) in factors.zip(&now.behaviours[number]).enumerate() {
            let BehaviourState::Pseudopods(state) = state else { continue };
            for (front, retraction) in state.releases(&controls.told_pseudopods(now.first_cell + cell)) {
                let let_go = pods.release * retraction;
                if let_go > 0.0 {
                    Positions { kind, now, cell }.release(let_go, &front, factors);
                }
            }
        }
    }
    for ((kind, now), own) in model.kinds.iter().zip(&*kinds).zip(&controls.of_atoms).filter(|(_, own)| is_set(own)) {
        of_all[now.atoms(kind)].iter_mut().zip(&own.adhesion).for_each(|(factor, own)| *factor *= own);
    }
    chemistry.controls.adhesion_of_atoms = of_all;
}
