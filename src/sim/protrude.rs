//! The stage in which pseudopods push and draw the atoms of their cell.
//!
//! The forces of a cell on itself have neither sum nor torque: what pushes the front out is carried by the skeleton to where the cell grips
//! something, eq. (pseudopods.4), so that without a grip nothing advances.

use rayon::prelude::*;

use super::contact::ContactScratch;
use super::kind::Kind;
use super::model::Model;
use super::state::{KindState, State, vector};
use super::workspace::Workspace;
use crate::Vec3;
use crate::cell::pseudopods::{Activity, Pseudopods};
use crate::cell::{Behaviour, BehaviourState};

/// What all atoms bear of a reaction, over what those bear that grip: so that there is an answer to every torque where few do.
const LEAK: f64 = 0.01;

/// The sliding speed at which friction counts as grip, µm/s.
const SLIDING: f64 = 1.0;

/// Cells that a thread looks at at once, at least.
const CELLS_PER_JOB: usize = 16;

/// The pseudopods of a kind, and the number of that behaviour.
fn pseudopods_of(kind: &Kind) -> Option<(usize, &Pseudopods)> {
    kind.behaviours.iter().enumerate().find_map(|(number, behaviour)| match behaviour {
        Behaviour::Pseudopods(pods) => Some((number, pods)),
        _ => None,
    })
}

