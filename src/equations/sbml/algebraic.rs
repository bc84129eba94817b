//! Algebraic rules, 0 = formula: which symbol each determines, and what that is equal to.
//!
//! A symbol can follow from an algebraic rule where nothing else determines it: it is not constant, has no other rule and no initial
//! assignment, no reaction changes it and no event sets it. Rules with one such symbol are solved first, and what they
//! determine is put into the others, as in Gauss' elimination. Rules that are left with as many symbols as there are rules
//! determine these together.

use super::document::RuleKind;
use super::linear::root;
use super::plan::{Kind, Plan};
use super::xml::Node;
use crate::equations::pieces::{extent, replaced};
use crate::equations::tree::{Expr, QuantityId};
use std::cell::Cell;
use std::collections::{BTreeSet, HashMap, HashSet};

/// An algebraic rule and the symbol that it determines.
#[derive(Clone, Copy)]
pub struct Determined<'a> {
    math: Node<'a>,
    symbol: &'a str,
}

/// Most rules that are solved together: each is put into all others.
const TOGETHER: usize = 100;
/// Most nodes of all formulas that are put into others, and how deep they may nest.
const SIZE_LIMIT: usize = 4_000_000;
const DEPTH_LIMIT: usize = 300;

/// What has been solved for, and where it may hide.
struct Known<'a> {
    solved: HashMap<QuantityId, Expr>,
    /// Symbols whose rules lead to what is solved for, now or later.
    hiding: HashSet<&'a str>,
    /// How many nodes may still be put in.
    left: Cell<usize>,
}

/// The rules that use a quantity, by their indices.
type Uses = HashMap<QuantityId, BTreeSet<usize>>;

/// A rule that is not yet solved.
struct Open<'a> {
    node: Node<'a>,
    math: Node<'a>,
    formula: Expr,
    /// What it could determine, in ascending order.
    unknowns: Vec<QuantityId>,
}

