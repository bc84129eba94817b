//! The stage that lets motile cells decide where they go during the step.

use super::model::Model;
use super::state::State;
use super::workspace::Workspace;
use crate::Vec3;
use crate::cell::motility::BrownianMotility;

/// Advances a copy of every walk by `dt` and notes the mean velocity it asks for, with what chemistry adds to it; the
/// step commits it when accepted.
pub fn advance_motility(model: &Model, dt: f64, state: &State, ws: &mut Workspace) {
    ws.walks.clear();
    ws.walks.extend_from_slice(&state.walks);
    ws.ended_runs.clear();
    let controls = &state.chemistry.controls;
    let mut next = 0;
    for kind in model.kinds.iter().filter(|kind| kind.brownian.is_some() || kind.biased) {
        for cell in kind.first_cell..kind.first_cell + kind.cells {
            let mut velocity = Vec3::from(controls.bias_of(cell));
            if let Some(motility) = &kind.brownian {
                let motility =
                    BrownianMotility { speed: controls.speed_of(cell).unwrap_or(motility.speed), ..*motility };
                let ended = &mut ws.ended_runs;
                velocity += motility.advance(model.seed, cell as u64, &mut ws.walks[next], dt, |duration, offset| {
                    ended.push((cell as u32, state.time + offset, duration));
                });
                next += 1;
            }
            ws.drive[cell] = velocity.into();
        }
    }
}
