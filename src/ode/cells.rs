//! The cells of one task, and which of them stand in the lanes at present.

use super::Reason;
use super::mask::{Mask, YES, when};
use super::scratch::Scratch;
use crate::equations::program::Lanes;
use crate::equations::tree::QuantityId;

/// The first cell of a task that failed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellTrouble {
    /// The cell, counted from the task's first.
    pub cell: usize,
    /// Time of its last good state.
    pub time: f64,
    /// The variable that is worst.
    pub variable: Option<usize>,
    /// The quantity whose equations have no solution there.
    pub unknown: Option<QuantityId>,
    /// What is wrong.
    pub reason: Reason,
}

/// Cells that one task advances: whole blocks, `[block][number][lane]`.
pub struct Cells<'a, const L: usize> {
    /// How many cells there are; the last block may have lanes to spare.
    pub count: usize,
    /// States.
    pub states: &'a mut [Lanes<L>],
    /// Open quantities.
    pub open_values: &'a [Lanes<L>],
    /// The step that each cell tries next; 0 where none is known.
    pub steps: &'a mut [Lanes<L>],
    /// Error of each cell's last step.
    pub errors: &'a mut [Lanes<L>],
    /// Rates at the states, where they are kept from window to window.
    pub kept: Option<Kept<'a, L>>,
}

/// The rates at which cells left their last window: those at which they begin the next, if they begin with the state and the open
/// quantities that the rates were worked out from. These stand beside them, so that it does not matter whose rates they are.
pub struct Kept<'a, const L: usize> {
    /// Of each block the rates, the states and the open quantities; [`UNKNOWN`] for states where nothing is known.
    pub numbers: &'a mut [Lanes<L>],
}

/// How many numbers of a block [`Kept`] holds, of a system of so many variables and open quantities.
pub fn kept_numbers(variables: usize, open: usize) -> usize {
    2 * variables + open
}

/// What stands for the state where no rates are known: a bit pattern that no arithmetic yields, so that no state is equal to it.
pub const UNKNOWN: f64 = f64::from_bits(u64::MAX);

/// The bits in which two numbers differ; none where rates worked out from the one are those of the other.
#[inline(always)]
fn differing(one: f64, other: f64) -> u64 {
    one.to_bits() ^ other.to_bits()
}

/// Adds the bits in which the numbers of each lane differ.
#[inline(always)]
fn add_differing<const L: usize>(differ: &mut [u64; L], one: &Lanes<L>, other: &Lanes<L>) {
    for l in 0..L {
        differ[l] |= differing(one[l], other[l]);
    }
}

impl<const L: usize> Kept<'_, L> {
    /// The rates of a block, and what they were worked out from.
    #[inline(always)]
    fn block(&self, block: usize, n: usize, open: usize) -> (&[Lanes<L>], &[Lanes<L>], &[Lanes<L>]) {
        let all = &self.numbers[block * kept_numbers(n, open)..][..kept_numbers(n, open)];
        (&all[..n], &all[n..2 * n], &all[2 * n..])
    }

    /// The same to be written.
    #[inline(always)]
    fn block_mut(&mut self, block: usize, n: usize, open: usize) -> [&mut [Lanes<L>]; 3] {
        let all = &mut self.numbers[block * kept_numbers(n, open)..][..kept_numbers(n, open)];
        let (rates, from) = all.split_at_mut(n);
        let (states, open_values) = from.split_at_mut(n);
        [rates, states, open_values]
    }
}

/// The lanes: each holds a cell until its window is done and then takes the next one that waits.
pub struct LaneCells<const L: usize> {
    /// The cell in each lane.
    pub cell: [usize; L],
    /// Whether the lane has a cell that is not done.
    pub active: Mask<L>,
    /// The step that the cell tries next.
    pub step: Lanes<L>,
    /// Error of its last step.
    pub error: Lanes<L>,
    /// Whether the rates at its state are not known.
    pub fresh: Mask<L>,
    /// The block that fills all lanes, while none of its cells has left.
    block: Option<usize>,
    /// The first cell that waits.
    next: usize,
}

impl<const L: usize> LaneCells<L> {
    /// All lanes empty.
    pub fn new() -> Self {
        Self { cell: [0; L], active: [0; L], step: [0.0; L], error: [1.0; L], fresh: [YES; L], block: None, next: 0 }
    }

    /// Whether a cell waits.
    pub fn waiting(&self, cells: &Cells<L>) -> bool {
        self.next < cells.count
    }

