//! One block of cells through one window.

use super::control::{self, EXPLICIT, LEAST, STIFF, Tolerances};
use super::scratch::Scratch;
use super::{Method, Reason, Work, explicit, rosenbrock};
use crate::chemistry::program::{Lanes, Program};

/// What a cell keeps between windows for the choice of its step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stride<const L: usize> {
    /// Next step; 0 where none is known.
    pub step: Lanes<L>,
    /// Error of the last step.
    pub error: Lanes<L>,
}

/// The first lane that failed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockTrouble {
    /// The lane.
    pub lane: usize,
    /// Time of its last good state.
    pub time: f64,
    /// The variable that is worst.
    pub variable: Option<usize>,
    /// What is wrong.
    pub reason: Reason,
}

/// Advances `scratch.state` of the first `used` lanes; `scratch.file` has the open quantities. A lane that fails keeps
/// its last good state and does not hinder its neighbours.
#[inline(always)]
pub fn advance<const L: usize>(
    program: &Program,
    method: Method,
    scratch: &mut Scratch<L>,
    stride: &mut Stride<L>,
    used: usize,
    (from, until): (f64, f64),
    tolerances: &Tolerances,
) -> Result<Work, BlockTrouble> {
    match method {
        Method::Rk45 => adaptive::<L, false>(program, scratch, stride, used, (from, until), tolerances),
        Method::Rosenbrock => adaptive::<L, true>(program, scratch, stride, used, (from, until), tolerances),
        Method::Rk4 { step } => fixed::<L, true>(program, scratch, used, (from, until), step),
        Method::Euler { step } => fixed::<L, false>(program, scratch, used, (from, until), step),
    }
}

#[inline(always)]
fn adaptive<const L: usize, const STIFFLY: bool>(
    program: &Program,
    s: &mut Scratch<L>,
    stride: &mut Stride<L>,
    used: usize,
    (from, until): (f64, f64),
    tolerances: &Tolerances,
) -> Result<Work, BlockTrouble> {
    let n = s.state.len();
    let controller = if STIFFLY { STIFF } else { EXPLICIT };
    let (mut work, mut trouble) = (Work::default(), None);
    let (mut time, mut active, mut refused) = ([from; L], [false; L], [false; L]);
    active[..used].fill(true);
    let mut left = used;
    if !STIFFLY || (0..used).any(|l| stride.step[l] <= 0.0) {
        s.rates_at_state(program, time);
        work.rates += used as u64;
    }
    if (0..used).any(|l| stride.step[l] <= 0.0) {
        let guess = control::first_step(&s.state, &s.stages[..n], &program.sizes, until - from, tolerances);
        for l in 0..L {
            stride.step[l] = if stride.step[l] > 0.0 { stride.step[l] } else { guess[l] };
        }
    }
    let shortest = 4.0 * f64::EPSILON * from.abs().max(until.abs());
    let mut round = 0;
    while left > 0 {
        let mut step = [until - from; L];
        let (mut last, mut cut) = ([false; L], [false; L]);
        for l in 0..L {
            let rest = until - time[l];
            last[l] = stride.step[l] >= rest * (1.0 - 1e-10);
            cut[l] = stride.step[l] > 0.5 * rest;
            let within = if cut[l] { 0.5 * rest } else { stride.step[l] };
            let within = if last[l] { rest } else { within };
            step[l] = if active[l] { within } else { step[l] };
        }
        if STIFFLY {
            rosenbrock::step(program, s, time, step);
        } else {
            explicit::tsitouras(program, s, time, step);
        }
        work.rates += 6 * left as u64;
        work.jacobians += if STIFFLY { left as u64 } else { 0 };
        let error = control::norm(&s.error, &s.state, &s.proposal, &program.sizes, tolerances);
        let mut factor = [1.0; L];
        for l in 0..L {
            factor[l] = controller.factor(error[l], stride.error[l]);
        }
        let mut accepted = [false; L];
        round += 1;
        for l in 0..L {
            if !active[l] {
                continue;
            }
            // A norm that is not a number compares false and is refused.
            accepted[l] = error[l] <= 1.0;
            if accepted[l] {
                time[l] = if last[l] { until } else { time[l] + step[l] };
                let most = if refused[l] { 1.0 } else { controller.most };
                let next = step[l] * factor[l].min(most);
                // A step cut by the window that was good enough says nothing against the longer one.
                let capped = (cut[l] || last[l]) && factor[l] >= most.min(controller.most);
                stride.step[l] = if capped { next.max(stride.step[l]) } else { next };
                stride.error[l] = error[l];
                work.steps += 1;
            } else {
                let shrink = if error[l] < f64::INFINITY { factor[l].min(SAFE_SHRINK) } else { LEAST };
                stride.step[l] = step[l] * shrink;
                work.rejected += 1;
            }
            refused[l] = !accepted[l];
            let short = !accepted[l] && stride.step[l] <= shortest;
            let endless = round >= tolerances.max_steps && time[l] < until;
            if short || endless {
                let (variable, finite) = s.worst_variable(program, time, l);
                let reason = match (short, finite && error[l].is_finite()) {
                    (false, _) => Reason::TooManySteps,
                    (true, true) => Reason::StepUnderflow,
                    (true, false) => Reason::NotFinite,
                };
                if trouble.is_none_or(|known: BlockTrouble| l < known.lane) {
                    trouble = Some(BlockTrouble { lane: l, time: time[l], variable, reason });
                }
            }
            if short || endless || time[l] >= until {
                active[l] = false;
                left -= 1;
            }
        }
        for v in 0..n {
            for l in 0..L {
                s.state[v][l] = if accepted[l] { s.proposal[v][l] } else { s.state[v][l] };
                if !STIFFLY {
                    s.stages[v][l] = if accepted[l] { s.stages[6 * n + v][l] } else { s.stages[v][l] };
                }
            }
        }
    }
    trouble.map_or(Ok(work), Err)
}

/// A refused step shrinks at least to this share.
const SAFE_SHRINK: f64 = 0.9;

/// Equal inner steps no longer than `longest`.
#[inline(always)]
fn fixed<const L: usize, const CLASSICAL: bool>(
    program: &Program,
    s: &mut Scratch<L>,
    used: usize,
    (from, until): (f64, f64),
    longest: f64,
) -> Result<Work, BlockTrouble> {
    let n = s.state.len();
    // An inner step that goes into the window but for round-off does so exactly.
    let count = ((until - from) / longest - 1e-9).ceil().max(1.0);
    let step = [(until - from) / count; L];
    let mut trouble: Option<BlockTrouble> = None;
    for number in 0..count as u64 {
        let time = [from + number as f64 * step[0]; L];
        if CLASSICAL {
            explicit::classical(program, s, time, step);
        } else {
            explicit::euler(program, s, time, step);
        }
        for v in 0..n {
            for l in 0..L {
                let good = s.proposal[v][l].is_finite();
                if !good && l < used && trouble.is_none_or(|known| l < known.lane) {
                    trouble =
                        Some(BlockTrouble { lane: l, time: time[l], variable: Some(v), reason: Reason::NotFinite });
                }
            }
        }
        if let Some(trouble) = trouble {
            return Err(trouble);
        }
        s.state.copy_from_slice(&s.proposal);
    }
    let steps = count as u64 * used as u64;
    Ok(Work { steps, rates: steps * if CLASSICAL { 4 } else { 1 }, ..Work::default() })
}
