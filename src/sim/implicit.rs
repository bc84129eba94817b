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
use super::model::Model;
use super::moved::Displacements;
use super::scheme::{gamma, larger, share_of_stage};
use super::solver::Stage;
use super::stages::{Block, Step};
use super::state::State;
use super::targets::Targets;
use super::thread_buffers::each_or_none;
use super::workspace::{KindScratch, Workspace};
use crate::mechanics::integrator::Order;

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
        let displacements = Displacements::of(kind, [from.time, from.time + dt], gamma(kind, order));
        let step = Step { model, kind, forces, solver, targets, displacements, order, start: from.time, dt };
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
        let KindScratch {
            increments,
            energy,
            volume,
            target,
            pressure,
            touch,
            own_factors,
            outer,
            on_held,
            coupled,
            ..
        } = w;
        let Coupled { gradient, swell, second, .. } = coupled;
        let error = (next.positions.par_chunks_exact_mut(length))
            .zip(now.rest_volumes.par_chunks_exact(lanes).zip(now.positions.par_chunks_exact(length)))
            .zip(volume.par_chunks_exact_mut(lanes).zip(target.par_chunks_exact_mut(lanes)))
            .zip(energy.par_chunks_exact_mut(lanes).zip(pressure.par_chunks_exact_mut(lanes)))
            .zip(
                each_or_none(increments, length, blocks)
                    .zip(each_or_none(own_factors, of_block.max(1), blocks))
                    .zip(each_or_none(outer, length, blocks).zip(each_or_none(on_held, length, blocks)))
                    .zip(each_or_none(gradient, length, blocks).zip(each_or_none(swell, length, blocks)))
                    .zip(each_or_none(second, length, blocks))
                    .zip(touch),
            )
            .enumerate()
            .map(|(number, ((((x, (rest, start)), (volume, target)), (energy, pressure)), kept))| {
                let (((((kept, own), (outer, on_held)), (gradient, swell)), second), touch) = kept;
                let swelling = gradient.zip(swell);
                let mut block = Block {
                    number,
                    x,
                    rest,
                    start,
                    volume,
                    target,
                    energy,
                    pressure,
                    outer,
                    on_held,
                    swelling,
                    second,
                    touch,
                };
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
