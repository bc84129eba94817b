//! Rigid motion of an adhesive: of all that leave its shape as it is, the one nearest to where drag would let its atoms go.

use std::ops::Range;

use nalgebra::{Matrix3, Rotation3, SymmetricEigen};

use crate::Vec3;
use crate::sim::contact::state::AdhesiveAtom;
use crate::sim::contact::vectors::V4;

/// Drag of an atom that is held over the largest of the others: it stays where it is.
const HELD: f64 = 1e9;

/// Resistance to turning below this part of the largest is none: atoms in a line.
const LINE: f64 = 1e-9;

/// Rounds that turn the best small rotation into the best one; each leaves the cube of what was left.
const TURNS: usize = 3;

/// The atoms of an adhesive as a body that resists as their drag does.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rigid {
    first: usize,
    end: usize,
    /// Centre of drag where the step began, µm.
    pub(super) centre: Vec3,
    /// Drag of all, pN·s/µm.
    drag: f64,
    /// Inverse of the resistance to turning; nothing along what turns nothing.
    inverse: Matrix3<f64>,
    /// Whether an obstacle holds it.
    grounded: bool,
}

/// A rigid motion from where the step began, eq. (adhesion.13).
struct Motion {
    shift: Vec3,
    turn: Rotation3<f64>,
}

impl Rigid {
    /// The body of these atoms among all that have clones; infinite drags become large ones.
    pub(super) fn of(
        range: Range<usize>,
        drags: &mut [f64],
        positions: impl Iterator<Item = Vec3> + Clone,
        grounded: bool,
    ) -> Self {
        let finite = drags.iter().copied().filter(|drag| drag.is_finite()).fold(0.0, f64::max);
        let held = if finite > 0.0 { HELD * finite } else { 1.0 };
        drags.iter_mut().filter(|drag| drag.is_infinite()).for_each(|drag| *drag = held);
        let drag: f64 = drags.iter().sum();
        let centre = positions.clone().zip(&*drags).map(|(x, drag)| x * *drag).sum::<Vec3>() / drag;
        let of_atom = |(x, drag): (Vec3, &f64)| {
            let r = x - centre;
            *drag * (Matrix3::identity() * r.norm_squared() - r * r.transpose())
        };
        let resistance: Matrix3<f64> = positions.zip(&*drags).map(of_atom).sum();
        let axes = SymmetricEigen::new(resistance);
        let largest = axes.eigenvalues.max();
        let over = axes.eigenvalues.map(|one| if one > LINE * largest { 1.0 / one } else { 0.0 });
        let inverse = axes.eigenvectors * Matrix3::from_diagonal(&over) * axes.eigenvectors.transpose();
        Self { first: range.start, end: range.end, centre, drag, inverse, grounded }
    }

    /// Where its atoms stand among all that have clones.
    pub(super) fn range(&self) -> Range<usize> {
        self.first..self.end
    }

    /// The mean displacement and the small rotation nearest to displacements of its atoms, each given with its arm from the centre, in the
    /// norm of the drag, eq. (adhesion.14); `turned` is how the body stands now.
    pub(super) fn fit(
        &self,
        turned: &Rotation3<f64>,
        drags: &[f64],
        moved: impl Iterator<Item = (Vec3, Vec3)>,
    ) -> (Vec3, Vec3) {
        if self.grounded {
            return (Vec3::zeros(), Vec3::zeros());
        }
        let (mut sum, mut torque) = (Vec3::zeros(), Vec3::zeros());
        for ((arm, moved), drag) in moved.zip(drags) {
            sum += *drag * moved;
            torque += *drag * arm.cross(&moved);
        }
        // Arms add up to nothing, so that the mean turns nothing.
        (sum / self.drag, turned * (self.inverse * (turned.inverse() * torque)))
    }

    /// Takes the sum and the torque out of the forces of its atoms.
    pub(super) fn balance(&self, atoms: &mut [AdhesiveAtom], drags: &[f64], positions: &[Vec3]) {
        let arm = |one: &AdhesiveAtom| positions[one.atom as usize] - self.centre;
        let moved = atoms.iter().zip(drags).map(|(one, drag)| (arm(one), Vec3::from(one.force) / *drag));
        let (shift, turn) = self.fit(&Rotation3::identity(), drags, moved);
        for (one, drag) in atoms.iter_mut().zip(drags) {
            let rigid = *drag * (shift + turn.cross(&arm(one)));
            one.force = (Vec3::from(one.force) - rigid).into();
        }
    }

    /// The rigid motion, with a rotation of any size, nearest to displacements of its atoms.
    fn motion(&self, atoms: &[AdhesiveAtom], drags: &[f64], positions: &[Vec3], moved: &[V4]) -> Motion {
        let mut motion = Motion { shift: Vec3::zeros(), turn: Rotation3::identity() };
        for _ in 0..TURNS {
            let left = atoms.iter().map(|one| {
                let arm = positions[one.atom as usize] - self.centre;
                (motion.turn * arm, vector(&moved[one.atom as usize]) - motion.of(&arm))
            });
            let (shift, turn) = self.fit(&motion.turn, drags, left);
            motion = Motion { shift: motion.shift + shift, turn: Rotation3::new(turn) * motion.turn };
        }
        motion
    }

    /// Whether an obstacle holds it.
    pub(super) fn is_grounded(&self) -> bool {
        self.grounded
    }

    /// Moves its atoms as one, with a rotation of any size; returns the farthest that this took one, µm. Adds the forces that do so to
    /// `forces`, pN.
    pub(super) fn align(
        &self,
        (atoms, drags): (&[AdhesiveAtom], &[f64]),
        positions: &[Vec3],
        moved: &mut [V4],
        forces: &mut [Vec3],
    ) -> f64 {
        let motion = self.motion(atoms, drags, positions, moved);
        let mut farthest: f64 = 0.0;
        for (one, force) in atoms.iter().zip(forces) {
            let moved = &mut moved[one.atom as usize];
            if moved[3] > 0.0 {
                let to = motion.of(&(positions[one.atom as usize] - self.centre));
                let further = to - vector(moved);
                farthest = farthest.max(further.norm());
                *force += further / moved[3];
                (moved[0], moved[1], moved[2]) = (to.x, to.y, to.z);
            }
        }
        farthest
    }
}

impl Motion {
    /// The displacement of what has this arm from the centre.
    fn of(&self, arm: &Vec3) -> Vec3 {
        self.shift + (self.turn * arm - arm)
    }
}

pub(super) fn vector(numbers: &V4) -> Vec3 {
    Vec3::new(numbers[0], numbers[1], numbers[2])
}
