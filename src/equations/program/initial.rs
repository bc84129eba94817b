//! The values that all quantities have at the start.

use super::past::Past;
use crate::equations::tree::{QuantityId, Role, System};

/// Values of all quantities at a time from their initial expressions and rules, each worked out after those it uses.
///
/// # Errors
/// The identifiers along a circle of initial values.
pub fn initial_values(system: &System, time: f64) -> Result<Vec<f64>, Vec<String>> {
    let mut values = vec![None; system.quantities.len()];
    for start in 0..system.quantities.len() as QuantityId {
        // A stack of its own instead of calls: long chains of definitions must not overflow the program's stack.
        let mut open = vec![start];
        while let Some(&number) = open.last() {
            if values[number as usize].is_some() {
                open.pop();
                continue;
            }
            let quantity = &system.quantities[number as usize];
            let expression = match &quantity.role {
                Role::Defined { rule } => rule,
                _ => &quantity.initial,
            };
            // Only one quantity is pushed at a time, so all on the stack lie on one path of uses.
            let mut missing = Vec::new();
            let mut note = |other: QuantityId| {
                if values[other as usize].is_none() && !missing.contains(&other) {
                    missing.push(other);
                }
            };
            expression.each_quantity(&mut note);
            if expression.has_delay() {
                system.history.iter().for_each(|(_, before)| before.each_quantity(&mut note));
            }
            if let Some(again) = missing.iter().find_map(|other| open.iter().position(|on_path| on_path == other)) {
                return Err(open[again..].iter().map(|&q| system.quantities[q as usize].id.clone()).collect());
            }
            match missing.first() {
                Some(&other) => open.push(other),
                None => {
                    let known = |other: QuantityId| values[other as usize].unwrap_or(f64::NAN);
                    let past = Past { system, start: time };
                    values[number as usize] = Some(past.value(expression, time, &known));
                    open.pop();
                }
            }
        }
    }
    Ok(values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect())
}
