//! Second reading: expressions are resolved, their units checked, and the system is put together.

use super::circles::circles;
use super::context::Context;
use super::declare::{Declarations, POSITION, tell};
use super::random_words::misplaced;
use super::vocabulary::with_article;
use super::xml::{Element, Text};
use crate::equations::expression::{Node, Scope, Unit, UnitScope, is_constant, parse};
use crate::equations::reactions;
use crate::equations::tree::{Binary, Draw, Expr, Quantity, QuantityId, Role, System};
use crate::error::Location;
use std::collections::HashMap;
use std::ops::Range;

/// The most definitions of which each uses the one before: what orders them is recursive.
const LONGEST_CHAIN: usize = 1000;

/// What an expression may use.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Use {
    /// Everything.
    All,
    /// What has a value at the start: everything but time.
    Start,
    /// What keeps one value: parameters.
    Fixed,
    /// Everything but what was: for what is worked out outside of a course.
    Now,
    /// What is known of the time before the start: parameters and the time.
    Before,
}

/// The second reader.
pub(super) struct Builder<'a, 'd> {
    pub(super) context: &'d mut Context,
    pub(super) known: Declarations<'a>,
    start: Scope,
    fixed: Scope,
    /// What is drawn where the system starts, with the names that stand for it.
    pub(super) draws: Vec<(Draw, String)>,
    pub(super) now: Scope,
    before: Scope,
    /// Intervals of schedules, which must be above 0, and where they are written.
    pub(super) schedules: Vec<(Expr, Range<usize>)>,
}

impl<'a, 'd> Builder<'a, 'd> {
    pub(super) fn new(context: &'d mut Context, known: Declarations<'a>) -> Self {
        let no_time = "only rates, definitions, events and transfers can use the time".to_owned();
        let no_delay = "only rates, definitions and events can look back".to_owned();
        let now = Scope { no_delay, ..known.scope.clone() };
        let start = Scope { no_time: no_time.clone(), ..now.clone() };
        let mut fixed = Scope { no_time, ..now.clone() };
        let is_parameter = |id: &str| known.sort(id) == Some("parameter");
        fixed.quantities.retain(|id, _| is_parameter(id));
        for id in known.scope.quantities.keys().filter(|id| !is_parameter(id)) {
            fixed.absent.insert(id.clone(), "this must keep one value: use numbers and parameters".to_owned());
        }
        let before = Scope { no_time: String::new(), ..fixed.clone() };
        Self { context, known, start, fixed, draws: Vec::new(), now, before, schedules: Vec::new() }
    }

    pub(super) fn scope(&self, allowed: Use) -> &Scope {
        match allowed {
            Use::All => &self.known.scope,
            Use::Start => &self.start,
            Use::Fixed => &self.fixed,
            Use::Now => &self.now,
            Use::Before => &self.before,
        }
    }

    /// Reads an expression; `expected` is its unit and what it is for. A number alone is taken in that unit.
    pub(super) fn expression(&mut self, text: &Text, allowed: Use, expected: Option<(&Unit, &str)>) -> Option<Expr> {
        let (node, troubles) = parse(&text.text);
        troubles.iter().for_each(|trouble| tell(self.context, text, trouble));
        if let Some(trouble) = misplaced(&node, &self.known.scope) {
            tell(self.context, text, &trouble);
            return None;
        }
        let resolved = self.scope(allowed).resolve(&node);
        match resolved {
            Ok(expr) if troubles.is_empty() => {
                if !is_constant(&node) {
                    self.check_units(text, &node, expected);
                }
                Some(expr)
            }
            Ok(_) => None,
            Err(more) => {
                more.iter().for_each(|trouble| tell(self.context, text, trouble));
                None
            }
        }
    }

    pub(super) fn check_units(&mut self, text: &Text, node: &Node, expected: Option<(&Unit, &str)>) {
        let mut troubles = Vec::new();
        let units = UnitScope { units: &self.known.units, scope: &self.known.scope, time: self.known.time_in_units() };
        match expected.filter(|_| units.time.is_some()) {
            // A document without any unit is not checked.
            Some((unit, what)) => units.expect(node, unit, what, &mut troubles),
            None => drop(units.measure(node, &mut troubles)),
        }
        troubles.iter().for_each(|trouble| tell(self.context, text, trouble));
    }

