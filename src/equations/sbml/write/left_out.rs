//! What core SBML cannot say: refused where the rest has no meaning without it, else left out and told.

use crate::equations::eml::{Document, Level, SCHEMES};
use crate::equations::program::initial_values;
use crate::equations::tree::Role;
use crate::error::{Error, Fault, Result};

/// Refuses documents of fields and membranes, and noise.
pub fn refuse(document: &Document) -> Result<()> {
    let mut faults = Vec::new();
    if let Some(field) = document.fields.first() {
        let fault = Fault::new("core SBML has no fields: nothing in it spreads in space").at(field.location.clone());
        faults.push(fault.help("write a system without fields; its <reaction> formulas can be rates of variables"));
    }
    if let Some(membrane) = &document.membrane {
        let mut fault =
            Fault::new("core SBML has no membranes: nothing in it differs from point to point of a surface");
        if let Some(variable) = membrane.surface.first() {
            fault = fault.at(variable.location.clone());
        }
        faults.push(
            fault.help("write a system of level `cell` or `scene`, whose variables are numbers of the whole cell"),
        );
    }
    for noise in &document.noise {
        let fault = Fault::new("core SBML has no noise: its equations are deterministic").at(noise.location.clone());
        faults.push(fault.help("take `noise` out, if the equations mean something without it"));
    }
    if faults.is_empty() { Ok(()) } else { Err(Error::Input(faults)) }
}

/// What is left out or means something else, one sentence each.
pub fn notices(document: &Document, names: &[String]) -> Vec<String> {
    let mut notices = Vec::new();
    if document.level == Level::Cell {
        notices.push("in an experiment each cell has a system of its own; this is one of them".to_owned());
    }
    for (quantity, id) in document.system.quantities.iter().zip(names) {
        if quantity.role == Role::Input {
            notices.push(format!("the input `{id}` is a constant with its default"));
        }
    }
    for draw in document.system.draws.iter().filter(|draw| draw.element == 0) {
        notices.push(format!(
            "the start of `{}` is drawn at random in EML; here it is the middle of what may be drawn",
            draw.variable
        ));
    }
    for link in &document.links {
        notices.push(format!("the link from {} to {} is left out", link.from.text, link.to.text));
    }
    if let Some(scheme) = SCHEMES.iter().find(|(_, scheme)| Some(*scheme) == document.solver.scheme) {
        notices.push(format!("SBML does not say how a model is solved: the scheme {} is left out", scheme.0));
    }
    notices.extend(histories(document, names));
    notices
}

/// Before the start SBML has what an initial assignment says for that time, which holds at the start, too. Rules hold at all times,
/// so that those of definitions can tell the times apart.
fn histories(document: &Document, names: &[String]) -> Vec<String> {
    let lost = document.system.history.iter().filter(|(number, _)| !is_said(document, *number as usize));
    lost.map(|(number, _)| {
        format!(
            "the history of `{}` is left out: SBML has only one that is the value of the start at the start",
            names[*number as usize]
        )
    })
    .collect()
}

/// Whether the model says the history of a quantity: that of a definition, and one of a variable that is its value at the start there.
pub fn is_said(document: &Document, number: usize) -> bool {
    let system = &document.system;
    let Some(before) = system.before_start(number as u32) else { return true };
    if matches!(system.quantities[number].role, Role::Defined { .. }) {
        return true;
    }
    let Ok(values) = initial_values(system, 0.0) else { return false };
    let at_start = before.evaluate(0.0, &|other| values[other as usize]);
    (at_start - values[number]).abs() <= 1e-12 * values[number].abs()
}
