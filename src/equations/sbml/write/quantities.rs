//! Quantities as species and parameters, their starts, and the rules that they follow.

use super::Writer;
use super::element::Element;
use super::kinds::{Kind, is_substance};
use super::left_out::is_said;
use crate::equations::program::initial_values;
use crate::equations::tree::{Binary, Expr, Role};

impl Writer<'_> {
    /// The compartments, the species and the parameters; what starts by a formula is noted.
    pub(super) fn quantities(&mut self) -> (Vec<Element>, Vec<Element>, Vec<Element>) {
        let (mut species, mut parameters) = (Vec::new(), Vec::new());
        for number in 0..self.document.system.quantities.len() {
            match self.kinds.of[number] {
                Kind::Parameter => parameters.push(self.parameter(number)),
                Kind::Reaction { .. } => {}
                kind => species.push(self.species(number, kind)),
            }
        }
        let compartment = Element::new("compartment")
            .with("id", &self.compartment)
            .with("spatialDimensions", "3")
            .with("size", "1")
            .with_some("units", self.measured.then_some("litre"))
            .with_flag("constant", true);
        let compartments = if species.is_empty() { Vec::new() } else { vec![compartment] };
        (compartments, species, parameters)
    }

    /// The beginning of an element with the identifier and the name of a quantity.
    pub(super) fn head(&self, element: &'static str, number: usize) -> Element {
        let (quantity, id) = (&self.document.system.quantities[number], &self.names.quantities[number]);
        let name = match quantity.name.as_str() {
            "" if *id != quantity.id => Some(&quantity.id),
            "" => None,
            _ => Some(&quantity.name),
        };
        Element::new(element).with("id", id).with_some("name", name)
    }

    fn species(&mut self, number: usize, kind: Kind) -> Element {
        let quantity = &self.document.system.quantities[number];
        let (start, unit) = match kind {
            Kind::Concentration => ("initialConcentration", self.units.amount_in_litre(&quantity.unit)),
            _ if is_substance(&quantity.unit) => ("initialAmount", self.units.reference(&quantity.unit)),
            _ => ("initialAmount", None),
        };
        let value = self.start(number);
        // All reactions measure their extents in the unit of what they change.
        if self.kinds.changed[number] && self.extent.is_none() {
            self.extent = unit.clone();
        }
        self.head("species", number)
            .with("compartment", &self.compartment)
            .with_some(start, value)
            .with_some("substanceUnits", unit)
            .with_flag("hasOnlySubstanceUnits", kind != Kind::Concentration)
            .with_flag("boundaryCondition", self.kinds.held[number])
            .with_flag("constant", self.kinds.constant[number])
    }

    fn parameter(&mut self, number: usize) -> Element {
        let quantity = &self.document.system.quantities[number];
        let unit = self.units.reference(&quantity.unit);
        let value = self.start(number);
        self.head("parameter", number)
            .with_some("value", value)
            .with_some("units", unit)
            .with_flag("constant", self.kinds.constant[number])
    }

    /// The number at which a quantity starts; none where a rule says it, or an initial assignment, which is noted.
    fn start(&mut self, number: usize) -> Option<String> {
        let document = self.document;
        let quantity = &document.system.quantities[number];
        if let Role::Defined { rule } = &quantity.role {
            // What an algebraic rule determines is sought from its value.
            let Expr::Root(equations, index) = rule else { return None };
            return match &equations.starts[*index as usize] {
                Expr::Number(value) => Some(decimal(*value)),
                _ => {
                    let values = initial_values(&document.system, 0.0).unwrap_or_default();
                    values.get(number).filter(|value| value.is_finite()).map(|value| decimal(*value))
                }
            };
        }
        let history = document.system.before_start(number as u32).filter(|_| is_said(document, number));
        match history.unwrap_or(&quantity.initial) {
            Expr::Number(value) if value.is_nan() => None,
            Expr::Number(value) if value.is_infinite() => Some(if *value > 0.0 { "INF" } else { "-INF" }.to_owned()),
            Expr::Number(value) => Some(decimal(*value)),
            formula => {
                let unit = self.units.reference(&quantity.unit);
                let formula = self.formulas.number(formula, unit.as_deref());
                let assignment = Element::new("initialAssignment").with("symbol", &self.names.quantities[number]);
                self.initial.push(assignment.child(formula));
                None
            }
        }
    }

    /// Rates of change and what holds at all times.
    pub(super) fn rules(&mut self) -> Vec<Element> {
        let system = &self.document.system;
        let mut rules = Vec::new();
        for (number, (quantity, id)) in system.quantities.iter().zip(&self.names.quantities).enumerate() {
            if self.kinds.changed[number] || matches!(self.kinds.of[number], Kind::Reaction { .. }) {
                continue;
            }
            let before = system.before_start(number as u32);
            if let Role::Defined { rule: Expr::Root(equations, index) } = &quantity.role {
                let residual = self.formulas.number(&equations.residuals[*index as usize], None);
                rules.push(Element::new("algebraicRule").child(residual));
                continue;
            }
            let (name, formula, unit) = match &quantity.role {
                Role::Defined { rule } => {
                    ("assignmentRule", with_history(rule, before), self.units.reference(&quantity.unit))
                }
                Role::Variable { rate } if *rate != Expr::Number(0.0) => ("rateRule", rate.clone(), None),
                _ => continue,
            };
            let formula = self.formulas.number(&formula, unit.as_deref());
            rules.push(Element::new(name).with("variable", id).child(formula));
        }
        rules
    }
}

/// What a definition is at all times, and what it was before the start.
fn with_history(rule: &Expr, before: Option<&Expr>) -> Expr {
    let Some(before) = before else { return rule.clone() };
    let is_before = Expr::Time.binary(Binary::Lt, Expr::Number(0.0));
    Expr::Piecewise { branches: vec![(is_before, before.clone())], otherwise: Box::new(rule.clone()) }
}

/// A number as an attribute holds it, with all its digits.
fn decimal(value: f64) -> String {
    if value == 0.0 || (1e-4..1e15).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
}
