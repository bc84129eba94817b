//! How far bodies have moved since their pairs were collected.

use super::boxes::Bounds;
use super::scene::Scene;
use crate::Vec3;

/// How a body has moved since the pairs were collected, µm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Motion {
    /// The mean displacement of its atoms.
    pub mean: Vec3,
    /// The farthest that an atom has moved beside that.
    pub beside: f64,
    /// The farthest that an atom has moved.
    pub farthest: f64,
}

impl Motion {
    /// None.
    pub const NONE: Self = Self { mean: Vec3::new(0.0, 0.0, 0.0), beside: 0.0, farthest: 0.0 };

    /// How far atoms of two bodies have moved beside each other at most, µm, eq. (contacts.11).
    #[inline]
    pub fn beside(&self, other: &Self) -> f64 {
        ((self.mean - other.mean).norm() + self.beside + other.beside).min(self.farthest + other.farthest)
    }
}

/// Where the atoms were when the pairs were collected: along each axis in steps of the box that their body had then, of which there
/// are 65535.
#[derive(Debug, Clone, Default)]
pub(super) struct Then {
    steps: Vec<[u16; 3]>,
}

/// The steps of a body.
struct Grid {
    low: Vec3,
    size: Vec3,
}

impl Grid {
    fn of(bounds: &Bounds) -> Self {
        let [low, high] = [bounds.low, bounds.high].map(|corner| Vec3::from(corner.map(f64::from)));
        Self { low, size: (high - low) / f64::from(u16::MAX) }
    }

    fn nearest(&self, position: &Vec3) -> [u16; 3] {
        let from_low = position - self.low;
        [0, 1, 2].map(|axis| (from_low[axis] / self.size[axis]).round() as u16)
    }

    fn position(&self, steps: &[u16; 3]) -> Vec3 {
        self.low + Vec3::from(steps.map(f64::from)).component_mul(&self.size)
    }

    /// The most by which a position is off along each axis.
    fn rounding(&self) -> Vec3 {
        self.size * 0.500_001
    }
}

/// The larger of two numbers, or whatever is not a number.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

impl Then {
    /// Takes down where the atoms are; nothing where one is nowhere.
    pub fn take(&mut self, scene: &Scene, positions: &[Vec3], boxes: &[Bounds]) {
        self.forget();
        if positions.iter().any(|position| position.iter().any(|part| !part.is_finite())) {
            return;
        }
        for (body, bounds) in (0..).zip(boxes) {
            let grid = Grid::of(bounds);
            self.steps.extend(scene.of_body(body, positions).iter().map(|position| grid.nearest(position)));
        }
    }

    /// Takes down anew where the atoms of a body are, which has this box now.
    pub fn take_again(&mut self, scene: &Scene, body: u32, positions: &[Vec3], bounds: &Bounds) {
        let (grid, first) = (Grid::of(bounds), scene.bodies[body as usize].first_atom as usize);
        let own = scene.of_body(body, positions);
        for (steps, position) in self.steps[first..first + own.len()].iter_mut().zip(own) {
            *steps = grid.nearest(position);
        }
    }

    /// Adds where the atoms of a body were that had this box then, to a rounding that its motion includes.
    pub fn positions_of(&self, scene: &Scene, body: u32, bounds: &Bounds, to: &mut Vec<Vec3>) {
        let (grid, first) = (Grid::of(bounds), scene.bodies[body as usize].first_atom as usize);
        to.extend(self.steps[first..first + scene.shape(body).atoms].iter().map(|steps| grid.position(steps)));
    }

    /// Forgets it.
    pub fn forget(&mut self) {
        self.steps.clear();
    }

    /// Whether it tells where so many atoms were.
    pub fn is_of(&self, atoms: usize) -> bool {
        self.steps.len() == atoms
    }

