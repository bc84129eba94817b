//! Events: what they set, in amounts.

use super::document;
use super::pieces::{binary, number, product, quantity, replaced};
use super::plan::{Change, Kind, Plan};
use crate::equations::tree::{Binary, Event, Expr, QuantityId, Role};
use std::collections::HashMap;

/// New values that an event sets at once.
type Values = HashMap<QuantityId, Expr>;

impl<'a> Plan<'_, 'a> {
    /// All events of the model.
    pub fn events(&mut self) -> Vec<Event> {
        let document = self.document;
        let mut made = Vec::new();
        for (index, event) in document.events.iter().enumerate() {
            let id = self.event_id(event, index);
            let Some(trigger) = event.trigger else {
                self.page.notice(format!("event `{id}` has no trigger and never fires"));
                continue;
            };
            let trigger = self.reader.formula(trigger);
            let delay = event.delay.map(|delay| self.reader.formula(delay));
            let priority = event.priority.map(|priority| self.reader.formula(priority));
            let (assignments, follower) = self.assignments(event, &id);
            made.push(Event {
                id,
                trigger,
                true_before_start: event.initially_true,
                delay,
                priority,
                values_from_firing: event.values_from_trigger,
                persistent: event.persistent,
                assignments,
            });
            made.extend(follower);
        }
        made
    }

    fn event_id(&self, event: &document::Event<'a>, number: usize) -> String {
        let made = |number: usize| format!("event_{number}");
        let free = |id: &String| !self.kinds.contains_key(id.as_str());
        event.id.map(str::to_owned).or((number + 1..).map(made).find(free)).unwrap_or_default()
    }

    /// What an event sets; and, when that takes the size of a compartment at the execution and values of the firing,
    /// a second event that follows at once.
    fn assignments(&self, event: &document::Event<'a>, id: &str) -> (Vec<(QuantityId, Expr)>, Option<Event>) {
        let mut values = Values::new();
        let mut order = Vec::new();
        for assignment in &event.assignments {
            let Some(&quantity_id) = self.reader.symbols.get(assignment.symbol) else { continue };
            let Some(math) = assignment.math else { continue };
            if values.insert(quantity_id, self.reader.formula(math)).is_some() {
                let found = format!("the event sets `{}` twice", assignment.symbol);
                self.page.fault_in(assignment.node, "variable", found, "keep one of the two");
            }
            order.push((quantity_id, assignment.symbol));
        }
        let (mut made, mut later) = (Vec::new(), Vec::new());
        for (quantity_id, symbol) in order {
            let value = values[&quantity_id].clone();
            let Some(Kind::Species(number)) = self.kinds.get(symbol).copied() else {
                made.push((quantity_id, value));
                continue;
            };
            let species = &self.document.species[number];
            let ids = self.species_ids(number);
            if species.only_amount || self.keeps_concentration(species) {
                made.push((quantity_id, value));
                continue;
            }
            if self.mixes_times(event, symbol) {
                later.push((ids, value));
            } else {
                let size = self.after(&ids.size(), &values);
                made.push((ids.amount, product(value, size)));
            }
        }
        let follower = if later.is_empty() { None } else { Some(self.follower(id, later, &mut made)) };
        (made, follower)
    }

    /// Keeps the concentrations of the firing until the execution, when a second event turns them into amounts.
    fn follower(
        &self,
        id: &str,
        later: Vec<(super::species::SpeciesIds, Expr)>,
        made: &mut Vec<(QuantityId, Expr)>,
    ) -> Event {
        let mut assignments = Vec::new();
        for (ids, value) in later {
            let kept = self.helper(&format!("{id}.{}", self.quantities[ids.amount as usize].id));
            made.push((kept, value));
            assignments.push((ids.amount, product(quantity(kept), ids.size())));
        }
        let due = self.helper(&format!("{id}.due"));
        made.push((due, number(1.0)));
        assignments.push((due, number(0.0)));
        Event {
            id: format!("{id}.amounts"),
            trigger: binary(Binary::Gt, quantity(due), number(0.5)),
            true_before_start: false,
            delay: None,
            priority: Some(number(f64::INFINITY)),
            values_from_firing: true,
            persistent: true,
            assignments,
        }
    }

    /// Adds quantities for what followers keep, before rates of change are numbered.
    pub fn declare_helpers(&mut self) {
        let document = self.document;
        for (index, event) in document.events.iter().enumerate() {
            let id = self.event_id(event, index);
            let symbols = event.assignments.iter().filter(|assignment| assignment.math.is_some());
            let kept: Vec<&str> = symbols.map(|assignment| assignment.symbol).collect();
            let kept: Vec<&str> = kept.into_iter().filter(|symbol| self.mixes_times(event, symbol)).collect();
            let due = (!kept.is_empty()).then_some("due");
            for name in kept.into_iter().chain(due) {
                let quantity_id = self.quantity(format!("{id}.{name}"), event.node);
                let entry = &mut self.quantities[quantity_id as usize];
                entry.name.clear();
                (entry.role, entry.initial) = (Role::Variable { rate: number(0.0) }, number(0.0));
            }
        }
    }

    /// Whether an event sets a concentration with values of the firing when the size at the execution is not known yet.
    fn mixes_times(&self, event: &document::Event<'a>, symbol: &str) -> bool {
        let Some(Kind::Species(number)) = self.kinds.get(symbol).copied() else { return false };
        let species = &self.document.species[number];
        let is_amount = species.only_amount || self.keeps_concentration(species);
        let sets_size =
            event.assignments.iter().any(|other| other.symbol == species.compartment && other.math.is_some());
        let steady = sets_size || self.change(species.compartment) == Change::Never;
        event.trigger.is_some() && event.delay.is_some() && event.values_from_trigger && !is_amount && !steady
    }

    /// The number of a quantity that only a follower uses.
    fn helper(&self, id: &str) -> QuantityId {
        let found = self.quantities.iter().position(|quantity| quantity.id == id);
        found.expect("helpers are declared") as QuantityId
    }

    /// What an expression is worth after an event has given its values.
    fn after(&self, expr: &Expr, values: &Values) -> Expr {
        replaced(expr, &|quantity_id| {
            if let Some(value) = values.get(&quantity_id) {
                return Some(value.clone());
            }
            match &self.quantities[quantity_id as usize].role {
                Role::Defined { rule } if self.depends(rule, values) => Some(self.after(rule, values)),
                _ => None,
            }
        })
    }

    /// Whether an expression uses what an event sets, directly or by rules.
    fn depends(&self, expr: &Expr, values: &Values) -> bool {
        let mut used = Vec::new();
        expr.each_quantity(&mut |quantity_id| used.push(quantity_id));
        used.into_iter().any(|quantity_id| {
            let by_rule = match &self.quantities[quantity_id as usize].role {
                Role::Defined { rule } => self.depends(rule, values),
                _ => false,
            };
            values.contains_key(&quantity_id) || by_rule
        })
    }
}