/// Finds how much each atom grips what its cell touches where a step begins: the most that its contacts bear across, pN, with what friction
/// bears at 1 µm/s.
pub fn find_grips(model: &Model, from: &State, ws: &mut Workspace) {
    if !model.kinds.iter().any(Kind::has_pseudopods) {
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

/// Finds the forces with which pseudopods push and draw atoms in a step, pN, in the order of cells; none in a model without them.
pub fn push_pseudopods(model: &Model, from: &State, to: &State, ws: &mut Workspace) {
    let Workspace { pushes, grips, .. } = ws;
    if !model.kinds.iter().any(Kind::has_pseudopods) {
        return;
    }
    pushes.clear();
    pushes.resize(from.atoms(model), Vec3::zeros());
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
    of_all.resize(if model.kinds.iter().any(Kind::has_pseudopods) { of_atoms } else { 0 }, 1.0);
    for (kind, now) in model.kinds.iter().zip(kinds) {
        let Some((number, pods)) = pseudopods_of(kind) else { continue };
        let factors = of_all[now.atoms(kind)].chunks_mut(kind.atoms());
        for (cell, (factors, state)) in factors.zip(&now.behaviours[number]).enumerate() {
            let BehaviourState::Pseudopods(state) = state else { continue };
            let let_go = pods.release * state.releases(&controls.told_pseudopods(now.first_cell + cell));
            if let_go > 0.0 {
                Positions { kind, now, cell }.release(let_go, &Vec3::from(state.direction), factors);
            }
        }
    }
    chemistry.controls.adhesion_of_atoms = of_all;
}

/// Where the atoms of a cell are.
#[derive(Clone, Copy)]
struct Positions<'a> {
    kind: &'a Kind,
    now: &'a KindState,
    cell: usize,
}

impl Positions<'_> {
    fn of(&self, atom: usize) -> Vec3 {
        vector(self.kind, &self.now.positions, self.cell, atom)
    }

    fn all(&self) -> impl Iterator<Item = Vec3> {
        (0..self.kind.atoms()).map(|atom| self.of(atom))
    }

    fn centre(&self) -> Vec3 {
        self.all().sum::<Vec3>() / self.kind.atoms() as f64
    }

    /// Adds the forces of one pseudopod.
    fn push(&self, pods: &Pseudopods, did: &Activity, grips: &[f64], forces: &mut [Vec3]) {
        let (centre, direction) = (self.centre(), Vec3::from(did.direction));
        if did.protrusion > 0.0 {
            self.protrude(pods, did.protrusion, (&centre, &direction), grips, forces);
        }
        if did.retraction > 0.0 {
            self.draw(pods, did.retraction * pods.contraction, (&centre, &direction), forces);
        }
    }

    /// How much an atom belongs to a pseudopod, eq. (pseudopods.2).
    fn share(&self, pods: &Pseudopods, atom: usize, (centre, direction): (&Vec3, &Vec3)) -> f64 {
        let out = self.of(atom) - centre;
        let cosine = out.dot(direction) / out.norm().max(f64::MIN_POSITIVE);
        ((cosine - pods.least_cosine) / (1.0 - pods.least_cosine)).max(0.0)
    }

    /// Pushes the front out, eq. (pseudopods.3), and what grips back, eq. (pseudopods.4).
    fn protrude(
        &self,
        pods: &Pseudopods,
        activity: f64,
        (centre, direction): (&Vec3, &Vec3),
        grips: &[f64],
        forces: &mut [Vec3],
    ) {
        let (mut sum, mut torque) = (Vec3::zeros(), Vec3::zeros());
        for facet in &self.kind.rest.facets {
            let [i, j, k] = facet.map(|atom| atom as usize);
            let share = |atom: usize| self.share(pods, atom, (centre, direction));
            let shares = [i, j, k].map(share);
            if shares == [0.0; 3] {
                continue;
            }
            let [a, b, c] = [i, j, k].map(|atom| self.of(atom));
            // A third of the facet's area belongs to each of its atoms.
            let area = (b - a).cross(&(c - a)) / 6.0;
            for (atom, (x, share)) in [i, j, k].into_iter().zip([a, b, c].into_iter().zip(shares)) {
                let force = activity * pods.pressure * share * area;
                forces[atom] += force;
                sum += force;
                torque += (x - centre).cross(&force);
            }
        }
        let held: f64 = grips.iter().sum();
        let mean = if held > 0.0 { LEAK * held / self.kind.atoms() as f64 } else { 1.0 };
        let weight = |atom: usize| grips[atom] + mean * (1.0 - self.share(pods, atom, (centre, direction)));
        answer((0..self.kind.atoms()).map(|atom| (weight(atom), self.of(atom) - centre)), (sum, torque), forces);
    }

    /// Draws front and rear together, eq. (pseudopods.5).
    fn draw(&self, pods: &Pseudopods, tension: f64, (centre, direction): (&Vec3, &Vec3), forces: &mut [Vec3]) {
        let backward = -direction;
        let end = |direction: &Vec3| {
            let share = |atom: usize| self.share(pods, atom, (centre, direction));
            let whole: f64 = (0..self.kind.atoms()).map(share).sum();
            let middle: Vec3 = (0..self.kind.atoms()).map(|atom| share(atom) * self.of(atom)).sum();
            (whole, middle / whole)
        };
        let [(of_front, front), (of_rear, rear)] = [end(direction), end(&backward)];
        let Some(axis) = (rear - front).try_normalize(0.0).filter(|_| of_front > 0.0 && of_rear > 0.0) else { return };
        for (atom, force) in forces.iter_mut().enumerate() {
            let [ahead, behind] = [direction, &backward].map(|to| self.share(pods, atom, (centre, to)));
            *force += tension * (ahead / of_front - behind / of_rear) * axis;
        }
    }

    /// Lowers the factors of adhesion behind the front, eq. (pseudopods.6).
    fn release(&self, let_go: f64, direction: &Vec3, factors: &mut [f64]) {
        let centre = self.centre();
        let ahead = |x: Vec3| (x - centre).dot(direction);
        let farthest = self.all().map(|x| ahead(x).abs()).fold(f64::MIN_POSITIVE, f64::max);
        for (factor, x) in factors.iter_mut().zip(self.all()) {
            *factor = 1.0 - let_go * (0.5 - ahead(x) / farthest).clamp(0.0, 1.0);
        }
    }
}

/// Adds the forces that take a sum and a torque away, each atom's in proportion to its weight: those of a rigid motion times the weights,
/// eq. (pseudopods.4). Of each atom its weight and where it is from the point of the torque, µm.
fn answer(atoms: impl Iterator<Item = (f64, Vec3)> + Clone, (sum, torque): (Vec3, Vec3), forces: &mut [Vec3]) {
    let whole: f64 = atoms.clone().map(|(weight, _)| weight).sum();
    let middle: Vec3 = atoms.clone().map(|(weight, x)| weight * x).sum::<Vec3>() / whole;
    let about = torque - middle.cross(&sum);
    let mut inertia = nalgebra::Matrix3::<f64>::zeros();
    for (weight, x) in atoms.clone() {
        let r = x - middle;
        inertia += weight * (nalgebra::Matrix3::<f64>::identity() * r.norm_squared() - r * r.transpose());
    }
    let turn = inertia.try_inverse().map_or(Vec3::zeros(), |inverse| inverse * about);
    for (force, (weight, x)) in forces.iter_mut().zip(atoms) {
        *force -= weight * (sum / whole + turn.cross(&(x - middle)));
    }
}

#[cfg(test)]
#[path = "protrude_tests.rs"]
mod tests;
