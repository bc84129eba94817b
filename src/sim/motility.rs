//! The stage that lets motile cells decide where they go during the step.

use super::kind::Kind;
use super::model::Model;
use super::state::{KindState, State};
use super::workspace::Workspace;
use crate::Vec3;
use crate::cell::motility::BrownianMotility;

/// Advances every walk by `dt` and notes the mean velocity it asks for, with what chemistry adds to it.
pub fn advance_motility(model: &Model, dt: f64, from: &State, to: &mut State, ws: &mut Workspace) {
    to.walks.clone_from(&from.walks);
    to.ended_runs.clone_from(&from.ended_runs);
    let controls = &from.chemistry.controls;
    let mut next = 0;
    let motile = |(kind, _): &(&Kind, &KindState)| kind.brownian.is_some() || kind.biased;
    for (kind, now) in model.kinds.iter().zip(&from.kinds).filter(motile) {
        for (cell, &id) in now.numbers().zip(&now.ids) {
            let mut velocity = Vec3::from(controls.bias_of(cell));
            if let Some(motility) = &kind.brownian {
                let motility =
                    BrownianMotility { speed: controls.speed_of(cell).unwrap_or(motility.speed), ..*motility };
                let ended = &mut to.ended_runs;
                velocity += motility.advance(model.seed, id, &mut to.walks[next], dt, |duration, offset| {
                    ended.push((id, from.time + offset, duration));
                });
                next += 1;
            }
            ws.drive[cell] = velocity.into();
        }
    }
}
