//! The implicit answer of cells to forces that change with where other cells are, eq. (step.12). Where these grow faster than drag answers in
//! a step, as between surfaces that are nearly closed, its matrix has their slopes, too, which reach from cell to cell. It is solved by conjugate
//! gradients, with what each cell does by itself before them: that the stages have found already, and this corrects it.

use rayon::prelude::*;

use super::contact::{ContactScratch, answer, are_steep, find_slopes, take_answer};
use super::coupled_scratch::Coupled;
use super::kind::Kind;
use super::model::Model;
use super::pressure::constrain;
use super::scheme::{OF_SLOPES, gamma, larger, root_mean_square, share_of_stage};
use super::solver::{Solver, Stage, System, solve_block};
use super::state::{KindState, State};
use super::thread_buffers::ThreadBuffers;
use super::workspace::{KindScratch, Workspace};
use crate::mechanics::integrator::{Order, StepSize};
use crate::mechanics::lanes::LANES;

/// Rounds of conjugate gradients, at most. What is left then is found by the error estimate.
const ROUNDS: usize = 100;

/// What the solution may leave of how far atoms move, over what a step's error may be.
const LEFT: f64 = 0.1;

/// The same over the mean edge, for steps of a fixed size.
const LEFT_OF_EDGE: f64 = 1e-5;

/// Numbers that a thread takes at once, at least.
const NUMBERS_PER_JOB: usize = 8192;

/// Says whether forces of the law of contact, which were found where a step of `dt` (s) begins, couple cells in it, and finds their slopes then.
pub fn begin_coupling(model: &Model, (dt, order): (f64, Order), from: &State, ws: &mut Workspace) -> bool {
    let couples = are_steep(model, dt, ws.kinds.iter().map(|w| w.stiffening));
    for ((kind, now), w) in model.kinds.iter().zip(&from.kinds).zip(&mut ws.kinds) {
        let size = if couples { now.positions.len() } else { 0 };
        w.coupled.suit(size, if couples { now.blocks(kind) } else { 0 }, model.keeps_tractions);
        w.coupled.solver = couples.then(|| w.solver(kind, dt, gamma(kind, order)));
    }
    if couples {
        find_slopes(model, from, &mut ws.contact);
    }
    couples
}

/// Corrects the increments of a stage, and where they take the atoms, for what cells do to each other meanwhile. Returns the largest error
/// estimate over the mean edge of its kind after the second stage, and else 0.
pub fn couple(model: &Model, order: Order, stage: Stage, from: &State, to: &mut State, ws: &mut Workspace) -> f64 {
    let Workspace { kinds, buffers, contact, .. } = ws;
    let cells = Cells { model, order, from, buffers };
    cells.solve(stage, kinds, contact);
    let counted = if stage == Stage::First { 1.0 } else { 0.5 };
    for (w, next) in kinds.iter_mut().zip(&mut to.kinds) {
        combine(&mut next.positions, &w.coupled.change, |x, change| x + counted * change);
        let (increments, change) = w.increments_of(stage);
        combine(increments, change, |y, change| y + change);
    }
    if model.keeps_tractions {
        for w in &mut *kinds {
            // What slopes have made of the increments, but for what they leave.
            w.combine_left(stage, |left, moved| moved - left);
        }
        answer(model, (OF_SLOPES, share_of_stage(order)), from, kinds.iter().map(|w| &w.coupled.left[..]), contact);
    }
    if stage == Stage::First || !matches!(model.integrator.size, StepSize::Adaptive { .. }) {
        return 0.0;
    }
    cells.parts(kinds).map(|(part, w)| part.error(w)).fold(0.0, larger)
}

impl KindScratch {
    /// The increments of a stage, and what they become more.
    fn increments_of(&mut self, stage: Stage) -> (&mut [f64], &[f64]) {
        let Self { increments, coupled: Coupled { second, change, .. }, .. } = self;
        (if stage == Stage::First { increments } else { second }, change)
    }

    /// Where tractions are kept, makes of what slopes have left and the increments of a stage what `by` says.
    fn combine_left(&mut self, stage: Stage, by: impl Fn(f64, f64) -> f64 + Sync) {
        let Self { increments, coupled: Coupled { second, left, .. }, .. } = self;
        combine(left, if stage == Stage::First { increments } else { second }, by);
    }
}

