//! Where a run is at an instant within a step: between the states at its ends, eq. (step.11).

use super::chemistry::{ChemistryState, advance_systems_to};
use super::constraints::enforce_constraints;
use super::model::Model;
use super::motility::advance_behaviours;
use super::moved::Displacements;
use super::state::{KindState, State};
use super::targets::measure_volumes;
use super::trouble::Trouble;
use super::workspace::Workspace;
use crate::Vec3;
use crate::elementary::go_back;

/// The state at a time (s) within the step that was made last and led to `to`. What moves or changes steadily lies on the line between the
/// ends of the step, volumes are exact, and no atom is behind an obstacle. Cells that nothing stops are where their walk has led them by then, and
/// systems without noise are solved until then. What is set between steps is as in the step, and what jumps (fibres, adhesives, bonds) as the
/// step left it. Runs and pseudopods that had ended by then are moved from `to` into it.
///
/// Nothing else of `to` is changed, nor anything that the next step reads.
///
/// # Errors
/// A volume that could not be made exact.
pub fn state_within(model: &Model, to: &mut State, time: f64, ws: &mut Workspace) -> Result<State, Trouble> {
    let from = std::mem::take(&mut ws.next);
    debug_assert!(from.time <= time && time <= to.time && from.counts() == to.counts(), "the step led elsewhere");
    let share = (time - from.time) / (to.time - from.time);
    let mut within = State { time, ..to.clone() };
    within.kinds.iter_mut().zip(&from.kinds).for_each(|(now, from)| now.go_back_to(from, share));
    put_on_courses(model, &from, &mut within);
    within.chemistry.go_back_to(&from.chemistry, share);
    follow_walks(model, (&from, to.time), &mut within, ws);
    advance_systems_to(model, (&from.chemistry, &to.chemistry), &mut within, &mut ws.chemistry);
    ws.next = from;
    within.ended_runs = to.ended_runs.extract_if(.., |(_, end, _)| *end <= time).collect();
    within.ended_pseudopods = to.ended_pseudopods.extract_if(.., |(_, end, _)| *end <= time).collect();
    measure_volumes(model, time, &within, ws);
    enforce_constraints(model, time, &mut within, ws)?;
    Ok(within)
}

/// Atoms that are moved are on their courses, which leave the line between the ends of the step where they turn.
fn put_on_courses(model: &Model, from: &State, within: &mut State) {
    let times = [from.time, within.time];
    for ((kind, from), now) in model.kinds.iter().zip(&from.kinds).zip(&mut within.kinds) {
        let Some(displacements) = Displacements::of(kind, times, 1.0) else { continue };
        let blocks =
            from.positions.chunks_exact(kind.block_len()).zip(now.positions.chunks_exact_mut(kind.block_len()));
        blocks.for_each(|(start, x)| displacements.put_from(start, x));
    }
}

/// Moves cells from the line between the ends of the step to where their walks have led them: where nothing is in their way they go by what
/// these ask for, whatever else they do. What may be in the way keeps them on their lines: other cells, obstacles, across these, and mass.
fn follow_walks(model: &Model, (from, end): (&State, f64), within: &mut State, ws: &mut Workspace) {
    let (passed, whole) = (within.time - from.time, end - from.time);
    if model.contact.is_some() || model.integrator.method.is_inertial() {
        return;
    }
    let mut walked = |dt: f64, within: &mut State| -> Vec<[f64; 3]> {
        advance_behaviours(model, dt, from, within, ws);
        ws.drive.iter().map(|velocity| velocity.map(|along| along * dt)).collect()
    };
    let (all, part) = (walked(whole, within), walked(passed, within));
    let share = passed / whole;
    for ((kind, begun), now) in model.kinds.iter().zip(&from.kinds).zip(&mut within.kinds) {
        if !begun.is_driven(kind) || kind.is_held() {
            continue;
        }
        for (local, cell) in begun.numbers().enumerate() {
            let off = Vec3::from_fn(|axis, _| part[cell][axis] - share * all[cell][axis]);
            let along = model.obstacles.iter().fold(off, |off, obstacle| match obstacle.surface.as_plane() {
                Some(normal) => off - off.dot(&normal) * normal,
                None => Vec3::zeros(),
            });
            now.shift(kind, local, &along);
        }
    }
}

impl KindState {
    fn go_back_to(&mut self, from: &Self, share: f64) {
        go_back(&mut self.positions, &from.positions, share);
        go_back(&mut self.velocities, &from.velocities, share);
        go_back(&mut self.dissipated, &from.dissipated, share);
        self.rest_volumes.clone_from(&from.rest_volumes);
    }
}

impl ChemistryState {
    fn go_back_to(&mut self, from: &Self, share: f64) {
        // Where the step was the first one, nothing may have been carried before it.
        if from.carried {
            self.controls.copy_from(&from.controls);
        }
        go_back(&mut self.times, &from.times, share);
        self.populations.iter_mut().zip(&from.populations).for_each(|(now, from)| now.go_back_to(from, share));
        for (now, from) in self.membranes.iter_mut().zip(&from.membranes) {
            now.kinds.iter_mut().zip(&from.kinds).for_each(|(now, from)| now.go_back_to(from, share));
        }
        for (now, from) in self.fields.iter_mut().zip(&from.fields) {
            go_back(&mut now.values, &from.values, share);
        }
    }
}
