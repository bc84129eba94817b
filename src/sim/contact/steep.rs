//! How forces of the law of contact change as cells move, for the implicit step: where they change more than drag answers in its time.

use super::gather::{gather, scatter};
use super::scratch::ContactScratch;
use crate::Vec3;
use crate::sim::kind::Kind;
use crate::sim::model::Model;
use crate::sim::state::{KindState, State};

/// What a pull on an atom grows with an opening, over what its drag and the stiffest shape of its cell answer, from which on the step answers
/// it, too. Two drops under tension, whose shapes answer little, are unstable without from 0.27 of what drag answers on.
const BESIDE_SHAPES: f64 = 0.2;

/// The same over what drag alone answers: shapes do not hold cells that move as a whole.
const BESIDE_DRAG: f64 = 1.5;

/// Whether forces of the law change so much as cells move in a step of `dt` (s) that its matrix must know; `stiffenings` are those of the
/// kinds. By what the document says of strengths and ranges, whatever chemistry makes of them. Never where there are obstacles: what holds cells on
/// these is found for each cell by itself, and would have to be found anew with what others do.
pub fn are_steep(model: &Model, dt: f64, stiffenings: impl Iterator<Item = f64>) -> bool {
    let Some(contact) = model.contact.as_ref().filter(|_| model.obstacles.is_empty()) else { return false };
    let steepest = contact.law.steepest();
    let mut kinds = model.kinds.iter().zip(&contact.areas).zip(stiffenings);
    kinds.any(|((kind, areas), stiffening)| {
        let slope = steepest * areas.iter().copied().fold(0.0, f64::max);
        let drag = kind.drag / dt;
        slope > (BESIDE_SHAPES * (drag + stiffening * kind.largest_stiffness)).min(BESIDE_DRAG * drag)
    })
}

/// Finds how the forces of the law change as cells move from where they were pulled last, [`super::pull_contacts`].
pub fn find_slopes(model: &Model, from: &State, s: &mut ContactScratch) {
    let Some(contact) = &s.scene(model, &from.kinds) else { return };
    contact.law.find_slopes(&contact.scene, &mut s.law, &s.positions);
}

/// Finds what the law does, beyond what it does where slopes were found, where all atoms are `moved` so (µm, an array for each kind in the
/// shape of its positions), so many times. What of it cells do to what they touch counts this share of the step; nothing is noted where that
/// is 0. It takes the memory of the live forces.
pub fn answer<'a>(
    model: &Model,
    (times, share): (f64, f64),
    from: &State,
    moved: impl Iterator<Item = &'a [f64]>,
    s: &mut ContactScratch,
) {
    let Some(contact) = &s.scene(model, &from.kinds) else { return };
    for ((number, kind), moved) in model.kinds.iter().enumerate().zip(moved) {
        gather(kind, moved, &mut s.positions[contact.atoms_of(number)], |moved| moved);
    }
    let live = &mut s.forces.live;
    live.fill(Vec3::zeros());
    let noted = s.tractions.counting(share);
    contact.law.answer(&contact.scene, &mut s.law, (times, &s.positions), live, noted);
}

/// Takes what was found so for the cells of a kind, pN.
pub fn take_answer(kind: &Kind, cells: &KindState, s: &ContactScratch, to: &mut [f64]) {
    let own = &s.forces.live[cells.atoms(kind)];
    scatter(kind, cells.cells(), |cell, atom| own[cell * kind.atoms() + atom], to);
}