/// The cells of a model in a step.
struct Cells<'a> {
    model: &'a Model,
    order: Order,
    from: &'a State,
    buffers: &'a ThreadBuffers,
}

/// Those of a kind.
struct Part<'a> {
    kind: &'a Kind,
    now: &'a KindState,
    gamma: f64,
    buffers: &'a ThreadBuffers,
}

impl Cells<'_> {
    fn parts<'b>(&'b self, kinds: &'b mut [KindScratch]) -> impl Iterator<Item = (Part<'b>, &'b mut KindScratch)> {
        let parts = self.model.kinds.iter().zip(&self.from.kinds);
        let part = |(kind, now)| Part { kind, now, gamma: gamma(kind, self.order), buffers: self.buffers };
        parts.map(part).zip(kinds)
    }

    /// How far the solution may be from where atoms would go, over the mean edge.
    fn tolerance(&self) -> f64 {
        match self.model.integrator.size {
            StepSize::Adaptive { tolerance, .. } => LEFT * tolerance,
            StepSize::Fixed(_) => LEFT_OF_EDGE,
        }
    }

    /// Finds by how much the increments of a stage change, (step.12).
    fn solve(&self, stage: Stage, kinds: &mut [KindScratch], contact: &mut ContactScratch) {
        let &Self { model, from, .. } = self;
        let moved = kinds.iter_mut().map(|w| &*w.increments_of(stage).0);
        answer(model, (OF_SLOPES, 0.0), from, moved, contact);
        let mut squared = 0.0;
        for (part, w) in self.parts(kinds) {
            take_answer(part.kind, part.now, contact, &mut w.coupled.residual);
            w.coupled.change.fill(0.0);
            squared += part.answer_alone(w);
            // The first residual is what slopes make of all that the stage has moved.
            w.combine_left(stage, |_, moved| moved);
            w.coupled.pushes.copy_from_slice(&w.coupled.left);
            w.coupled.direction.copy_from_slice(&w.coupled.spare);
            w.coupled.pushed.copy_from_slice(&w.coupled.residual);
        }
        for _ in 0..ROUNDS {
            // A cell by itself would move farther than it does among others, so that this bounds what is left.
            let left = self.parts(kinds).map(|(part, w)| part.largest(&w.coupled.spare)).fold(0.0, larger);
            if squared == 0.0 || left <= self.tolerance() {
                return;
            }
            answer(model, (OF_SLOPES, 0.0), from, kinds.iter().map(|w| &w.coupled.direction[..]), contact);
            let mut along = 0.0;
            for (part, w) in self.parts(kinds) {
                let Coupled { spare, pushed, direction, sums, .. } = &mut w.coupled;
                take_answer(part.kind, part.now, contact, spare);
                combine(spare, pushed, |answer, pushed| pushed - answer);
                along += part.dot(spare, direction, sums);
            }
            let (step, before) = (squared / along, squared);
            squared = 0.0;
            for (part, w) in self.parts(kinds) {
                let Coupled { change, direction, residual, spare, left, pushes, .. } = &mut w.coupled;
                combine(left, pushes, |left, pushes| left - step * pushes);
                combine(left, direction, |left, direction| left + step * direction);
                combine(change, direction, |change, direction| change + step * direction);
                combine(residual, spare, |residual, answered| residual - step * answered);
                squared += part.answer_alone(w);
            }
            let kept = squared / before;
            for w in &mut *kinds {
                let Coupled { direction, spare, pushed, residual, left, pushes, .. } = &mut w.coupled;
                combine(pushes, left, |pushes, left| left + kept * pushes);
                combine(direction, spare, |direction, moved| moved + kept * direction);
                combine(pushed, residual, |pushed, residual| residual + kept * pushed);
            }
        }
    }
}

