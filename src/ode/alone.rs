//! Cells one by one in machine code: for each the decisions of [`block`](super::block), so the same bits.

use pulp::Scalar;

use super::Work;
use super::adaptive::Adaptive;
use super::block::{self, CellTrouble};
use super::control::{self, Tolerances};
use super::mask::{Mask, when};
use super::scratch::Scratch;
use crate::equations::program::{LEFT, Lanes, Program, StepCode, Way};

/// What belongs to a few cells, each in a lane of one block.
pub struct Alone<'a, const L: usize> {
    /// The program of all.
    pub program: &'a Program,
    /// Its machine code.
    pub code: &'a StepCode<L>,
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
    pub fn advance<M: Adaptive>(
        &mut self,
        l: usize,
        (from, until): (f64, f64),
        tolerances: &Tolerances,
    ) -> Result<Work, CellTrouble> {
        let known = self.known.first().map_or(0, |known| known[l]);
        let unknown = self.steps[l] <= 0.0;
        let wanted = if unknown { self.first_step(l, (from, until), tolerances) } else { self.steps[l] };
        let Tolerances { absolute, relative, max_steps } = *tolerances;
        let mut way = Way { time: from, until, wanted, step: 0.0, absolute, relative, fresh: !known & 1 };
        let shortest = control::shortest(from, until);
        let (mut steps, mut rejected, mut previous, mut most) = (0, 0, self.errors[l], M::CONTROLLER.most);
        let failed = loop {
            let wanted = way.wanted;
            let half = 0.5 * (until - way.time);
            let mut error = self.code.run(l, self.given, self.states, self.rates, &mut way);
            if M::JACOBIANS > 0 && error == LEFT {
                error = self.by_register_code::<M>(l, &mut way, tolerances);
            }
            way.fresh = 0;
            let factor = M::CONTROLLER.factor(error, previous);
            if error <= 1.0 {
                steps += 1;
                way.wanted = control::after_good(way.step, (wanted, wanted > half), factor, most);
                (previous, most) = (error, M::CONTROLLER.most);
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
        let tries = steps + rejected;
        let begin = if M::LAST.is_some() { !known & 1 } else { u64::from(unknown) };
        let (rates, jacobians) = (M::RATES * tries + begin, M::JACOBIANS * tries);
        let work = Work { steps, rejected, rates, jacobians, ..Work::default() };
        failed.map_or(Ok(work), |error| Err(self.trouble(l, &way, error, shortest)))
    }

    /// A step that machine code has left, as it would have been taken: returns the norm of its error.
    #[cold]
    #[inline(never)]
    fn by_register_code<M: Adaptive>(&mut self, l: usize, way: &mut Way, tolerances: &Tolerances) -> f64 {
        self.load(l);
        let (program, s) = (self.program, &mut *self.room);
        M::step(Scalar, program, s, &[way.time], &[way.step]);
        let [error] = control::norm(&s.error, &s.state, &s.proposal, &program.sizes, tolerances);
        if error <= 1.0 {
            self.states.iter_mut().zip(&s.proposal).for_each(|(to, from)| to[l] = from[0]);
            let last = way.wanted >= (way.until - way.time) * control::NEAR;
            way.time = if last { way.until } else { way.time + way.step };
        }
        error
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
