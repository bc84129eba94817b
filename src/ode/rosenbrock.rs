//! The step for stiff systems, eq. (ode.2).

use pulp::{Simd, WithSimd};

use super::linear::Linear;
use super::scratch::{LooksBack, Scratch};
use super::tableau::rodas::{A1, A2, A3, A4, A5, C, D2, D3, G, GAMMA, K1, K2, K3, K4, K5, STAGES};
use super::wide::{combine, negated_where_finite, take_away};
use crate::equations::program::{Lanes, Program, run_wide};

/// One step from (time, state). Leaves proposal, error and the stages. Derivatives that are not finite (a root at 0,
/// say) count as 0: the error estimate then decides about the step. Where values keep to their side of nothing, what they were beyond it at
/// the end counts as an error.
#[inline(always)]
pub fn step<S: Simd, const L: usize, P: LooksBack<L>>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L, P>,
    time: &Lanes<L>,
    step: &Lanes<L>,
) {
    let n = s.state.len();
    let mut inverse = *step;
    for l in 0..L {
        inverse[l] = 1.0 / step[l];
    }
    prepare(simd, program, s, time, &inverse);
    let clock = Clock { time, step, inverse: &inverse };
    solve_stage(simd, program, s, 0, &clock);
    stage(simd, program, s, &A1, &K1, &clock);
    stage(simd, program, s, &A2, &K2, &clock);
    stage(simd, program, s, &A3, &K3, &clock);
    stage(simd, program, s, &A4, &K4, &clock);
    stage(simd, program, s, &A5, &K5, &clock);
    for v in 0..n {
        let last = s.stages[(STAGES - 1) * n + v];
        s.error[v] = last;
        let proposal = &mut s.proposal[v];
        for l in 0..L {
            proposal[l] += last[l];
        }
    }
    if s.keeps_side {
        for v in 0..n {
            let floor = s.floor_of(v);
            for l in 0..L {
                let below = floor[l] - s.proposal[v][l];
                if below > 0.0 {
                    s.proposal[v][l] = floor[l];
                    s.error[v][l] = s.error[v][l].abs() + below;
                }
            }
        }
    }
}

/// When the step begins, its length and one over it.
struct Clock<'a, const L: usize> {
    time: &'a Lanes<L>,
    step: &'a Lanes<L>,
    inverse: &'a Lanes<L>,
}

/// The stage after the first `W`: its argument, its rates, its right side and its linear system.
#[inline(always)]
fn stage<S: Simd, const W: usize, const L: usize, P: LooksBack<L>>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L, P>,
    argument: &[f64; W],
    right: &[f64; W],
    clock: &Clock<L>,
) {
    let n = s.state.len();
    for v in 0..n {
        combine(simd, argument, &s.stages, (n, v), s.state[v], &[1.0; L], &mut s.file[1 + v]);
    }
    let now = &mut s.file[0];
    for l in 0..L {
        now[l] = clock.time[l] + C[W] * clock.step[l];
    }
    s.proposal.copy_from_slice(&s.file[1..=n]);
    // Rates are those of what is kept; what the step comes to is told as it is.
    if s.keeps_side {
        for v in 0..n {
            let floor = s.floor_of(v);
            for l in 0..L {
                let value = &mut s.file[1 + v][l];
                *value = if *value < floor[l] { floor[l] } else { *value };
            }
        }
    }
    s.rates_into(simd, program, W);
    let (earlier, present) = s.stages.split_at_mut(W * n);
    for (v, rate) in present[..n].iter_mut().enumerate() {
        combine(simd, right, earlier, (n, v), *rate, clock.inverse, rate);
    }
    solve_stage(simd, program, s, W, clock);
}

/// The linear system of a stage whose right side lacks only the derivative by time.
#[inline(always)]
fn solve_stage<S: Simd, const L: usize, P>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L, P>,
    stage: usize,
    clock: &Clock<L>,
) {
    let n = s.state.len();
    let present = &mut s.stages[stage * n..(stage + 1) * n];
    if G[stage] != 0.0 && !program.timeless {
        let mut weight = *clock.step;
        for l in 0..L {
            weight[l] *= G[stage];
        }
        for (rate, negated) in present.iter_mut().zip(&s.drift) {
            take_away(simd, rate, &weight, negated);
        }
    }
    simd.vectorize(Solve { linear: &mut s.linear, program, right: present });
}

/// The linear system of a stage, as an object: a function of its own for each kind of registers, not one in each stage.
struct Solve<'a, const L: usize> {
    linear: &'a mut Linear<L>,
    program: &'a Program,
    right: &'a mut [Lanes<L>],
}

impl<const L: usize> WithSimd for Solve<'_, L> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.linear.solve(simd, self.program, self.right);
    }
}

/// What a rate takes in a step from a variable that is nothing, over the absolute tolerance, beyond which it is no round-off: the equations lead
/// below nothing, and it is not kept from going there.
const FALLS: f64 = 1e-9;

/// Rates, derivatives and the factored matrix 1/(γ·step) − J at (time, state).
#[inline(always)]
fn prepare<S: Simd, const L: usize, P: LooksBack<L>>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L, P>,
    time: &Lanes<L>,
    inverse: &Lanes<L>,
) {
    let n = s.state.len();
    s.file[0] = *time;
    s.file[1..=n].copy_from_slice(&s.state);
    s.past.fill(program, &program.linear, &mut s.file);
    run_wide(simd, &program.linear, &mut s.file);
    for v in 0..n {
        s.stages[v] = s.file[program.linear.outputs[v] as usize];
        if !program.timeless {
            // Kept with the other sign, as the matrix is.
            negated_where_finite(simd, &s.file[program.linear.outputs[n + v] as usize], &mut s.drift[v]);
        }
    }
    if s.keeps_side {
        let least = FALLS * s.absolute;
        for v in 0..n {
            for l in 0..L {
                if s.state[v][l] == 0.0 && s.stages[v][l] < -least * program.sizes[v] * inverse[l] {
                    s.floor[l] = f64::NEG_INFINITY;
                }
            }
        }
    }
    let mut diagonal = *inverse;
    for l in 0..L {
        diagonal[l] *= 1.0 / GAMMA;
    }
    s.linear.factor(simd, program, &s.file, &diagonal);
}

/// The state at a share of the last step, after a step that was accepted.
pub fn between<P>(s: &Scratch<1, P>, share: f64, state: &mut [f64]) {
    let n = state.len();
    for (v, value) in state.iter_mut().enumerate() {
        let weighted = |weights: &[f64; 5]| -> f64 {
            weights.iter().enumerate().map(|(stage, weight)| weight * s.stages[stage * n + v][0]).sum()
        };
        let rest = 1.0 - share;
        let bend = weighted(&D2) + share * weighted(&D3);
        // So that what stands still does so to the last bit.
        *value = s.state[v][0] + share * (s.proposal[v][0] - s.state[v][0] + rest * bend);
        if s.keeps_side && s.state[v][0] >= 0.0 && *value < 0.0 {
            *value = 0.0;
        }
    }
}
