//! The cells of one task, and which of them stand in the lanes at present.

use super::mask::{Mask, YES, when};
use super::scratch::Scratch;
use crate::equations::program::Lanes;

/// Cells that one task advances: whole blocks, `[block][number][lane]`.
pub struct Cells<'a, const L: usize> {
    /// How many cells there are; the last block may have lanes to spare.
    pub count: usize,
    /// States.
    pub states: &'a mut [Lanes<L>],
    /// Open quantities.
    pub given: &'a [Lanes<L>],
    /// The step that each cell tries next; 0 where none is known.
    pub steps: &'a mut [Lanes<L>],
    /// Error of each cell's last step.
    pub errors: &'a mut [Lanes<L>],
    /// Rates at the states, where they are kept from window to window.
    pub kept: Option<Kept<'a, L>>,
}

/// The rates at which cells left their last window: those at which they begin the next.
pub struct Kept<'a, const L: usize> {
    /// Rates, as [`Cells::states`].
    pub rates: &'a mut [Lanes<L>],
    /// The cells of which they are known.
    pub known: &'a mut [Mask<L>],
}

/// The lanes: each holds a cell until its window is done and then takes the next one that waits.
pub struct Seats<const L: usize> {
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

impl<const L: usize> Seats<L> {
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
        let numbers = cells.given.len() / cells.steps.len();
        for (register, from) in s.file[open..open + numbers].iter_mut().zip(&cells.given[block * numbers..]) {
            register[l] = from[lane];
        }
        self.fresh[l] = YES;
        if let Some(kept) = &cells.kept {
            for (rate, from) in s.stages[..n].iter_mut().zip(&kept.rates[block * n..]) {
                rate[l] = from[lane];
            }
            self.fresh[l] = !kept.known[block][lane];
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
        let numbers = cells.given.len() / cells.steps.len();
        s.file[open..open + numbers].copy_from_slice(&cells.given[block * numbers..(block + 1) * numbers]);
        self.fresh = [YES; L];
        if let Some(kept) = &cells.kept {
            s.stages[..n].copy_from_slice(&kept.rates[block * n..(block + 1) * n]);
            self.fresh = kept.known[block].map(|known| !known);
        }
        (self.step, self.error) = (cells.steps[block], cells.errors[block]);
        self.cell = std::array::from_fn(|l| self.next + l);
        (self.active, self.block) = ([YES; L], Some(block));
        self.next += L;
        true
    }

    /// Copies what belongs to a lane's cell back to it; the rates count as known if the cell has arrived.
    #[inline(always)]
    pub fn leave(&mut self, l: usize, cells: &mut Cells<L>, s: &Scratch<L>, arrived: bool) {
        let (block, lane, n) = (self.cell[l] / L, self.cell[l] % L, s.state.len());
        for (to, state) in cells.states[block * n..(block + 1) * n].iter_mut().zip(&s.state) {
            to[lane] = state[l];
        }
        if let Some(kept) = &mut cells.kept {
            for (to, rate) in kept.rates[block * n..(block + 1) * n].iter_mut().zip(&s.stages) {
                to[lane] = rate[l];
            }
            kept.known[block][lane] = when(arrived);
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
            kept.rates[block * n..(block + 1) * n].copy_from_slice(&s.stages[..n]);
            kept.known[block] = [YES; L];
        }
        (cells.steps[block], cells.errors[block]) = (self.step, self.error);
        self.active = [0; L];
        true
    }
}
