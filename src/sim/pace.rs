//! How long a step is: what is planned, where it must end, and what an error says of it.

use super::chemistry::next_exchange;
use super::model::Model;
use super::state::State;
use crate::mechanics::integrator::StepSize;

/// The step to try first.
pub fn plan_step(model: &Model, state: &State) -> f64 {
    match model.integrator.size {
        // What is left of a fixed step that was made shorter.
        StepSize::Fixed(dt) if state.next_step > 0.0 => state.next_step.min(dt),
        StepSize::Fixed(dt) => dt,
        StepSize::Adaptive { largest, .. } if state.next_step > 0.0 => state.next_step.min(largest),
        StepSize::Adaptive { largest, .. } => {
            let relax = |kind: &super::model::Kind| kind.drag / kind.largest_stiffness.max(f64::MIN_POSITIVE);
            on_ladder(model.kinds.iter().map(relax).fold(largest, f64::min)).min(largest)
        }
    }
}

/// The step to plan after one of `dt_now` that was planned as `planned` first and as `dt` last. A step cut short by a kink says
/// nothing against the step planned before it; one of a fixed size that was made shorter is made up for.
pub fn plan_next(model: &Model, planned: f64, dt: f64, dt_now: f64, next: f64) -> f64 {
    match model.integrator.size {
        StepSize::Fixed(_) if dt < planned => planned - dt_now,
        StepSize::Fixed(whole) => whole,
        StepSize::Adaptive { .. } if dt_now < dt => dt.max(next),
        StepSize::Adaptive { .. } => next,
    }
}

/// The shortest part of a fixed step that is made shorter still, over the whole: where that does not do, it was chosen badly.
const SHORTEST: f64 = 0.01;

/// Whether what is left of a step is too short to be made shorter still.
pub fn is_shortest(model: &Model, dt: f64) -> bool {
    matches!(model.integrator.size, StepSize::Fixed(whole) if dt < SHORTEST * whole)
}

/// A step never runs over a bend of a course, an exchange with chemistry or the end of the run.
pub fn end_at_kinks(model: &Model, time: f64, dt: f64) -> f64 {
    // Room for the round-off of a clock that adds many steps.
    let slack = 1e-12 * model.until;
    let kinks = model.kinks.iter().copied().chain([model.until, next_exchange(model, time)]);
    let ahead = kinks.filter(|&kink| kink > time + slack);
    let left = ahead.fold(f64::INFINITY, f64::min) - time;
    if dt >= left - slack { left } else { dt }
}

/// Whether the error allows the step, and the step to try next.
pub fn judge(model: &Model, dt: f64, error: f64) -> (bool, f64) {
    let StepSize::Adaptive { tolerance, largest } = model.integrator.size else {
        return if error.is_finite() { (true, dt) } else { (false, 0.5 * dt) };
    };
    if error.is_nan() || error.is_infinite() {
        return (false, on_ladder(0.3 * dt));
    }
    // The estimate is of first order, so that the error grows with the square of the step.
    let ideal = dt * (0.9 * (tolerance / error.max(1e-300)).sqrt()).clamp(0.3, 4.0);
    (error <= tolerance, on_ladder(ideal).min(largest))
}

/// The largest power of √2 seconds not above a step: few different steps mean few factorisations.
fn on_ladder(dt: f64) -> f64 {
    (0.5 * (2.0 * dt.log2() + 1e-9).floor()).exp2()
}