impl Part<'_> {
    /// The linear system of the cells of a block.
    fn system<'b>(&'b self, (solver, own_factors): (&'b Solver, &'b [f64]), block: usize) -> System<'b> {
        let Some(tangent) = &self.kind.tangent else { return System::Shared(solver) };
        let (factor, lanes) = match &solver.own[..] {
            [] => {
                let length = tangent.len(self.kind.lanes);
                (&own_factors[block * length..][..length], self.kind.lanes)
            }
            own => (own, 1),
        };
        System::Own { mobility: solver.mobility, tangent, factor, lanes }
    }

    /// Finds what the residual would move of each cell by itself, volumes kept; left in `spare`. Returns the product of both.
    fn answer_alone(&self, w: &mut KindScratch) -> f64 {
        let (kind, lanes, length) = (self.kind, self.kind.lanes, self.kind.block_len());
        let KindScratch { coupled, own_factors, target, .. } = w;
        let Coupled { spare: y, residual, gradient, swell, solver, sums, .. } = coupled;
        let Some(solver) = solver else { return 0.0 };
        y.copy_from_slice(residual);
        y.par_chunks_exact_mut(length)
            .zip(self.now.positions.par_chunks_exact(length))
            .zip(gradient.par_chunks_exact(length).zip(swell.par_chunks_exact(length)))
            .zip(target.par_chunks_exact(lanes))
            .enumerate()
            .for_each(|(block, (((y, x), (gradient, swell)), target))| {
                self.buffers.enter(length, |[spare, spare2, ..]| {
                    let (wanted, mut pressure) = ([0.0; LANES], [0.0; LANES]);
                    solve_block(kind, lanes, &self.system((solver, own_factors), block), x, y, spare, spare2);
                    let (wanted, pressure) = (&wanted[..lanes], &mut pressure[..lanes]);
                    constrain(kind, self.gamma, gradient, swell, wanted, target, y, pressure);
                });
            });
        self.dot(y, residual, sums)
    }

    /// The sum of products over all atoms of all cells, in the order of blocks; `sums` has a number for each.
    fn dot(&self, one: &[f64], other: &[f64], sums: &mut [f64]) -> f64 {
        let (lanes, length) = (self.kind.lanes, self.kind.block_len());
        let blocks = one.par_chunks_exact(length).zip(other.par_chunks_exact(length)).zip(&mut *sums);
        blocks.enumerate().for_each(|(block, ((one, other), sum))| {
            let mut of_lanes = [0.0; LANES];
            for (one, other) in one.chunks_exact(lanes).zip(other.chunks_exact(lanes)) {
                (0..lanes).for_each(|lane| of_lanes[lane] += one[lane] * other[lane]);
            }
            // Lanes beyond the last cell repeat it.
            *sum = of_lanes.iter().take(self.now.cells() - block * lanes).sum();
        });
        sums.iter().sum()
    }

    /// The largest root mean square of displacements over the atoms of a cell, over the mean edge.
    fn largest(&self, moved: &[f64]) -> f64 {
        let blocks = moved.par_chunks_exact(self.kind.block_len());
        blocks.map(|moved| root_mean_square(self.kind, moved)).reduce(|| 0.0, larger) / self.kind.edge
    }

    /// The error estimate of a step over the mean edge, without what stiff shapes have of it by being stiff.
    fn error(&self, w: &mut KindScratch) -> f64 {
        let (kind, length) = (self.kind, self.kind.block_len());
        let KindScratch { coupled: Coupled { second: error, solver, .. }, increments, own_factors, .. } = w;
        let Some(solver) = solver else { return 0.0 };
        combine(error, increments, |second, first| 0.5 * (first + second));
        let blocks = error.par_chunks_exact_mut(length).zip(self.now.positions.par_chunks_exact(length));
        blocks.enumerate().for_each(|(block, (error, x))| {
            self.buffers.enter(length, |[spare, spare2, ..]| {
                self.system((solver, own_factors), block).filter(kind, (x, &[]), error, spare, spare2);
            });
        });
        self.largest(error)
    }
}

/// Makes of each number and another one what `by` says.
fn combine(to: &mut [f64], from: &[f64], by: impl Fn(f64, f64) -> f64 + Sync) {
    let pairs = to.par_iter_mut().zip(from).with_min_len(NUMBERS_PER_JOB);
    pairs.for_each(|(to, from)| *to = by(*to, *from));
}