    /// The expression in an attribute; nothing when it is absent or at fault.
    pub(super) fn attribute(
        &mut self,
        element: &Element,
        name: &str,
        allowed: Use,
        expected: Option<(&Unit, &str)>,
    ) -> Option<Expr> {
        let text = element.attribute(name)?.clone();
        self.expression(&text, allowed, expected)
    }

    /// The number in an attribute.
    pub(super) fn number(&mut self, element: &Element, name: &str) -> Option<f64> {
        let text = element.attribute(name)?;
        let value = text.text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
        if value.is_none() {
            let message = format!("`{name}` is \"{}\"; a number was expected", text.text.trim());
            self.context.fault(text.whole(), &message, "not a number", "write a number such as 0.1 or 1e-6");
        }
        value
    }

    /// A number above zero.
    pub(super) fn positive(&mut self, element: &Element, name: &str) -> Option<f64> {
        let value = self.number(element, name)?;
        if value <= 0.0 {
            let message = format!("`{name}` is {value}; a number above 0 was expected");
            self.context.fault(element.location(name), &message, "not above 0", "write a number such as 0.1 or 1e-6");
            return None;
        }
        Some(value)
    }

    /// The unit of a quantity, where it has one.
    pub(super) fn unit_of(&self, id: &str) -> Option<Unit> {
        self.known.units.get(id).cloned()
    }

    /// The quantities of the document and where they are declared.
    pub(super) fn quantities(&mut self, root: &Element) -> (Vec<Quantity>, Vec<Location>) {
        let mut equations = self.equations(root);
        let mut by_reactions = reactions::rates(&self.known.reactions);
        let (mut quantities, mut locations) = (Vec::new(), Vec::new());
        for number in 0..self.known.quantities.len() {
            let (id, element) = (self.known.quantities[number].id.clone(), self.known.quantities[number].element);
            let own = self.unit_of(&id);
            let (role, initial) = match element.kind.name {
                "parameter" => (Some(Role::Parameter), self.value(element, "value", Use::Fixed, &id)),
                "mean" | "integral" => (Some(Role::Input), Some(Expr::Number(0.0))),
                "input" => (Some(Role::Input), self.value(element, "default", Use::Fixed, &id)),
                "define" => {
                    let what = format!("the definition of `{id}`");
                    let rule = self.expression(&element.text, Use::All, own.as_ref().map(|unit| (unit, what.as_str())));
                    (rule.map(|rule| Role::Defined { rule }), Some(Expr::Number(0.0)))
                }
                // Their equations are looked at when all rules are known.
                "algebraic" => (Some(Role::Input), Some(Expr::Number(0.0))),
                "reaction" => {
                    let rule = self.rate_of_reaction(element, &id);
                    (rule.map(|rule| Role::Defined { rule }), Some(Expr::Number(0.0)))
                }
                "field" => {
                    let rate = self.reaction(element, &id, by_reactions.remove(&(number as QuantityId)));
                    let initial = element
                        .attribute("initial")
                        .map(|_| ())
                        .map_or(Some(Expr::Number(0.0)), |()| self.value(element, "initial", Use::Start, &id));
                    (rate.map(|rate| Role::Variable { rate }), initial)
                }
                _ => {
                    let changed = by_reactions.remove(&(number as QuantityId));
                    let rate = self.rate(element, &id, equations.remove(id.as_str()), changed);
                    (rate.map(|rate| Role::Variable { rate }), self.start_of(element, &id))
                }
            };
            // After a fault something stands in its stead, so that all the rest can be read.
            quantities.push(Quantity {
                name: element.word("name"),
                role: role.unwrap_or(Role::Input),
                initial: initial.unwrap_or(Expr::Number(0.0)),
                unit: match (element.kind.name, &own) {
                    ("reaction", Some(unit)) => unit.text(),
                    _ => element.word("unit"),
                },
                id,
            });
            locations.push(self.context.location(element.location("id"), "declared here"));
        }
        for (name, unit) in self.known.given.clone() {
            let is_position = POSITION.contains(&name);
            quantities.push(Quantity {
                id: name.to_owned(),
                name: if is_position { format!("position {name}") } else { format!("{name} of the cell") },
                role: Role::Input,
                initial: Expr::Number(if is_position { 0.0 } else { 1.0 }),
                unit: if is_position { self.known.length_text.clone() } else { unit.text() },
            });
            locations.push(self.context.location(root.at.clone(), "given here"));
        }
        quantities.extend(self.drawn_quantities());
        locations.extend(self.draws.iter().map(|_| self.context.location(root.at.clone(), "drawn here")));
        (quantities, locations)
    }

