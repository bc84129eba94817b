//! Cells one by one by an explicit pair in machine code: for each the decisions of [`block`](super::block), so the same
//! bits.

use super::Work;
use super::block::{self, CellTrouble};
use super::control::{self, Controller, Tolerances};
use super::mask::{Mask, when};
use super::scratch::Scratch;
use crate::chemistry::program::{Lanes, PairStep, Program, Way};

/// What belongs to a few cells, each in a lane of one block.
pub struct Alone<'a, const L: usize> {
    /// The program of all.
    pub program: &'a Program,
    /// Its machine code.
    pub code: &'a PairStep<L>,
    /// How the pair chooses the next step.
    pub controller: Controller,
    /// Room for what is worked out by register code.
    pub room: &'a mut Scratch<1>,
    /// States.
    pub states: &'a mut [Lanes<L>],
    /// Open quantities.
    pub given: &'a [Lanes<L>],
    /// Rates at the states.
    pub rates: &'a mut [Lanes<L>],
    /// The cells of which they are known; none where they may not be kept.
    pub known: &'a mut [Mask<L>],
    /// The step that each cell tries next; 0 where none is known.
    pub steps: &'a mut Lanes<L>,
    /// Error of each cell's last step.
    pub errors: &'a mut Lanes<L>,
}

impl<const L: usize> Alone<'_, L> {
    /// Advances the cell in a lane. A cell that fails keeps its last good state.
    ///
    /// # Errors
    /// What is wrong, and when.
    #[inline(always)]
    pub fn advance(
        &mut self,
        l: usize,
        (from, until): (f64, f64),
        tolerances: &Tolerances,
    ) -> Result<Work, CellTrouble> {
        let known = self.known.first().map_or(0, |known| known[l]);
        let wanted = if self.steps[l] > 0.0 { self.steps[l] } else { self.first_step(l, (from, until), tolerances) };
        let Tolerances { absolute, relative, max_steps } = *tolerances;
        let mut way = Way { time: from, until, wanted, step: 0.0, absolute, relative, fresh: !known & 1 };
        let shortest = control::shortest(from, until);
        let controller = self.controller;
        let (mut steps, mut rejected, mut previous, mut most) = (0, 0, self.errors[l], controller.most);
        let failed = loop {
            let wanted = way.wanted;
            let half = 0.5 * (until - way.time);
            let error = self.code.run(l, self.given, self.states, self.rates, &mut way);
            way.fresh = 0;
            let factor = controller.factor(error, previous);
            if error <= 1.0 {
                steps += 1;
                way.wanted = control::after_good(way.step, (wanted, wanted > half), factor, most);
                (previous, most) = (error, controller.most);
                if way.time >= until {
                    break None;
                }
            } else {
                rejected += 1;
                way.wanted = control::after_refused(way.step, error, factor);
                most = 1.0;
                if way.wanted <= shortest {
                    break Some(error);
                }
            }
            if steps + rejected >= u64::from(max_steps) {
                break Some(error);
            }
        };
        (self.steps[l], self.errors[l]) = (way.wanted, previous);
        if let Some(known) = self.known.first_mut() {
            known[l] = when(failed.is_none());
        }
        let rates = self.code.rates() * (steps + rejected) + (!known & 1);
        let work = Work { steps, rejected, rates, ..Work::default() };
        failed.map_or(Ok(work), |error| Err(self.trouble(l, &way, error, shortest)))
    }

    /// Puts the cell of a lane into the room.
    fn load(&mut self, l: usize) {
        let open = self.program.first_open();
        self.room.state.iter_mut().zip(&*self.states).for_each(|(to, from)| to[0] = from[l]);
        self.room.file[open..].iter_mut().zip(self.given).for_each(|(to, from)| to[0] = from[l]);
    }

    #[cold]
    #[inline(never)]
    fn first_step(&mut self, l: usize, (from, until): (f64, f64), tolerances: &Tolerances) -> f64 {
        self.load(l);
        let (program, s) = (self.program, &mut *self.room);
        s.rates_at_state(program, [from]);
        control::first_step(&s.state, &s.stages[..s.state.len()], &program.sizes, until - from, tolerances)[0]
    }

    #[cold]
    #[inline(never)]
    fn trouble(&mut self, l: usize, way: &Way, error: f64, shortest: f64) -> CellTrouble {
        self.load(l);
        block::explain(self.program, self.room, ([way.time], [way.wanted]), 0, (l, error, shortest))
    }
}
