//! The stage in which fibres are made and removed: those of pseudopods; programs make and remove theirs between steps.
//!
//! A pseudopod makes them when it begins to retract, between atoms of its front and of the rear, and they go when that has ended. What
//! chooses the atoms is eq. (pseudopods.9). They are active as the pseudopod retracts, and programs say how active theirs are.

use super::fibre_state::{FibreState, slots_of};
use super::model::Model;
use super::skeleton::Positions;
use super::state::{KindState, State};
use super::workspace::Workspace;
use crate::Vec3;
use crate::cell::pseudopods::{Activity, PodFibres, Pseudopods};
use crate::cell::{Behaviour, BehaviourState};
use crate::mechanics::fibres::Fibre;
use crate::random::{Purpose, Stream};

/// Draws that are kept for the fibres of one pseudopod: no budget is as large.
const DRAWS: u64 = 1 << 32;

/// Makes and removes the fibres of pseudopods as these retract in the step, and notes what acts in it.
pub fn act_fibres(model: &Model, from: &State, to: &mut State, ws: &mut Workspace) {
    for ((kind, begun), next) in model.kinds.iter().zip(&from.kinds).zip(&mut to.kinds) {
        next.fibres.copy_from(&begun.fibres);
        let pods = kind.behaviours.iter().enumerate().find_map(|(number, behaviour)| match behaviour {
            Behaviour::Pseudopods(pods) => Some((number, pods, pods.fibres?)),
            _ => None,
        });
        let Some((number, pods, rule)) = pods else { continue };
        let KindState { behaviours, fibres, .. } = next;
        for (cell, state) in behaviours[number].iter().enumerate() {
            let BehaviourState::Pseudopods(state) = state else { continue };
            let retracts = |did: &&Activity| did.retraction > 0.0;
            for slot in &mut fibres.slots[slots_of(kind, cell)] {
                let Some(made) = slot else { continue };
                let Some(pod) = made.pod else { continue };
                match state.did.iter().filter(retracts).find(|did| did.number == pod) {
                    Some(did) => made.fibre.activation = did.retraction,
                    None => *slot = None,
                }
            }
            for did in state.did.iter().filter(retracts) {
                if fibres.of_cell(kind, cell).all(|made| made.pod != Some(did.number)) {
                    let positions = Positions { kind, now: begun, cell };
                    make(&positions, (pods, rule), did, (model.seed, from.time), fibres);
                }
            }
        }
    }
    ws.fibres.gather(model, &to.kinds);
}

/// Makes the fibres of a pseudopod that begins to retract, eq. (pseudopods.9); fewer than the rule says where front or rear have not as many
/// atoms, or the cell's budget not as many slots left.
fn make(
    positions: &Positions,
    (pods, rule): (&Pseudopods, PodFibres),
    did: &Activity,
    (seed, time): (u64, f64),
    fibres: &mut FibreState,
) {
    let &Positions { kind, now, cell } = positions;
    let (centre, ahead) = (positions.centre(), Vec3::from(did.direction));
    let first = u64::from(did.number) * DRAWS;
    for fibre in 0..rule.number as u64 {
        let draws = Stream::new(seed, Purpose::Fibres, now.ids[cell] as u32, first + fibre).uniform_pair();
        let end = |draw: f64, direction: Vec3| {
            let is_taken = |atom: usize| {
                let own = fibres.of_cell(kind, cell).filter(|made| made.pod == Some(did.number));
                own.flat_map(|made| made.fibre.atoms).any(|taken| taken as usize == atom)
            };
            let share = |atom: usize| positions.share(pods, atom, (&centre, &direction));
            drawn(draw, (0..kind.atoms()).filter(|atom| !is_taken(*atom)).map(|atom| (atom, share(atom))))
        };
        let [Some(front), Some(rear)] = [end(draws[0], ahead), end(draws[1], -ahead)] else { return };
        let fibre = Fibre { atoms: [front, rear], stiffness: rule.stiffness, activation: did.retraction };
        if fibres.add(kind, cell, time, Some(did.number), fibre).is_none() {
            return;
        }
    }
}

/// The atom that a number uniform in [0, 1) means, each as likely as its weight says; none where no weight is above 0.
fn drawn(draw: f64, atoms: impl Iterator<Item = (usize, f64)> + Clone) -> Option<u32> {
    let whole: f64 = atoms.clone().map(|(_, weight)| weight).sum();
    let (mut before, mut last) = (0.0, None);
    for (atom, weight) in atoms.filter(|(_, weight)| *weight > 0.0) {
        before += weight;
        // By round-off the last may be passed.
        last = Some(atom as u32);
        if draw * whole < before {
            break;
        }
    }
    last
}

#[cfg(test)]
#[path = "fibres_tests.rs"]
mod tests;
