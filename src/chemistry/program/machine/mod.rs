//! Machine code for one cell. Lanes would stand empty, so the register code of its program is turned into instructions of
//! the processor, once it has run for a while. Operation by operation they do what [`run`](super::run) does: the same bits.
//! Where the processor or the system allows no such code, the register code is run on.

mod calls;
mod emit;
mod module;
mod pair;
mod twos;

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

use pair::PAIRS;
pub use pair::{PairStep, Tableau, Way};

use super::{LANES, Program};

/// A program is made into machine code after so many windows, and so many more for each variable: by then it has taken about
/// as long as that takes (0.6 ms for 4 variables, 5 for 16, 24 to 36 for 64).
const WINDOWS: u32 = 2000;
/// As above.
const WINDOWS_A_VARIABLE: u32 = 150;

/// Programs with more operations stay register code: making code of them takes tens of milliseconds.
const MOST_OPERATIONS: usize = 500;
/// As above, for variables.
const MOST_VARIABLES: usize = 64;

/// The machine code of a program, once it is of use.
#[derive(Debug, Default)]
pub struct Machine {
    /// One for each explicit pair.
    steps: [OnceLock<Option<PairStep<LANES>>>; PAIRS],
    /// Windows that went by without.
    waited: [AtomicU32; PAIRS],
}

impl Program {
    /// Machine code of a step of one cell by an explicit pair, asked for window by window: there is none in the first windows, for
    /// very large programs, nor where the system allows none.
    #[inline(always)]
    pub fn pair_step(&self, tableau: &Tableau) -> Option<&PairStep<LANES>> {
        match self.machine.steps[tableau.number].get() {
            Some(step) => step.as_ref(),
            None => self.pair_step_in_time(tableau),
        }
    }

    fn pair_step_in_time(&self, tableau: &Tableau) -> Option<&PairStep<LANES>> {
        let wait = WINDOWS + WINDOWS_A_VARIABLE * self.size() as u32;
        if self.machine.waited[tableau.number].fetch_add(1, Ordering::Relaxed) < wait {
            return None;
        }
        let small = self.rates.ops.len() <= MOST_OPERATIONS && self.size() <= MOST_VARIABLES;
        let step = &self.machine.steps[tableau.number];
        step.get_or_init(|| small.then(|| PairStep::new(self, tableau)).flatten()).as_ref()
    }
}
