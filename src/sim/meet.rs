//! The stage that notes what pseudopods met, for cells that heed it in the next step.

use super::contact::near_cell;
use super::model::Model;
use super::protrude::pseudopods_of;
use super::skeleton::Positions;
use super::state::State;
use super::workspace::Workspace;
use crate::Vec3;
use crate::cell::BehaviourState;
use crate::cell::pseudopods::Pseudopods;

/// Notes where a step ends which fronts touch other cells, and where each cell is touched, eqs (pseudopods.11) and (pseudopods.12), for
/// types with contact inhibition. What touches is what was found last: where the step ended under virtual adhesives, and else where it began.
pub fn note_meetings(model: &Model, to: &mut State, ws: &mut Workspace) {
    let heeds = |number: usize| Some(pseudopods_of(&model.kinds[number])?.1.inhibition?.by);
    if (0..model.kinds.len()).all(|number| heeds(number).is_none()) {
        return;
    }
    let Some(contact) = ws.contact.scene(model, &to.kinds) else { return };
    let (scene, found) = (&contact.scene, &ws.contact.found.atoms[..]);
    for (number, kind) in model.kinds.iter().enumerate() {
        let (Some((behaviour, pods)), Some(by)) = (pseudopods_of(kind), heeds(number)) else { continue };
        let mut states = std::mem::take(&mut to.kinds[number].behaviours[behaviour]);
        let now = &to.kinds[number];
        for (cell, state) in states.iter_mut().enumerate() {
            let BehaviourState::Pseudopods(state) = state else { continue };
            let ((begin, near), own) = (near_cell(kind, now, found, cell), now.first_cell + cell);
            let counts = |body: usize| body != own && by.counts(to.kind_of(body).0 == number);
            ws.touched.clear();
            ws.touched.resize(kind.atoms(), false);
            let touching = near.iter().filter(|contact| scene.reach.touches(contact.gap));
            let meets = touching.filter(|contact| counts(contact.body(scene) as usize));
            meets.for_each(|contact| ws.touched[(contact.atom - begin) as usize] = true);
            let (positions, touched) = (Positions { kind, now, cell }, &ws.touched);
            state.note_touch(positions.touched(touched), |direction| positions.met(pods, direction, touched));
        }
        to.kinds[number].behaviours[behaviour] = states;
    }
}

impl Positions<'_> {
    /// The mean of the directions from the middle of the cell to the atoms that are touched, eq. (pseudopods.11); 0 where none is.
    fn touched(&self, touched: &[bool]) -> Vec3 {
        let count = touched.iter().filter(|touched| **touched).count();
        if count == 0 {
            return Vec3::zeros();
        }
        let centre = self.centre();
        let out = |(atom, _): (usize, _)| (self.of(atom) - centre).try_normalize(0.0).unwrap_or_default();
        touched.iter().enumerate().filter(|(_, touched)| **touched).map(out).sum::<Vec3>() / count as f64
    }

    /// The share of a front that is touched, eq. (pseudopods.12).
    fn met(&self, pods: &Pseudopods, direction: &Vec3, touched: &[bool]) -> f64 {
        let centre = self.centre();
        let (mut whole, mut met) = (0.0, 0.0);
        for (atom, touched) in touched.iter().enumerate() {
            let share = self.share(pods, atom, (&centre, direction));
            whole += share;
            met += if *touched { share } else { 0.0 };
        }
        if whole > 0.0 { met / whole } else { 0.0 }
    }
}
