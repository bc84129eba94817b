//! Explicit steps: the Dormand–Prince pair, the classical method of order 4 and Euler's.

use super::scratch::Scratch;
use super::tableau::dormand_prince::{A, C, D, E, STAGES};
use crate::chemistry::program::{Lanes, Program};

/// One step of the pair from (time, state), whose rates are stage 0. Leaves proposal, error, and the rates at the
/// proposal as the last stage.
#[inline(always)]
pub fn dormand_prince<const L: usize>(program: &Program, s: &mut Scratch<L>, time: Lanes<L>, step: Lanes<L>) {
    let n = s.state.len();
    for stage in 1..STAGES {
        for v in 0..n {
            let mut sum = [0.0; L];
            for (earlier, &weight) in A[stage][..stage].iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
                let slope = &s.stages[earlier * n + v];
                for l in 0..L {
                    sum[l] += weight * slope[l];
                }
            }
            let begin = s.state[v];
            for l in 0..L {
                sum[l] = begin[l] + step[l] * sum[l];
            }
            s.file[1 + v] = sum;
            s.proposal[v] = sum;
        }
        for l in 0..L {
            s.file[0][l] = time[l] + C[stage] * step[l];
        }
        s.rates_into(program, stage);
    }
    for v in 0..n {
        let mut sum = [0.0; L];
        for (stage, &weight) in E.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
            let slope = &s.stages[stage * n + v];
            for l in 0..L {
                sum[l] += weight * slope[l];
            }
        }
        for l in 0..L {
            s.error[v][l] = step[l] * sum[l];
        }
    }
}

/// The state at a share of the last step of the pair, after a step that was accepted.
pub fn dormand_prince_between(s: &Scratch<1>, step: f64, share: f64, state: &mut [f64]) {
    let n = state.len();
    let slope = |stage: usize, v: usize| s.stages[stage * n + v][0];
    for (v, value) in state.iter_mut().enumerate() {
        let (begin, change) = (s.state[v][0], s.proposal[v][0] - s.state[v][0]);
        let bend = step * slope(0, v) - change;
        let far = change - step * slope(6, v) - bend;
        let last: f64 = step * D.iter().enumerate().map(|(stage, weight)| weight * slope(stage, v)).sum::<f64>();
        let rest = 1.0 - share;
        *value = begin + share * (change + rest * (bend + share * (far + rest * last)));
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
