//! Where the clock switches something: comparisons whose sides depend on time alone.

use crate::equations::tree::{Binary, Expr, Role, System};

/// Differences of the sides of every comparison that depends on time but on no variable.
pub fn stops(system: &System) -> Vec<Expr> {
    let mut found = Vec::new();
    let mut steady = vec![None; system.quantities.len()];
    for quantity in &system.quantities {
        match &quantity.role {
            Role::Variable { rate } => comparisons(system, rate, &mut steady, &mut found),
            Role::Defined { rule } => comparisons(system, rule, &mut steady, &mut found),
            _ => {}
        }
    }
    for event in &system.events {
        comparisons(system, &event.trigger, &mut steady, &mut found);
    }
    found
}

fn comparisons(system: &System, expression: &Expr, steady: &mut Vec<Option<bool>>, found: &mut Vec<Expr>) {
    match expression {
        Expr::Number(_) | Expr::Time | Expr::Quantity(_) => {}
        Expr::Unary(_, a) => comparisons(system, a, steady, found),
        Expr::Binary(function, a, b) => {
            let compares =
                matches!(function, Binary::Lt | Binary::Le | Binary::Gt | Binary::Ge | Binary::Eq | Binary::Ne);
            if compares && is_steady(system, a, steady) && is_steady(system, b, steady) {
                let difference = Expr::Binary(Binary::Sub, a.clone(), b.clone());
                if !found.contains(&difference) {
                    found.push(difference);
                }
            }
            comparisons(system, a, steady, found);
            comparisons(system, b, steady, found);
        }
        Expr::Piecewise { branches, otherwise } => {
            for (condition, value) in branches {
                comparisons(system, condition, steady, found);
                comparisons(system, value, steady, found);
            }
            comparisons(system, otherwise, steady, found);
        }
        Expr::Delay(value, delay) => {
            comparisons(system, value, steady, found);
            comparisons(system, delay, steady, found);
        }
    }
}

/// Whether an expression depends on no variable, nor on what was.
fn is_steady(system: &System, expression: &Expr, steady: &mut Vec<Option<bool>>) -> bool {
    if expression.has_delay() {
        return false;
    }
    let mut used = Vec::new();
    expression.each_quantity(&mut |quantity| used.push(quantity));
    used.into_iter().all(|quantity| match &system.quantities[quantity as usize].role {
        Role::Variable { .. } => false,
        Role::Parameter | Role::Input => true,
        Role::Defined { rule } => steady[quantity as usize].unwrap_or_else(|| {
            let answer = is_steady(system, rule, steady);
            steady[quantity as usize] = Some(answer);
            answer
        }),
    })
}
