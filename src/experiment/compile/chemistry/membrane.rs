//! Documents of membranes.

use super::super::super::Document;
use super::{Part, at, pace, within};
use crate::equations::tree::{Expr, Role};
use crate::error::Fault;
use crate::membrane::{MembraneStepping, MembraneSystem};
use crate::ode::{EventPlan, Method, Tolerances};
use crate::sim::Kind;
use crate::sim::chemistry::{Chemistry, Members, Membrane, Reactor};

/// Tolerances of a step where neither document says any: relative and absolute.
const TOLERANCE: (f64, f64) = (1e-4, 1e-7);

/// Coefficients of diffusion that `set` has made negative, or that a link is to change during the run.
fn check_diffusion(part: &Part, system: &MembraneSystem, faults: &mut Vec<Fault>) {
    let Some(membrane) = &part.document.membrane else { return };
    for (variable, value) in membrane.surface.iter().zip(system.diffusion()) {
        let id = &part.document.system.quantities[variable.quantity as usize].id;
        if !(value.is_finite() && *value >= 0.0) {
            let message = format!("`diffusion` of `{id}` is {value}; 0 or more was expected");
            faults.push(within(&variable.location, "spreads so", message, "correct what the experiment sets"));
        }
        let mut linked = None;
        variable.diffusion.each_quantity(&mut |used| {
            let quantity = &part.document.system.quantities[used as usize];
            linked = linked.take().or((quantity.role == Role::Input).then_some(&quantity.id));
        });
        if let Some(parameter) = linked {
            let message = format!("a link sets `{parameter}`, but `diffusion` of `{id}` keeps one value");
            faults.push(within(
                &variable.location,
                "spreads so",
                message,
                "let no link set what a diffusion coefficient uses",
            ));
        }
    }
}

/// The system of a document of membranes; nothing where it is at fault.
pub(super) fn reactor(document: &Document, part: &Part, kinds: &[Kind], faults: &mut Vec<Fault>) -> Option<Reactor> {
    let (entry, eml) = (part.entry, &part.document);
    let before = faults.len();
    for (key, given) in [("scheme", entry.scheme.is_some()), ("exchange", entry.exchange.is_some())] {
        if given {
            let key = part.key(key);
            let fault = Fault::new(format!("`{key}` has no meaning for membranes")).help(
                "remove it: membranes have a scheme of their own and exchange numbers in every step; rtol, atol, inner_step and noise_step can be set",
            );
            faults.push(at(document, &key, "not used", fault));
        }
    }
    let relative = entry.rtol.or(eml.solver.rtol).unwrap_or(TOLERANCE.0);
    let absolute = entry.atol.or(eml.solver.atol).unwrap_or(TOLERANCE.1);
    let inner = entry.inner_step.map(|step| step.value() / eml.seconds).or(eml.solver.inner_step);
    let stepping = match inner {
        Some(step) => MembraneStepping::Longest { step, relative, absolute },
        None => MembraneStepping::Adaptive { relative, absolute },
    };
    let system = match MembraneSystem::new(eml, stepping, &[]) {
        Ok(system) => system,
        Err(circle) => {
            let message = format!("`{}` has a circle of definitions: {}", part.name, circle.join(" → "));
            let fault = Fault::new(message).help("let one of them be a variable");
            faults.push(at(document, &part.key("document"), "this document", fault));
            return None;
        }
    };
    check_diffusion(part, &system, faults);
    let pace = pace(document, part, eml.seconds, faults);
    for kind in part.kinds.iter().map(|&kind| &kinds[kind]) {
        let (what, help) = if kind.rest.facets.is_empty() {
            ("has no surface", "give the type a mesh with facets")
        } else if system.uses_volume && !kind.closed {
            (
                "encloses no volume, which the document uses",
                "give the type a closed mesh, or write the document without `volume`",
            )
        } else {
            continue;
        };
        let fault = Fault::new(format!("type `{}`, which has the membranes of `{}`, {what}", kind.name, part.name));
        faults.push(at(document, &part.key("document"), "this document", fault.help(help)));
    }
    if faults.len() > before {
        return None;
    }
    let is_recorded = |number: u32, role: &Role| *role != Role::Parameter && MembraneSystem::is_recorded(eml, number);
    let quantities = (0..).zip(&eml.system.quantities).filter(|(number, q)| is_recorded(*number, &q.role));
    Some(Reactor {
        beside: None,
        name: part.name.to_owned(),
        program: system.inside().clone(),
        events: EventPlan::default(),
        // Surface and pools are kicked together, with the membrane.
        noise: None,
        starts: None,
        pace,
        membrane: Some(Membrane::new(system, &part.kinds, kinds)),
        members: Members::Kinds(part.kinds.clone()),
        seconds: eml.seconds,
        // Pools are moved with the surface; nothing is solved by itself.
        method: Method::Rk45,
        tolerances: Tolerances { relative, absolute, ..Tolerances::default() },
        exchange: None,
        recorded: quantities.map(|(number, q)| (number, q.id.clone(), q.unit.clone())).collect(),
    })
}

/// Lets a membrane work out expressions of its quantities at all atoms.
pub(super) fn show(part: &Part, chemistry: &mut Chemistry, shown: &[Expr]) {
    let Some(membrane) = chemistry.reactors.get_mut(part.number).and_then(|reactor| reactor.membrane.as_mut()) else {
        return;
    };
    // What had no circle of definitions has none with expressions of the same quantities.
    if let Ok(system) = MembraneSystem::new(&part.document, membrane.system.stepping, shown) {
        membrane.system = system;
    }
}
