//! The choice of the next step from the error of this one.

use serde::{Deserialize, Serialize};

use crate::equations::program::Lanes;

/// How large the error of a step may be: for every variable below absolute·size + relative·|value|, with the sizes of
/// [`Program::sizes`](crate::equations::program::Program::sizes).
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

/// For the explicit pair of order 5(4), as in Hairer, Nørsett, Wanner, II.4.
pub const EXPLICIT: Controller = Controller { now: 0.17, before: 0.04, most: 8.0 };
/// For the explicit pair of order 6(5): the exponents go with one over the order, as there.
pub const SIXTH: Controller = Controller { now: 0.144, before: 0.03, most: 8.0 };
/// For the Rosenbrock method.
pub const STIFF: Controller = Controller { now: 0.23, before: 0.0, most: 6.0 };

const SAFETY: f64 = 0.9;
/// Least that a step may shrink to.
const LEAST: f64 = 0.2;
/// A refused step shrinks at least to this share.
const SAFE_SHRINK: f64 = 0.9;
/// A step of at least this share of what is left of a window is the last.
pub const NEAR: f64 = 1.0 - 1e-10;
/// Errors are not counted as smaller than this in the controller.
const SMALLEST: f64 = 1e-8;

impl Controller {
    /// The factor on the step, eq. (ode.4).
    #[inline(always)]
    pub fn factor(&self, error: f64, previous: f64) -> f64 {
        let error = if error > SMALLEST { error } else { SMALLEST };
        let previous = if previous > 1e-4 { previous } else { 1e-4 };
        let mut exponent = -self.now * rough_log2(error);
        if self.before != 0.0 {
            exponent += self.before * rough_log2(previous);
        }
        let factor = SAFETY * rough_exp2(exponent);
        let factor = if factor < self.most { factor } else { self.most };
        if factor > LEAST { factor } else { LEAST }
    }
}

/// The step after one that was good enough, by a factor of which no more than `most` is allowed. `cut` says that a longer
/// one was wanted than fitted into the window.
#[inline(always)]
pub fn after_good(step: f64, (wanted, cut): (f64, bool), factor: f64, most: f64) -> f64 {
    let grown = if factor < most { factor } else { most };
    let next = step * grown;
    // A step cut by the window that was good enough says nothing against the longer one.
    if cut & (grown >= most) & (next < wanted) { wanted } else { next }
}

/// The step after one that was refused.
#[inline(always)]
pub fn after_refused(step: f64, error: f64, factor: f64) -> f64 {
    let known = if factor < SAFE_SHRINK { factor } else { SAFE_SHRINK };
    step * if error < f64::INFINITY { known } else { LEAST }
}

/// Steps are not shorter than this: the clock could not tell their ends apart.
#[inline(always)]
pub fn shortest(from: f64, until: f64) -> f64 {
    4.0 * f64::EPSILON * from.abs().max(until.abs())
}

/// The logarithm to base 2 of a positive number that is not tiny, to 1.2·10⁻⁴; that of infinity is 1024. A step need not be
/// known better than its error, but the next one waits for it: so few operations follow each other.
#[inline(always)]
fn rough_log2(x: f64) -> f64 {
    const WHOLE: f64 = 4_503_599_627_370_496.0; // 2^52: its low bits count
    // The polynomial of degree 4 that is 0 at 1 and 1 at 2 and strays least between.
    const P: [f64; 5] = [
        -2.519_829_174_141_391,
        4.086_382_797_461_809,
        -2.134_134_463_629_906,
        0.649_711_501_401_801,
        -0.082_130_661_092_313_23,
    ];
    let bits = x.to_bits();
    let exponent = f64::from_bits((bits >> 52) | WHOLE.to_bits()) - (WHOLE + 1023.0);
    let m = f64::from_bits((bits & (u64::MAX >> 12)) | 1.0_f64.to_bits());
    let square = m * m;
    exponent + ((P[0] + P[1] * m) + square * ((P[2] + P[3] * m) + square * P[4]))
}

/// 2 to a power between −1000 and 1000, to 8·10⁻⁵ of it.
#[inline(always)]
fn rough_exp2(x: f64) -> f64 {
    const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5·2^52: adding it leaves a whole number in the low bits
    // The polynomial of degree 3 that strays least between −½ and ½.
    const P: [f64; 4] =
        [0.999_928_060_136_914_6, 0.693_261_019_172_029_9, 0.242_611_357_297_266_54, 0.055_171_552_215_402_19];
    let shifted = x + ROUND;
    let r = x - (shifted - ROUND);
    let value = (P[0] + P[1] * r) + (r * r) * (P[2] + P[3] * r);
    f64::from_bits(value.to_bits().wrapping_add(shifted.to_bits() << 52))
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
            // The inverse first: it is known before the error is.
            let ratio = error[l].abs() * (1.0 / (absolute + tolerances.relative * size));
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

#[cfg(test)]
mod tests {
    use super::{Controller, EXPLICIT, LEAST, SIXTH, STIFF};

    #[test]
    fn the_factor_is_the_formula_to_a_ten_thousandth() {
        let exact = |controller: &Controller, error: f64, last: f64| {
            let power = error.max(1e-8).powf(-controller.now) * last.max(1e-4).powf(controller.before);
            (0.9 * power).min(controller.most).max(LEAST)
        };
        for controller in [EXPLICIT, SIXTH, STIFF] {
            for (a, b) in (0..4000).flat_map(|a| (0..13).map(move |b| (a, b))) {
                let (error, last) = (10_f64.powf(0.01 * f64::from(a) - 12.0), 10_f64.powf(-0.5 * f64::from(b)));
                let (found, exact) = (controller.factor(error, last), exact(&controller, error, last));
                assert!((found / exact - 1.0).abs() < 1e-4, "{error:e} after {last:e}: {found}, not {exact}");
            }
            assert_eq!(controller.factor(f64::INFINITY, 1.0), LEAST);
            assert_eq!(controller.factor(0.0, 1.0), controller.most);
        }
    }
}
