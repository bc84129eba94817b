//! Species: their amounts and concentrations, in compartments of constant or changing size.
//!
//! The state is the amount n; the concentration is n/V. Reactions change amounts, and when only the size V changes, the
//! amount stays. A rate rule for a concentration c means dn/dt = V dc/dt + c dV/dt. Where V follows an assignment
//! rule, its rate is not at hand and the state is c instead, n = c V.

use super::document::{RuleKind, Species};
use super::plan::{Change, Kind, Plan};
use super::xml::Node;
use crate::equations::pieces::{difference, negative, number, product, quantity, quotient, sum, total};
use crate::equations::tree::{Expr, Participant, QuantityId, Reaction, Role};

/// The quantities of a species and of its compartment.
#[derive(Clone, Copy)]
pub struct SpeciesIds {
    pub amount: QuantityId,
    pub concentration: QuantityId,
    /// None when the compartment is not known.
    pub size: Option<QuantityId>,
}

impl SpeciesIds {
    pub fn size(&self) -> Expr {
        self.size.map_or(number(1.0), quantity)
    }
}

impl<'a> Plan<'_, 'a> {
    /// The quantities of a species.
    pub fn species_ids(&self, number: usize) -> SpeciesIds {
        let amount = self.amounts[number];
        let compartment = self.document.species[number].compartment;
        SpeciesIds { amount, concentration: amount + 1, size: self.compartment_id(compartment) }
    }

    fn compartment_id(&self, id: &str) -> Option<QuantityId> {
        let known = matches!(self.kinds.get(id), Some(Kind::Compartment(_)));
        self.reader.symbols.get(id).copied().filter(|_| known)
    }

    /// Whether the state of a species is its concentration.
    pub fn keeps_concentration(&self, species: &Species<'a>) -> bool {
        let has_rate = matches!(self.rules.get(species.id), Some((RuleKind::Rate, _)));
        has_rate && !species.only_amount && self.change(species.compartment) == Change::Defined
    }

    /// Role and start of all species. Roles of compartments and rules of reactions are there already.
    pub fn all_species(&mut self) {
        let document = self.document;
        let mut terms = self.reaction_terms();
        for (index, species) in document.species.iter().enumerate() {
            let ids = self.species_ids(index);
            if ids.size.is_none() && !species.compartment.is_empty() {
                let found = format!("there is no compartment `{}`", species.compartment);
                self.page.fault_in(species.node, "compartment", found, "name one of the <listOfCompartments>");
            }
            let amount = self.start(species, ids);
            let (amount_role, concentration_role) = self.roles(species, ids, std::mem::take(&mut terms[index]));
            let concentration = quotient(amount.clone(), ids.size());
            for (entry, role, initial) in
                [(ids.amount, amount_role, amount), (ids.concentration, concentration_role, concentration)]
            {
                let entry = &mut self.quantities[entry as usize];
                (entry.role, entry.initial) = (role, initial);
            }
        }
        self.solve_equilibria();
    }

    /// The amount at the start.
    fn start(&mut self, species: &Species<'a>, ids: SpeciesIds) -> Expr {
        if let Some(math) = self.initial.get(species.id) {
            let value = self.start_formula(*math);
            return if species.only_amount { value } else { product(value, ids.size()) };
        }
        match (species.amount, species.concentration) {
            (Some(amount), _) => number(amount),
            (None, Some(concentration)) => product(number(concentration), ids.size()),
            (None, None) => {
                if !self.is_defined(species.id) {
                    self.page.notice(format!("species `{}` has no initial value: it starts at 0", species.id));
                }
                number(0.0)
            }
        }
    }

    /// Roles of amount and concentration.
    fn roles(&self, species: &Species<'a>, ids: SpeciesIds, terms: Vec<Expr>) -> (Role, Role) {
        let size = ids.size();
        let as_concentration = Role::Defined { rule: quotient(quantity(ids.amount), size.clone()) };
        let as_amount = Role::Defined { rule: product(quantity(ids.concentration), size.clone()) };
        match self.rules.get(species.id) {
            Some((RuleKind::Assignment, math)) => {
                let rule = Role::Defined { rule: self.rule(species.id, *math) };
                if species.only_amount { (rule, as_concentration) } else { (as_amount, rule) }
            }
            Some((RuleKind::Rate, math)) => {
                let rate = self.reader.formula(*math);
                if species.only_amount {
                    return (Role::Variable { rate }, as_concentration);
                }
                if self.keeps_concentration(species) {
                    return (as_amount, Role::Variable { rate });
                }
                let mut rate = product(rate, size);
                if let (Change::Flows, Some(size)) = (self.change(species.compartment), ids.size) {
                    let flow = self.rate(size).unwrap_or(number(f64::NAN));
                    rate = sum(rate, product(quantity(ids.concentration), flow));
                }
                (Role::Variable { rate }, as_concentration)
            }
            None if !terms.is_empty() => (Role::Variable { rate: total(terms) }, as_concentration),
            None if self.set_by_events.contains(species.id) => (Role::Variable { rate: number(0.0) }, as_concentration),
            None => (Role::Parameter, as_concentration),
        }
    }

    /// What each species gains by each reaction that changes it.
    fn reaction_terms(&mut self) -> Vec<Vec<Expr>> {
        let document = self.document;
        let mut terms = vec![Vec::new(); document.species.len()];
        for (number_of, reaction) in document.reactions.iter().enumerate() {
            let happens = reaction.law.as_ref().is_some_and(|law| law.math.is_some());
            for (position, participant) in reaction.participants.iter().enumerate() {
                let Some(Kind::Species(index)) = self.kinds.get(participant.species).copied() else {
                    if !participant.species.is_empty() {
                        let found = format!("there is no species `{}`", participant.species);
                        self.page.fault_in(participant.node, "species", found, "name one of the <listOfSpecies>");
                    }
                    continue;
                };
                let species = &document.species[index];
                let stoichiometry = self.stoichiometry(number_of, position);
                if species.boundary || species.constant || !happens || reaction.fast {
                    continue;
                }
                if self.rules.contains_key(species.id) {
                    let found =
                        format!("species `{}` has a rule and is changed by reaction `{}`", species.id, reaction.id);
                    let help = "set boundaryCondition=\"true\" if the rule alone changes it, or delete the rule";
                    self.page.fault_in(participant.node, "species", found, help);
                    continue;
                }
                let Some(&rate) = self.reader.symbols.get(reaction.id) else { continue };
                let factor = self.conversion(species);
                let term = product(product(stoichiometry, factor), quantity(rate));
                terms[index].push(if participant.sign < 0.0 { negative(term) } else { term });
            }
        }
        terms
    }

    /// The reactions whose stoichiometries are numbers. What they make of rates is looked at where all rates are known.
    pub fn reactions_by_number(&self) -> Vec<Reaction> {
        let document = self.document;
        let mut found = Vec::new();
        for (index, reaction) in document.reactions.iter().enumerate() {
            let rate = self.reader.symbols.get(reaction.id).copied();
            let Some(rate) =
                rate.filter(|_| !reaction.fast && reaction.law.as_ref().is_some_and(|law| law.math.is_some()))
            else {
                continue;
            };
            let participant = |position: usize| {
                let Some(Kind::Species(species)) = self.kinds.get(reaction.participants[position].species).copied()
                else {
                    return None;
                };
                let is_held = document.species[species].boundary || document.species[species].constant;
                match self.stoichiometry(index, position) {
                    Expr::Number(stoichiometry) if stoichiometry > 0.0 && stoichiometry.is_finite() => {
                        Some(Participant { quantity: self.amounts[species], stoichiometry, is_held })
                    }
                    _ => None,
                }
            };
            let side = |sign: f64| {
                let positions = (0..reaction.participants.len())
                    .filter(|&position| reaction.participants[position].sign * sign > 0.0);
                positions.map(participant).collect::<Option<Vec<_>>>()
            };
            if let (Some(reactants), Some(products)) = (side(-1.0), side(1.0)) {
                found.push(Reaction { rate, reversible: reaction.reversible, reactants, products });
            }
        }
        found
    }

    /// What turns the extent of reactions into the amount of a species.
    pub fn conversion(&self, species: &Species<'a>) -> Expr {
        let Some(id) = species.factor.or(self.document.factor) else { return number(1.0) };
        match (self.kinds.get(id), self.reader.symbols.get(id)) {
            (Some(Kind::Parameter(_)), Some(&quantity_id)) => quantity(quantity_id),
            _ => {
                let found = format!("the conversion factor `{id}` is not a parameter");
                self.page.fault_in(species.node, "conversionFactor", found, "name one of the <listOfParameters>");
                number(1.0)
            }
        }
    }

    /// The rate of change of a quantity as an expression; none when an assignment rule hides it.
    pub fn rate(&self, quantity_id: QuantityId) -> Option<Expr> {
        match &self.quantities[quantity_id as usize].role {
            Role::Parameter | Role::Input => Some(number(0.0)),
            Role::Variable { rate } => Some(rate.clone()),
            Role::Defined { .. } => {
                let index = self.amounts.iter().position(|amount| amount + 1 == quantity_id)?;
                if self
                    .rules
                    .get(self.document.species[index].id)
                    .is_some_and(|(kind, _)| *kind == RuleKind::Assignment)
                {
                    return None;
                }
                let ids = self.species_ids(index);
                let change = self.rate(ids.amount)?;
                let flow = ids.size.map_or(Some(number(0.0)), |size| self.rate(size))?;
                let diluted = match flow {
                    Expr::Number(0.0) => change,
                    flow => difference(change, product(quantity(ids.concentration), flow)),
                };
                Some(quotient(diluted, ids.size()))
            }
        }
    }

    /// Gives the rates that formulas ask for their quantities.
    pub fn rates(&mut self) {
        for (quantity_id, node) in self.reader.rates() {
            let rule = self.rate(quantity_id).unwrap_or_else(|| self.no_rate(quantity_id, node));
            let id = format!("rateOf({})", self.quantities[quantity_id as usize].id);
            let made = self.quantity(id, node);
            self.quantities[made as usize].role = Role::Defined { rule };
            self.quantities[made as usize].name.clear();
            // Nothing changed before the start.
            self.history.push((made, number(0.0)));
        }
    }

    fn no_rate(&self, quantity_id: QuantityId, node: Node<'a>) -> Expr {
        let found = format!(
            "rateOf is asked for `{}`, which follows from an assignment rule",
            self.quantities[quantity_id as usize].id
        );
        self.page.fault(node, found, "only what a rate rule or reactions change has a rate in SBML");
        number(f64::NAN)
    }
}
