//! The over-damped schemes: the linearly implicit step of first and second order, and explicit Euler.
//!
//! With A = ζ/dt + γK, K constant, the increment of the first-order step is `A Y = F(X)`, eq. (step.2), γ = 1. The
//! second-order step, eq. (step.3), is the two-stage W-method of Verwer et al. (1999), second order whatever K is:
//! `A Y₁ = F(X)`, `A Y₂ = F(X + Y₁) − 2 (ζ/dt) Y₁`, `X⁺ = X + 3/2 Y₁ + 1/2 Y₂`, and `(Y₁ + Y₂)/2` estimates the error.
//! Rigid motion is taken out of A, eq. (step.4). An incompressible cell's increments are those of the same system under
//! the linearised constraint, eq. (step.5): one more solve gives the displacement S that a unit of pressure causes. Where no constant K
//! tells how stiff the shapes of a cell are, it is the tangent stiffness of each cell, eq. (step.10).

use rayon::prelude::*;

use super::contact::{has_live_forces, pull_contacts};
use super::coupled::{begin_coupling, couple};
use super::coupled_scratch::Coupled;
use super::forces::{Acting, Forces};
use super::kind::Kind;
use super::model::Model;
use super::planes::{self, TouchScratch};
use super::pressure::{carry_pressure, constrain};
use super::scheme::{gamma, larger, root_mean_square, share_of_stage};
use super::solver::{Solver, Stage, System, solve_block};
use super::state::State;
use super::targets::Targets;
use super::thread_buffers::each_or_none;
use super::workspace::{KindScratch, Workspace};
use crate::mechanics::integrator::{Order, StepSize};
use crate::mechanics::lanes::LANES;
use crate::mechanics::tangent::Scales;

/// Moves all atoms freely by one step: forces, the increments that they cause, and where these take the atoms; constraints hold to
/// first order. Returns the largest error estimate over the mean edge of its kind, 0 at first order and for steps of a fixed size. A block goes through all
/// stages at once, with the buffers of its thread, so that what they need is near and is not held for all cells. Forces that change
/// with where other cells are, as those of links do, are known for a second stage only after the first of all blocks.
pub fn advance_implicitly(
    model: &Model,
    dt: f64,
    order: Order,
    from: &State,
    to: &mut State,
    ws: &mut Workspace,
) -> f64 {
    let controls = &from.chemistry.controls;
    pull_contacts(model, controls, &from.kinds, &mut ws.contact, share_of_stage(order));
    let couples = begin_coupling(model, (dt, order), from, ws);
    match order {
        Order::First if couples => {
            advance_stages(model, dt, order, &[Stage::First], from, to, ws);
            couple(model, order, Stage::First, from, to, ws)
        }
        Order::First => advance_stages(model, dt, order, &[Stage::First], from, to, ws),
        Order::Second if has_live_forces(model) => {
            advance_stages(model, dt, order, &[Stage::First], from, to, ws);
            if couples {
                couple(model, order, Stage::First, from, to, ws);
            }
            pull_contacts(model, controls, &to.kinds, &mut ws.contact, share_of_stage(order));
            let error = advance_stages(model, dt, order, &[Stage::Second], from, to, ws);
            if couples { couple(model, order, Stage::Second, from, to, ws) } else { error }
        }
        Order::Second => advance_stages(model, dt, order, &[Stage::First, Stage::Second], from, to, ws),
    }
}

