//! The cells of one task through one window.

use std::marker::PhantomData;

use pulp::{Simd, WithSimd};

use super::adaptive::{Adaptive, Rodas, Tsitouras, Verner};
use super::cells::{CellTrouble, Cells, LaneCells};
use super::control::{self, Controller, NEAR, Tolerances};
use super::mask::{self, Mask, both, choose, pick, when};
use super::scratch::Scratch;
use super::{Method, Reason, Work, fixed};
use crate::equations::program::{Lanes, Program};

/// Advances all cells of a task; the constants stand in `scratch.file`. A cell that fails keeps its last good state and
/// does not hinder its neighbours.
///
/// # Errors
/// The trouble of the first cell that failed.
#[inline(always)]
pub fn advance<S: Simd, const L: usize>(
    simd: S,
    program: &Program,
    method: Method,
    scratch: &mut Scratch<L>,
    cells: &mut Cells<L>,
    window: (f64, f64),
    tolerances: &Tolerances,
) -> Result<Work, CellTrouble> {
    match method {
        Method::Rk45 => adaptive::<S, L, Tsitouras>(simd, program, scratch, cells, window, tolerances),
        Method::Rk65 => adaptive::<S, L, Verner>(simd, program, scratch, cells, window, tolerances),
        Method::Rosenbrock => adaptive::<S, L, Rodas>(simd, program, scratch, cells, window, tolerances),
        Method::Rk4 { step } => fixed::advance::<S, L, true>(simd, program, scratch, cells, window, step),
        Method::Euler { step } => fixed::advance::<S, L, false>(simd, program, scratch, cells, window, step),
    }
}

/// Lanes wait for each other until one in so many is free: that costs less than to change cells more often.
const FREE_SHARE: usize = 2;

/// How far each lane has come in the window, beside what goes with its cell.
struct Progress<const L: usize> {
    time: Lanes<L>,
    /// Rounds since the cell entered its lane.
    rounds: Lanes<L>,
    refused: Mask<L>,
}

/// The steps of a round.
struct Round<const L: usize> {
    step: Lanes<L>,
    /// Those that end with the window.
    last: Mask<L>,
    /// Those that would else have been longer than half of what is left, the last ones among them.
    cut: Mask<L>,
}

#[inline(always)]
fn adaptive<S: Simd, const L: usize, M: Adaptive>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L>,
    cells: &mut Cells<L>,
    (from, until): (f64, f64),
    tolerances: &Tolerances,
) -> Result<Work, CellTrouble> {
    let (mut work, mut trouble) = (Work::default(), None);
    let mut lanes = LaneCells::<L>::new();
    let mut progress = Progress { time: [from; L], rounds: [0.0; L], refused: [0; L] };
    let shortest = control::shortest(from, until);
    let open = program.first_open();
    loop {
        sit(&mut lanes, &mut progress, cells, open, s, from);
        let left = mask::count(&lanes.active);
        if left == 0 {
            break;
        }
        begin::<S, L, M>(simd, program, s, &mut lanes, (&progress.time, until - from), tolerances, &mut work);
        let round = plan(&lanes, &progress, (from, until));
        let (time, step, method) = (&progress.time, &round.step, PhantomData::<M>);
        let mut error = simd.vectorize(Attempt { program, s, time, step, tolerances, method });
        let mut tries = left as u64;
        if M::KEEPS_SIDE && is_nan(&error, &lanes.active) && s.keep_sides(&error, &program.sizes, tolerances) {
            error = simd.vectorize(Attempt { program, s, time, step, tolerances, method });
            tries *= 2;
            s.keeps_side = false;
        }
        work.jacobians += M::JACOBIANS * tries;
        work.rates += M::RATES * tries;
        let accepted = judge(&mut lanes, &mut progress, &round, &error, &M::CONTROLLER, until);
        let steps = mask::count(&accepted);
        work.steps += steps as u64;
        work.rejected += (left - steps) as u64;
        advance_state::<L, M>(s, &accepted, steps);
        let (arrived, leaving) = leaving(&lanes, &progress, until, shortest, f64::from(tolerances.max_steps));
        let leave = mask::count(&leaving);
        if leave == 0 {
            continue;
        }
        if mask::count(&arrived) == L && lanes.leave_block(cells, s) {
            continue;
        }
        for l in (0..L).filter(|&l| leaving[l] != 0) {
            if arrived[l] == 0 {
                let known = explain(program, s, (progress.time, lanes.step), l, (lanes.cell[l], error[l], shortest));
                if trouble.is_none_or(|first: CellTrouble| known.cell < first.cell) {
                    trouble = Some(known);
                }
            }
            lanes.leave(l, cells, s, arrived[l] != 0);
        }
    }
    trouble.map_or(Ok(work), Err)
}

