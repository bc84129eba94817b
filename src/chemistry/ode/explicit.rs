//! Explicit steps: the pair of Tsitouras, the classical method of order 4 and Euler's.

use pulp::Simd;

use super::scratch::Scratch;
use super::tableau::tsitouras::{A2, A3, A4, A5, A6, B, C, D, E};
use super::wide::{combine, combine_from};
use crate::chemistry::program::{Lanes, Program};

/// The rates at the state that the first `W` stages give, as the next stage.
#[inline(always)]
fn stage<S: Simd, const W: usize, const L: usize>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L>,
    weights: &[f64; W],
    time: &Lanes<L>,
    step: &Lanes<L>,
) {
    let n = s.state.len();
    for v in 0..n {
        combine_from(simd, weights, &s.stages, (n, v), &s.state[v], step, &mut s.file[1 + v]);
    }
    let clock = &mut s.file[0];
    for l in 0..L {
        clock[l] = time[l] + C[W] * step[l];
    }
    s.rates_into(program, W);
}

/// One step of the pair from (time, state), whose rates are stage 0. Leaves proposal, error, and the rates at the
/// proposal as the last stage.
#[inline(always)]
pub fn tsitouras<S: Simd, const L: usize>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L>,
    time: &Lanes<L>,
    step: &Lanes<L>,
) {
    let n = s.state.len();
    stage(simd, program, s, &A2, time, step);
    stage(simd, program, s, &A3, time, step);
    stage(simd, program, s, &A4, time, step);
    stage(simd, program, s, &A5, time, step);
    stage(simd, program, s, &A6, time, step);
    stage(simd, program, s, &B, time, step);
    s.proposal.copy_from_slice(&s.file[1..=n]);
    for v in 0..n {
        combine(simd, &E, &s.stages, (n, v), [0.0; L], step, &mut s.error[v]);
    }
}

/// The state at a share of the last step of the pair, after a step that was accepted.
pub fn tsitouras_between(s: &Scratch<1>, step: f64, share: f64, state: &mut [f64]) {
    let n = state.len();
    let weights = D.map(|row| row.iter().rev().fold(0.0, |sum, weight| (sum + weight) * share));
    for (v, value) in state.iter_mut().enumerate() {
        let sum: f64 = weights.iter().enumerate().map(|(stage, weight)| weight * s.stages[stage * n + v][0]).sum();
        *value = s.state[v][0] + step * sum;
    }
}

/// One step of the classical method of order 4 from (time, state).
#[inline(always)]
pub fn classical<const L: usize>(program: &Program, s: &mut Scratch<L>, time: Lanes<L>, step: Lanes<L>) {
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
        s.rates_into(program, stage);
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
pub fn euler<const L: usize>(program: &Program, s: &mut Scratch<L>, time: Lanes<L>, step: Lanes<L>) {
    s.rates_at_state(program, time);
    for v in 0..s.state.len() {
        for l in 0..L {
            s.proposal[v][l] = s.state[v][l] + step[l] * s.stages[v][l];
        }
    }
}
