//! What makes the sweeps fast: conjugate directions (Silcowitz-Hansen, Niebe and Erleben 2010). What a sweep changes is
//! taken for a gradient, and a share of the last direction is added to it.

use rayon::prelude::*;

use super::mobility::{Mobility, Motion};
use super::rounds::Crew;
use super::together::Together;
use super::vectors::V4;
use crate::Vec3;

/// After a sweep that changed this much more than the one before, the iteration starts again. Where two contacts are almost
/// the same, as edges that meet where another crosses them, one hands its load to the other in many sweeps that change the
/// same, give or take a percent: starting again at each of these would leave plain sweeps.
const RESTART: f64 = 1.15;

/// Atoms that a thread takes at once, at least, where it has to be woken.
const ATOMS_PER_JOB: usize = 4096;

/// Atoms and cells that one of a crew takes at once.
const ATOMS_OF_CREW: usize = 1024;
const CELLS_OF_CREW: usize = 32;

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
pub fn go_on(share: f64, moved: &mut [V4], before: &mut [Vec3], direction: &mut [Vec3], crew: Crew) {
    in_parts(ATOMS_OF_CREW, (moved, before, direction), crew, |now, before, direction| {
        for i in 0..3 {
            let (change, old) = (now[i] - before[i], share * direction[i]);
            now[i] += old;
            direction[i] = old + change;
            before[i] = now[i];
        }
    });
}

/// The same for what the modes of cells have moved.
pub fn go_on_by_modes(share: f64, mobility: &mut Mobility, crew: Crew) {
    let Mobility { moved, before, direction, .. } = mobility;
    in_parts(CELLS_OF_CREW, (moved, before, direction), crew, |now, before, direction| {
        go_on_one(share, now, before, direction);
    });
}

/// Does something with what stands at the same place in three lists, in parts of so many.
fn in_parts<A: Send, B: Send>(
    size: usize,
    (now, before, direction): (&mut [A], &mut [B], &mut [B]),
    crew: Crew,
    work: impl Fn(&mut A, &mut B, &mut B) + Sync,
) {
    let len = now.len().min(before.len()).min(direction.len());
    let (now, before, direction) = (Together::new(now), Together::new(before), Together::new(direction));
    crew.each(len.div_ceil(size), |part| {
        let part = part * size..len.min((part + 1) * size);
        // SAFETY: each part is that of one job.
        let (now, before, direction) =
            unsafe { (now.part(part.clone()), before.part(part.clone()), direction.part(part)) };
        now.iter_mut().zip(before).zip(direction).for_each(|((now, before), direction)| work(now, before, direction));
    });
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
    use super::{Crew, Momentum, go_on};
    use crate::Vec3;

    #[test]
    fn a_sweep_that_changes_a_little_more_keeps_the_direction_and_one_that_changes_much_more_loses_it() {
        let (mut moved, mut before, mut direction) = ([[0.0; 4]], [Vec3::zeros()], [Vec3::zeros()]);
        let mut momentum = Momentum::default();
        momentum.begin();
        let mut after = |work: f64| {
            moved[0][0] += 1.0;
            let share = momentum.share(work);
            go_on(share, &mut moved, &mut before, &mut direction, Crew::ALONE);
            (share, moved[0][0])
        };
        assert_eq!(after(2.0), (0.0, 1.0), "no direction yet");
        assert_eq!(after(1.0), (0.5, 2.5), "half of the last change");
        // The direction is 1 + 0.5 by now.
        assert_eq!(after(1.01), (1.0, 5.0), "all of it, and no more");
        assert_eq!(after(2.0), (0.0, 6.0), "started again");
    }
}
