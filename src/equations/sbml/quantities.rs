//! What compartments, parameters, stoichiometries and reactions are in the system.

use super::document::{Parameter, RuleKind};
use super::math::Scope;
use super::plan::Plan;
use super::xml::Node;
use crate::equations::pieces::{number, quantity, replaced};
use crate::equations::tree::{Expr, QuantityId, Role};

impl<'a> Plan<'_, 'a> {
    /// Role and start of all compartments, parameters and stoichiometries with a name.
    pub fn plain_quantities(&mut self) {
        let document = self.document;
        for compartment in &document.compartments {
            let needs_size = compartment.dimensions != 0.0;
            let silent = self.initial.contains_key(compartment.id) || self.is_defined(compartment.id);
            if compartment.size.is_none() && needs_size && !silent {
                self.page.notice(format!("compartment `{}` has no size: it is taken as 1", compartment.id));
            }
            self.plain(compartment.id, Some(compartment.size.unwrap_or(1.0)));
        }
        for parameter in &document.parameters {
            self.plain(parameter.id, parameter.value);
        }
        for participant in document.reactions.iter().flat_map(|reaction| &reaction.participants) {
            let Some(id) = participant.id else { continue };
            let silent = self.initial.contains_key(id) || self.is_defined(id) || participant.math.is_some();
            if participant.stoichiometry.is_none() && !silent && self.page.level == 3 {
                self.page.notice(format!("species reference `{id}` has no stoichiometry: it is taken as 1"));
            }
            self.plain(id, Some(participant.stoichiometry.unwrap_or(1.0)));
            if let (Some(math), Some(&quantity_id), false) =
                (participant.math, self.reader.symbols.get(id), self.is_defined(id))
            {
                self.quantities[quantity_id as usize].role = Role::Defined { rule: self.reader.formula(math) };
            }
        }
    }

    /// The formula of an initial assignment. A concentration that the model gives stands for its number, so that the size
    /// of its compartment may depend on it.
    pub fn start_formula(&self, math: Node<'a>) -> Expr {
        replaced(&self.reader.formula(math), &|quantity_id| {
            let index = self.amounts.binary_search(&quantity_id.checked_sub(1)?).ok()?;
            let species = &self.document.species[index];
            let by_other =
                species.amount.is_some() || self.initial.contains_key(species.id) || self.is_defined(species.id);
            species.concentration.filter(|_| !by_other).map(number)
        })
    }

    /// Role and start of what is its own quantity: by its rule, its initial assignment, the events, its value.
    fn plain(&mut self, id: &'a str, value: Option<f64>) {
        let Some(&quantity_id) = self.reader.symbols.get(id) else { return };
        let initial = match self.initial.get(id) {
            Some(math) => self.start_formula(*math),
            None => {
                if value.is_none() && !self.is_defined(id) {
                    self.unset.push(quantity_id);
                }
                number(value.unwrap_or(f64::NAN))
            }
        };
        let role = match self.rules.get(id) {
            Some((RuleKind::Assignment, math)) => Role::Defined { rule: self.rule(id, *math) },
            Some((RuleKind::Rate, math)) => Role::Variable { rate: self.reader.formula(*math) },
            None if self.set_by_events.contains(id) => Role::Variable { rate: number(0.0) },
            None => Role::Parameter,
        };
        let quantity = &mut self.quantities[quantity_id as usize];
        (quantity.initial, quantity.role) = (initial, role);
    }

    /// The rates of all reactions, and their local parameters as quantities named `reaction.parameter`.
    pub fn reactions(&mut self) {
        let document = self.document;
        for reaction in &document.reactions {
            let mut scope = Scope::default();
            let law = reaction.law.as_ref();
            for local in law.into_iter().flat_map(|law| &law.locals) {
                let quantity_id = self.local(local);
                if scope.names.insert(local.id, quantity(quantity_id)).is_some() {
                    let found = format!("`{}` is declared twice", local.id);
                    self.page.fault_in(local.node, "id", found, "rename one of the two");
                }
            }
            let rule = match law.and_then(|law| law.math) {
                Some(math) => self.reader.local_formula(math, &scope),
                None => {
                    self.page.notice(format!("reaction `{}` has no kinetic law and does not happen", reaction.id));
                    number(0.0)
                }
            };
            if let Some(&quantity_id) = self.reader.symbols.get(reaction.id) {
                self.quantities[quantity_id as usize].role = Role::Defined { rule };
            }
        }
    }

    /// The start of a local parameter.
    fn local(&mut self, local: &Parameter<'a>) -> QuantityId {
        let quantity_id = self.locals[&local.node.index()];
        self.quantities[quantity_id as usize].initial = number(local.value.unwrap_or(f64::NAN));
        if local.value.is_none() {
            self.unset.push(quantity_id);
        }
        quantity_id
    }

    /// The stoichiometry of a participant.
    pub fn stoichiometry(&self, reaction: usize, position: usize) -> Expr {
        let participant = &self.document.reactions[reaction].participants[position];
        let named = participant.id.and_then(|id| self.reader.symbols.get(id).map(|&quantity| (id, quantity)));
        if let Some((id, quantity_id)) = named {
            let fixed =
                matches!(self.quantities[quantity_id as usize].role, Role::Parameter) && !self.initial.contains_key(id);
            if !fixed {
                return quantity(quantity_id);
            }
        } else if let Some(math) = participant.math {
            return self.reader.formula(math);
        }
        number(participant.stoichiometry.unwrap_or(1.0))
    }
}
