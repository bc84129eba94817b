//! What the changes of aggregates promise.

use super::*;
use crate::output::clusters;
use crate::random::{Purpose, Stream};
use ndarray::Array2;

/// The events of frames that give the aggregate of each cell.
fn events<const CELLS: usize>(frames: &[[u32; CELLS]]) -> Vec<Event> {
    let numbers = Array2::from_shape_fn((frames.len(), CELLS), |(frame, cell)| f64::from(frames[frame][cell]));
    changes(numbers.view())
}

#[test]
fn aggregates_are_born_merge_split_and_die() {
    let found =
        events(&[[0, 1, 2, 3, 4, 5], [0, 0, 2, 2, 4, 5], [0, 0, 0, 0, 4, 5], [0, 1, 0, 1, 4, 5], [0, 1, 0, 3, 4, 5]]);
    let event = |frame, change, before: &[u64], after: &[u64], cells| Event {
        frame,
        change,
        before: before.to_vec(),
        after: after.to_vec(),
        cells,
    };
    let wanted = [
        event(1, Change::Birth, &[], &[0], 2),
        event(1, Change::Birth, &[], &[2], 2),
        event(2, Change::Merge, &[0, 2], &[0], 4),
        event(3, Change::Split, &[0], &[0, 1], 4),
        event(4, Change::Death, &[1], &[], 2),
    ];
    assert_eq!(found, wanted);
}

#[test]
fn cells_that_join_or_leave_change_nothing_nor_does_a_new_smallest_number() {
    assert_eq!(events(&[[0, 1, 1, 3], [0, 0, 0, 3], [0, 1, 1, 1]]), []);
    assert_eq!(events::<3>(&[[0, 0, 2]]), []);
    assert_eq!(events::<0>(&[[], []]), []);
}

#[test]
fn cells_that_change_partners_split_and_merge_at_once() {
    let found = events(&[[0, 0, 2, 2, 2, 2], [0, 1, 0, 1, 1, 0]]);
    let changes: Vec<Change> = found.iter().map(|event| event.change).collect();
    assert_eq!(changes, [Change::Split, Change::Split, Change::Merge, Change::Merge]);
}

#[test]
fn the_events_account_for_the_number_of_aggregates() {
    let mut dice = Stream::new(3, Purpose::Permutation, 0, 0);
    let mut next = || dice.uniform_pair()[0];
    for _ in 0..500 {
        let mut frame = || {
            let pairs = (next() * 12.0) as usize;
            let pairs: Vec<[u32; 2]> = (0..pairs).map(|_| [0; 2].map(|_| (next() * 20.0) as u32)).collect();
            // Some cells are not there in one of the frames.
            let there = |first: u32| (next() < 0.9).then_some(u64::from(first));
            clusters(20, pairs).into_iter().map(there).collect::<Vec<_>>()
        };
        let (before, after) = (frame(), frame());
        let number = |frame: &[Option<u64>]| sizes(frame).iter().filter(|known| known.1 > 1).count() as i64;
        let change: i64 = changes_between(1, &before, &after)
            .iter()
            .map(|event| match event.change {
                Change::Birth => 1,
                Change::Death => -1,
                Change::Split => event.after.len() as i64 - 1,
                Change::Merge => 1 - event.before.len() as i64,
            })
            .sum();
        assert_eq!(number(&after) - number(&before), change, "{before:?} {after:?}");
    }
}

#[test]
fn cells_that_come_or_go_change_only_what_they_make_or_end() {
    let none = f64::NAN;
    let frames = ndarray::arr2(&[
        [0.0, none, 2.0, 2.0, none],
        // A daughter beside its mother makes an aggregate of two; the one of 2 gets a third.
        [0.0, 0.0, 2.0, 2.0, 2.0],
        // The first of three is gone: the others go on under another number.
        [0.0, 0.0, none, 3.0, 3.0],
        // All of an aggregate are gone.
        [0.0, 0.0, none, none, none],
    ]);
    let event = |frame, change, before: &[u64], after: &[u64]| Event {
        frame,
        change,
        before: before.to_vec(),
        after: after.to_vec(),
        cells: 2,
    };
    assert_eq!(changes(frames.view()), [event(1, Change::Birth, &[], &[0]), event(3, Change::Death, &[3], &[])]);
}

#[test]
fn changes_are_counted_in_the_frame_in_which_they_are_seen() {
    let frames = ndarray::arr2(&[
        [0.0, 1.0, 2.0, 3.0],
        [0.0, 0.0, 2.0, 2.0],
        [0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 2.0, 2.0],
        [0.0, 1.0, 2.0, 2.0],
    ]);
    let [births, merges, splits, deaths] = counts_of_changes(frames.view());
    assert_eq!(births, [0.0, 2.0, 0.0, 0.0, 0.0]);
    assert_eq!(merges, [0.0, 0.0, 1.0, 0.0, 0.0]);
    assert_eq!(splits, [0.0, 0.0, 0.0, 1.0, 0.0]);
    assert_eq!(deaths, [0.0, 0.0, 0.0, 0.0, 1.0]);
}
