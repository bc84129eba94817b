//! The step for stiff systems.

use super::lu;
use super::scratch::Scratch;
use super::tableau::rodas::{A, C, D2, D3, G, GAMMA, K, STAGES};
use crate::chemistry::program::{Lanes, Program, run};

/// One step from (time, state). Leaves proposal, error and the stages. Derivatives that are not finite (a root at 0,
/// say) count as 0: the error estimate then decides about the step.
#[inline(always)]
pub fn step<const L: usize>(program: &Program, s: &mut Scratch<L>, time: Lanes<L>, step: Lanes<L>) {
    let n = s.state.len();
    prepare(program, s, time, step);
    for stage in 0..STAGES {
        if stage > 0 {
            for v in 0..n {
                let mut sum = s.state[v];
                for (earlier, &weight) in A[stage][..stage].iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
                    let slope = &s.stages[earlier * n + v];
                    for l in 0..L {
                        sum[l] += weight * slope[l];
                    }
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
            for (earlier, &weight) in K[stage][..stage].iter().enumerate() {
                let slope = &s.stages[earlier * n + v];
                for l in 0..L {
                    sum[l] += weight * slope[l];
                }
            }
            let (rate, drift) = (s.stages[stage * n + v], s.drift[v]);
            for l in 0..L {
                sum[l] = rate[l] + sum[l] / step[l] + G[stage] * step[l] * drift[l];
            }
            s.stages[stage * n + v] = sum;
        }
        lu::solve(&s.matrix, n, &s.swaps, &mut s.stages[stage * n..(stage + 1) * n]);
    }
    for v in 0..n {
        let last = s.stages[(STAGES - 1) * n + v];
        s.error[v] = last;
        for l in 0..L {
            s.proposal[v][l] += last[l];
        }
    }
}

/// Rates, derivatives and the factored matrix 1/(γ·step) − J at (time, state).
#[inline(always)]
fn prepare<const L: usize>(program: &Program, s: &mut Scratch<L>, time: Lanes<L>, step: Lanes<L>) {
    let n = s.state.len();
    s.file[0] = time;
    s.file[1..=n].copy_from_slice(&s.state);
    run(&program.linear, &mut s.file);
    let finite = |value: f64| if value.abs() < f64::INFINITY { value } else { 0.0 };
    for v in 0..n {
        s.stages[v] = s.file[program.linear.outputs[v] as usize];
        let drift = s.file[program.linear.outputs[n + v] as usize];
        for l in 0..L {
            s.drift[v][l] = finite(drift[l]);
        }
    }
    s.matrix.fill([0.0; L]);
    for (&(row, column), &register) in program.pattern.iter().zip(&program.linear.outputs[2 * n..]) {
        let entry = s.file[register as usize];
        let to = &mut s.matrix[row as usize * n + column as usize];
        for l in 0..L {
            to[l] = -finite(entry[l]);
        }
    }
    for v in 0..n {
        for l in 0..L {
            s.matrix[v * n + v][l] += 1.0 / (GAMMA * step[l]);
        }
    }
    lu::factor(&mut s.matrix, n, &mut s.swaps);
}

/// The state at a share of the last step, after a step that was accepted.
pub fn between(s: &Scratch<1>, share: f64, state: &mut [f64]) {
    let n = state.len();
    for (v, value) in state.iter_mut().enumerate() {
        let weighted = |weights: &[f64; 5]| -> f64 {
            weights.iter().enumerate().map(|(stage, weight)| weight * s.stages[stage * n + v][0]).sum()
        };
        let rest = 1.0 - share;
        let bend = weighted(&D2) + share * weighted(&D3);
        *value = rest * s.state[v][0] + share * (s.proposal[v][0] + rest * bend);
    }
}
