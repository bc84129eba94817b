//! The forces of a cell on itself: what pushes its surface out, what draws it together, and what its skeleton carries to where it grips.
//!
//! They have neither sum nor torque: what pushes the front out is borne by where the cell grips something, eq. (pseudopods.4), so that
//! without a grip nothing advances.

use super::kind::Kind;
use super::state::{KindState, vector};
use crate::Vec3;
use crate::cell::pseudopods::{Activity, Pseudopods};

/// What all atoms bear of a reaction, over what those bear that grip: so that there is an answer to every torque where few do.
const LEAK: f64 = 0.01;

/// Where the atoms of a cell are.
#[derive(Clone, Copy)]
pub(super) struct Positions<'a> {
    pub kind: &'a Kind,
    pub now: &'a KindState,
    pub cell: usize,
}

impl Positions<'_> {
    /// Where an atom is, µm.
    pub fn of(&self, atom: usize) -> Vec3 {
        vector(self.kind, &self.now.positions, self.cell, atom)
    }

    fn all(&self) -> impl Iterator<Item = Vec3> {
        (0..self.kind.atoms()).map(|atom| self.of(atom))
    }

    /// The mean of the atoms, µm.
    pub fn centre(&self) -> Vec3 {
        self.all().sum::<Vec3>() / self.kind.atoms() as f64
    }

    /// Adds the forces of one pseudopod.
    pub fn push(&self, pods: &Pseudopods, did: &Activity, grips: &[f64], forces: &mut [Vec3]) {
        let (centre, direction) = (self.centre(), Vec3::from(did.direction));
        if did.protrusion > 0.0 {
            self.protrude(pods, did.protrusion, (&centre, &direction), grips, forces);
        }
        if did.retraction > 0.0 {
            self.draw(pods, did.retraction * pods.contraction, (&centre, &direction), forces);
        }
    }

    /// How much an atom belongs to a pseudopod, eq. (pseudopods.2).
    pub fn share(&self, pods: &Pseudopods, atom: usize, (centre, direction): (&Vec3, &Vec3)) -> f64 {
        let out = self.of(atom) - centre;
        let cosine = out.dot(direction) / out.norm().max(f64::MIN_POSITIVE);
        ((cosine - pods.least_cosine) / (1.0 - pods.least_cosine)).max(0.0)
    }

    /// Pushes the front out, eq. (pseudopods.3), and what grips back.
    fn protrude(
        &self,
        pods: &Pseudopods,
        activity: f64,
        (centre, direction): (&Vec3, &Vec3),
        grips: &[f64],
        forces: &mut [Vec3],
    ) {
        let share = |atom: usize| self.share(pods, atom, (centre, direction));
        let left = self.left_of_reach(pods, (centre, direction));
        if left > 0.0 {
            self.push_out(activity * pods.pressure * left, share, centre, grips, forces);
        }
    }

    /// What of the pressure is left where the front is, eq. (pseudopods.8).
    fn left_of_reach(&self, pods: &Pseudopods, (centre, direction): (&Vec3, &Vec3)) -> f64 {
        if pods.reach == f64::INFINITY {
            return 1.0;
        }
        let (mut whole, mut ahead) = (0.0, 0.0);
        for (atom, x) in self.all().enumerate() {
            let share = self.share(pods, atom, (centre, direction));
            whole += share;
            ahead += share * (x - centre).dot(direction);
        }
        if whole == 0.0 {
            return 1.0;
        }
        let radius = (self.kind.rest_volume() * 3.0 / (4.0 * std::f64::consts::PI)).cbrt();
        (1.0 - (ahead / whole - radius) / pods.reach).clamp(0.0, 1.0)
    }

    /// Pushes atoms out with pressures of their own, pN/µm², and what grips back, eq. (pseudopods.4).
    pub fn press(&self, pressures: &[f64], grips: &[f64], forces: &mut [Vec3]) {
        let most = pressures.iter().copied().fold(0.0, f64::max);
        if most > 0.0 {
            self.push_out(most, |atom| pressures[atom] / most, &self.centre(), grips, forces);
        }
    }

    /// Pushes atoms out with their share of a pressure, pN/µm², and what grips back, eq. (pseudopods.4).
    fn push_out(&self, pressure: f64, share: impl Fn(usize) -> f64, centre: &Vec3, grips: &[f64], forces: &mut [Vec3]) {
        let (mut sum, mut torque) = (Vec3::zeros(), Vec3::zeros());
        for facet in &self.kind.rest.facets {
            let [i, j, k] = facet.map(|atom| atom as usize);
            let shares = [i, j, k].map(&share);
            if shares == [0.0; 3] {
                continue;
            }
            let [a, b, c] = [i, j, k].map(|atom| self.of(atom));
            // A third of the facet's area belongs to each of its atoms.
            let area = (b - a).cross(&(c - a)) / 6.0;
            for (atom, (x, share)) in [i, j, k].into_iter().zip([a, b, c].into_iter().zip(shares)) {
                let force = pressure * share * area;
                forces[atom] += force;
                sum += force;
                torque += (x - centre).cross(&force);
            }
        }
        let held: f64 = grips.iter().sum();
        // What is more than the grips bear slips: it is for those that are not pushed, as where nothing grips.
        let behind: f64 = (0..self.kind.atoms()).map(|atom| 1.0 - share(atom)).sum();
        let slips = if behind > 0.0 { (sum.norm() - held).max(0.0) / behind } else { 0.0 };
        let mean = if held > 0.0 { slips.max(LEAK * held / self.kind.atoms() as f64) } else { 1.0 };
        // Where all are pushed alike and nothing grips, all bear alike.
        let none = held == 0.0 && (0..self.kind.atoms()).all(|atom| share(atom) == 1.0);
        let weight = |atom: usize| if none { 1.0 } else { grips[atom] + mean * (1.0 - share(atom)) };
        answer((0..self.kind.atoms()).map(|atom| (weight(atom), self.of(atom) - centre)), (sum, torque), forces);
    }

    /// Draws facets together with the mean of the tensions of their atoms, pN/µm, eq. (pseudopods.7).
    pub fn tighten(&self, tensions: &[f64], forces: &mut [Vec3]) {
        for facet in &self.kind.rest.facets {
            let corners = facet.map(|atom| atom as usize);
            let tension: f64 = corners.iter().map(|&atom| tensions[atom]).sum::<f64>() / 3.0;
            let [a, b, c] = corners.map(|atom| self.of(atom));
            let Some(normal) = (b - a).cross(&(c - a)).try_normalize(0.0) else { continue };
            let pull = 0.5 * tension * normal;
            let (on_b, on_c) = (pull.cross(&(c - a)), (b - a).cross(&pull));
            forces[corners[0]] -= on_b + on_c;
            forces[corners[1]] += on_b;
            forces[corners[2]] += on_c;
        }
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
    pub fn release(&self, let_go: f64, direction: &Vec3, factors: &mut [f64]) {
        let centre = self.centre();
        let ahead = |x: Vec3| (x - centre).dot(direction);
        let farthest = self.all().map(|x| ahead(x).abs()).fold(f64::MIN_POSITIVE, f64::max);
        for (factor, x) in factors.iter_mut().zip(self.all()) {
            *factor *= 1.0 - let_go * (0.5 - ahead(x) / farthest).clamp(0.0, 1.0);
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
#[path = "skeleton_tests.rs"]
mod tests;
