//! What becomes of aggregates from frame to frame: they are born, merge, split and die.

use ndarray::ArrayView2;
use std::fmt;

/// What happened to aggregates of two cells or more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Change {
    /// Cells that were alone made one.
    Birth,
    /// Cells of two or more came together in one.
    Merge,
    /// Cells of one are now in two or more.
    Split,
    /// All cells of one are alone, or gone.
    Death,
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Birth => "birth",
            Self::Merge => "merge",
            Self::Split => "split",
            Self::Death => "death",
        })
    }
}

/// A change between a recorded instant and the one before.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Event {
    /// The frame in which it is seen first.
    pub frame: usize,
    /// What happened.
    pub change: Change,
    /// Ids of the aggregates that it happened to, as they were in the frame before; none for a birth.
    pub before: Vec<u64>,
    /// Ids of the aggregates that came of it; none for a death.
    pub after: Vec<u64>,
    /// Cells of the one aggregate that was born, merged, split or died.
    pub cells: usize,
}

/// Finds the changes in a recording of the aggregate of each cell, [frame, cell], NaN where a cell is not there. An
/// aggregate goes on in all that have cells of it; single cells that join or leave it, are born into it or vanish from it
/// are no change. So the number of aggregates of two cells or more changes by births − deaths + Σ (parts − 1) of splits
/// − Σ (parts − 1) of merges.
pub fn changes(aggregates: ArrayView2<f64>) -> Vec<Event> {
    let numbers = |frame: usize| -> Vec<Option<u64>> {
        aggregates.row(frame).iter().map(|number| (!number.is_nan()).then_some(*number as u64)).collect()
    };
    let frames = aggregates.nrows();
    (1..frames).flat_map(|frame| changes_between(frame, &numbers(frame - 1), &numbers(frame))).collect()
}

/// The changes from one frame to the next: deaths and splits, then merges and births.
fn changes_between(frame: usize, before: &[Option<u64>], after: &[Option<u64>]) -> Vec<Event> {
    let (sizes_before, sizes_after) = (sizes(before), sizes(after));
    let size = |sizes: &[(u64, usize)], number: u64| {
        sizes.binary_search_by_key(&number, |known| known.0).map_or(0, |index| sizes[index].1)
    };
    let both = before.iter().zip(after).filter_map(|(before, after)| Some([(*before)?, (*after)?]));
    let mut went: Vec<[u64; 2]> = both.collect();
    went.retain(|[before, after]| size(&sizes_before, *before) > 1 && size(&sizes_after, *after) > 1);
    went.sort_unstable();
    went.dedup();
    // Of every aggregate of one side, those of the other that it shares cells with: one is no change.
    let mut events = Vec::new();
    for (side, known, alone, several) in
        [(0, &sizes_before, Change::Death, Change::Split), (1, &sizes_after, Change::Birth, Change::Merge)]
    {
        for &(number, cells) in known.iter().filter(|known| known.1 > 1) {
            let others: Vec<u64> = went.iter().filter(|went| went[side] == number).map(|went| went[1 - side]).collect();
            let change = match others.len() {
                0 => alone,
                1 => continue,
                _ => several,
            };
            let (before, after) = if side == 0 { (vec![number], others) } else { (others, vec![number]) };
            events.push(Event { frame, change, before, after, cells });
        }
    }
    events
}

/// The numbers of aggregates, ascending, with their cells.
fn sizes(aggregates: &[Option<u64>]) -> Vec<(u64, usize)> {
    let mut numbers: Vec<u64> = aggregates.iter().copied().flatten().collect();
    numbers.sort_unstable();
    numbers.chunk_by(|one, other| one == other).map(|alike| (alike[0], alike.len())).collect()
}

/// How many aggregates are born, merge, split and die from the frame before to each; none in the first.
pub(super) fn counts_of_changes(aggregates: ArrayView2<f64>) -> [Vec<f64>; 4] {
    let events = changes(aggregates);
    [Change::Birth, Change::Merge, Change::Split, Change::Death].map(|change| {
        let mut counts = vec![0.0; aggregates.nrows()];
        events.iter().filter(|event| event.change == change).for_each(|event| counts[event.frame] += 1.0);
        counts
    })
}

#[cfg(test)]
#[path = "changes_tests.rs"]
mod tests;
