//! The cells of one task, and which of them stand in the lanes at present.

use super::scratch::Scratch;
use crate::chemistry::program::Lanes;

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
}

/// The lanes: each holds a cell until its window is done and then takes the next one that waits.
pub struct Seats<const L: usize> {
    /// The cell in each lane.
    pub cell: [usize; L],
    /// Whether the lane has a cell that is not done.
    pub active: [bool; L],
    /// The first cell that waits.
    next: usize,
}

impl<const L: usize> Seats<L> {
    /// All lanes empty.
    pub fn new() -> Self {
        Self { cell: [0; L], active: [false; L], next: 0 }
    }

    /// Whether a cell waits.
    pub fn waiting(&self, cells: &Cells<L>) -> bool {
        self.next < cells.count
    }

    /// Gives a free lane the next cell; its state, open quantities, step and error are copied in. Returns whether there
    /// was one.
    #[inline(always)]
    pub fn take(
        &mut self,
        l: usize,
        cells: &Cells<L>,
        open: usize,
        s: &mut Scratch<L>,
        (step, error): (&mut Lanes<L>, &mut Lanes<L>),
    ) -> bool {
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
        (step[l], error[l]) = (cells.steps[block][lane], cells.errors[block][lane]);
        (self.cell[l], self.active[l]) = (self.next, true);
        self.next += 1;
        true
    }

    /// Fills all lanes with the next block, if none is active and one can be had whole. Returns whether it was done.
    #[inline(always)]
    pub fn take_block(
        &mut self,
        cells: &Cells<L>,
        open: usize,
        s: &mut Scratch<L>,
        (step, error): (&mut Lanes<L>, &mut Lanes<L>),
    ) -> bool {
        if !self.next.is_multiple_of(L) || self.next + L > cells.count || self.active.contains(&true) {
            return false;
        }
        let (block, n) = (self.next / L, s.state.len());
        s.state.copy_from_slice(&cells.states[block * n..(block + 1) * n]);
        let numbers = cells.given.len() / cells.steps.len();
        s.file[open..open + numbers].copy_from_slice(&cells.given[block * numbers..(block + 1) * numbers]);
        (*step, *error) = (cells.steps[block], cells.errors[block]);
        self.cell = std::array::from_fn(|l| self.next + l);
        self.active = [true; L];
        self.next += L;
        true
    }

    /// Copies a lane's state, step and error back to its cell.
    #[inline(always)]
    pub fn leave(&mut self, l: usize, cells: &mut Cells<L>, s: &Scratch<L>, step: &Lanes<L>, error: &Lanes<L>) {
        let (block, lane, n) = (self.cell[l] / L, self.cell[l] % L, s.state.len());
        for (to, state) in cells.states[block * n..(block + 1) * n].iter_mut().zip(&s.state) {
            to[lane] = state[l];
        }
        (cells.steps[block][lane], cells.errors[block][lane]) = (step[l], error[l]);
        self.active[l] = false;
    }

    /// Copies all lanes back, if they hold one whole block. Returns whether it was done.
    #[inline(always)]
    pub fn leave_block(&mut self, cells: &mut Cells<L>, s: &Scratch<L>, step: &Lanes<L>, error: &Lanes<L>) -> bool {
        let first = self.cell[0];
        if !first.is_multiple_of(L) || !(0..L).all(|l| self.active[l] && self.cell[l] == first + l) {
            return false;
        }
        let (block, n) = (first / L, s.state.len());
        cells.states[block * n..(block + 1) * n].copy_from_slice(&s.state);
        (cells.steps[block], cells.errors[block]) = (*step, *error);
        self.active = [false; L];
        true
    }
}