impl<'a> Plan<'_, 'a> {
    /// Finds out which symbol each algebraic rule determines, and notes it as that of an assignment rule. They come in
    /// the order in which they can be solved.
    pub fn algebraic_rules(&mut self) -> Vec<Determined<'a>> {
        let mut free = self.undetermined();
        let mut known = self.known(&free.values().copied().collect());
        let (mut open, mut uses): (Vec<Option<Open<'a>>>, Uses) = (Vec::new(), Uses::new());
        for rule in &self.document.algebraic {
            let Some(math) = rule.math else {
                self.page.notice("an algebraic rule has no formula and says nothing");
                continue;
            };
            let formula = self.put_in(&self.reader.formula(math), &known, &[]);
            let unknowns = self.unknowns(&formula, &free);
            note_uses(&mut uses, open.len(), &formula, &free);
            open.push(Some(Open { node: rule.node, math, formula, unknowns }));
        }
        let with_one = |(index, open): (usize, &Option<Open>)| {
            open.as_ref().filter(|open| open.unknowns.len() == 1).map(|_| index)
        };
        let mut ready: BTreeSet<usize> = open.iter().enumerate().filter_map(with_one).collect();
        let mut determined = Vec::new();
        while let Some(index) = ready.pop_first().or_else(|| first_of_square(&open)) {
            let Some(rule) = open[index].take() else { continue };
            let solution = rule.unknowns.iter().find_map(|&x| Some((x, root(&rule.formula, x)?)));
            let Some((x, root)) = solution else {
                self.not_linear(&rule, &free);
                continue;
            };
            let symbol = free.remove(&x).unwrap_or_default();
            known.solved.insert(x, root);
            determined.push(Determined { math: rule.math, symbol });
            for other in uses.remove(&x).unwrap_or_default() {
                let Some(rule) = open[other].as_mut() else { continue };
                rule.formula = self.put_in(&rule.formula, &known, &[]);
                rule.unknowns = self.unknowns(&rule.formula, &free);
                if rule.unknowns.len() == 1 {
                    ready.insert(other)
                } else {
                    ready.remove(&other)
                };
                note_uses(&mut uses, other, &rule.formula, &free);
            }
        }
        open.iter().flatten().for_each(|rule| self.not_determined(rule, &free));
        for &Determined { math, symbol } in &determined {
            self.rules.insert(symbol, (RuleKind::Assignment, math));
        }
        determined
    }

    /// Solves the algebraic rules for what they determine, once all quantities have their numbers.
    pub fn solve(&mut self, determined: &[Determined<'a>]) {
        let mut known = self.known(&determined.iter().map(|one| one.symbol).collect());
        for &Determined { math, symbol } in determined {
            let x = self.reader.symbols[symbol];
            let formula = self.put_in(&self.reader.formula(math), &known, &[]);
            let solution = root(&formula, x).unwrap_or(Expr::Number(f64::NAN));
            self.solved.insert(symbol, solution.clone());
            known.solved.insert(x, solution);
        }
    }

    /// Nothing is solved for yet of some symbols.
    fn known(&self, symbols: &HashSet<&'a str>) -> Known<'a> {
        Known { solved: HashMap::new(), hiding: self.resting_on(symbols), left: Cell::new(SIZE_LIMIT) }
    }

    /// The symbols that nothing determines so far, by their quantities.
    fn undetermined(&self) -> HashMap<QuantityId, &'a str> {
        let changed = self.changed_by_reactions();
        let is_free = |&(symbol, kind): &(&&'a str, &Kind)| {
            let said = self.rules.contains_key(*symbol) || self.initial.contains_key(*symbol);
            !said && !self.is_constant(*kind) && !self.set_by_events.contains(*symbol) && !changed.contains(*symbol)
        };
        let free = self.kinds.iter().filter(is_free);
        free.filter_map(|(symbol, _)| Some((*self.reader.symbols.get(symbol)?, *symbol))).collect()
    }

    /// The species that a reaction changes.
    fn changed_by_reactions(&self) -> HashSet<&'a str> {
        let happens = |law: &super::document::Law<'a>| law.math.is_some();
        let reactions = self.document.reactions.iter().filter(|reaction| reaction.law.as_ref().is_some_and(happens));
        let species = reactions.flat_map(|reaction| &reaction.participants).map(|participant| participant.species);
        species.filter(|species| !self.is_boundary(species)).collect()
    }

    fn is_boundary(&self, symbol: &str) -> bool {
        matches!(self.kinds.get(symbol), Some(&Kind::Species(index)) if self.document.species[index].boundary)
    }

    /// What a formula could determine. A species at the boundary is held from outside if something else can follow.
    fn unknowns(&self, formula: &Expr, free: &HashMap<QuantityId, &'a str>) -> Vec<QuantityId> {
        let mut found = BTreeSet::new();
        formula.each_quantity(&mut |quantity_id| {
            if free.contains_key(&quantity_id) {
                found.insert(quantity_id);
            }
        });
        let inner: Vec<QuantityId> = found.iter().copied().filter(|x| !self.is_boundary(free[x])).collect();
        if inner.is_empty() { found.into_iter().collect() } else { inner }
    }

    /// A formula with what has been solved for put in, and with the assignment rules behind which it may hide.
    fn put_in(&self, formula: &Expr, known: &Known<'a>, path: &[QuantityId]) -> Expr {
        replaced(formula, &|quantity_id| {
            if path.contains(&quantity_id) {
                return None;
            }
            let by = match known.solved.get(&quantity_id) {
                Some(solution) => solution.clone(),
                None => {
                    let id = self.quantities.get(quantity_id as usize)?.id.trim_matches(['[', ']']);
                    let (&symbol, (kind, math)) = self.rules.get_key_value(id)?;
                    if *kind != RuleKind::Assignment || !known.hiding.contains(symbol) {
                        return None;
                    }
                    self.reader.formula(*math)
                }
            };
            let (depth, size) = extent(&by);
            if path.len() + depth > DEPTH_LIMIT || size > known.left.get() {
                return None;
            }
            known.left.set(known.left.get() - size);
            Some(self.put_in(&by, known, &[path, &[quantity_id]].concat()))
        })
    }

    fn not_linear(&self, rule: &Open<'a>, free: &HashMap<QuantityId, &'a str>) {
        let names = names(&rule.unknowns, free);
        let found = format!("the algebraic rule is not linear in {names}, which nothing else determines");
        let help = "solve the equation for it by hand, and write an <assignmentRule> for it in place of this rule";
        self.page.fault(rule.node, found, help);
    }

    fn not_determined(&self, rule: &Open<'a>, free: &HashMap<QuantityId, &'a str>) {
        if rule.unknowns.is_empty() {
            let found = "nothing is left that the algebraic rule could determine";
            let help = "everything in it is constant or follows from other rules, reactions, initial assignments or events: \
                        delete the rule, or one of those";
            return self.page.fault(rule.node, found, help);
        }
        let found = format!("the algebraic rule could determine any of {}", names(&rule.unknowns, free));
        let help = "declare those that do not change with `constant=\"true\"`, or write an <assignmentRule> for the one that follows";
        self.page.fault(rule.node, found, help);
    }
}

/// Notes the use of all that is not yet determined.
fn note_uses(uses: &mut Uses, index: usize, formula: &Expr, free: &HashMap<QuantityId, &str>) {
    formula.each_quantity(&mut |x| {
        if free.contains_key(&x) {
            uses.entry(x).or_default().insert(index);
        }
    });
}

/// The first of the rules that are left, when these have as many unknowns as there are rules.
fn first_of_square(open: &[Option<Open>]) -> Option<usize> {
    let unknowns: HashSet<QuantityId> = open.iter().flatten().flat_map(|rule| &rule.unknowns).copied().collect();
    let rules = open.iter().flatten().count();
    let square =
        rules == unknowns.len() && rules <= TOGETHER && open.iter().flatten().all(|rule| !rule.unknowns.is_empty());
    open.iter().position(Option::is_some).filter(|_| square)
}

fn names(unknowns: &[QuantityId], free: &HashMap<QuantityId, &str>) -> String {
    let names: Vec<String> =
        unknowns.iter().map(|x| format!("`{}`", free.get(x).copied().unwrap_or_default())).collect();
    names.join(", ")
}
