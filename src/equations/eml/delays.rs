//! What was before the start, and delays that look ahead.

use super::build::{Builder, Use};
use super::document::Level;
use super::xml::Element;
use crate::equations::expression;
use crate::equations::tree::{Expr, QuantityId, Role, System};

impl Builder<'_, '_> {
    /// What quantities were before the start, where the document says so.
    pub(super) fn history(&mut self, root: &Element) -> Vec<(QuantityId, Expr)> {
        let elements = root.children.iter().filter(|child| child.attribute("history").is_some());
        let mut found = Vec::new();
        for element in elements {
            let id = element.word("id");
            if self.known.level == Level::Membrane {
                let help = "remove it: membranes cannot look back";
                self.context.fault(element.location("history"), "`history` has no meaning here", "not used", help);
            }
            if let (Some(expr), Some(number)) = (self.value(element, "history", Use::Before, &id), self.find(&id)) {
                found.push((number, expr));
            }
        }
        found
    }

    /// Tells delays that look ahead whatever happens: those of parameters.
    pub(super) fn check_delays(&mut self, system: &System, values: &[f64]) {
        let is_fixed = |delay: &Expr| {
            let mut fixed = !delay.uses_time();
            delay.each_quantity(&mut |q| fixed &= system.quantities[q as usize].role == Role::Parameter);
            fixed
        };
        for (quantity, declared) in system.quantities.iter().zip(&self.known.quantities) {
            let (Role::Variable { rate: own } | Role::Defined { rule: own }) = &quantity.role else { continue };
            own.each_delay(&mut |past, delay| {
                let value = delay.evaluate(0.0, &|q| values[q as usize]);
                if !is_fixed(delay) || value >= 0.0 {
                    return;
                }
                let whole = Expr::Delay(Box::new(past.clone()), Box::new(delay.clone()));
                let text = expression::write(&whole, &|q| system.quantities[q as usize].id.clone());
                let message = format!("`{}` uses {text}, whose delay is {value}; 0 or more was expected", quantity.id);
                let help = "what will be is not known: let the delay be a time of 0 or more";
                self.context.fault(declared.element.location("id"), &message, "looks ahead", help);
            });
        }
    }
}