/// Stages of a step for all cells. The first stage moves atoms to X + Y₁, the second to X + 3/2 Y₁ + 1/2 Y₂.
fn advance_stages(
    model: &Model,
    dt: f64,
    order: Order,
    stages: &[Stage],
    from: &State,
    to: &mut State,
    ws: &mut Workspace,
) -> f64 {
    let Workspace { kinds, buffers, drive, pushes, fibres, contact, .. } = ws;
    let mut worst = 0.0;
    let cells = from.kinds.iter().zip(&mut to.kinds);
    for ((kind, (now, next)), w) in model.kinds.iter().zip(cells).zip(kinds) {
        let controls = &from.chemistry.controls;
        let acting = Acting { drive, pushes, fibres, contact: &contact.forces };
        let forces = Forces { kind, cells: now, controls, acting };
        let solver = &*w.solver(kind, dt, gamma(kind, order));
        let targets = Targets::of(model, kind, [from.time, from.time + dt]);
        let step = Step { model, kind, forces, solver, targets, order, start: from.time, dt };
        let (length, lanes) = (kind.block_len(), kind.lanes);
        let blocks = now.blocks(kind);
        let couples = w.coupled.couples();
        if couples || order == Order::Second && stages.len() == 1 {
            w.increments.resize(now.positions.len(), 0.0);
        }
        // Contacts move cells by their factors; alone each has it only while it is made a step with.
        let of_block = kind.tangent.as_ref().map_or(0, |tangent| tangent.len(lanes));
        let are_kept = model.contact.is_some() && solver.own.is_empty();
        w.own_factors.resize(if are_kept { of_block * blocks } else { 0 }, 0.0);
        let KindScratch { increments, energy, volume, target, pressure, touch, own_factors, outer, coupled, .. } = w;
        let Coupled { gradient, swell, second, .. } = coupled;
        let error = (next.positions.par_chunks_exact_mut(length))
            .zip(now.rest_volumes.par_chunks_exact(lanes).zip(now.positions.par_chunks_exact(length)))
            .zip(volume.par_chunks_exact_mut(lanes).zip(target.par_chunks_exact_mut(lanes)))
            .zip(energy.par_chunks_exact_mut(lanes).zip(pressure.par_chunks_exact_mut(lanes)))
            .zip(
                each_or_none(increments, length, blocks)
                    .zip(each_or_none(own_factors, of_block.max(1), blocks))
                    .zip(each_or_none(outer, length, blocks))
                    .zip(each_or_none(gradient, length, blocks).zip(each_or_none(swell, length, blocks)))
                    .zip(each_or_none(second, length, blocks))
                    .zip(touch),
            )
            .enumerate()
            .map(|(number, ((((x, (rest, start)), (volume, target)), (energy, pressure)), kept))| {
                let (((((kept, own), outer), (gradient, swell)), second), touch) = kept;
                let swelling = gradient.zip(swell);
                let mut block =
                    Block { number, x, rest, start, volume, target, energy, pressure, outer, swelling, second, touch };
                buffers.enter_with_factor(length, |buffer, spare| {
                    let (factor, has_factor) = match own {
                        Some(own) => (own, stages[0] == Stage::Second),
                        None => (spare, false),
                    };
                    let system = step.system(&block, factor, has_factor);
                    step.advance(&mut block, &system, stages, kept, buffer)
                })
            })
            .reduce(|| 0.0, larger);
        worst = larger(worst, error / kind.edge);
    }
    worst
}

/// What the stages of a step need of a kind.
struct Step<'a> {
    model: &'a Model,
    kind: &'a Kind,
    forces: Forces<'a>,
    solver: &'a Solver,
    targets: Option<Targets<'a>>,
    order: Order,
    /// When it begins, s.
    start: f64,
    dt: f64,
}

/// A block of cells in a step.
struct Block<'a> {
    number: usize,
    /// Positions after the stages that were made.
    x: &'a mut [f64],
    /// Rest volumes of its cells.
    rest: &'a [f64],
    /// Positions where the step begins.
    start: &'a [f64],
    volume: &'a mut [f64],
    target: &'a mut [f64],
    energy: &'a mut [f64],
    pressure: &'a mut [f64],
    /// Where forces from outside are added up, if somebody asks.
    outer: Option<&'a mut [f64]>,
    /// Where the gradients of volumes and what a unit of pressure moves are kept, where cells are coupled to others.
    swelling: Option<(&'a mut [f64], &'a mut [f64])>,
    /// Where the increments of the second stage are kept then.
    second: Option<&'a mut [f64]>,
    touch: &'a mut TouchScratch,
}