    pub(super) fn value(&mut self, element: &Element, attribute: &str, allowed: Use, id: &str) -> Option<Expr> {
        let own = self.unit_of(id);
        let what = format!("`{attribute}` of `{id}`");
        self.attribute(element, attribute, allowed, own.as_ref().map(|unit| (unit, what.as_str())))
    }

    /// Equations that stand by themselves, by the variable they belong to.
    fn equations<'e>(&mut self, root: &'e Element) -> HashMap<String, &'e Element> {
        let mut found: HashMap<String, &Element> = HashMap::new();
        for element in root.all("equation").filter(|element| element.attribute("of").is_some()) {
            let id = element.word("of");
            let sort = self.known.sort(&id);
            let (message, help) = match sort {
                Some("variable") if found.contains_key(&id) => {
                    (format!("`{id}` has two equations"), "remove one, or add the two".to_owned())
                }
                Some("variable") => {
                    found.insert(id, element);
                    continue;
                }
                Some(other) => (
                    format!("`{id}` is {}, which has no rate of change", with_article(other)),
                    format!("declare it with <variable id=\"{id}\" initial=\"…\">"),
                ),
                None => {
                    let variables = self.known.ids().filter(|id| self.known.sort(id) == Some("variable"));
                    let near = self.context.meant(&id, variables);
                    let help = near.map_or(format!("declare <variable id=\"{id}\" initial=\"…\">"), |near| {
                        format!("did you mean `{near}`?")
                    });
                    (format!("there is no variable `{id}`"), help)
                }
            };
            self.context.fault(element.location("of"), &message, "this equation", &help);
        }
        found
    }

    /// The rate of a variable: its own, or what reactions make of it.
    fn rate(&mut self, element: &Element, id: &str, equation: Option<&Element>, changed: Option<Expr>) -> Option<Expr> {
        let own = equation.map(|equation| equation.location("of"));
        let own = own.or_else(|| element.attribute("rate").map(|_| element.location("rate")));
        if let (Some(own), Some(_)) = (&own, &changed) {
            let message = format!("`{id}` has a rate of its own and is changed by reactions");
            let help = format!(
                "write what the rate says as a reaction (\"-> {id}\" makes it, \"{id} ->\" uses it up), or `${id}` where a reaction leaves it as it is"
            );
            self.context.fault(own.clone(), &message, "beside reactions", &help);
            return None;
        }
        let text = match (element.attribute("rate"), equation) {
            (None, None) if changed.is_some() || self.known.lost_reactions => return changed,
            (Some(_), Some(equation)) => {
                let message = format!("`{id}` has a rate and an equation");
                self.context.fault(equation.location("of"), &message, "a second equation", "remove one of them");
                return None;
            }
            (Some(rate), None) => rate.clone(),
            (None, Some(equation)) => equation.text.clone(),
            (None, None) => {
                let help = format!(
                    "write <equation of=\"{id}\">…</equation>, a <reaction> that changes it, or rate=\"0\" for what only events change"
                );
                self.context.fault(element.location("id"), &format!("`{id}` has no equation"), "changes how?", &help);
                return None;
            }
        };
        let unit = self.per_time(id);
        let what = format!("the rate of `{id}`");
        self.expression(&text, Use::All, unit.as_ref().map(|unit| (unit, what.as_str())))
    }

    /// The rate of a field by reaction: its own, or what reactions of the document make of it.
    fn reaction(&mut self, element: &Element, id: &str, changed: Option<Expr>) -> Option<Expr> {
        let mut reactions = element.all("reaction");
        let Some(reaction) = reactions.next() else { return Some(changed.unwrap_or(Expr::Number(0.0))) };
        if changed.is_some() {
            let message = format!("`{id}` has a reaction of its own and is changed by others");
            let help = "write it as <reaction id=\"…\" equation=\"…\" rate=\"…\"/> beside the fields";
            self.context.fault(reaction.at.clone(), &message, "beside reactions", help);
        }
        if let Some(second) = reactions.next() {
            let message = format!("`{id}` has two reactions");
            self.context.fault(second.at.clone(), &message, "a second reaction", "write their sum in one <reaction>");
        }
        let unit = self.per_time(id);
        let what = format!("the reaction of `{id}`");
        self.expression(&reaction.text, Use::All, unit.as_ref().map(|unit| (unit, what.as_str())))
    }

    /// The net rate of a reaction.
    fn rate_of_reaction(&mut self, element: &Element, id: &str) -> Option<Expr> {
        let unit = self.unit_of(id);
        let mut part = |name: &str, what: String| {
            self.attribute(element, name, Use::All, unit.as_ref().map(|unit| (unit, what.as_str())))
        };
        let forward = part("rate", format!("the rate of `{id}`"));
        if element.attribute("reverse").is_none() {
            return forward;
        }
        let backward = part("reverse", format!("the reverse rate of `{id}`"));
        let reactions = &self.known.reactions;
        let number = self.find(id);
        if reactions.iter().any(|reaction| Some(reaction.rate) == number && !reaction.reversible) {
            let message = format!("`{id}` goes one way and has a reverse rate");
            let help = "write `=` for `->` in its equation, or remove `reverse`";
            self.context.fault(element.location("reverse"), &message, "backwards", help);
        }
        Some(forward?.binary(Binary::Sub, backward?))
    }

    fn per_time(&self, id: &str) -> Option<Unit> {
        self.unit_of(id).map(|unit| unit.times(&self.known.time.to_the(-1.0)))
    }

    /// Tells what depends on itself, and initial values that are not finite.
    pub(super) fn check_values(&mut self, system: &System) {
        let uses = |number: usize| -> Vec<usize> {
            let quantity = &system.quantities[number];
            let expr = match &quantity.role {
                Role::Defined { rule } => rule,
                _ => &quantity.initial,
            };
            let mut found = Vec::new();
            expr.each_quantity(&mut |other| found.push(other as usize));
            found.sort_unstable();
            found.dedup();
            found
        };
        let found = circles(system.quantities.len(), &uses);
        for circle in &found {
            let id = |number: &usize| format!("`{}`", system.quantities[*number].id);
            let path: Vec<String> = circle.iter().chain([&circle[0]]).map(id).collect();
            let defined = |number: &usize| matches!(system.quantities[*number].role, Role::Defined { .. });
            let what = if circle.iter().all(defined) { "definitions" } else { "initial values" };
            let message = format!("{what} go in a circle: {}", path.join(" → "));
            let at = self.known.quantities[circle[0]].element.location("id");
            let help = "let one of them be a number, or a <variable> with an equation";
            self.context.fault(at, &message, "in the circle", help);
        }
        if found.is_empty() {
            let lengths = super::start::lengths(system.quantities.len(), &uses);
            if let Some(number) = lengths.iter().position(|length| *length > LONGEST_CHAIN) {
                let at = self.known.quantities[number].element.location("id");
                let message = format!("more than {LONGEST_CHAIN} quantities in a row use each other to be computed");
                self.context.fault(at, &message, "too far down", "let expressions do more at once");
            } else if self.context.is_clean() {
                let values = super::start::values(system);
                self.check_finite(&values);
                self.check_delays(system, &values);
                self.check_roots(&system.quantities, &values);
                self.check_schedules(&values);
            }
        }
    }

    fn check_finite(&mut self, values: &[f64]) {
        for (number, value) in values.iter().enumerate() {
            let Some(declared) = self.known.quantities.get(number) else { continue };
            let attribute = match declared.element.kind.name {
                "parameter" => "value",
                "input" => "default",
                "variable" => "initial",
                _ => continue,
            };
            if !value.is_finite() {
                let message = format!("`{attribute}` of `{}` is {value}, which is not finite", declared.id);
                let at = declared.element.location(attribute);
                self.context.fault(at, &message, &value.to_string(), "correct it: a run must start from numbers");
            }
        }
    }

    /// The number of a quantity.
    pub(super) fn find(&self, id: &str) -> Option<QuantityId> {
        self.known.scope.quantities.get(id).copied()
    }
}
