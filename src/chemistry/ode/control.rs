//! The choice of the next step from the error of this one.

use serde::{Deserialize, Serialize};

use crate::chemistry::program::{Lanes, math};

/// How large the error of a step may be: the root mean square over the variables of error / (absolute + relative·|value|)
/// stays below 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tolerances {
    /// Relative to the variable's size.
    pub relative: f64,
    /// In the variable's own unit.
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
    /// The factor on the step.
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

/// The weighted root mean square of `error`.
#[inline(always)]
pub fn norm<const L: usize>(
    error: &[Lanes<L>],
    state: &[Lanes<L>],
    proposal: &[Lanes<L>],
    tolerances: &Tolerances,
) -> Lanes<L> {
    let mut sum = [0.0; L];
    for ((error, state), proposal) in error.iter().zip(state).zip(proposal) {
        for l in 0..L {
            let (before, after) = (state[l].abs(), proposal[l].abs());
            let size = if before > after { before } else { after };
            let ratio = error[l] / (tolerances.absolute + tolerances.relative * size);
            sum[l] += ratio * ratio;
        }
    }
    let share = 1.0 / (error.len().max(1) as f64);
    for l in 0..L {
        sum[l] = (sum[l] * share).sqrt();
    }
    sum
}

/// A first step where none is known: a hundredth of the time in which the state would change by its own size.
#[inline(always)]
pub fn first_step<const L: usize>(
    state: &[Lanes<L>],
    rates: &[Lanes<L>],
    window: f64,
    tolerances: &Tolerances,
) -> Lanes<L> {
    let (size, speed) = (norm(state, state, state, tolerances), norm(rates, state, state, tolerances));
    let mut step = [0.0; L];
    for l in 0..L {
        let by_state = 0.01 * size[l] / speed[l];
        let known = size[l] > 1e-5 && speed[l] > 1e-5;
        let guess = if known { by_state } else { 1e-6 * window };
        step[l] = if guess < window { guess } else { window };
    }
    step
}
