//! Events: what they set, in amounts.

use super::document;
use super::pieces::{binary, number, product, quantity, quotient, replaced};
use super::plan::{Change, Kind, Plan};
use crate::equations::tree::{Binary, Event, Expr, QuantityId, Role};
use std::collections::{HashMap, HashSet};

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

    /// What an event sets; and, when values of the firing meet sizes of the execution, a second event that follows at once.
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
        if !self.mixes_times(event) {
            return (self.amounts_set(&order, &values), None);
        }
        let mut kept = Vec::new();
        for &(quantity_id, symbol) in &order {
            let helper = self.helper(&format!("{id}.{symbol}"));
            let value = values.insert(quantity_id, quantity(helper));
            kept.extend(value.map(|value| (helper, value)));
        }
        let due = self.helper(&format!("{id}.due"));
        kept.push((due, number(1.0)));
        let mut assignments = self.amounts_set(&order, &values);
        assignments.push((due, number(0.0)));
        (kept, Some(follower(id, due, assignments)))
    }

    /// What is set when symbols get values: amounts for concentrations, by the sizes that compartments have before. Where the
    /// state is a concentration, it jumps when the event changes the size, and the amount stays.
    fn amounts_set(&self, order: &[(QuantityId, &str)], values: &Values) -> Vec<(QuantityId, Expr)> {
        let jumped = |concentration: Expr, size: Expr| match self.depends(&size, values) {
            true => quotient(product(concentration, size.clone()), self.after(&size, values)),
            false => concentration,
        };
        let mut made = Vec::new();
        for &(quantity_id, symbol) in order {
            let value = values[&quantity_id].clone();
            match self.kinds.get(symbol) {
                Some(&Kind::Species(index)) if !self.document.species[index].only_amount => {
                    let ids = self.species_ids(index);
                    made.push(match self.keeps_concentration(&self.document.species[index]) {
                        true => (quantity_id, jumped(value, ids.size())),
                        false => (ids.amount, product(value, ids.size())),
                    });
                }
                _ => made.push((quantity_id, value)),
            }
        }
        for (index, species) in self.document.species.iter().enumerate() {
            let ids = self.species_ids(index);
            let others = self.keeps_concentration(species) && !values.contains_key(&ids.concentration);
            if others && self.depends(&ids.size(), values) {
                made.push((ids.concentration, jumped(quantity(ids.concentration), ids.size())));
            }
        }
        made
    }

    /// Adds quantities for what followers keep, before rates of change are numbered.
    pub fn declare_helpers(&mut self) {
        let document = self.document;
        for (index, event) in document.events.iter().enumerate() {
            if !self.mixes_times(event) {
                continue;
            }
            let id = self.event_id(event, index);
            for name in set_by(event).chain(["due"]) {
                let quantity_id = self.quantity(format!("{id}.{name}"), event.node);
                let entry = &mut self.quantities[quantity_id as usize];
                entry.name.clear();
                (entry.role, entry.initial) = (Role::Variable { rate: number(0.0) }, number(0.0));
            }
        }
    }

    /// Whether an event has values of its firing and sets a concentration by a size that may be another at its execution.
    fn mixes_times(&self, event: &document::Event<'a>) -> bool {
        if event.trigger.is_none() || !event.values_from_trigger {
            return false;
        }
        let others = self.document.events.iter().filter(|other| !std::ptr::eq(*other, event));
        let later: HashSet<&str> = others.flat_map(set_by).collect();
        let varies = |compartment: &'a str| match event.delay {
            Some(_) => self.change(compartment) != Change::Never,
            None => self.rests_on(compartment, &later),
        };
        let own: HashSet<&str> = set_by(event).collect();
        self.document.species.iter().any(|species| {
            let sets = own.contains(species.id) && !species.only_amount;
            let jumps = self.keeps_concentration(species) && self.rests_on(species.compartment, &own);
            (sets || jumps) && varies(species.compartment)
        })
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

/// The symbols that an event sets.
fn set_by<'d, 'a>(event: &'d document::Event<'a>) -> impl Iterator<Item = &'a str> + use<'d, 'a> {
    event.assignments.iter().filter(|assignment| assignment.math.is_some()).map(|assignment| assignment.symbol)
}

/// The second event of one that keeps the values of its firing until the execution: it sets them by the sizes that compartments
/// have then.
fn follower(id: &str, due: QuantityId, assignments: Vec<(QuantityId, Expr)>) -> Event {
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
