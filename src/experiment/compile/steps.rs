//! Chooses how the run steps.

use super::super::{Document, Method as Text, Pseudopods};
use crate::error::{Error, Fault, Result, short};
use crate::mechanics::integrator::{Integrator, Method, Order, StepSize};
use crate::mechanics::stability::{Body, largest_stable_step};
use crate::sim::Kind;

/// The part of the largest stable step that is taken where the user names none: stiffness grows as a cell deforms.
const SAFETY: f64 = 0.5;

/// The default longest step, and the default time between frames, over the duration of the run.
pub(super) const HUNDREDTH: f64 = 0.01;

/// Scheme and step; measures the true stiffness of every kind where the scheme needs it.
pub fn integrator(document: &Document, kinds: &mut [Kind]) -> Result<Integrator> {
    let text = &document.experiment.run.integrator;
    let order = if text.order == 1 { Order::First } else { Order::Second };
    let method = match text.method {
        Text::Implicit => Method::Implicit { order },
        Text::Explicit => Method::Explicit,
        Text::Euler => Method::Euler,
        Text::SemiImplicitEuler => Method::SemiImplicitEuler,
        Text::Verlet => Method::Verlet,
        Text::RungeKutta4 => Method::RungeKutta4,
    };
    let until = document.experiment.run.until.value();
    let pods = document.experiment.cells.values().filter_map(|cell| cell.pseudopods.as_ref());
    let cycle = pods.map(Pseudopods::shortest_cycle).fold(f64::INFINITY, f64::min);
    let borne = longest_with_fibres(document, kinds)?;
    // What is sought is where cells come to rest, in steps as long as they allow; some must be left to see that they do.
    let usual = if document.experiment.run.equilibrium.is_some() { 5.0 * HUNDREDTH * until } else { HUNDREDTH * until };
    let longest = text.max_step.map_or(usual.min(cycle).min(borne), |step| step.value());
    if let Method::Implicit { order } = method {
        let largest = longest;
        for kind in kinds {
            kind.fibre_limit = 0.5 * kind.drag / text.step.map_or(longest, |step| step.value());
        }
        let size = match (text.step, order) {
            (Some(step), _) => StepSize::Fixed(step.value()),
            (None, Order::Second) => StepSize::Adaptive { tolerance: text.tolerance, largest },
            (None, Order::First) => {
                let fault = Fault::new("the implicit scheme of order 1 has no error estimate to choose a step by")
                    .help("give run.integrator.step, or use order = 2");
                let location = document.location("run.integrator.order", "needs a fixed step");
                return Err(Error::input(location.into_iter().fold(fault, Fault::at)));
            }
        };
        return Ok(Integrator { method, size });
    }
    let mut limit = (f64::INFINITY, String::new());
    for kind in kinds {
        kind.largest_stiffness = kind.measure_largest_stiffness();
        // Its own fibres are in that, and no others.
        kind.fibre_limit = kind.pod_fibre_stiffness();
        let body = Body { mass: kind.mass, drag: kind.drag, largest_stiffness: kind.largest_stiffness };
        let stable = largest_stable_step(method, &body);
        if stable < limit.0 {
            limit = (stable, kind.name.clone());
        }
    }
    let Some(step) = text.step.map(|step| step.value()) else {
        let largest = longest.min(SAFETY * limit.0);
        // How far an atom may travel in a step is for contacts to say, and they say it within the run.
        let size = match document.experiment.contact {
            Some(_) => StepSize::Adaptive { tolerance: text.tolerance, largest },
            None => StepSize::Fixed(largest),
        };
        return Ok(Integrator { method, size });
    };
    if step > limit.0 && !text.allow_unstable {
        let fault = Fault::new(format!(
            "the step is not stable: {} s is above the limit of {} s",
            short(step),
            short(limit.0)
        ))
        .help(format!(
            "the limit comes from the stiffness of type `{}`; leave the step out and a stable one is chosen, use \
                 method = \"implicit\", or set allow_unstable = true to see it fail",
            limit.1
        ));
        let location = document.location("run.integrator.step", "too large");
        return Err(Error::input(location.into_iter().fold(fault, Fault::at)));
    }
    Ok(Integrator { method, size: StepSize::Fixed(step) })
}

/// The longest step of the implicit scheme, s, that bears the fibres of pseudopods, eq. (fibres.2): the stiffness of what comes and goes is
/// not in its system.
fn longest_with_fibres(document: &Document, kinds: &[Kind]) -> Result<f64> {
    let text = &document.experiment.run.integrator;
    if text.method != Text::Implicit {
        return Ok(f64::INFINITY);
    }
    let longest = |kind: &Kind| match kind.pod_fibre_stiffness() {
        0.0 => f64::INFINITY,
        stiffness => 0.5 * kind.drag / stiffness,
    };
    let Some(kind) = kinds.iter().min_by(|a, b| longest(a).total_cmp(&longest(b))) else { return Ok(f64::INFINITY) };
    for (key, step) in [("step", text.step), ("max_step", text.max_step)] {
        if let Some(step) = step.filter(|step| step.value() > longest(kind)) {
            let key = format!("run.integrator.{key}");
            let (step, longest) = (short(step.value()), short(longest(kind)));
            let fault = Fault::new(format!(
                "`{key}` is {step} s, and the fibres of `cells.{}.pseudopods` bear steps of {longest} s",
                kind.name
            ));
            let fault = fault.help("let steps be shorter, fibres softer and more of them, or the drag larger");
            let location = document.location(&key, "too long for these fibres");
            return Err(Error::input(location.into_iter().fold(fault, Fault::at)));
        }
    }
    Ok(longest(kind))
}
