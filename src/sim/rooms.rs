//! Room to work on the cells of one block, one for each thread: what a block needs only for a while is not held for all of them.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::model::Model;

/// Arrays in a room.
const ARRAYS: usize = 6;

/// Arrays of the shape of a block's positions.
type Room = [Vec<f64>; ARRAYS];

/// A room for each thread.
#[derive(Debug, Default)]
pub struct Rooms(Vec<Mutex<Room>>);

/// Nothing in a room outlasts the work on a block.
impl Clone for Rooms {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Rooms {
    /// Makes rooms for all threads, large enough for every block of a model. Nothing is allocated where they are there.
    pub fn suit(&mut self, model: &Model) {
        let longest = model.kinds.iter().map(|kind| kind.block_len()).max().unwrap_or(0);
        self.0.resize_with(rayon::current_num_threads().max(self.0.len()), Mutex::default);
        for room in &mut self.0 {
            let room = room.get_mut().unwrap_or_else(PoisonError::into_inner);
            for array in room {
                if array.len() < longest {
                    array.reserve_exact(longest - array.len());
                    array.resize(longest, 0.0);
                }
            }
        }
    }

    /// Works in the room of this thread, with arrays of this length. Other rooms must not be entered meanwhile.
    ///
    /// # Panics
    /// When there are no rooms as long as this.
    pub fn enter<T>(&self, length: usize, work: impl FnOnce([&mut [f64]; ARRAYS]) -> T) -> T {
        let room = &self.0[rayon::current_thread_index().unwrap_or(0) % self.0.len()];
        let mut room = room.lock().unwrap_or_else(PoisonError::into_inner);
        work(room.each_mut().map(|array| &mut array[..length]))
    }

    /// Writes NaN over all numbers.
    pub fn poison(&mut self) {
        for room in &mut self.0 {
            let room = room.get_mut().unwrap_or_else(PoisonError::into_inner);
            room.iter_mut().for_each(|array| array.fill(f64::NAN));
        }
    }
}

/// The part of each of `blocks` blocks in an array that is held for all, or as many times nothing where it is empty.
pub fn each_or_none(
    array: &mut [f64],
    length: usize,
    blocks: usize,
) -> impl IndexedParallelIterator<Item = Option<&mut [f64]>> {
    let not_held = if array.is_empty() { blocks } else { 0 };
    array.par_chunks_exact_mut(length).map(Some).chain(rayon::iter::repeat_n((), not_held).map(|()| None))
}