/// A step of all lanes, as an object: a function of its own for each method and kind of registers.
struct Attempt<'a, const L: usize, M> {
    program: &'a Program,
    s: &'a mut Scratch<L>,
    time: &'a Lanes<L>,
    step: &'a Lanes<L>,
    tolerances: &'a Tolerances,
    method: PhantomData<M>,
}

impl<const L: usize, M: Adaptive> WithSimd for Attempt<'_, L, M> {
    /// The errors of the lanes, in tolerances.
    type Output = Lanes<L>;
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Lanes<L> {
        let Self { program, s, time, step, tolerances, .. } = self;
        M::step(simd, program, s, time, step);
        control::norm(&s.error, &s.state, &s.proposal, &program.sizes, tolerances)
    }
}

/// Whether the error of an active lane is not a number.
#[inline(always)]
fn is_nan<const L: usize>(error: &Lanes<L>, active: &Mask<L>) -> bool {
    let mut any = 0;
    for l in 0..L {
        any |= active[l] & when(error[l].is_nan());
    }
    any != 0
}

/// The steps that lanes take next: as wanted, or into what is left of the window.
#[inline(always)]
fn plan<const L: usize>(lanes: &LaneCells<L>, progress: &Progress<L>, (from, until): (f64, f64)) -> Round<L> {
    let mut round = Round { step: [0.0; L], last: [0; L], cut: [0; L] };
    for l in 0..L {
        let (rest, wanted) = (until - progress.time[l], lanes.step[l]);
        let (last, cut) = (when(wanted >= rest * NEAR), when(wanted > 0.5 * rest));
        let within = pick(last, rest, pick(cut, 0.5 * rest, wanted));
        round.step[l] = pick(lanes.active[l], within, until - from);
        (round.last[l], round.cut[l]) = (last, cut);
    }
    round
}

/// Looks at the errors of a round: lanes whose step is good enough move on, and all get their next step. Returns the
/// lanes that have moved on.
#[inline(always)]
fn judge<const L: usize>(
    lanes: &mut LaneCells<L>,
    progress: &mut Progress<L>,
    round: &Round<L>,
    error: &Lanes<L>,
    controller: &Controller,
    until: f64,
) -> Mask<L> {
    let (mut factor, mut accepted) = ([1.0; L], [0; L]);
    for l in 0..L {
        factor[l] = controller.factor(error[l], lanes.error[l]);
    }
    for l in 0..L {
        // A norm that is not a number compares false and is refused.
        accepted[l] = lanes.active[l] & when(error[l] <= 1.0);
    }
    for l in 0..L {
        let (step, wanted) = (round.step[l], lanes.step[l]);
        let most = pick(progress.refused[l], 1.0, controller.most);
        let next = control::after_good(step, (wanted, round.cut[l] != 0), factor[l], most);
        lanes.step[l] = pick(accepted[l], next, control::after_refused(step, error[l], factor[l]));
    }
    for l in 0..L {
        let end = pick(round.last[l], until, progress.time[l] + round.step[l]);
        progress.time[l] = pick(accepted[l], end, progress.time[l]);
        lanes.error[l] = pick(accepted[l], error[l], lanes.error[l]);
        progress.refused[l] = !accepted[l];
        progress.rounds[l] += pick(lanes.active[l], 1.0, 0.0);
    }
    accepted
}

