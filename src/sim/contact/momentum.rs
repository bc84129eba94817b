//! What makes the sweeps fast: conjugate directions (Silcowitz-Hansen, Niebe and Erleben 2010). What a sweep changes is
//! taken for a gradient, and a share of the last direction is added to it.

use super::sweep::V4;

/// The directions of displacements; those of forces stand in the rows.
#[derive(Debug, Clone, Default)]
pub struct Momentum {
    /// Displacements before the sweep.
    before: Vec<V4>,
    /// The last direction.
    way: Vec<V4>,
    /// The work of the last sweep, pN·µm.
    work: f64,
}

impl Momentum {
    /// Begins at these displacements without a direction.
    pub fn begin(&mut self, moved: &[V4]) {
        self.before.clear();
        self.before.extend_from_slice(moved);
        self.way.clear();
        self.way.resize(moved.len(), [0.0; 4]);
        self.work = 0.0;
    }

    /// The displacement of an atom before the sweep.
    pub fn displacement(&self, atom: u32) -> &V4 {
        &self.before[atom as usize]
    }

    /// Goes on along the last direction after a sweep that did this work; returns the share of it that is taken.
    pub fn go_on(&mut self, work: f64, moved: &mut [V4]) -> f64 {
        let share = if self.work > 0.0 { work / self.work } else { 0.0 };
        // After a sweep that changed more than the one before, start again.
        let share = if share > 1.0 { 0.0 } else { share };
        self.work = work;
        for ((now, before), way) in moved.iter_mut().zip(&mut self.before).zip(&mut self.way) {
            for i in 0..4 {
                let (change, old) = (now[i] - before[i], share * way[i]);
                now[i] += old;
                way[i] = old + change;
                before[i] = now[i];
            }
        }
        share
    }

    /// Writes NaN over all numbers.
    pub fn poison(&mut self) {
        self.before.fill([f64::NAN; 4]);
        self.way.fill([f64::NAN; 4]);
        self.work = f64::NAN;
    }
}
