//! What a system knows of its events: part of the state, in lists that are copied without allocating.

use std::ops::Range;

use serde::{Deserialize, Serialize};

/// An event that has fired and waits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Waiting {
    /// Number of the event.
    pub event: usize,
    /// When it is due.
    pub time: f64,
    /// How many new values wait with it, when they are those of the firing.
    pub kept: Option<usize>,
}

/// What a system knows of its events at a time: which triggers hold, and what has fired and waits.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "Saved", into = "Saved")]
pub struct EventMemory {
    pub(super) holds: Vec<bool>,
    waiting: Vec<Waiting>,
    /// The new values that wait, in the order of those that they wait with.
    values: Vec<f64>,
}

impl EventMemory {
    /// Nothing waits.
    pub(super) fn new(holds: Vec<bool>) -> Self {
        Self { holds, ..Self::default() }
    }

    /// Becomes another; where as much waits as there is memory for, nothing is allocated.
    pub fn copy_from(&mut self, other: &Self) {
        self.holds.clone_from(&other.holds);
        self.waiting.clone_from(&other.waiting);
        self.values.clone_from(&other.values);
    }

    /// Whether another is of as many events.
    pub fn has_shape_of(&self, other: &Self) -> bool {
        let count = self.holds.len();
        let known = |memory: &Self| memory.waiting.iter().all(|waiting| waiting.event < count);
        count == other.holds.len() && known(self) && known(other)
    }

    /// Makes sure that so many events and new values can wait before anything is allocated.
    pub(super) fn reserve(&mut self, events: usize, values: usize) {
        reserve(&mut self.holds, events);
        reserve(&mut self.waiting, events);
        reserve(&mut self.values, values);
    }

    /// What waits, in the order of firing.
    pub(super) fn waiting(&self) -> &[Waiting] {
        &self.waiting
    }

    /// When the next is due; infinite when nothing waits.
    pub(super) fn next(&self) -> f64 {
        self.waiting.iter().map(|waiting| waiting.time).fold(f64::INFINITY, f64::min)
    }

    /// Lets an event wait, with the new values of its firing if it sets these.
    pub(super) fn add(&mut self, event: usize, time: f64, values: Option<&[f64]>) {
        self.waiting.push(Waiting { event, time, kept: values.map(<[f64]>::len) });
        self.values.extend_from_slice(values.unwrap_or_default());
    }

    /// Takes what waits at a position, and writes the values that waited with it.
    pub(super) fn take(&mut self, at: usize, values: &mut Vec<f64>) -> Waiting {
        values.clear();
        values.extend(self.values.drain(self.values_of(at)));
        self.waiting.remove(at)
    }

    /// Forgets all that waits of an event.
    pub(super) fn forget(&mut self, event: usize) {
        while let Some(at) = self.waiting.iter().position(|waiting| waiting.event == event) {
            self.values.drain(self.values_of(at));
            self.waiting.remove(at);
        }
    }

    fn values_of(&self, at: usize) -> Range<usize> {
        let kept = |waiting: &Waiting| waiting.kept.unwrap_or(0);
        let first = self.waiting[..at].iter().map(kept).sum();
        first..first + kept(&self.waiting[at])
    }
}

/// Makes sure that a list can hold so much in all before anything is allocated.
pub(super) fn reserve<T>(list: &mut Vec<T>, length: usize) {
    list.reserve(length.saturating_sub(list.len()));
}

/// An event memory in a checkpoint, where each event that waits has its values beside it.
#[derive(Serialize, Deserialize)]
struct Saved {
    holds: Vec<bool>,
    pending: Vec<(usize, f64, Option<Vec<f64>>)>,
}

impl From<EventMemory> for Saved {
    fn from(memory: EventMemory) -> Self {
        let mut values = memory.values.into_iter();
        let pending = memory.waiting.iter().map(|waiting| {
            let kept = waiting.kept.map(|count| values.by_ref().take(count).collect());
            (waiting.event, waiting.time, kept)
        });
        Self { holds: memory.holds, pending: pending.collect() }
    }
}

impl From<Saved> for EventMemory {
    fn from(saved: Saved) -> Self {
        let mut memory = Self::new(saved.holds);
        saved.pending.iter().for_each(|(event, time, values)| memory.add(*event, *time, values.as_deref()));
        memory
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two events that keep values, one that does not, in the order 2, 0, 1, 2.
    fn memory() -> EventMemory {
        let mut memory = EventMemory::new(vec![true, false, true]);
        memory.add(2, 4.0, Some(&[1.0, 2.0]));
        memory.add(0, 3.0, None);
        memory.add(1, 2.0, Some(&[3.0]));
        memory.add(2, 5.0, Some(&[4.0, 5.0]));
        memory
    }

    #[test]
    fn values_stay_with_the_event_that_they_wait_for() {
        let (mut memory, mut values) = (memory(), vec![9.0]);
        assert_eq!(memory.next(), 2.0);
        assert_eq!(memory.take(2, &mut values), Waiting { event: 1, time: 2.0, kept: Some(1) });
        assert_eq!(values, [3.0]);
        assert_eq!(memory.take(1, &mut values).kept, None);
        assert!(values.is_empty());
        assert_eq!(memory.take(1, &mut values).time, 5.0);
        assert_eq!(values, [4.0, 5.0]);
    }

    #[test]
    fn what_no_longer_persists_goes_with_its_values() {
        let (mut memory, mut values) = (memory(), Vec::new());
        memory.forget(2);
        assert_eq!(memory.waiting().iter().map(|waiting| waiting.event).collect::<Vec<_>>(), [0, 1]);
        assert_eq!(memory.take(1, &mut values).event, 1);
        assert_eq!(values, [3.0]);
    }

    #[test]
    fn a_checkpoint_holds_all_of_it() {
        let memory = memory();
        let bytes = postcard::to_stdvec(&memory).unwrap();
        assert_eq!(postcard::from_bytes::<EventMemory>(&bytes).unwrap(), memory);
    }
}
