//! What the stages of the implicit step have in common: what counts of a stiffness in their matrix and of their forces in the step, and how
//! errors are measured.

use super::kind::Kind;
use crate::mechanics::integrator::Order;
use crate::mechanics::lanes::LANES;

/// γ of the two-stage scheme where K is a good stand-in for the true stiffness: damps what contacts make ring, for any K at or above a half
/// of the true stiffness.
const DAMPING: f64 = 1.0;

/// The same where K is far too large for some shapes, which are damped by that, and relax too slowly as it is.
const EXACT: f64 = 0.5;

/// The same with the tangent stiffness of each cell.
const TANGENT: f64 = 1.0;

/// What counts of the slopes of forces between cells in the matrix of the step.
pub const OF_SLOPES: f64 = 1.0;

/// γ for an order.
pub fn gamma(kind: &Kind, order: Order) -> f64 {
    match order {
        Order::First => 1.0,
        Order::Second if kind.tangent.is_some() => TANGENT,
        Order::Second if kind.is_told() => DAMPING,
        Order::Second => EXACT,
    }
}

/// What forces of a stage count of what moves a cell as a whole: (step.3) moves it by the mean of both.
pub fn share_of_stage(order: Order) -> f64 {
    match order {
        Order::First => 1.0,
        Order::Second => 0.5,
    }
}

/// The largest root mean square over the atoms of a cell of a block, µm.
pub fn root_mean_square(kind: &Kind, errors: &[f64]) -> f64 {
    let mut squares = [0.0; LANES];
    for errors in errors.chunks_exact(kind.lanes) {
        squares.iter_mut().zip(errors).for_each(|(square, error)| *square += error * error);
    }
    let largest = squares[..kind.lanes].iter().copied().fold(0.0, larger);
    (largest / kind.atoms() as f64).sqrt()
}

/// The larger of two numbers, or whatever is not a number.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}
