//! The choice of the next step from the error of this one.

use serde::{Deserialize, Serialize};

use crate::chemistry::program::{Lanes, math};

/// How large the error of a step may be: for every variable below absolute·size + relative·|value|, with the sizes of
/// [`Program::sizes`](crate::chemistry::program::Program::sizes).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tolerances {
    /// Relative to the variable's size.
    pub relative: f64,
    /// In the variable's own unit, for variables of size 1.
    pub absolute: f64,
    /// Most steps in a window.
    pub max_steps: u32,
}

impl Default for Tolerances {
    fn default() -> Self {
        Self { relative: 1e-6, absolute: 1e-9, max_steps: 100_000 }
    }
}

/// Exponents of a proportional-integral controller (Gustafsson) and the bounds of its factor.
#[derive(Debug, Clone, Copy)]
pub struct Controller {
    /// Exponent of this step's error.
    pub now: f64,
    /// Exponent of the last step's error.
    pub before: f64,
    /// Most that a step may grow.
    pub most: f64,
}

/// For the explicit pair, as in Hairer, Nørsett, Wanner, II.4.
pub const EXPLICIT: Controller = Controller { now: 0.17, before: 0.04, most: 8.0 };
/// For the Rosenbrock method.
pub const STIFF: Controller = Controller { now: 0.23, before: 0.0, most: 6.0 };

const SAFETY: f64 = 0.9;
/// Least that a step may shrink to.
pub const LEAST: f64 = 0.2;
/// Errors are not counted as smaller than this in the controller.
const SMALLEST: f64 = 1e-8;

impl Controller {
    /// The factor on the step, eq. (ode.4).
    #[inline(always)]
    pub fn factor(&self, error: f64, previous: f64) -> f64 {
        let error = if error > SMALLEST { error } else { SMALLEST };
        let previous = if previous > 1e-4 { previous } else { 1e-4 };
        let mut exponent = -self.now * math::ln(error);
        if self.before != 0.0 {
            exponent += self.before * math::ln(previous);
        }
        let factor = SAFETY * math::exp(exponent);
        let factor = if factor < self.most { factor } else { self.most };
        if factor > LEAST { factor } else { LEAST }
    }
}

/// The largest of the variables' errors, each over what is allowed, eq. (ode.3); not a number where one of them is none. What does not
/// err at all counts as 0, even where it is not a number: a value that nothing has set yet.
#[inline(always)]
pub fn norm<const L: usize>(
    error: &[Lanes<L>],
    state: &[Lanes<L>],
    proposal: &[Lanes<L>],
    sizes: &[f64],
    tolerances: &Tolerances,
) -> Lanes<L> {
    let mut largest = [0.0; L];
    for (((error, state), proposal), own) in error.iter().zip(state).zip(proposal).zip(sizes) {
        let absolute = tolerances.absolute * own;
        for l in 0..L {
            let (before, after) = (state[l].abs(), proposal[l].abs());
            let size = if before > after { before } else { after };
            let ratio = error[l].abs() / (absolute + tolerances.relative * size);
            let ratio = if error[l] == 0.0 { 0.0 } else { ratio };
            let takes = (ratio > largest[l]) | ratio.is_nan();
            largest[l] = if takes { ratio } else { largest[l] };
        }
    }
    largest
}

/// A first step where none is known: a hundredth of the time in which the state would change by its own size.
#[inline(always)]
pub fn first_step<const L: usize>(
    state: &[Lanes<L>],
    rates: &[Lanes<L>],
    sizes: &[f64],
    window: f64,
    tolerances: &Tolerances,
) -> Lanes<L> {
    let (size, speed) = (norm(state, state, state, sizes, tolerances), norm(rates, state, state, sizes, tolerances));
    let mut step = [0.0; L];
    for l in 0..L {
        let by_state = 0.01 * size[l] / speed[l];
        let known = size[l] > 1e-5 && speed[l] > 1e-5;
        let guess = if known { by_state } else { 1e-6 * window };
        step[l] = if guess < window { guess } else { window };
    }
    step
}
