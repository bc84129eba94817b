//! The stage that lets cells decide where they go during the step.

use super::model::Model;
use super::state::State;
use super::workspace::Workspace;
use crate::Vec3;
use crate::cell::{Circumstances, Ended};

/// Lets all behaviours go on by `dt` (s), and notes the mean velocity that those of each cell ask for together.
pub fn advance_behaviours(model: &Model, dt: f64, from: &State, to: &mut State, ws: &mut Workspace) {
    to.ended_runs.clone_from(&from.ended_runs);
    to.ended_pseudopods.clone_from(&from.ended_pseudopods);
    let controls = &from.chemistry.controls;
    let State { kinds, ended_runs, ended_pseudopods, .. } = to;
    for ((kind, begun), now) in model.kinds.iter().zip(&from.kinds).zip(kinds) {
        now.behaviours.clone_from(&begun.behaviours);
        if !begun.is_driven(kind) {
            continue;
        }
        for (local, (cell, &id)) in begun.numbers().zip(&begun.ids).enumerate() {
            let (speed, bias) = (controls.speed_of(cell), controls.bias_of(cell));
            let circumstances =
                Circumstances { seed: model.seed, cell: id, speed, bias, pseudopods: controls.told_pseudopods(cell) };
            let mut velocity = Vec3::zeros();
            for (behaviour, states) in kind.behaviours.iter().zip(&mut now.behaviours) {
                velocity += behaviour.advance(dt, &circumstances, &mut states[local], |ended, offset| match ended {
                    Ended::Run(duration) => ended_runs.push((id, from.time + offset, duration)),
                    Ended::Pseudopod(pod) => ended_pseudopods.push((id, from.time + offset, pod)),
                });
            }
            if begun.is_biased {
                velocity += Vec3::from(bias);
            }
            ws.drive[cell] = velocity.into();
        }
    }
}
