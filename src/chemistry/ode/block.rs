//! The cells of one task through one window.

use pulp::Simd;

use super::cells::{Cells, Seats};
use super::control::{self, EXPLICIT, LEAST, STIFF, Tolerances};
use super::scratch::Scratch;
use super::{Method, Reason, Work, explicit, rosenbrock};
use crate::chemistry::program::{Lanes, Program};

/// The first cell of a task that failed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellTrouble {
    /// The cell, counted from the task's first.
    pub cell: usize,
    /// Time of its last good state.
    pub time: f64,
    /// The variable that is worst.
    pub variable: Option<usize>,
    /// What is wrong.
    pub reason: Reason,
}

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
        Method::Rk45 => adaptive::<S, L, false>(simd, program, scratch, cells, window, tolerances),
        Method::Rosenbrock => adaptive::<S, L, true>(simd, program, scratch, cells, window, tolerances),
        Method::Rk4 { step } => fixed::<L, true>(program, scratch, cells, window, step),
        Method::Euler { step } => fixed::<L, false>(program, scratch, cells, window, step),
    }
}

/// A refused step shrinks at least to this share.
const SAFE_SHRINK: f64 = 0.9;

/// Lanes wait for each other until one in so many is free: that costs less than to change cells more often.
const FREE_SHARE: usize = 2;

/// What is known of each lane on its way through the window.
struct Way<const L: usize> {
    time: Lanes<L>,
    step: Lanes<L>,
    error: Lanes<L>,
    /// Rounds since the cell took its seat.
    rounds: [u32; L],
    refused: [bool; L],
    /// Whether the rates at the state are not known.
    fresh: [bool; L],
}

#[inline(always)]
fn adaptive<S: Simd, const L: usize, const STIFFLY: bool>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L>,
    cells: &mut Cells<L>,
    (from, until): (f64, f64),
    tolerances: &Tolerances,
) -> Result<Work, CellTrouble> {
    let n = s.state.len();
    let controller = if STIFFLY { STIFF } else { EXPLICIT };
    let (mut work, mut trouble) = (Work::default(), None);
    let mut seats = Seats::<L>::new();
    let mut way =
        Way { time: [from; L], step: [0.0; L], error: [1.0; L], rounds: [0; L], refused: [false; L], fresh: [true; L] };
    let shortest = 4.0 * f64::EPSILON * from.abs().max(until.abs());
    let open = program.first_open();
    loop {
        sit(&mut seats, &mut way, cells, open, s, from);
        let left = seats.active.iter().filter(|active| **active).count();
        if left == 0 {
            break;
        }
        begin::<L, STIFFLY>(program, s, &seats, &mut way, until - from, tolerances, &mut work);
        let (mut step, mut last, mut cut) = ([0.0; L], [false; L], [false; L]);
        for l in 0..L {
            let (rest, wanted) = (until - way.time[l], way.step[l]);
            last[l] = wanted >= rest * (1.0 - 1e-10);
            cut[l] = wanted > 0.5 * rest;
            let within = if cut[l] { 0.5 * rest } else { wanted };
            let within = if last[l] { rest } else { within };
            step[l] = if seats.active[l] { within } else { until - from };
        }
        if STIFFLY {
            rosenbrock::step(simd, program, s, &way.time, &step);
            work.jacobians += left as u64;
        } else {
            explicit::tsitouras(simd, program, s, &way.time, &step);
        }
        work.rates += 6 * left as u64;
        let error = control::norm(&s.error, &s.state, &s.proposal, &program.sizes, tolerances);
        let mut factor = [1.0; L];
        for l in 0..L {
            factor[l] = controller.factor(error[l], way.error[l]);
        }
        let (mut accepted, mut leaving, mut any_leaves, mut all_leave) = ([false; L], [false; L], false, true);
        for l in 0..L {
            // A norm that is not a number compares false and is refused.
            accepted[l] = seats.active[l] & (error[l] <= 1.0);
            let most = if way.refused[l] { 1.0 } else { controller.most };
            let grown = if factor[l] < most { factor[l] } else { most };
            let next = step[l] * grown;
            // A step cut by the window that was good enough says nothing against the longer one.
            let keeps = (cut[l] | last[l]) & (grown >= most) & (next < way.step[l]);
            let next = if keeps { way.step[l] } else { next };
            let known = if factor[l] < SAFE_SHRINK { factor[l] } else { SAFE_SHRINK };
            let shrunk = step[l] * if error[l] < f64::INFINITY { known } else { LEAST };
            let end = if last[l] { until } else { way.time[l] + step[l] };
            way.time[l] = if accepted[l] { end } else { way.time[l] };
            way.step[l] = if accepted[l] { next } else { shrunk };
            way.error[l] = if accepted[l] { error[l] } else { way.error[l] };
            way.refused[l] = !accepted[l];
            way.rounds[l] += u32::from(seats.active[l]);
            let short = !accepted[l] & (way.step[l] <= shortest);
            let endless = way.rounds[l] >= tolerances.max_steps;
            leaving[l] = seats.active[l] & (short | endless | (way.time[l] >= until));
            any_leaves |= leaving[l];
            all_leave &= leaving[l];
        }
        let steps = accepted.iter().filter(|accepted| **accepted).count();
        work.steps += steps as u64;
        work.rejected += (left - steps) as u64;
        for (state, proposal) in s.state.iter_mut().zip(&s.proposal) {
            choose(state, proposal, &accepted);
        }
        if !STIFFLY {
            let (first, others) = s.stages.split_at_mut(n);
            for (first, last) in first.iter_mut().zip(&others[5 * n..]) {
                choose(first, last, &accepted);
            }
        }
        if !any_leaves {
            continue;
        }
        for l in (0..L).filter(|&l| leaving[l] && way.time[l] < until) {
            let known = explain(program, s, &way, l, (seats.cell[l], error[l], shortest));
            if trouble.is_none_or(|first: CellTrouble| known.cell < first.cell) {
                trouble = Some(known);
            }
        }
        if all_leave && seats.leave_block(cells, s, &way.step, &way.error) {
            continue;
        }
        for l in (0..L).filter(|&l| leaving[l]) {
            seats.leave(l, cells, s, &way.step, &way.error);
        }
    }
    trouble.map_or(Ok(work), Err)
}

