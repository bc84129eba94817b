//! What makes the sweeps fast: conjugate directions (Silcowitz-Hansen, Niebe and Erleben 2010). What a sweep changes is
//! taken for a gradient, and a share of the last direction is added to it.

use super::sweep::V4;

/// After a sweep that changed this much more than the one before, the iteration starts again. Where two contacts are almost
/// the same, as edges that meet where another crosses them, one hands its load to the other in many sweeps that change the
/// same, give or take a percent: starting again at each of these would leave plain sweeps.
const RESTART: f64 = 1.15;

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
        let share = if share > RESTART { 0.0 } else { share.min(1.0) };
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

#[cfg(test)]
mod tests {
    use super::Momentum;

    #[test]
    fn a_sweep_that_changes_a_little_more_keeps_the_direction_and_one_that_changes_much_more_loses_it() {
        let mut moved = [[0.0; 4]];
        let mut momentum = Momentum::default();
        momentum.begin(&moved);
        let mut after = |work: f64| {
            moved[0][0] += 1.0;
            (momentum.go_on(work, &mut moved), moved[0][0])
        };
        assert_eq!(after(2.0), (0.0, 1.0), "no direction yet");
        assert_eq!(after(1.0), (0.5, 2.5), "half of the last change");
        // The direction is 1 + 0.5 by now.
        assert_eq!(after(1.01), (1.0, 5.0), "all of it, and no more");
        assert_eq!(after(2.0), (0.0, 6.0), "started again");
    }
}