impl Step<'_> {
    /// The linear system of the cells of a block; `factor` takes one of their own, or has it from the first stage.
    fn system<'b>(&'b self, block: &Block, factor: &'b mut [f64], has_factor: bool) -> System<'b> {
        let (kind, dt) = (self.kind, self.dt);
        let Some(tangent) = &kind.tangent else { return System::Shared(self.solver) };
        let mobility = dt / kind.drag;
        if !self.solver.own.is_empty() {
            return System::Own { mobility, tangent, factor: &self.solver.own, lanes: 1 };
        }
        let elastic = self.forces.elastic_factors(block.number);
        let scales = Scales {
            diagonal: kind.drag / dt,
            gamma: gamma(kind, self.order),
            elastic: &elastic[..kind.lanes],
            held: &kind.held,
        };
        let factor = &mut factor[..tangent.len(kind.lanes)];
        if !has_factor {
            tangent.factor(&kind.forces, kind.lanes, block.start, scales, factor);
        }
        System::Own { mobility, tangent, factor, lanes: kind.lanes }
    }

    /// Whether the step is as long as its error allows: one of a fixed size needs no estimate, which costs another solution.
    fn asks_for_error(&self) -> bool {
        matches!(self.model.integrator.size, StepSize::Adaptive { .. })
    }

    /// Takes a block through stages of the step. The increments of the first are `kept` where stages are made one by one. Returns the
    /// largest error estimate, µm.
    fn advance(
        &self,
        block: &mut Block,
        system: &System,
        stages: &[Stage],
        mut kept: Option<&mut [f64]>,
        [y, first, gradient, swell, spare, spare2]: [&mut [f64]; 6],
    ) -> f64 {
        let (kind, end) = (self.kind, self.start + self.dt);
        if let Some(targets) = &self.targets {
            targets.on_block(block.start, block.rest, gradient, block.volume, block.target);
            // The displacement that a unit of pressure causes, eq. (step.5).
            swell.copy_from_slice(gradient);
            solve_block(kind, kind.lanes, system, block.start, swell, spare, spare2);
            if let Some(kept) = &mut block.swelling {
                kept.0.copy_from_slice(gradient);
                kept.1.copy_from_slice(swell);
            }
        }
        let mut error = 0.0;
        for &stage in stages {
            if let (Stage::Second, Some(kept)) = (stage, &kept) {
                first.copy_from_slice(kept);
            }
            let (time, x) = if stage == Stage::First { (self.start, block.start) } else { (end, &*block.x) };
            self.forces.on_block(block.number, time, (x, block.rest), (&mut *y, &mut *block.energy), spare);
            if let Some(outer) = &mut block.outer {
                self.forces.add_outer(block.number, (time, share_of_stage(self.order)), x, outer, spare);
            }
            if stage == Stage::Second {
                carry_pressure(kind, block.x, block.pressure, y, spare);
            }
            self.solve(system, block, stage, y, first, (&*gradient, &*swell), [&mut *spare, &mut *spare2]);
            block.go_on(stage, y, first);
            if let (Stage::Second, Some(kept)) = (stage, &mut block.second) {
                kept.copy_from_slice(y);
            } else if stage == Stage::Second && self.asks_for_error() {
                first.iter_mut().zip(&*y).for_each(|(first, y)| *first = 0.5 * (*first + y));
                system.filter(kind, block.start, first, spare, spare2);
                error = root_mean_square(kind, first);
            }
            if let (Stage::First, Some(kept)) = (stage, &mut kept) {
                kept.copy_from_slice(first);
            }
        }
        error
    }

    /// Turns forces into the increments of a stage, in place.
    fn solve(
        &self,
        system: &System,
        block: &mut Block,
        stage: Stage,
        y: &mut [f64],
        first: &[f64],
        (gradient, swell): (&[f64], &[f64]),
        [spare, spare2]: [&mut [f64]; 2],
    ) {
        let &Self { model, kind, order, .. } = self;
        let Block { start, volume, target, pressure, touch, .. } = block;
        if stage == Stage::Second {
            let back = 2.0 / system.mobility();
            y.iter_mut().zip(first).for_each(|(y, k)| *y -= back * k);
        }
        solve_block(kind, kind.lanes, system, start, y, spare, spare2);
        let mut wanted = [0.0; LANES];
        for lane in 0..kind.lanes {
            let missing = target[lane] - volume[lane];
            wanted[lane] = if stage == Stage::First { missing } else { -missing };
        }
        let gamma = gamma(kind, order);
        constrain(kind, gamma, gradient, swell, &wanted[..kind.lanes], target, y, pressure);
        let scene = planes::Scene { model, kind, system: *system, stage, gamma, share: share_of_stage(order) };
        planes::correct_block(&scene, start, first, gradient, swell, target, y, pressure, touch);
    }
}

impl Block<'_> {
    /// Moves atoms by the increments of a stage, and keeps those of the first.
    fn go_on(&mut self, stage: Stage, y: &[f64], first: &mut [f64]) {
        let starts = self.x.iter_mut().zip(self.start).zip(y);
        if stage == Stage::First {
            starts.for_each(|((x, start), y)| *x = start + y);
            first.copy_from_slice(y);
        } else {
            starts.zip(first).for_each(|(((x, start), y2), y1)| *x = start + 1.5 * *y1 + 0.5 * y2);
        }
    }
}
