//! How one cell answers many forces at once, in lanes that are copies of it.

use super::kind::Kind;
use super::solver::{System, solve_block};
use super::thread_buffers::SETS;
use crate::mechanics::lanes::LANES;

/// Blocks whose lanes are copies of one cell, each with a force of its own.
#[derive(Debug, Clone, Default)]
pub struct Copies {
    x: Vec<f64>,
    columns: Vec<f64>,
    spare: Vec<f64>,
    spare2: Vec<f64>,
}

impl Copies {
    /// Writes NaN over all numbers.
    pub fn poison(&mut self) {
        for array in [&mut self.x, &mut self.columns, &mut self.spare, &mut self.spare2] {
            array.fill(f64::NAN);
        }
    }

    /// Solves for columns of a cell whose atoms are at `x`, as many at a time as there are lanes, which takes about as long as one alone; of a cell that has
    /// a factor of its own several times as many, as that is read from memory once for all.
    pub fn solve(&mut self, kind: &Kind, system: &System, x: &[f64], columns: &mut [f64]) {
        let (size, set) = (x.len(), LANES * x.len());
        let sets = if matches!(system, System::Own { .. }) { SETS } else { 1 };
        self.x.clear();
        self.x.extend(x.iter().flat_map(|value| [*value; LANES]));
        for array in [&mut self.columns, &mut self.spare, &mut self.spare2] {
            array.resize(sets * set, 0.0);
        }
        for columns in columns.chunks_mut(sets * set) {
            let used = columns.len().div_ceil(set) * set;
            let Self { x, columns: together, spare, spare2 } = self;
            let together = &mut together[..used];
            together.fill(0.0);
            for (columns, together) in columns.chunks(set).zip(together.chunks_exact_mut(set)) {
                for (lane, column) in columns.chunks_exact(size).enumerate() {
                    together.chunks_exact_mut(LANES).zip(column).for_each(|(row, value)| row[lane] = *value);
                }
            }
            solve_block(kind, LANES, system, x, together, &mut spare[..used], &mut spare2[..used]);
            for (columns, together) in columns.chunks_mut(set).zip(together.chunks_exact(set)) {
                for (lane, column) in columns.chunks_exact_mut(size).enumerate() {
                    together.chunks_exact(LANES).zip(column).for_each(|(row, value)| *value = row[lane]);
                }
            }
        }
    }
}
