//! Buffers for the work on one block of cells, a set for each thread: what a block needs only for a while is not held for all of them.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::kind::Kind;
use super::model::Model;
use crate::mechanics::lanes::LANES;

/// Buffers of a thread.
const ARRAYS: usize = 6;

/// Sets of right sides of one cell that are solved for at once, so that its factor is read once for all of them.
pub const SETS: usize = 4;

/// Arrays of the shape of a block's positions.
type Buffers = [Vec<f64>; ARRAYS];

/// A set of buffers for each thread, and one for the factor of the tangent stiffness of a block.
#[derive(Debug, Default)]
pub struct ThreadBuffers(Vec<Mutex<(Buffers, Vec<f64>)>>);

/// Nothing in them outlasts the work on a block.
impl Clone for ThreadBuffers {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl ThreadBuffers {
    /// Makes buffers for all threads, large enough for every block of a model. Nothing is allocated where they are there.
    pub fn suit(&mut self, model: &Model) {
        // Cells that have a stiffness of their own are solved for several right sides at once: where contacts ask them, for many.
        let sets = if model.contact.is_some() { SETS } else { 1 };
        let length =
            |kind: &Kind| if kind.tangent.is_some() { 3 * kind.atoms() * LANES * sets } else { kind.block_len() };
        let longest = model.kinds.iter().map(length).max().unwrap_or(0);
        let factor = model.kinds.iter().map(|kind| kind.tangent.as_ref().map_or(0, |tangent| tangent.len(kind.lanes)));
        let factor = factor.max().unwrap_or(0);
        self.0.resize_with(rayon::current_num_threads().max(self.0.len()), Mutex::default);
        for own in &mut self.0 {
            let own = own.get_mut().unwrap_or_else(PoisonError::into_inner);
            let arrays = own.0.iter_mut().map(|array| (array, longest)).chain([(&mut own.1, factor)]);
            for (array, length) in arrays {
                if array.len() < length {
                    array.reserve_exact(length - array.len());
                    array.resize(length, 0.0);
                }
            }
        }
    }

    /// Works with the buffers of this thread, cut to this length. They must not be asked for again meanwhile.
    ///
    /// # Panics
    /// When there are none as long as this.
    pub fn enter<T>(&self, length: usize, work: impl FnOnce([&mut [f64]; ARRAYS]) -> T) -> T {
        self.enter_with_factor(length, |arrays, _| work(arrays))
    }

    /// The same, and with the buffer of factors, as long as the longest of them.
    ///
    /// # Panics
    /// When there are no buffers as long as this.
    pub fn enter_with_factor<T>(&self, length: usize, work: impl FnOnce([&mut [f64]; ARRAYS], &mut [f64]) -> T) -> T {
        let own = &self.0[rayon::current_thread_index().unwrap_or(0) % self.0.len()];
        let mut own = own.lock().unwrap_or_else(PoisonError::into_inner);
        let (arrays, factor) = &mut *own;
        work(arrays.each_mut().map(|array| &mut array[..length]), factor)
    }

    /// Writes NaN over all numbers.
    pub fn poison(&mut self) {
        for own in &mut self.0 {
            let own = own.get_mut().unwrap_or_else(PoisonError::into_inner);
            own.0.iter_mut().chain([&mut own.1]).for_each(|array| array.fill(f64::NAN));
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