    /// How a body has moved that had this box then, rounding included; not a number where an atom is nowhere.
    pub fn motion(&self, scene: &Scene, body: u32, bounds: &Bounds, positions: &[Vec3]) -> Motion {
        let now = scene.of_body(body, positions);
        let then = &self.steps[scene.bodies[body as usize].first_atom as usize..][..now.len()];
        let grid = Grid::of(bounds);
        let displacement = |now: &Vec3, then: &[u16; 3]| now - grid.position(then);
        let sum: Vec3 = now.iter().zip(then).map(|(now, then)| displacement(now, then)).sum();
        let (mean, rounding) = (sum / now.len().max(1) as f64, grid.rounding());
        let (mut farthest, mut beside) = (0.0, 0.0);
        for (now, then) in now.iter().zip(then) {
            let displacement = displacement(now, then);
            farthest = larger(farthest, (displacement.abs() + rounding).norm_squared());
            beside = larger(beside, ((displacement - mean).abs() + rounding).norm_squared());
        }
        Motion { mean, beside: beside.sqrt(), farthest: farthest.sqrt() }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of::<[u16; 3]>() * self.steps.capacity()
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_scenes::{Dice, packed_stage};
    use super::super::{Reach, Sides};
    use super::*;

    const REACH: Reach = Reach { proximity: 0.2, prediction: 0.2, depth: 0.2, margin: 0.1 };

    #[test]
    fn motion_is_never_less_than_it_is_and_hardly_more() {
        let stage = packed_stage(9, REACH, 2);
        let boxes: Vec<Bounds> = (0..stage.scene.bodies.len() as u32)
            .map(|body| Bounds::around(stage.scene.of_body(body, &stage.positions), 0.0))
            .collect();
        let mut then = Then::default();
        then.take(&stage.scene, &stage.positions, &boxes);
        assert!(then.is_of(stage.positions.len()));
        let mut dice = Dice(3);
        for size in [0.0, 1e-6, 1e-3, 0.1, 10.0] {
            let displacements: Vec<Vec3> = stage.positions.iter().map(|_| dice.vector() * size).collect();
            let now: Vec<Vec3> = stage
                .positions
                .iter()
                .zip(&displacements)
                .map(|(position, displacement)| position + displacement)
                .collect();
            for body in 0..boxes.len() as u32 {
                let (motion, displacements) = (
                    then.motion(&stage.scene, body, &boxes[body as usize], &now),
                    stage.scene.of_body(body, &displacements),
                );
                let farthest = displacements.iter().map(Vec3::norm).fold(0.0, f64::max);
                let mean = displacements.iter().sum::<Vec3>() / displacements.len() as f64;
                let beside = displacements.iter().map(|displacement| (displacement - mean).norm()).fold(0.0, f64::max);
                // A step along each axis of a box of less than 30 µm.
                let rounding = 3.0 * 30.0 / f64::from(u16::MAX);
                assert!((farthest..farthest + rounding).contains(&motion.farthest), "{farthest}: {motion:?}");
                assert!((motion.mean - mean).norm() < rounding);
                let off = motion.beside + (motion.mean - mean).norm() - beside;
                assert!((0.0..2.0 * rounding).contains(&off), "{beside}: {motion:?}");
            }
        }
    }

    #[test]
    fn what_is_flat_or_nowhere_is_told_right() {
        let sheet = crate::geometry::sheet(4.0, 4.0, 4, 4);
        let mut stage =
            super::super::test_scenes::stage(&[(&sheet, Sides::Both, sheet.positions.clone())], Vec::new(), REACH);
        let boxes = [Bounds::around(&stage.positions, 0.0)];
        let mut then = Then::default();
        then.take(&stage.scene, &stage.positions, &boxes);
        assert!(then.motion(&stage.scene, 0, &boxes[0], &stage.positions).farthest < 1e-4);
        stage.positions[3].z = f64::NAN;
        assert!(then.motion(&stage.scene, 0, &boxes[0], &stage.positions).farthest.is_nan());
        then.take(&stage.scene, &stage.positions, &boxes);
        assert!(!then.is_of(stage.positions.len()), "where it was nowhere tells nothing");
    }
}
