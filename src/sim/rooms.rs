//! Room to work on the cells of one block, one for each thread: what a block needs only for a while is not held for all of them.

use std::sync::{Mutex, PoisonError};

use super::model::Model;

/// Arrays of the shape of a block's positions.
#[derive(Debug, Clone, Default)]
pub struct Room {
    /// Forces, pN; then what they cause.
    pub force: Vec<f64>,
    /// Spare array.
    pub spare: Vec<f64>,
    /// Spare array.
    pub spare2: Vec<f64>,
}

impl Room {
    fn arrays(&mut self) -> [&mut Vec<f64>; 3] {
        [&mut self.force, &mut self.spare, &mut self.spare2]
    }
}

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
            for array in room.arrays() {
                if array.len() < longest {
                    array.reserve_exact(longest - array.len());
                    array.resize(longest, 0.0);
                }
            }
        }
    }

    /// Works in the room of this thread, with arrays of this length: force, spare, spare. Other rooms must not be entered
    /// meanwhile.
    ///
    /// # Panics
    /// When there are no rooms as long as this.
    pub fn enter<T>(&self, length: usize, work: impl FnOnce([&mut [f64]; 3]) -> T) -> T {
        let room = &self.0[rayon::current_thread_index().unwrap_or(0) % self.0.len()];
        let mut room = room.lock().unwrap_or_else(PoisonError::into_inner);
        work(room.arrays().map(|array| &mut array[..length]))
    }

    /// Writes NaN over all numbers.
    pub fn poison(&mut self) {
        for room in &mut self.0 {
            let room = room.get_mut().unwrap_or_else(PoisonError::into_inner);
            room.arrays().into_iter().for_each(|array| array.fill(f64::NAN));
        }
    }
}