/// The lanes that have arrived, and all whose cell leaves: these, and those in trouble.
#[inline(always)]
fn leaving<const L: usize>(
    lanes: &LaneCells<L>,
    progress: &Progress<L>,
    until: f64,
    shortest: f64,
    max_rounds: f64,
) -> (Mask<L>, Mask<L>) {
    let (mut arrived, mut leaving) = ([0; L], [0; L]);
    for l in 0..L {
        let short = progress.refused[l] & when(lanes.step[l] <= shortest);
        let endless = when(progress.rounds[l] >= max_rounds);
        arrived[l] = lanes.active[l] & when(progress.time[l] >= until);
        leaving[l] = arrived[l] | (lanes.active[l] & (short | endless));
    }
    (arrived, leaving)
}

/// Makes proposals that were accepted the state, and with an explicit pair the rates there the first stage.
#[inline(always)]
fn advance_state<const L: usize, M: Adaptive>(s: &mut Scratch<L>, accepted: &Mask<L>, steps: usize) {
    let n = s.state.len();
    if steps == L {
        std::mem::swap(&mut s.state, &mut s.proposal);
        if let Some(last) = M::LAST {
            s.stages.copy_within(last * n..(last + 1) * n, 0);
        }
        return;
    }
    for (state, proposal) in s.state.iter_mut().zip(&s.proposal) {
        choose(state, proposal, accepted);
    }
    if let Some(last) = M::LAST {
        let (first, others) = s.stages.split_at_mut(n);
        for (first, last) in first.iter_mut().zip(&others[(last - 1) * n..last * n]) {
            choose(first, last, accepted);
        }
    }
}

/// Fills free lanes with cells that wait.
#[inline(always)]
fn sit<const L: usize>(
    lanes: &mut LaneCells<L>,
    progress: &mut Progress<L>,
    cells: &Cells<L>,
    open: usize,
    s: &mut Scratch<L>,
    from: f64,
) {
    let free = L - mask::count(&lanes.active);
    if free * FREE_SHARE < L || !lanes.waiting(cells) {
        return;
    }
    if free == L && lanes.take_block(cells, open, s) {
        (progress.time, progress.rounds, progress.refused) = ([from; L], [0.0; L], [0; L]);
        return;
    }
    for l in 0..L {
        if lanes.active[l] == 0 && lanes.take(l, cells, open, s) {
            (progress.time[l], progress.rounds[l], progress.refused[l]) = (from, 0.0, 0);
        }
    }
}

/// What cells that have just sat down need: the rates at their state, and a first step where none is known.
#[inline(always)]
fn begin<S: Simd, const L: usize, M: Adaptive>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L>,
    lanes: &mut LaneCells<L>,
    (time, window): (&Lanes<L>, f64),
    tolerances: &Tolerances,
    work: &mut Work,
) {
    let mut unknown = [0; L];
    for l in 0..L {
        unknown[l] = lanes.active[l] & when(lanes.step[l] <= 0.0);
    }
    let fresh = mask::count(&both(&lanes.fresh, &lanes.active));
    let unknown = mask::count(&unknown) > 0;
    lanes.fresh = [0; L];
    if !unknown && (fresh == 0 || M::LAST.is_none()) {
        return;
    }
    if fresh > 0 {
        // Those of the others come out as they are: the same code at the same time and state.
        s.rates_at_state(simd, program, *time);
        work.rates += fresh as u64;
    }
    if unknown {
        let guess = control::first_step(&s.state, &s.stages[..s.state.len()], &program.sizes, window, tolerances);
        for l in 0..L {
            lanes.step[l] = if lanes.step[l] > 0.0 { lanes.step[l] } else { guess[l] };
        }
    }
}

/// What is wrong with the cell of a lane.
#[inline(never)]
fn explain<const L: usize>(
    program: &Program,
    s: &mut Scratch<L>,
    (time, step): (Lanes<L>, Lanes<L>),
    l: usize,
    (cell, error, shortest): (usize, f64, f64),
) -> CellTrouble {
    let (variable, finite) = s.worst_variable(program, time, l);
    let reason = match (step[l] <= shortest, finite && error.is_finite()) {
        (false, _) => Reason::TooManySteps,
        (true, true) => Reason::StepUnderflow,
        (true, false) => Reason::NotFinite,
    };
    let unknown = if program.searched.is_empty() { None } else { s.lost_unknown(program, time, l) };
    CellTrouble { cell, time: time[l], variable, unknown, reason }
}
