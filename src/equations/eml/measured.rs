//! Units that follow from expressions, and quantities without one in a document that has units.

use super::context::Context;
use super::declare::Declarations;
use super::xml::{Element, Text};
use crate::equations::expression::{Measure, Node, UnitScope, is_constant, parse};
use std::collections::{HashMap, HashSet};

/// Finds the unit of what is made of others, and tells what has none in a document that has units: whatever such a quantity takes
/// part in would go unchecked.
pub(super) fn complete(context: &mut Context, known: &mut Declarations) {
    if known.quantities.iter().all(|declared| declared.element.attribute("unit").is_none()) {
        return;
    }
    let open = follow(known);
    for number in open {
        let declared = &known.quantities[number];
        // Where there is an expression, what it lacks is told of its parts.
        if expression(declared.element).is_some() {
            continue;
        }
        let message =
            format!("`{}` has no unit, and others have: what it takes part in cannot be checked", declared.id);
        let help = "write unit=\"…\", with 1 for a plain number, or remove all units of the document";
        context.fault(declared.element.location("id"), &message, "in which unit?", help);
    }
}

fn has_unit(known: &Declarations, number: usize) -> bool {
    let declared = &known.quantities[number];
    // A unit at fault has been told, and the rate of a reaction is in the unit of what it changes.
    declared.element.attribute("unit").is_some()
        || declared.element.kind.name == "reaction"
        || known.units.contains_key(&declared.id)
}

/// The expression that a quantity equals, or equals at the start.
fn value(element: &Element) -> Option<&Text> {
    match element.kind.name {
        "define" | "mean" => Some(&element.text),
        "parameter" => element.attribute("value"),
        "variable" | "field" => element.attribute("initial"),
        "input" => element.attribute("default"),
        "algebraic" => element.attribute("start"),
        _ => None,
    }
}

/// Finds the units that follow from expressions, each when those of all that it uses are known; the quantities that are left have none.
fn follow(known: &mut Declarations) -> Vec<usize> {
    let open: Vec<usize> = (0..known.quantities.len()).filter(|&number| !has_unit(known, number)).collect();
    let numbers: HashMap<&str, usize> =
        open.iter().map(|&number| (known.quantities[number].id.as_str(), number)).collect();
    let numbers_of = |node: &Node| -> HashSet<usize> {
        node.names().iter().filter_map(|(name, _)| numbers.get(name).copied()).collect()
    };
    let in_functions: HashSet<usize> =
        known.scope.functions.values().flat_map(|function| numbers_of(&function.body)).collect();
    let mut users: HashMap<usize, Vec<usize>> = HashMap::new();
    let (mut waiting, mut ready) = (HashMap::new(), Vec::new());
    for &number in &open {
        let Some(node) = expression(known.quantities[number].element) else { continue };
        let mut used = numbers_of(&node);
        if !node.calls().is_empty() {
            used.extend(&in_functions);
        }
        used.iter().for_each(|other| users.entry(*other).or_default().push(number));
        if used.is_empty() {
            ready.push(number);
        }
        waiting.insert(number, (used.len(), node));
    }
    let mut found = HashSet::new();
    while let Some(number) = ready.pop() {
        let units = UnitScope { units: &known.units, scope: &known.scope, time: known.time_in_units() };
        let Measure::Known(unit) = units.measure(&waiting[&number].1, &mut Vec::new()) else { continue };
        known.units.insert(known.quantities[number].id.clone(), unit);
        found.insert(number);
        for user in users.remove(&number).unwrap_or_default() {
            let Some((left, _)) = waiting.get_mut(&user) else { continue };
            *left -= 1;
            if *left == 0 {
                ready.push(user);
            }
        }
    }
    open.into_iter().filter(|number| !found.contains(number)).collect()
}

/// The expression of a quantity that tells its unit; a number alone is in the unit that is expected, and none is.
fn expression(element: &Element) -> Option<Node> {
    let node = parse(&value(element)?.text).0;
    (element.kind.name == "define" || !is_constant(&node)).then_some(node)
}
