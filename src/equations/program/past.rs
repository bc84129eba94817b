//! What the quantities of a system were before its start.

use std::cell::RefCell;
use std::collections::HashMap;

use crate::equations::tree::{Expr, QuantityId, Role, System};

/// The past of a system: what its history says, or else what it had at the start; what is defined follows by its rule, at the time
/// in question.
#[derive(Debug, Clone, Copy)]
pub struct Past<'a> {
    /// The equations.
    pub system: &'a System,
    /// When they start to hold.
    pub start: f64,
}

/// What has been worked out, by quantity and time.
type Known = RefCell<HashMap<(QuantityId, u64), f64>>;

impl Past<'_> {
    /// The value of an expression at a time until the start; `at_start` gives quantities at the start.
    pub fn value(&self, expression: &Expr, time: f64, at_start: &impl Fn(QuantityId) -> f64) -> f64 {
        let known = Known::default();
        expression.evaluate_at(time, &|quantity, time| self.quantity((quantity, time), at_start, &known))
    }

    fn quantity(
        &self,
        (quantity, time): (QuantityId, f64),
        at_start: &dyn Fn(QuantityId) -> f64,
        known: &Known,
    ) -> f64 {
        let rule = match (&self.system.quantities[quantity as usize].role, self.system.before_start(quantity)) {
            _ if time >= self.start || time.is_nan() => return at_start(quantity),
            (_, Some(before)) => before,
            (Role::Defined { rule }, None) => rule,
            _ => return at_start(quantity),
        };
        let key = (quantity, time.to_bits());
        if let Some(&value) = known.borrow().get(&key) {
            return value;
        }
        let value = rule.evaluate_at(time, &|quantity, time| self.quantity((quantity, time), at_start, known));
        known.borrow_mut().insert(key, value);
        value
    }

    /// Whether an expression has one value before the start, whenever that is.
    pub fn is_steady(&self, expression: &Expr) -> bool {
        let (mut open, mut seen) = (vec![expression], vec![false; self.system.quantities.len()]);
        while let Some(expression) = open.pop() {
            if !only_delays(expression) {
                return false;
            }
            expression.each_quantity(&mut |quantity| {
                if std::mem::replace(&mut seen[quantity as usize], true) {
                    return;
                }
                match (&self.system.quantities[quantity as usize].role, self.system.before_start(quantity)) {
                    (_, Some(before)) => open.push(before),
                    (Role::Defined { rule }, None) => open.push(rule),
                    _ => {}
                }
            });
        }
        true
    }
}

/// Whether an expression uses the time by looking back alone.
fn only_delays(expression: &Expr) -> bool {
    match expression {
        Expr::Time => false,
        Expr::Number(_) | Expr::Quantity(_) => true,
        Expr::Unary(_, a) => only_delays(a),
        Expr::Binary(_, a, b) | Expr::Delay(a, b) => only_delays(a) && only_delays(b),
        Expr::Root(equations, _) => equations.expressions().all(only_delays),
        Expr::Piecewise { branches, otherwise } => {
            only_delays(otherwise) && branches.iter().all(|(a, b)| only_delays(a) && only_delays(b))
        }
    }
}
