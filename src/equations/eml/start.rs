//! The values of a system's quantities at the start.

use crate::equations::tree::{Role, System};

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
            if values[number].is_some() {
                waiting.pop();
                continue;
            }
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

/// For each of `count` things the length of the longest row of things that must be computed up to it. Nothing may depend
/// on itself.
pub(super) fn lengths(count: usize, uses: &impl Fn(usize) -> Vec<usize>) -> Vec<usize> {
    let mut found: Vec<Option<usize>> = vec![None; count];
    for first in 0..count {
        let mut waiting = vec![first];
        while let Some(&number) = waiting.last() {
            if found[number].is_some() {
                waiting.pop();
                continue;
            }
            let parts = uses(number);
            let missing: Vec<usize> = parts.iter().copied().filter(|&part| found[part].is_none()).collect();
            if missing.is_empty() {
                found[number] = Some(1 + parts.iter().filter_map(|&part| found[part]).max().unwrap_or(0));
                waiting.pop();
            } else {
                waiting.extend(missing);
            }
        }
    }
    found.into_iter().map(|length| length.unwrap_or(0)).collect()
}
