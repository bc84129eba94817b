//! What can only be seen when all formulas are read: values that are missing, definitions in a circle.

use super::plan::Plan;
use crate::equations::tree::{Event, QuantityId, Role};

impl Plan<'_, '_> {
    /// A value that is missing is a fault where it can never come, or is needed at once; else it is told of.
    pub fn check_values(&self, events: &[Event]) {
        let mut used = vec![false; self.quantities.len()];
        let mut mark = |quantity_id: QuantityId| used[quantity_id as usize] = true;
        for quantity in &self.quantities {
            match &quantity.role {
                Role::Defined { rule } => rule.each_quantity(&mut mark),
                Role::Variable { rate } => {
                    rate.each_quantity(&mut mark);
                    quantity.initial.each_quantity(&mut mark);
                }
                Role::Parameter | Role::Input => quantity.initial.each_quantity(&mut mark),
            }
        }
        for event in events {
            let formulas = [Some(&event.trigger), event.delay.as_ref(), event.priority.as_ref()];
            let values = event.assignments.iter().map(|(_, value)| value);
            formulas.into_iter().flatten().chain(values).for_each(|formula| formula.each_quantity(&mut mark));
        }
        for equilibrium in &self.equilibria {
            let reaction = &self.document.reactions[equilibrium.reaction];
            if self.reader.symbols.get(reaction.id).is_some_and(|&rate| used[rate as usize]) {
                let found =
                    format!("a formula uses the rate of `{}`, which is fast: its equilibrium has no rate", reaction.id);
                let help =
                    "take it out of formulas, or make the reaction slow, with a law much quicker than the others";
                self.page.fault_in(reaction.node, "fast", found, help);
            }
        }
        for &quantity_id in &self.unset {
            let quantity = &self.quantities[quantity_id as usize];
            let id = &quantity.id;
            let flows = matches!(&quantity.role, Role::Variable { .. } if self.rules.contains_key(id.as_str()));
            let fixed = matches!(quantity.role, Role::Parameter) && used[quantity_id as usize];
            if flows || fixed {
                let found = format!("`{id}` has no value");
                self.page.fault(self.nodes[quantity_id as usize], found, "add `value=\"…\"` or an initial assignment");
            } else {
                self.page.notice(format!("parameter `{id}` has no value: it is not a number until an event sets it"));
            }
        }
    }

    /// Rules and initial values must follow from others without a circle.
    pub fn check_circles(&self) {
        let mut mark = vec![Mark::New; self.quantities.len()];
        for start in 0..self.quantities.len() as QuantityId {
            if mark[start as usize] == Mark::New
                && let Some(circle) = self.circle_from(start, &mut mark)
            {
                let names: Vec<&str> =
                    circle.iter().map(|&quantity_id| self.quantities[quantity_id as usize].id.as_str()).collect();
                let found = match names.as_slice() {
                    [one] => format!("`{one}` is defined by itself"),
                    _ => format!("definitions go in a circle: {} → {}", names.join(" → "), names[0]),
                };
                let help = "give one of them a value that does not depend on the others";
                self.page.fault(self.nodes[circle[0] as usize], found, help);
                return;
            }
        }
    }

    /// What must be known at the start before a quantity is.
    fn needs(&self, quantity_id: QuantityId) -> Vec<QuantityId> {
        let quantity = &self.quantities[quantity_id as usize];
        let mut needs = Vec::new();
        match &quantity.role {
            Role::Defined { rule } => rule.each_quantity(&mut |other| needs.push(other)),
            _ => quantity.initial.each_quantity(&mut |other| needs.push(other)),
        }
        needs
    }

    /// A circle met from a quantity on. The walk keeps its own stack: chains may be long.
    fn circle_from(&self, start: QuantityId, mark: &mut [Mark]) -> Option<Vec<QuantityId>> {
        let mut path = vec![(start, self.needs(start))];
        mark[start as usize] = Mark::Open;
        while let Some((quantity_id, needs)) = path.last_mut() {
            let Some(next) = needs.pop() else {
                mark[*quantity_id as usize] = Mark::Done;
                path.pop();
                continue;
            };
            match mark[next as usize] {
                Mark::Done => {}
                Mark::New => {
                    mark[next as usize] = Mark::Open;
                    path.push((next, self.needs(next)));
                }
                Mark::Open => {
                    let begin = path.iter().position(|(open, _)| *open == next).unwrap_or(0);
                    return Some(path[begin..].iter().map(|(open, _)| *open).collect());
                }
            }
        }
        None
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Mark {
    New,
    Open,
    Done,
}
