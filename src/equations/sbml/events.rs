//! Events: what they set, in amounts.

use super::document;
use super::plan::{Change, Kind, Plan};
use super::xml::Node;
use crate::equations::pieces::{binary, extent, number, product, quantity, quotient, replaced};
use crate::equations::tree::{Binary, Event, Expr, QuantityId, Role};
use std::collections::{HashMap, HashSet};

/// New values that an event sets at once.
type Values = HashMap<QuantityId, Expr>;

/// How deep rules may lead to what an event sets.
const DEPTH: usize = 300;

/// What must be known of all events to read one.
struct Setters<'a> {
    /// How many events set each symbol.
    counts: HashMap<&'a str, usize>,
    /// The species whose state is the concentration.
    keepers: Vec<usize>,
}

impl<'a> Plan<'_, 'a> {
    /// All events of the model.
    pub fn events(&mut self) -> Vec<Event> {
        let document = self.document;
        let (setters, mut made) = (self.setters(), Vec::new());
        for (index, event) in document.events.iter().enumerate() {
            let id = self.event_id(event, index);
            let Some(trigger) = event.trigger else {
                self.page.notice(format!("event `{id}` has no trigger and never fires"));
                continue;
            };
            let trigger = self.reader.formula(trigger);
            let delay = event.delay.map(|delay| self.reader.formula(delay));
            let priority = event.priority.map(|priority| self.reader.formula(priority));
            let (assignments, follower) = self.assignments(event, &id, &setters);
            made.push(Event {
                id,
                trigger,
                true_before_start: event.initially_true,
                delay,
                priority,
                values_from_firing: event.values_from_trigger,
                persistent: event.persistent,
                assignments,
                schedule: None,
            });
            made.extend(follower);
        }
        made
    }

    fn setters(&self) -> Setters<'a> {
        let mut counts = HashMap::new();
        for event in &self.document.events {
            set_by(event)
                .collect::<HashSet<_>>()
                .into_iter()
                .for_each(|symbol| *counts.entry(symbol).or_default() += 1);
        }
        let species = self.document.species.iter().enumerate();
        let keepers = species.filter(|(_, species)| self.keeps_concentration(species)).map(|(index, _)| index);
        Setters { counts, keepers: keepers.collect() }
    }

    fn event_id(&self, event: &document::Event<'a>, number: usize) -> String {
        let made = |number: usize| format!("event_{number}");
        let free = |id: &String| !self.kinds.contains_key(id.as_str());
        event.id.map(str::to_owned).or((number + 1..).map(made).find(free)).unwrap_or_default()
    }

    /// What an event sets; and, when values of the firing meet sizes of the execution, a second event that follows at once.
    fn assignments(
        &self,
        event: &document::Event<'a>,
        id: &str,
        setters: &Setters<'a>,
    ) -> (Vec<(QuantityId, Expr)>, Option<Event>) {
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
        if !self.mixes_times(event, setters) {
            return (self.amounts_set(event.node, (&order, &values), &setters.keepers), None);
        }
        let mut kept = Vec::new();
        for &(quantity_id, symbol) in &order {
            let helper = self.helper(&format!("{id}.{symbol}"));
            let value = values.insert(quantity_id, quantity(helper));
            kept.extend(value.map(|value| (helper, value)));
        }
        let due = self.helper(&format!("{id}.due"));
        kept.push((due, number(1.0)));
        let mut assignments = self.amounts_set(event.node, (&order, &values), &setters.keepers);
        assignments.push((due, number(0.0)));
        (kept, Some(follower(id, due, assignments)))
    }

    /// What is set when symbols get values: amounts for concentrations, by the sizes that compartments have before. Where the
    /// state is a concentration, it jumps when the event changes the size, and the amount stays.
    fn amounts_set(
        &self,
        node: Node<'a>,
        (order, values): (&[(QuantityId, &str)], &Values),
        keepers: &[usize],
    ) -> Vec<(QuantityId, Expr)> {
        let jumped = |concentration: Expr, size: Expr| match self.depends(&size, values) {
            true => quotient(product(concentration, size.clone()), self.after(&size, values, (node, DEPTH))),
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
        for &index in keepers {
            let ids = self.species_ids(index);
            if !values.contains_key(&ids.concentration) && self.depends(&ids.size(), values) {
                if !self.reader.take(1) {
                    self.reader.too_large::<()>(node);
                    break;
                }
                made.push((ids.concentration, jumped(quantity(ids.concentration), ids.size())));
            }
        }
        made
    }

    /// Adds quantities for what followers keep, before rates of change are numbered.
    pub fn declare_helpers(&mut self) {
        let (document, setters) = (self.document, self.setters());
        for (index, event) in document.events.iter().enumerate() {
            if !self.mixes_times(event, &setters) {
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
    fn mixes_times(&self, event: &document::Event<'a>, setters: &Setters<'a>) -> bool {
        if event.trigger.is_none() || !event.values_from_trigger {
            return false;
        }
        let own: HashSet<&str> = set_by(event).collect();
        let by_another =
            |symbol: &str| setters.counts.get(symbol).is_some_and(|&n| n > usize::from(own.contains(symbol)));
        let varies = |index: usize| {
            let compartment = self.document.species[index].compartment;
            match event.delay {
                Some(_) => self.change(compartment) != Change::Never,
                None => self.rests_on(compartment, &by_another),
            }
        };
        let sets = |symbol: &&str| match self.kinds.get(symbol) {
            Some(&Kind::Species(index)) => !self.document.species[index].only_amount && varies(index),
            _ => false,
        };
        let jumps = |&index: &usize| {
            self.rests_on(self.document.species[index].compartment, &|symbol| own.contains(symbol)) && varies(index)
        };
        if !self.reader.take(setters.keepers.len()) {
            return self.reader.too_large::<()>(event.node).is_some();
        }
        own.iter().any(sets) || setters.keepers.iter().any(jumps)
    }

    /// The number of a quantity that only a follower uses.
    fn helper(&self, id: &str) -> QuantityId {
        let found = self.quantities.iter().position(|quantity| quantity.id == id);
        found.expect("helpers are declared") as QuantityId
    }

    /// What an expression is worth after an event has set its values.
    fn after(&self, expr: &Expr, values: &Values, (node, depth): (Node<'a>, usize)) -> Expr {
        replaced(expr, &|quantity_id| {
            let rule = match &self.quantities[quantity_id as usize].role {
                Role::Defined { rule } if self.depends(rule, values) => Some(rule),
                _ => None,
            };
            let by = values.get(&quantity_id).or(rule)?;
            if depth == 0 || !self.reader.take(extent(by).1) {
                return self.reader.too_large(node);
            }
            match values.get(&quantity_id) {
                Some(value) => Some(value.clone()),
                None => Some(self.after(by, values, (node, depth - 1))),
            }
        })
    }

    /// Whether an expression uses what an event sets, directly or by rules.
    fn depends(&self, expr: &Expr, values: &Values) -> bool {
        let (mut open, mut seen) = (Vec::new(), HashSet::new());
        expr.each_quantity(&mut |quantity_id| open.push(quantity_id));
        while let Some(quantity_id) = open.pop() {
            if values.contains_key(&quantity_id) {
                return true;
            }
            if let Role::Defined { rule } = &self.quantities[quantity_id as usize].role
                && seen.insert(quantity_id)
            {
                rule.each_quantity(&mut |other| open.push(other));
            }
        }
        false
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
        schedule: None,
    }
}
