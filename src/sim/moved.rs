//! Atoms that are moved on courses, within a step: they are where their course has them, and the others feel them there, eq. (moved.2).

use std::cell::Cell;

use super::kind::Kind;
use super::solver::Stage;
use crate::Vec3;

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
        self.go(1.0, self.times, x);
    }

    /// Puts moved atoms of a block, which stand where they end the step, back to where it begins.
    pub fn put_to_start(&self, x: &mut [f64]) {
        let [start, end] = self.times;
        self.go(1.0, [end, start], x);
    }

    /// Puts moved atoms of a block, which stand where the others do, to where these feel them in a stage: the forces of the first stage are those
    /// of a share γ of their displacement, those of the second of what is left of it.
    pub fn put_to_stage(&self, stage: Stage, x: &mut [f64]) {
        let [start, end] = self.times;
        self.go(self.gamma, if stage == Stage::First { [start, end] } else { [end, start] }, x);
    }

    /// Writes the increments of moved atoms over those of a stage: the whole displacement from where the step starts, and back by it in the
    /// second, so that 3/2 and 1/2 of them are it.
    pub fn set_increments(&self, stage: Stage, start: &[f64], y: &mut [f64]) {
        let share = if stage == Stage::First { 1.0 } else { -1.0 };
        self.each(self.times, |at| start[at], |at, displacement| y[at] = share * displacement);
    }

    /// Puts moved atoms of a block to where they are at the later time, given where they are at the earlier.
    pub fn put_from(&self, start: &[f64], x: &mut [f64]) {
        self.each(self.times, |at| start[at], |at, displacement| x[at] = start[at] + displacement);
    }

    fn go(&self, share: f64, times: [f64; 2], x: &mut [f64]) {
        let seen = Cell::from_mut(x).as_slice_of_cells();
        self.each(times, |at| seen[at].get(), |at, displacement| seen[at].set(seen[at].get() + share * displacement));
    }

    /// Tells each number of a block that is one of a moved atom, and its displacement from one time to another, given where it is.
    fn each(&self, times: [f64; 2], from: impl Fn(usize) -> f64, mut work: impl FnMut(usize, f64)) {
        let lanes = self.kind.lanes;
        for moved in &self.kind.moved {
            let displaced = moved.displaced(times);
            for (atom, lane) in moved.atoms.iter().flat_map(|atom| (0..lanes).map(move |lane| (*atom as usize, lane))) {
                let number = |axis: usize| (3 * atom + axis) * lanes + lane;
                let displacement = displaced(Vec3::from_fn(|axis, _| from(number(axis))));
                for axis in (0..3).filter(|axis| self.kind.held[3 * atom + axis] == 0.0) {
                    work(number(axis), displacement[axis]);
                }
            }
        }
    }
}
