//! Which quantities of a system can be parameters of a document.

use super::super::Document;
use crate::equations::tree::{Expr, Role};

/// Which quantities EML can have as parameters: given by numbers and other such parameters.
pub(super) fn fixed(document: &Document) -> Vec<bool> {
    let system = &document.system;
    let mut fixed: Vec<bool> = system.quantities.iter().map(|q| matches!(q.role, Role::Parameter)).collect();
    for (number, quantity) in system.quantities.iter().enumerate() {
        fixed[number] &= !quantity.initial.uses_time();
    }
    loop {
        let found = (0..fixed.len())
            .filter(|&number| fixed[number] && uses(&system.quantities[number].initial, &|other| !fixed[other]));
        let found: Vec<usize> = found.collect();
        if found.is_empty() {
            return fixed;
        }
        found.into_iter().for_each(|number| fixed[number] = false);
    }
}

/// Whether an expression uses a quantity that is such.
pub(super) fn uses(expr: &Expr, is: &impl Fn(usize) -> bool) -> bool {
    let mut found = false;
    expr.each_quantity(&mut |number| found |= is(number as usize));
    found
}
