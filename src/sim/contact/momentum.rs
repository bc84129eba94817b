//! What makes the sweeps fast: conjugate directions (Silcowitz-Hansen, Niebe and Erleben 2010). What a sweep changes is
//! taken for a gradient, and a share of the last direction is added to it.

use rayon::prelude::*;

use super::mobility::{Mobility, Motion};
use super::vectors::V4;
use crate::Vec3;

/// After a sweep that changed this much more than the one before, the iteration starts again. Where two contacts are almost
/// the same, as edges that meet where another crosses them, one hands its load to the other in many sweeps that change the
/// same, give or take a percent: starting again at each of these would leave plain sweeps.
const RESTART: f64 = 1.15;

/// Atoms and cells that a thread takes at once, at least.
const ATOMS_PER_JOB: usize = 4096;
const CELLS_PER_JOB: usize = 128;

/// How much of the last direction is taken; those of forces stand in the rows.
#[derive(Debug, Clone, Default)]
pub struct Momentum {
    /// The work of the last sweep, pN·µm.
    work: f64,
}

impl Momentum {
    /// Begins without a direction.
    pub fn begin(&mut self) {
        self.work = 0.0;
    }

    /// The share of the last direction that is taken after a sweep that did this work.
    pub fn share(&mut self, work: f64) -> f64 {
        let share = if self.work > 0.0 { work / self.work } else { 0.0 };
        self.work = work;
        if share > RESTART { 0.0 } else { share.min(1.0) }
    }

    /// Writes NaN over all numbers.
    pub fn poison(&mut self) {
        self.work = f64::NAN;
    }
}

/// Begins at some displacements without a direction.
pub fn begin(moved: &[V4], before: &mut Vec<Vec3>, direction: &mut Vec<Vec3>) {
    before.resize(moved.len(), Vec3::zeros());
    direction.resize(moved.len(), Vec3::zeros());
    let lists = moved.par_iter().zip(before).zip(direction).with_min_len(ATOMS_PER_JOB);
    lists.for_each(|((&[x, y, z, _], before), direction)| (*before, *direction) = (Vec3::new(x, y, z), Vec3::zeros()));
}

/// Goes on from displacements after a sweep along a share of the last direction: `before` are those before the sweep, and
/// become those before the next.
pub fn go_on(share: f64, moved: &mut [V4], before: &mut [Vec3], direction: &mut [Vec3]) {
    let lists = moved.par_iter_mut().zip(before).zip(direction).with_min_len(ATOMS_PER_JOB);
    lists.for_each(|((now, before), direction)| {
        for i in 0..3 {
            let (change, old) = (now[i] - before[i], share * direction[i]);
            now[i] += old;
            direction[i] = old + change;
            before[i] = now[i];
        }
    });
}

/// The same for what the modes of cells have moved.
pub fn go_on_by_modes(share: f64, mobility: &mut Mobility) {
    let Mobility { moved, before, direction, .. } = mobility;
    let lists = moved.par_iter_mut().zip(before).zip(direction).with_min_len(CELLS_PER_JOB);
    lists.for_each(|((now, before), direction)| go_on_one(share, now, before, direction));
}

fn go_on_one(share: f64, now: &mut Motion, before: &mut Motion, direction: &mut Motion) {
    let numbers = now.along.iter_mut().zip(&mut before.along).zip(&mut direction.along);
    let turns = std::iter::once(((&mut now.turn, &mut before.turn), &mut direction.turn));
    for ((now, before), direction) in numbers.chain(turns) {
        for i in 0..4 {
            let (change, old) = (now[i] - before[i], share * direction[i]);
            now[i] += old;
            direction[i] = old + change;
            before[i] = now[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Momentum, go_on};
    use crate::Vec3;

    #[test]
    fn a_sweep_that_changes_a_little_more_keeps_the_direction_and_one_that_changes_much_more_loses_it() {
        let (mut moved, mut before, mut direction) = ([[0.0; 4]], [Vec3::zeros()], [Vec3::zeros()]);
        let mut momentum = Momentum::default();
        momentum.begin();
        let mut after = |work: f64| {
            moved[0][0] += 1.0;
            let share = momentum.share(work);
            go_on(share, &mut moved, &mut before, &mut direction);
            (share, moved[0][0])
        };
        assert_eq!(after(2.0), (0.0, 1.0), "no direction yet");
        assert_eq!(after(1.0), (0.5, 2.5), "half of the last change");
        // The direction is 1 + 0.5 by now.
        assert_eq!(after(1.01), (1.0, 5.0), "all of it, and no more");
        assert_eq!(after(2.0), (0.0, 6.0), "started again");
    }
}
