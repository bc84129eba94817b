//! Where the clock switches something: comparisons whose sides depend on time alone, and whole numbers that it counts.

use crate::equations::tree::{Binary, Expr, Role, System, Unary};

/// What depends on time, but on no variable, where the clock switches something.
#[derive(Debug, Default)]
pub struct Stops {
    /// Differences of the sides of comparisons, which switch something where they are nothing, and arguments of what has a kink or jumps there.
    pub differences: Vec<Expr>,
    /// What is rounded to a whole number, which jumps where it is one.
    pub counts: Vec<Expr>,
}

/// All of them in a system, or those alone that depend on no input either, so that they are the same in all cells.
pub fn stops(system: &System, with_inputs: bool) -> Stops {
    let mut found = Stops::default();
    let is_known = |role: &Role| match role {
        Role::Variable { .. } => Some(false),
        Role::Input => Some(with_inputs),
        Role::Parameter => Some(true),
        Role::Defined { .. } => None,
    };
    let mut steady = system.quantities.iter().map(|quantity| is_known(&quantity.role)).collect();
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

fn comparisons(system: &System, expression: &Expr, steady: &mut Vec<Option<bool>>, found: &mut Stops) {
    match expression {
        Expr::Number(_) | Expr::Time | Expr::Quantity(_) => {}
        Expr::Unary(function, a) => {
            let to = match function {
                Unary::Floor | Unary::Ceil => Some(&mut found.counts),
                Unary::Heaviside | Unary::Sign | Unary::Abs => Some(&mut found.differences),
                _ => None,
            };
            if let Some(to) = to.filter(|_| is_steady(system, a, steady)) {
                add(to, (**a).clone());
            }
            comparisons(system, a, steady, found);
        }
        Expr::Binary(function, a, b) => {
            let of_both = |function: Binary| Expr::Binary(function, a.clone(), b.clone());
            let to = match function {
                Binary::Lt | Binary::Le | Binary::Gt | Binary::Ge | Binary::Eq | Binary::Ne => {
                    Some((&mut found.differences, of_both(Binary::Sub)))
                }
                Binary::Min | Binary::Max => Some((&mut found.differences, of_both(Binary::Sub))),
                Binary::Rem | Binary::Quotient => Some((&mut found.counts, of_both(Binary::Div))),
                _ => None,
            };
            if let Some((to, switching)) = to
                && is_steady(system, a, steady)
                && is_steady(system, b, steady)
            {
                add(to, switching);
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
        Expr::Root(equations, _) => {
            equations.expressions().for_each(|part| comparisons(system, part, steady, found));
        }
        Expr::Delay(value, delay) => {
            comparisons(system, value, steady, found);
            comparisons(system, delay, steady, found);
        }
    }
}

fn add(to: &mut Vec<Expr>, expression: Expr) {
    if !to.contains(&expression) {
        to.push(expression);
    }
}

/// Whether an expression depends on nothing but what is known to be steady, nor on what was.
fn is_steady(system: &System, expression: &Expr, steady: &mut Vec<Option<bool>>) -> bool {
    if expression.has_delay() {
        return false;
    }
    let mut used = Vec::new();
    expression.each_quantity(&mut |quantity| used.push(quantity));
    used.into_iter().all(|quantity| match &system.quantities[quantity as usize].role {
        Role::Defined { rule } if steady[quantity as usize].is_none() => {
            let answer = is_steady(system, rule, steady);
            steady[quantity as usize] = Some(answer);
            answer
        }
        _ => steady[quantity as usize].unwrap_or_default(),
    })
}
