//! What quantities were before the start, where formulas of the time say how they start.

use crate::equations::tree::{Role, System};

/// Notes as their history the formulas by which variables start, where these depend on the time: they hold until the start.
pub fn of_starts(system: &mut System) {
    let mut varies: Vec<bool> = system.quantities.iter().map(|_| false).collect();
    loop {
        let found = (0..varies.len()).filter(|&number| {
            let (quantity, mut depends) = (&system.quantities[number], false);
            let formula = match &quantity.role {
                Role::Defined { rule } => rule,
                _ => &quantity.initial,
            };
            formula.each_quantity(&mut |other| depends |= varies[other as usize]);
            !varies[number] && (depends || formula.uses_time())
        });
        let found: Vec<usize> = found.collect();
        if found.is_empty() {
            break;
        }
        found.into_iter().for_each(|number| varies[number] = true);
    }
    for number in (0..varies.len()).filter(|&number| varies[number]) {
        let quantity = &system.quantities[number];
        if !matches!(quantity.role, Role::Defined { .. }) && system.before_start(number as u32).is_none() {
            system.history.push((number as u32, quantity.initial.clone()));
        }
    }
}
