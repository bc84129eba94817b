//! Machine code for one cell. Lanes would stand empty, so the register code of its program is turned into instructions of
//! the processor, once it has run for a while. Operation by operation they do what [`run`](super::run) does: the same bits.
//! Where the processor or the system allows no such code, the register code is run on.

mod calls;
mod emit;
mod module;
mod pair;
mod step;
mod stiff;
mod twos;

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

pub use pair::Tableau;
pub use step::{LEFT, StepCode, Way};
pub use stiff::RosenbrockTableau;

use super::{LANES, Program};

/// A program is made into machine code after so many windows, and so many more for each variable: by then it has taken about
/// as long as that takes (0.6 ms for 4 variables, 5 for 16, 24 to 36 for 64).
const WINDOWS: u32 = 2000;
/// As above.
const WINDOWS_A_VARIABLE: u32 = 150;

/// Programs with more operations, of the rates or for the Rosenbrock method with their derivatives, stay register code: making code of them takes tens of milliseconds.
const MOST_OPERATIONS: usize = 500;
/// As above, for variables.
const MOST_VARIABLES: usize = 64;

/// How many methods have machine code.
const METHODS: usize = 3;

/// The machine code of a program, once it is of use.
#[derive(Debug, Default)]
pub struct Machine {
    /// One for each method.
    steps: [OnceLock<Option<StepCode<LANES>>>; METHODS],
    /// Windows that went by without.
    waited: [AtomicU32; METHODS],
}

impl Program {
    /// Machine code of a step of one cell by an explicit pair, asked for window by window: there is none in the first windows, for
    /// very large programs, nor where the system allows none.
    #[inline(always)]
    pub fn pair_step(&self, tableau: &Tableau) -> Option<&StepCode<LANES>> {
        match self.machine.steps[tableau.number].get() {
            Some(step) => step.as_ref(),
            None => self.in_time(tableau.number, self.rates.ops.len(), || pair::compile(self, tableau)),
        }
    }

    /// As [`Self::pair_step`], by a Rosenbrock method.
    #[inline(always)]
    pub fn rosenbrock_step(&self, tableau: &RosenbrockTableau) -> Option<&StepCode<LANES>> {
        match self.machine.steps[tableau.number].get() {
            Some(step) => step.as_ref(),
            None => self.in_time(tableau.number, self.linear.ops.len(), || stiff::compile(self, tableau)),
        }
    }

    #[cold]
    #[inline(never)]
    fn in_time(
        &self,
        number: usize,
        operations: usize,
        compile: impl FnOnce() -> Option<StepCode<LANES>>,
    ) -> Option<&StepCode<LANES>> {
        let wait = WINDOWS + WINDOWS_A_VARIABLE * self.size() as u32;
        if self.machine.waited[number].fetch_add(1, Ordering::Relaxed) < wait {
            return None;
        }
        let small = operations <= MOST_OPERATIONS && self.size() <= MOST_VARIABLES;
        self.machine.steps[number].get_or_init(|| if small { compile() } else { None }).as_ref()
    }
}
