//! The values of a system's quantities at the start.

use crate::chemistry::tree::{Role, System};

/// The value of every quantity at the start, at time 0. Nothing may depend on itself.
pub(super) fn values(system: &System) -> Vec<f64> {
    let count = system.quantities.len();
    let expr = |number: usize| match &system.quantities[number].role {
        Role::Defined { rule } => rule,
        _ => &system.quantities[number].initial,
    };
    let mut values: Vec<Option<f64>> = vec![None; count];
    for first in 0..count {
        let mut waiting = vec![first];
        while let Some(&number) = waiting.last() {
            let mut missing = Vec::new();
            expr(number).each_quantity(&mut |other| {
                if values[other as usize].is_none() {
                    missing.push(other as usize);
                }
            });
            if missing.is_empty() {
                values[number] = Some(expr(number).evaluate(0.0, &|other| values[other as usize].unwrap_or(f64::NAN)));
                waiting.pop();
            } else {
                waiting.extend(missing);
            }
        }
    }
    values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect()
}
