//! Explicit steps: the pairs of Tsitouras and of Verner, the classical method of order 4 and Euler's.

use pulp::{Scalar, Simd};

use super::scratch::{LooksBack, Scratch};
use super::tableau::tsitouras::D;
use super::tableau::{tsitouras as five, verner as six};
use super::wide::{combine, combine_from};
use crate::equations::program::{Lanes, Program};

/// The rates at the state that the first `W` stages give, at a share of the step, as the next stage.
#[inline(always)]
fn stage<S: Simd, const W: usize, const L: usize, P: LooksBack<L>>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L, P>,
    (weights, share): (&[f64; W], f64),
    time: &Lanes<L>,
    step: &Lanes<L>,
) {
    let n = s.state.len();
    for v in 0..n {
        combine_from(simd, weights, &s.stages, (n, v), &s.state[v], step, &mut s.file[1 + v]);
    }
    let clock = &mut s.file[0];
    for l in 0..L {
        clock[l] = time[l] + share * step[l];
    }
    s.rates_into(simd, program, W);
}

/// One step of the pair from (time, state), whose rates are stage 0. Leaves proposal, error, and the rates at the
/// proposal as the last stage.
#[inline(always)]
pub fn tsitouras<S: Simd, const L: usize, P: LooksBack<L>>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L, P>,
    time: &Lanes<L>,
    step: &Lanes<L>,
) {
    let n = s.state.len();
    stage(simd, program, s, (&five::A2, five::C[1]), time, step);
    stage(simd, program, s, (&five::A3, five::C[2]), time, step);
    stage(simd, program, s, (&five::A4, five::C[3]), time, step);
    stage(simd, program, s, (&five::A5, five::C[4]), time, step);
    stage(simd, program, s, (&five::A6, five::C[5]), time, step);
    stage(simd, program, s, (&five::B, five::C[6]), time, step);
    s.proposal.copy_from_slice(&s.file[1..=n]);
    for v in 0..n {
        combine(simd, &five::E, &s.stages, (n, v), [0.0; L], step, &mut s.error[v]);
    }
}

/// As [`tsitouras`], for the pair of order 6(5).
#[inline(always)]
pub fn verner<S: Simd, const L: usize, P: LooksBack<L>>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L, P>,
    time: &Lanes<L>,
    step: &Lanes<L>,
) {
    let n = s.state.len();
    stage(simd, program, s, (&six::A2, six::C[1]), time, step);
    stage(simd, program, s, (&six::A3, six::C[2]), time, step);
    stage(simd, program, s, (&six::A4, six::C[3]), time, step);
    stage(simd, program, s, (&six::A5, six::C[4]), time, step);
    stage(simd, program, s, (&six::A6, six::C[5]), time, step);
    stage(simd, program, s, (&six::A7, six::C[6]), time, step);
    stage(simd, program, s, (&six::A8, six::C[7]), time, step);
    stage(simd, program, s, (&six::B, six::C[8]), time, step);
    s.proposal.copy_from_slice(&s.file[1..=n]);
    for v in 0..n {
        combine(simd, &six::E, &s.stages, (n, v), [0.0; L], step, &mut s.error[v]);
    }
}

/// The stage of the pair of order 6(5) in the middle of its step, for [`verner_between`].
const MIDDLE: usize = 9;

/// The state in the middle of the last step of the pair of order 6(5), with its rates as one more stage.
pub fn verner_middle<P: LooksBack<1>>(
    program: &Program,
    s: &mut Scratch<1, P>,
    time: f64,
    step: f64,
    middle: &mut Vec<f64>,
) {
    stage(Scalar, program, s, (&six::MIDDLE, 0.5), &[time], &[step]);
    middle.clear();
    middle.extend(s.file[1..=s.state.len()].iter().map(|value| value[0]));
}

/// The state at a share of the last step of the pair of order 6(5), eq. (ode.5): the polynomial of degree 5 with the values and rates at its begin,
/// middle and end.
pub fn verner_between<P>(s: &Scratch<1, P>, step: f64, share: f64, middle: &[f64], state: &mut [f64]) {
    let n = state.len();
    let (x, rest) = (share, 1.0 - share);
    let (x2, rest2, centre2) = (x * x, rest * rest, (1.0 - 2.0 * x) * (1.0 - 2.0 * x));
    for (v, value) in state.iter_mut().enumerate() {
        let begin = s.state[v][0];
        // Changes, so that what stands still does so to the last bit.
        let (half, whole) = (middle[v] - begin, s.proposal[v][0] - begin);
        let [first, centre, last] = [0, MIDDLE, 8].map(|stage| step * s.stages[stage * n + v][0]);
        let by_begin = rest2 * centre2 * x * first;
        let by_middle = 16.0 * x2 * rest2 * (half + (x - 0.5) * centre);
        let by_end = x2 * centre2 * (whole + rest * (6.0 * whole - last));
        *value = begin + (by_begin + by_middle + by_end);
    }
}

/// The state at a share of the last step of the pair of order 5(4), after a step that was accepted.
pub fn tsitouras_between<P>(s: &Scratch<1, P>, step: f64, share: f64, state: &mut [f64]) {
    let n = state.len();
    let weights = D.map(|row| row.iter().rev().fold(0.0, |sum, weight| (sum + weight) * share));
    for (v, value) in state.iter_mut().enumerate() {
        let sum: f64 = weights.iter().enumerate().map(|(stage, weight)| weight * s.stages[stage * n + v][0]).sum();
        *value = s.state[v][0] + step * sum;
    }
}

/// One step of the classical method of order 4 from (time, state).
#[inline(always)]
pub fn classical<S: Simd, const L: usize, P: LooksBack<L>>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L, P>,
    time: Lanes<L>,
    step: Lanes<L>,
) {
    const SHARE: [f64; 4] = [0.0, 0.5, 0.5, 1.0];
    let n = s.state.len();
    for stage in 0..4 {
        for v in 0..n {
            for l in 0..L {
                let slope = if stage == 0 { 0.0 } else { s.stages[(stage - 1) * n + v][l] };
                s.file[1 + v][l] = s.state[v][l] + SHARE[stage] * step[l] * slope;
            }
        }
        for l in 0..L {
            s.file[0][l] = time[l] + SHARE[stage] * step[l];
        }
        s.rates_into(simd, program, stage);
    }
    for v in 0..n {
        for l in 0..L {
            let outer = s.stages[v][l] + s.stages[3 * n + v][l];
            let inner = s.stages[n + v][l] + s.stages[2 * n + v][l];
            s.proposal[v][l] = s.state[v][l] + step[l] * (outer + 2.0 * inner) / 6.0;
        }
    }
}

/// One step of Euler's method from (time, state).
#[inline(always)]
pub fn euler<S: Simd, const L: usize, P: LooksBack<L>>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L, P>,
    time: Lanes<L>,
    step: Lanes<L>,
) {
    s.rates_at_state(simd, program, time);
    for v in 0..s.state.len() {
        for l in 0..L {
            s.proposal[v][l] = s.state[v][l] + step[l] * s.stages[v][l];
        }
    }
}