/// Takes over some lanes of another.
#[inline(always)]
fn choose<const L: usize>(to: &mut Lanes<L>, from: &Lanes<L>, lanes: &[bool; L]) {
    for l in 0..L {
        to[l] = if lanes[l] { from[l] } else { to[l] };
    }
}

/// Fills free lanes with cells that wait.
#[inline(always)]
fn sit<const L: usize>(
    seats: &mut Seats<L>,
    way: &mut Way<L>,
    cells: &Cells<L>,
    open: usize,
    s: &mut Scratch<L>,
    from: f64,
) {
    let free = seats.active.iter().filter(|active| !**active).count();
    if free * FREE_SHARE < L || !seats.waiting(cells) {
        return;
    }
    if seats.take_block(cells, open, s, (&mut way.step, &mut way.error)) {
        (way.time, way.rounds, way.refused, way.fresh) = ([from; L], [0; L], [false; L], [true; L]);
        return;
    }
    for l in 0..L {
        if !seats.active[l] && seats.take(l, cells, open, s, (&mut way.step, &mut way.error)) {
            (way.time[l], way.rounds[l], way.refused[l], way.fresh[l]) = (from, 0, false, true);
        }
    }
}

/// What cells that have just sat down need: the rates at their state, and a first step where none is known.
#[inline(always)]
fn begin<const L: usize, const STIFFLY: bool>(
    program: &Program,
    s: &mut Scratch<L>,
    seats: &Seats<L>,
    way: &mut Way<L>,
    window: f64,
    tolerances: &Tolerances,
    work: &mut Work,
) {
    let (mut fresh, mut unknown) = (0, false);
    for l in 0..L {
        fresh += u64::from(way.fresh[l] & seats.active[l]);
        unknown |= seats.active[l] & (way.step[l] <= 0.0);
    }
    if fresh == 0 || (STIFFLY && !unknown) {
        way.fresh = [false; L];
        return;
    }
    // Those of the others come out as they are: the same code at the same time and state.
    s.rates_at_state(program, way.time);
    work.rates += fresh;
    if unknown {
        let guess = control::first_step(&s.state, &s.stages[..s.state.len()], &program.sizes, window, tolerances);
        for l in 0..L {
            way.step[l] = if way.step[l] > 0.0 { way.step[l] } else { guess[l] };
        }
    }
    way.fresh = [false; L];
}

/// What is wrong with the cell of a lane.
#[inline(never)]
fn explain<const L: usize>(
    program: &Program,
    s: &mut Scratch<L>,
    way: &Way<L>,
    l: usize,
    (cell, error, shortest): (usize, f64, f64),
) -> CellTrouble {
    let (variable, finite) = s.worst_variable(program, way.time, l);
    let reason = match (way.step[l] <= shortest, finite && error.is_finite()) {
        (false, _) => Reason::TooManySteps,
        (true, true) => Reason::StepUnderflow,
        (true, false) => Reason::NotFinite,
    };
    CellTrouble { cell, time: way.time[l], variable, reason }
}

/// Equal inner steps no longer than `longest`.
#[inline(always)]
fn fixed<const L: usize, const CLASSICAL: bool>(
    program: &Program,
    s: &mut Scratch<L>,
    cells: &mut Cells<L>,
    (from, until): (f64, f64),
    longest: f64,
) -> Result<Work, CellTrouble> {
    let (n, open) = (s.state.len(), program.first_open());
    // An inner step that goes into the window but for round-off does so exactly.
    let count = ((until - from) / longest - 1e-9).ceil().max(1.0);
    let step = (until - from) / count;
    let numbers = cells.given.len() / cells.steps.len();
    let mut trouble: Option<CellTrouble> = None;
    for block in 0..cells.steps.len() {
        s.state.copy_from_slice(&cells.states[block * n..(block + 1) * n]);
        s.file[open..open + numbers].copy_from_slice(&cells.given[block * numbers..(block + 1) * numbers]);
        let mut going = [true; L];
        for number in 0..count as u64 {
            let time = from + number as f64 * step;
            if CLASSICAL {
                explicit::classical(program, s, [time; L], [step; L]);
            } else {
                explicit::euler(program, s, [time; L], [step; L]);
            }
            for l in 0..L {
                let broken = (0..n).find(|&v| !s.proposal[v][l].is_finite());
                if broken.is_some() && going[l] {
                    going[l] = false;
                    let cell = block * L + l;
                    if cell < cells.count && trouble.is_none_or(|known| cell < known.cell) {
                        trouble = Some(CellTrouble { cell, time, variable: broken, reason: Reason::NotFinite });
                    }
                }
            }
            for (state, proposal) in s.state.iter_mut().zip(&s.proposal) {
                choose(state, proposal, &going);
            }
        }
        cells.states[block * n..(block + 1) * n].copy_from_slice(&s.state);
    }
    let steps = count as u64 * cells.count as u64;
    let work = Work { steps, rates: steps * if CLASSICAL { 4 } else { 1 }, ..Work::default() };
    trouble.map_or(Ok(work), Err)
}
