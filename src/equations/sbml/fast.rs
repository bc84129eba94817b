//! Fast reactions, whose equilibrium holds at all times.
//!
//! A fast reaction of one reactant A and one product B, n_A' = … − α J and n_B' = … + β J, keeps n_A/α + n_B/β. This total is the state
//! in place of the two amounts: slow reactions change it, and both amounts follow from it and from J = 0, where the law is linear
//! in them, or proportional to both (`catalysis`). Where one of the two is at the boundary the other follows from it. The equilibrium
//! must draw amounts near: J falls as the reaction goes on.

use super::document::Reaction;
use super::plan::{Equilibrium, Kind, Plan};
use crate::equations::linear::line;
use crate::equations::pieces::{difference, negative, number, product, quantity, quotient, replaced, sum};
use crate::equations::tree::{Expr, QuantityId, Role};
use std::cell::Cell;

/// How many rules and initial assignments a number may be behind.
pub const DEPTH: usize = 8;

impl<'a> Plan<'_, 'a> {
    /// Adds quantities for what fast reactions keep, before rates of change are numbered. Fast reactions of which no equilibrium is
    /// solved for are faults.
    pub fn declare_equilibria(&mut self) {
        let document = self.document;
        for (index, reaction) in document.reactions.iter().enumerate().filter(|(_, reaction)| reaction.fast) {
            let Some(species) = self.pair(reaction) else {
                self.not_solved_for(reaction);
                continue;
            };
            let total = (!species.iter().any(|&index| self.is_held(index))).then(|| {
                let total = self.quantity(format!("total({})", reaction.id), reaction.node);
                self.quantities[total as usize].name.clear();
                total
            });
            self.equilibria.push(Equilibrium { reaction: index, species, total });
        }
    }

    fn is_held(&self, index: usize) -> bool {
        let species = &self.document.species[index];
        species.boundary || species.constant
    }

    /// The reactant and the product of a reaction that has one of each, if nothing but slow reactions changes them beside it.
    fn pair(&self, reaction: &Reaction<'a>) -> Option<[usize; 2]> {
        reaction.law.as_ref()?.math?;
        let index = |sign: f64| {
            let found = reaction.participants.iter().find(|participant| participant.sign == sign)?;
            match self.kinds.get(found.species) {
                Some(&Kind::Species(index)) => Some(index),
                _ => None,
            }
        };
        let pair = [index(-1.0)?, index(1.0)?];
        let alone = |&index: &usize| {
            let id = self.document.species[index].id;
            let has = |other: &&Reaction<'a>| other.fast && other.participants.iter().any(|part| part.species == id);
            let said = self.rules.contains_key(id) || self.set_by_events.contains(id);
            self.is_held(index) || (!said && self.document.reactions.iter().filter(has).count() == 1)
        };
        let moves = pair.iter().any(|&index| !self.is_held(index));
        (reaction.participants.len() == 2 && pair[0] != pair[1] && moves && pair.iter().all(alone)).then_some(pair)
    }

    /// Lets totals be the state, and the amounts of fast reactions follow from them. Species have their roles by slow reactions.
    pub fn solve_equilibria(&mut self) {
        for equilibrium in self.equilibria.clone() {
            if self.solve_equilibrium(equilibrium).is_none() {
                self.not_solved_for(&self.document.reactions[equilibrium.reaction]);
            }
        }
    }

    fn solve_equilibrium(&mut self, Equilibrium { reaction, species, total }: Equilibrium) -> Option<()> {
        let rate = *self.reader.symbols.get(self.document.reactions[reaction].id)?;
        let Role::Defined { rule: law } = &self.quantities[rate as usize].role else { return None };
        // Seen from the species that is solved for, the other one follows, or is held.
        let from_product = self.is_held(species[0]);
        let [solved, other] = if from_product { [species[1], species[0]] } else { species };
        let factors = [-1.0, 1.0].map(|sign| self.factor(reaction, sign));
        let good = |factor: &Expr| self.steady_value(factor, false, DEPTH) > 0.0;
        let [used, made] = factors.into_iter().filter(good).collect::<Vec<_>>().try_into().ok()?;
        let (solved, other) = (self.species_ids(solved), self.species_ids(other));
        let partner = match total {
            Some(total) => {
                let rest = difference(quantity(total), quotient(quantity(solved.amount), used.clone()));
                product(made.clone(), rest)
            }
            None => quantity(other.amount),
        };
        let law = &match total {
            Some(_) => self.without_catalysis(law, if from_product { [other, solved] } else { [solved, other] })?,
            None => law.clone(),
        };
        if let (Expr::Number(0.0), Some(total)) = (law, total) {
            let parts = [(solved, &used), (other, &made)].map(|(ids, by)| quotient(quantity(ids.amount), by.clone()));
            let [a, b] = parts;
            self.quantities[total as usize].role = Role::Defined { rule: sum(a, b) };
            return Some(());
        }
        let law = replaced(law, &|quantity_id| match quantity_id {
            id if id == other.amount => Some(partner.clone()),
            id if id == other.concentration => Some(quotient(partner.clone(), other.size())),
            id if id == solved.concentration => Some(quotient(quantity(solved.amount), solved.size())),
            _ => None,
        });
        let (slope, constant) = line(&law, solved.amount)?;
        // The equilibrium holds from the start on.
        for amount in [solved.amount, other.amount] {
            self.history.push((amount, self.quantities[amount as usize].initial.clone()));
        }
        if !self.has_sign(&slope, if from_product { -1.0 } else { 1.0 }, None) {
            return None;
        }
        if let Some(total) = total {
            let [(rate, initial), (more, begin)] = [(solved, &used), (other, &made)].map(|(ids, factor)| {
                let entry = &self.quantities[ids.amount as usize];
                let share = |part: &Expr| match part {
                    Expr::Number(0.0) => number(0.0),
                    part => quotient(part.clone(), factor.clone()),
                };
                let rate = if let Role::Variable { rate } = &entry.role { rate } else { &number(0.0) };
                (share(rate), share(&entry.initial))
            });
            let entry = &mut self.quantities[total as usize];
            (entry.role, entry.initial) = (Role::Variable { rate: sum(rate, more) }, sum(initial, begin));
            self.quantities[other.amount as usize].role = Role::Defined { rule: partner };
        }
        let amount = quotient(negative(constant), slope);
        self.quantities[solved.amount as usize].role = Role::Defined { rule: amount };
        Some(())
    }

    /// By how much the amount of a reaction's only reactant (sign -1) or product (1) changes with its extent.
    fn factor(&self, reaction: usize, sign: f64) -> Expr {
        let participants = &self.document.reactions[reaction].participants;
        let position = participants.iter().position(|participant| participant.sign == sign).unwrap_or(0);
        let factor = match self.kinds.get(participants[position].species) {
            Some(&Kind::Species(index)) => self.conversion(&self.document.species[index]),
            _ => number(f64::NAN),
        };
        product(self.stoichiometry(reaction, position), factor)
    }

    /// The value of what never changes, but for the sizes of compartments if these may; not a number where it depends on more.
    pub fn steady_value(&self, expr: &Expr, sizes: bool, depth: usize) -> f64 {
        let Some(depth) = depth.checked_sub(1).filter(|_| !expr.uses_time()) else { return f64::NAN };
        let varies = Cell::new(false);
        let value = expr.evaluate(f64::NAN, &|quantity_id: QuantityId| {
            let quantity = self.quantities.get(quantity_id as usize);
            let size = |id: &str| sizes && matches!(self.kinds.get(id), Some(Kind::Compartment(_)));
            let value = match quantity.map(|quantity| (&quantity.role, quantity)) {
                Some((Role::Defined { rule }, _)) => self.steady_value(rule, sizes, depth),
                Some((Role::Variable { .. }, quantity)) if !size(&quantity.id) => f64::NAN,
                Some((_, quantity)) => self.steady_value(&quantity.initial, sizes, depth),
                None => f64::NAN,
            };
            varies.set(varies.get() || value.is_nan());
            value
        });
        if varies.get() { f64::NAN } else { value }
    }

    fn not_solved_for(&self, reaction: &Reaction<'a>) {
        let found = format!("reaction `{}` is fast, and its equilibrium is not solved for", reaction.id);
        let help = "it is where one reactant becomes one product by a law linear in both or proportional to both, and no rule, event or other fast reaction \
                    changes these; else write the equilibrium with rules, or give the reaction a law much quicker than the others";
        self.page.fault_in(reaction.node, "fast", found, help);
    }
}
