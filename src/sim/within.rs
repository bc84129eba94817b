//! Where a run is at an instant within a step: between the states at its ends, eq. (step.11).

use super::chemistry::ChemistryState;
use super::constraints::enforce_constraints;
use super::model::Model;
use super::state::{KindState, State};
use super::targets::measure_volumes;
use super::trouble::Trouble;
use super::workspace::Workspace;

/// The state at a time (s) within the step that was made last and led to `to`. What moves or changes steadily lies on the line between the
/// ends of the step, volumes are exact, and no atom is behind a plane. What is set between steps is as in the step, and what jumps (fibres,
/// adhesives, bonds) as the step left it. Runs and pseudopods that had ended by then are moved from `to` into it.
///
/// Nothing else of `to` is changed, nor anything that the next step reads.
///
/// # Errors
/// A volume that could not be made exact.
pub fn state_within(model: &Model, to: &mut State, time: f64, ws: &mut Workspace) -> Result<State, Trouble> {
    let from = std::mem::take(&mut ws.next);
    debug_assert!(from.time <= time && time <= to.time && from.counts() == to.counts(), "the step led elsewhere");
    let share = (time - from.time) / (to.time - from.time);
    let mut within = State { time, ended_runs: Vec::new(), ended_pseudopods: Vec::new(), ..to.clone() };
    within.ended_runs.extend(to.ended_runs.extract_if(.., |(_, end, _)| *end <= time));
    within.ended_pseudopods.extend(to.ended_pseudopods.extract_if(.., |(_, end, _)| *end <= time));
    within.kinds.iter_mut().zip(&from.kinds).for_each(|(now, from)| now.go_back_to(from, share));
    within.chemistry.go_back_to(&from.chemistry, share);
    ws.next = from;
    measure_volumes(model, time, &within, ws);
    enforce_constraints(model, time, &mut within, ws)?;
    Ok(within)
}

/// Moves numbers back towards those of before: all the way where the share of the step is 0.
pub(super) fn go_back(now: &mut [f64], before: &[f64], share: f64) {
    now.iter_mut().zip(before).for_each(|(now, before)| *now = before + share * (*now - before));
}

impl KindState {
    fn go_back_to(&mut self, from: &Self, share: f64) {
        go_back(&mut self.positions, &from.positions, share);
        go_back(&mut self.velocities, &from.velocities, share);
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
