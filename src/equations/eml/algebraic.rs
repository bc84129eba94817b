//! Algebraic equations, `<algebraic id="x" start="1">x^2 + x = a</algebraic>`: quantities that equations determine at all times.

use super::build::{Builder, Use};
use super::xml::{Element, Text};
use crate::equations::determine::{TOGETHER, Undetermined, Unknown, rules};
use crate::equations::tree::{Expr, Quantity, QuantityId, Role};

impl Builder<'_, '_> {
    /// Gives each quantity with an equation of its own the rule that this, and those of others, determine.
    pub(super) fn algebraic(&mut self, quantities: &mut [Quantity]) {
        let mut unknowns = Vec::new();
        for number in 0..self.known.quantities.len() {
            let declared = &self.known.quantities[number];
            let (id, element) = (declared.id.clone(), declared.element);
            if element.kind.name != "algebraic" {
                continue;
            }
            let start = self.value(element, "start", Use::Now, &id);
            let Some(text) = self.difference(element) else { continue };
            let Some(residual) = self.expression(&text, Use::Now, None) else { continue };
            unknowns.push(Unknown { quantity: number as QuantityId, residual, start });
        }
        if !self.context.is_clean() {
            return;
        }
        for (quantity, rule) in rules(&unknowns, quantities) {
            match rule {
                Ok(rule) => quantities[quantity as usize].role = Role::Defined { rule },
                Err(why) => self.not_determined(quantity, why),
            }
        }
    }

    /// Both sides of an equation as one expression that is nothing.
    fn difference(&mut self, element: &Element) -> Option<Text> {
        let text = &element.text;
        let bytes = text.text.as_bytes();
        let is_sign = |&at: &usize| {
            let beside = [at.checked_sub(1).map(|before| bytes[before]), bytes.get(at + 1).copied()];
            let joined = [b'<', b'>', b'!', b'='];
            bytes[at] == b'=' && !beside[0].is_some_and(|c| joined.contains(&c)) && beside[1] != Some(b'=')
        };
        let signs: Vec<usize> = (0..bytes.len()).filter(is_sign).collect();
        let [at] = signs[..] else {
            let message = format!("the equation has {} signs `=`; one was expected", signs.len());
            let help = "write an equation, such as `x^2 + x = a`, or `x^2 + x - a = 0`";
            let at = if text.text.trim().is_empty() { element.at.clone() } else { text.whole() };
            self.context.fault(at, &message, "what equals what?", help);
            return None;
        };
        let (left, right) = (text.part(&(0..at)), text.part(&(at + 1..bytes.len())));
        // The numbers are those of the equation as it is written.
        if right.text.trim() == "0" {
            return Some(left);
        }
        let sign = text.location(&(at..at + 1));
        let mut whole = text.part(&(0..0));
        whole.append(&left);
        whole.write(" - (", &sign);
        whole.append(&right);
        whole.write(")", &sign);
        Some(whole)
    }

    fn not_determined(&mut self, quantity: QuantityId, why: Undetermined) {
        let declared = &self.known.quantities[quantity as usize];
        let id = &declared.id;
        let (message, label, help) = match why {
            Undetermined::Unused => (
                format!("`{id}` is not determined: no equation is left that uses it"),
                "what is it?",
                "each unknown needs an equation that uses it, itself or through definitions".to_owned(),
            ),
            Undetermined::NoStart => (
                format!("the equation of `{id}` is not linear in it and has no start"),
                "where does the search begin?",
                "write start=\"…\", an expression that is near the solution at all times".to_owned(),
            ),
            Undetermined::TooMany => (
                format!("more than {TOGETHER} algebraic equations determine `{id}` together"),
                "too many",
                "write what can be solved for as definitions".to_owned(),
            ),
            Undetermined::TooLarge => (
                format!("the equation of `{id}` is too large with the definitions that use the unknowns put in"),
                "too large",
                "let it use fewer definitions that depend on the unknowns".to_owned(),
            ),
        };
        self.context.fault(declared.element.location("id"), &message, label, &help);
    }

    /// Tells equations that have no solution at the start.
    pub(super) fn check_roots(&mut self, quantities: &[Quantity], values: &[f64]) {
        for (number, declared) in self.known.quantities.iter().enumerate() {
            let is_searched = matches!(&quantities[number].role, Role::Defined { rule: Expr::Root(..) });
            if is_searched && !values[number].is_finite() {
                let message = format!("the equation of `{}` has no solution at the start that is found", declared.id);
                let help = "it is sought from `start` by Newton's rule: begin nearer to it, and where the equation is not flat";
                self.context.fault(declared.element.location("start"), &message, "sought from here", help);
            }
        }
    }
}