    /// Gives a free lane the next cell; its state, open quantities, step, error and known rates are copied in. Returns
    /// whether there was one.
    #[inline(always)]
    pub fn take(&mut self, l: usize, cells: &Cells<L>, open: usize, s: &mut Scratch<L>) -> bool {
        if self.next >= cells.count {
            return false;
        }
        let (block, lane, n) = (self.next / L, self.next % L, s.state.len());
        for (state, from) in s.state.iter_mut().zip(&cells.states[block * n..]) {
            state[l] = from[lane];
        }
        let numbers = cells.open_values.len() / cells.steps.len();
        for (register, from) in s.file[open..open + numbers].iter_mut().zip(&cells.open_values[block * numbers..]) {
            register[l] = from[lane];
        }
        self.fresh[l] = YES;
        if let Some(kept) = &cells.kept {
            let (rates, states, open_values) = kept.block(block, n, numbers);
            for (rate, from) in s.stages[..n].iter_mut().zip(rates) {
                rate[l] = from[lane];
            }
            let mut differ = 0;
            for (before, now) in states.iter().zip(&s.state).chain(open_values.iter().zip(&s.file[open..])) {
                differ |= differing(before[lane], now[l]);
            }
            self.fresh[l] = when(differ != 0);
        }
        (self.step[l], self.error[l]) = (cells.steps[block][lane], cells.errors[block][lane]);
        (self.cell[l], self.active[l], self.block) = (self.next, YES, None);
        self.next += 1;
        true
    }

    /// Fills all lanes, which must be free, with the next block, if one can be had whole. Returns whether it was done.
    #[inline(always)]
    pub fn take_block(&mut self, cells: &Cells<L>, open: usize, s: &mut Scratch<L>) -> bool {
        if !self.next.is_multiple_of(L) || self.next + L > cells.count {
            return false;
        }
        let (block, n) = (self.next / L, s.state.len());
        s.state.copy_from_slice(&cells.states[block * n..(block + 1) * n]);
        let numbers = cells.open_values.len() / cells.steps.len();
        s.file[open..open + numbers].copy_from_slice(&cells.open_values[block * numbers..(block + 1) * numbers]);
        self.fresh = [YES; L];
        if let Some(kept) = &cells.kept {
            let (rates, states, open_values) = kept.block(block, n, numbers);
            s.stages[..n].copy_from_slice(rates);
            let mut differ = [0; L];
            for (before, now) in states.iter().zip(&s.state) {
                add_differing(&mut differ, before, now);
            }
            for (before, now) in open_values.iter().zip(&s.file[open..open + numbers]) {
                add_differing(&mut differ, before, now);
            }
            self.fresh = differ.map(|differ| when(differ != 0));
        }
        (self.step, self.error) = (cells.steps[block], cells.errors[block]);
        self.cell = std::array::from_fn(|l| self.next + l);
        (self.active, self.block) = ([YES; L], Some(block));
        self.next += L;
        true
    }

    /// Copies what belongs to a lane's cell back to it; the rates are kept if the cell has arrived.
    #[inline(always)]
    pub fn leave(&mut self, l: usize, cells: &mut Cells<L>, s: &Scratch<L>, arrived: bool) {
        let (block, lane, n) = (self.cell[l] / L, self.cell[l] % L, s.state.len());
        for (to, state) in cells.states[block * n..(block + 1) * n].iter_mut().zip(&s.state) {
            to[lane] = state[l];
        }
        if let Some(kept) = &mut cells.kept {
            let numbers = cells.open_values.len() / cells.steps.len();
            let [rates, states, open_values] = kept.block_mut(block, n, numbers);
            for (to, rate) in rates.iter_mut().zip(&s.stages) {
                to[lane] = rate[l];
            }
            for (to, state) in states.iter_mut().zip(&s.state) {
                to[lane] = if arrived { state[l] } else { UNKNOWN };
            }
            for (to, from) in open_values.iter_mut().zip(&cells.open_values[block * numbers..]) {
                to[lane] = from[lane];
            }
        }
        (cells.steps[block][lane], cells.errors[block][lane]) = (self.step[l], self.error[l]);
        (self.active[l], self.block) = (0, None);
    }

    /// Copies all lanes back, all arrived, if they still hold one whole block. Returns whether it was done.
    #[inline(always)]
    pub fn leave_block(&mut self, cells: &mut Cells<L>, s: &Scratch<L>) -> bool {
        let (Some(block), n) = (self.block.take(), s.state.len()) else {
            return false;
        };
        cells.states[block * n..(block + 1) * n].copy_from_slice(&s.state);
        if let Some(kept) = &mut cells.kept {
            let numbers = cells.open_values.len() / cells.steps.len();
            let [rates, states, open_values] = kept.block_mut(block, n, numbers);
            rates.copy_from_slice(&s.stages[..n]);
            states.copy_from_slice(&s.state);
            open_values.copy_from_slice(&cells.open_values[block * numbers..(block + 1) * numbers]);
        }
        (cells.steps[block], cells.errors[block]) = (self.step, self.error);
        self.active = [0; L];
        true
    }
}
