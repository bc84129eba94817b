//! How the reaction of a curved obstacle changes as what it holds slides and tips on it, eq. (planes.4): the stiff part of that goes with the solve.

use super::obstacle::Obstacle;
use super::spots::Spot;
use crate::Vec3;

/// A stiffness of one direction: a force of minus `stiffness` times the displacement along it, on the atoms with these vectors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roll {
    /// Atoms and the vectors of the direction there; twice the same atom, the second with none, where it is one.
    pub parts: [(usize, Vec3); 2],
    /// Stiffness, pN/µm.
    pub stiffness: f64,
}

/// Displacement by which the curvature is measured, over the length of the direction.
const PROBE: f64 = 1e-4;

/// Curvatures below this, 1/µm, count as none.
const FLAT: f64 = 1e-9;

impl Roll {
    /// The displacement along its direction.
    pub fn along(&self, of_atom: impl Fn(usize) -> Vec3) -> f64 {
        self.parts.iter().map(|(atom, vector)| vector.dot(&of_atom(*atom))).sum()
    }
}

/// Adds how a spot rolls that is held by a reaction (pN), atoms being `at` (µm).
pub fn add_rolls(
    obstacle: &Obstacle,
    time: f64,
    spot: &Spot,
    reaction: f64,
    at: impl Fn(usize) -> Vec3,
    rolls: &mut Vec<Roll>,
) {
    let point = spot.mean(&at);
    // The second derivative of the gap along a vector, 1/µm times its length.
    let turned = |vector: &Vec3| {
        let normal = |sign: f64| obstacle.beside(time, &(point + sign * PROBE * vector)).normal;
        (normal(1.0) - normal(-1.0)) / (2.0 * PROBE)
    };
    let [one, other] = spot.atoms;
    // Where the surface is hollow the reaction turns back what slides off.
    let u = spot.normal.cross(&if spot.normal.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() }).normalize();
    let v = spot.normal.cross(&u);
    let (by_u, by_v) = (turned(&u), turned(&v));
    let (a, b, c) = (by_u.dot(&u), 0.5 * (by_u.dot(&v) + by_v.dot(&u)), by_v.dot(&v));
    let (mean, half) = (0.5 * (a + c), (0.5 * (a - c)).hypot(b));
    let first = if half > FLAT { 0.5 * b.atan2(0.5 * (a - c)) } else { 0.0 };
    for (curvature, angle) in [(mean + half, first), (mean - half, first + std::f64::consts::FRAC_PI_2)] {
        if curvature < -FLAT {
            let (sin, cos) = angle.sin_cos();
            let direction = cos * u + sin * v;
            let parts = [(one, spot.shares[0] * direction), (other, spot.shares[1] * direction)];
            rolls.push(Roll { parts, stiffness: -reaction * curvature });
        }
    }
    // Where an edge tips on a rim its deepest point goes along it.
    if one != other {
        let along = at(other) - at(one);
        let bent = turned(&along);
        let slope = bent.dot(&along);
        if slope > FLAT * along.norm_squared() {
            let parts = [(one, spot.shares[0] * bent - spot.normal), (other, spot.shares[1] * bent + spot.normal)];
            rolls.push(Roll { parts, stiffness: reaction / slope });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{self, Profile, Turned};
    use crate::sim::kind::Kind;
    use crate::sim::spots::find_spots;

    /// Within a round lip: a rim along one direction, hollow along the other.
    fn pipette() -> Obstacle {
        let corners = [[2.0, 0.0], [3.0, 0.0], [3.0, 9.0], [2.0, 9.0]];
        let profile = Profile { corners: &corners, rounding: 0.5, around: 0 };
        let body = Turned::new(&profile, Vec3::zeros(), Vec3::z()).expect("good");
        Obstacle { name: "p".into(), surface: geometry::Obstacle::Turned(body.into()), going: None }
    }

    fn one_edge() -> Kind {
        let facet =
            crate::geometry::Surface { positions: vec![Vec3::zeros(), Vec3::x(), Vec3::y()], facets: vec![[0, 1, 2]] };
        Kind::new("facet", facet, Vec::new())
    }

    /// The reaction of an edge, which is the gradient of the gap of its deepest point times its size, changes by minus what rolls and what is
    /// left is not stiff: the part that pushes off what slides from a rim.
    #[test]
    fn the_stiff_part_of_a_reaction_is_that_of_differences() {
        let (pipette, kind) = (pipette(), one_edge());
        // Over the rim from outside to inside, and far from it the third atom.
        let start = [Vec3::new(2.45, 0.1, -0.05), Vec3::new(1.9, -0.15, 0.4), Vec3::new(0.0, 0.0, -9.0)];
        let spot_of = |x: &[Vec3; 3]| -> Spot {
            let mut spots = Vec::new();
            find_spots(&kind, std::slice::from_ref(&pipette), 0.0, |atom| x[atom], &mut spots);
            *spots.iter().find(|spot| spot.atoms == [0, 1]).expect("an edge")
        };
        let force = |x: &[Vec3; 3]| -> [Vec3; 2] { spot_of(x).shares.map(|share| share * spot_of(x).normal) };
        let mut rolls = Vec::new();
        add_rolls(&pipette, 0.0, &spot_of(&start), 1.0, |atom| start[atom], &mut rolls);
        assert_eq!(rolls.len(), 2, "hollow around the axis, and tipping: {rolls:?}");
        let mut stiffness = nalgebra::Matrix6::<f64>::zeros();
        for column in 0..6 {
            let moved = |by: f64| {
                let mut x = start;
                x[column / 3][column % 3] += by;
                force(&x)
            };
            let (on, back) = (moved(1e-5), moved(-1e-5));
            for row in 0..6 {
                stiffness[(row, column)] = -(on[row / 3][row % 3] - back[row / 3][row % 3]) / 2e-5;
            }
        }
        assert!((stiffness - stiffness.transpose()).norm() < 1e-6 * stiffness.norm(), "a gradient");
        for roll in &rolls {
            let vectors = roll.parts.map(|(_, vector)| vector);
            let q = nalgebra::Vector6::from_fn(|row, _| vectors[row / 3][row % 3]);
            stiffness -= roll.stiffness * q * q.transpose();
        }
        let left = stiffness.symmetric_eigen().eigenvalues;
        assert!(left.max() < 1e-5 && left.min() < -0.1, "{left}");
    }
}
