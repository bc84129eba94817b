//! What rules, initial assignments and events say of symbols.

use super::document::RuleKind;
use super::plan::{Change, Kind, Plan};
use super::xml::Node;
use crate::equations::tree::Expr;
use std::collections::{HashMap, HashSet};

/// So many symbols are followed to find out what one rests on.
const LONGEST_SEARCH: usize = 10_000;

impl<'a> Plan<'_, 'a> {
    /// Rules, initial assignments and event assignments by their symbols.
    pub fn statements(&mut self) {
        let document = self.document;
        for (kind, rule) in &document.rules {
            if !self.may_change(rule.node, "variable", rule.symbol) {
                continue;
            }
            let Some(math) = rule.math else {
                self.page.notice(format!("the rule for `{}` has no formula and says nothing", rule.symbol));
                continue;
            };
            if self.rules.insert(rule.symbol, (*kind, math)).is_some() {
                let found = format!("there are two rules for `{}`", rule.symbol);
                self.page.fault_in(rule.node, "variable", found, "keep one of them");
            }
        }
        for assignment in &document.initial {
            let symbol = assignment.symbol;
            if !self.is_settable(assignment.node, "symbol", symbol) {
                continue;
            }
            let Some(math) = assignment.math else {
                self.page.notice(format!("the initial assignment to `{symbol}` has no formula and assigns nothing"));
                continue;
            };
            if self.initial.insert(symbol, math).is_some() {
                let found = format!("there are two initial assignments to `{symbol}`");
                self.page.fault_in(assignment.node, "symbol", found, "keep one of them");
            }
            if self.is_defined(symbol) {
                let found = format!("`{symbol}` has both an assignment rule and an initial assignment");
                self.page.fault_in(assignment.node, "symbol", found, "the rule holds at the start too: delete this");
            }
        }
        for assignment in document.events.iter().flat_map(|event| &event.assignments) {
            let symbol = assignment.symbol;
            if !self.may_change(assignment.node, "variable", symbol) {
                continue;
            }
            if self.is_defined(symbol) {
                let found = format!("an event sets `{symbol}`, which has an assignment rule");
                self.page.fault_in(assignment.node, "variable", found, "the rule holds always: delete one of the two");
            }
            if assignment.math.is_some() {
                self.set_by_events.insert(symbol);
            } else {
                self.page.notice(format!("an event assignment to `{symbol}` has no formula and assigns nothing"));
            }
        }
    }

    /// Whether a symbol has a value that can be set.
    fn is_settable(&self, node: Node<'a>, attribute: &str, symbol: &str) -> bool {
        let kind = self.kinds.get(symbol);
        let settable =
            matches!(kind, Some(Kind::Compartment(_) | Kind::Species(_) | Kind::Parameter(_) | Kind::Reference(..)));
        if !settable && !symbol.is_empty() {
            let found = match kind {
                None => format!("`{symbol}` is not known"),
                Some(_) => format!("`{symbol}` has no value that can be set"),
            };
            let help = "name a compartment, a species, a parameter or a species reference";
            self.page.fault_in(node, attribute, found, help);
        }
        settable
    }

    /// Whether what a symbol is stays as it is.
    pub fn is_constant(&self, kind: Kind) -> bool {
        let document = self.document;
        match kind {
            Kind::Compartment(number) => document.compartments[number].constant,
            Kind::Species(number) => document.species[number].constant,
            Kind::Parameter(number) => document.parameters[number].constant,
            Kind::Reference(reaction, position) => document.reactions[reaction].participants[position].constant,
            Kind::Reaction(_) | Kind::Function | Kind::Event => true,
        }
    }

    /// Whether a symbol may change during a run.
    fn may_change(&self, node: Node<'a>, attribute: &str, symbol: &'a str) -> bool {
        if !self.is_settable(node, attribute, symbol) {
            return false;
        }
        let constant = self.is_constant(self.kinds[symbol]);
        if constant {
            let found = format!("`{symbol}` is constant and cannot be changed here");
            self.page.fault_in(node, attribute, found, format!("declare `{symbol}` with `constant=\"false\"`"));
        }
        !constant
    }

    /// Whether an assignment rule says what a symbol is.
    pub fn is_defined(&self, symbol: &str) -> bool {
        matches!(self.rules.get(symbol), Some((RuleKind::Assignment, _)))
    }

    /// The formula of a symbol's rule: as it is written, or as an algebraic rule was solved.
    pub fn rule(&self, symbol: &str, math: Node<'a>) -> Expr {
        self.solved.get(symbol).cloned().unwrap_or_else(|| self.reader.formula(math))
    }

    /// Whether what a symbol is may follow from one of some symbols, by rules and sizes; also where that is too long to find out.
    pub fn rests_on(&self, symbol: &'a str, some: &dyn Fn(&str) -> bool) -> bool {
        let (mut open, mut seen) = (vec![symbol], HashSet::from([symbol]));
        while let Some(symbol) = open.pop() {
            if some(symbol) || seen.len() > LONGEST_SEARCH {
                return true;
            }
            open.extend(self.used_by(symbol).filter(|name| seen.insert(*name)));
        }
        false
    }

    /// The symbols that rest on one of some, by rules and sizes.
    pub fn resting_on(&self, some: &HashSet<&'a str>) -> HashSet<&'a str> {
        let mut users: HashMap<&str, Vec<&'a str>> = HashMap::new();
        for symbol in self.kinds.keys().filter(|symbol| !some.contains(**symbol)) {
            self.used_by(symbol).for_each(|used| users.entry(used).or_default().push(symbol));
        }
        let (mut open, mut found): (Vec<&str>, _) = (some.iter().copied().collect(), HashSet::new());
        while let Some(used) = open.pop() {
            open.extend(users.remove(used).unwrap_or_default().into_iter().filter(|user| found.insert(*user)));
        }
        found
    }

    /// What the formula of a symbol names: its assignment rule, its law, or the size by which an amount is a concentration.
    fn used_by(&self, symbol: &str) -> impl Iterator<Item = &'a str> + use<'a> {
        let law = |number: usize| self.document.reactions[number].law.as_ref().and_then(|law| law.math);
        let (formula, compartment) = match (self.rules.get(symbol), self.kinds.get(symbol)) {
            (Some((RuleKind::Assignment, math)), _) => (Some(*math), None),
            (_, Some(&Kind::Reaction(number))) => (law(number), None),
            (_, Some(&Kind::Species(number))) => (None, Some(self.document.species[number].compartment)),
            _ => (None, None),
        };
        let names = formula.into_iter().flat_map(|math| math.descendants());
        let names = names.filter(|node| node.is_element() && node.name() == "ci").map(super::math::name);
        names.chain(compartment)
    }

    /// How a compartment's size changes.
    pub fn change(&self, compartment: &str) -> Change {
        match self.rules.get(compartment) {
            Some((RuleKind::Assignment, _)) => Change::Defined,
            Some((RuleKind::Rate, _)) => Change::Flows,
            None if self.set_by_events.contains(compartment) => Change::Jumps,
            None => Change::Never,
        }
    }
}
