//! The stage that lets motile cells decide where they go during the step.

use super::model::Model;
use super::state::State;
use super::workspace::Workspace;

/// Advances a copy of every walk by `dt` and notes the mean velocity it asks for; the step commits it when accepted.
pub fn advance_motility(model: &Model, dt: f64, state: &State, ws: &mut Workspace) {
    if state.walks.is_empty() {
        return;
    }
    ws.walks.clear();
    ws.walks.extend_from_slice(&state.walks);
    ws.ended_runs.clear();
    let mut next = 0;
    for kind in &model.kinds {
        let Some(motility) = &kind.brownian else { continue };
        for cell in kind.first_cell..kind.first_cell + kind.cells {
            let ended = &mut ws.ended_runs;
            let velocity = motility.advance(model.seed, cell as u64, &mut ws.walks[next], dt, |duration, offset| {
                ended.push((cell as u32, state.time + offset, duration));
            });
            ws.drive[cell] = velocity.into();
            next += 1;
        }
    }
}
