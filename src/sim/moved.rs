//! Atoms that are moved on courses, within a step: they are where their course has them, and the others feel them there, eq. (moved.2).

use super::kind::Kind;
use super::solver::Stage;

/// A step as moved atoms have it.
#[derive(Clone, Copy)]
pub struct Displacements<'a> {
    kind: &'a Kind,
    /// When it begins and ends, s.
    times: [f64; 2],
    /// γ of the scheme.
    gamma: f64,
}

impl<'a> Displacements<'a> {
    /// Those of a step; none where no atom is moved on a course.
    pub fn of(kind: &'a Kind, times: [f64; 2], gamma: f64) -> Option<Self> {
        (!kind.moved.is_empty()).then_some(Self { kind, times, gamma })
    }

    /// Puts moved atoms of a block where they end the step; they stand where it begins.
    pub fn put_to_end(&self, x: &mut [f64]) {
        self.go(1.0, x);
    }

    /// Puts moved atoms of a block, which stand where they end the step, back to where it begins.
    pub fn put_to_start(&self, x: &mut [f64]) {
        self.go(-1.0, x);
    }

    /// Puts moved atoms of a block, which stand where the others do, to where these feel them in a stage: the forces of the first stage are those
    /// of a share γ of their displacement, those of the second of what is left of it.
    pub fn put_to_stage(&self, stage: Stage, x: &mut [f64]) {
        self.go(if stage == Stage::First { self.gamma } else { -self.gamma }, x);
    }

    /// Writes the increments of moved atoms over those of a stage: the whole displacement, and back by it in the second, so that 3/2 and 1/2 of them are it.
    pub fn set_increments(&self, stage: Stage, y: &mut [f64]) {
        let share = if stage == Stage::First { 1.0 } else { -1.0 };
        self.each(|at, displacement| y[at] = share * displacement);
    }

    fn go(&self, share: f64, x: &mut [f64]) {
        self.each(|at, displacement| x[at] += share * displacement);
    }

    /// Tells each number of a block that is one of a moved atom, and its displacement.
    fn each(&self, mut work: impl FnMut(usize, f64)) {
        let lanes = self.kind.lanes;
        for moved in &self.kind.moved {
            let displacement = moved.displaced(self.times);
            for atom in &moved.atoms {
                for axis in 0..3 {
                    let number = 3 * *atom as usize + axis;
                    if self.kind.held[number] == 0.0 {
                        (number * lanes..(number + 1) * lanes).for_each(|at| work(at, displacement[axis]));
                    }
                }
            }
        }
    }
}
