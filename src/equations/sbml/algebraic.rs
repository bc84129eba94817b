//! Algebraic rules, 0 = formula: which symbol each determines, and what that is equal to.
//!
//! A symbol can follow from an algebraic rule where nothing else determines it: it is not constant, has no other rule and no initial
//! assignment, no reaction changes it and no event sets it. Rules with one such symbol are solved first, and what they
//! determine is put into the others, as in Gauss' elimination. Rules that are left with as many symbols as there are rules
//! determine these together. What a rule is not linear in is sought, from the value that the model gives it.

use super::document::RuleKind;
use super::plan::{Kind, Plan};
use super::xml::Node;
use crate::equations::linear::root;
use crate::equations::pieces::{extent, number, product, quotient, replaced};
use crate::equations::tree::{Equations, Expr, QuantityId};
use std::cell::Cell;
use std::collections::{BTreeSet, HashMap, HashSet};

/// An algebraic rule and the symbol that it determines.
#[derive(Clone, Copy)]
pub struct Determined<'a> {
    math: Node<'a>,
    symbol: &'a str,
    /// The number that it shares with those with which it is sought together; none where the rule is solved for it.
    sought: Option<usize>,
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
            let (index, solution) = match self.solution(&open, index) {
                Some((index, x, root)) => (index, Some((x, root))),
                None => (index, None),
            };
            let Some(rule) = open[index].take() else { continue };
            let x = match (solution, &rule.unknowns[..]) {
                (Some((x, root)), _) => {
                    known.solved.insert(x, root);
                    determined.push(Determined { math: rule.math, symbol: free[&x], sought: None });
                    x
                }
                (None, &[x]) if !rule.formula.has_delay() => {
                    determined.push(Determined { math: rule.math, symbol: free[&x], sought: Some(determined.len()) });
                    x
                }
                (None, [_, _, ..]) if !rule.formula.has_delay() => {
                    open[index] = Some(rule);
                    self.seek_together(&mut open, &mut free, &mut determined);
                    continue;
                }
                (None, _) => {
                    self.not_linear(&rule, &free);
                    continue;
                }
            };
            free.remove(&x);
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
        for &Determined { math, symbol, .. } in &determined {
            self.rules.insert(symbol, (RuleKind::Assignment, math));
        }
        determined
    }

    /// Of the rules that are left, when these determine symbols together, the first that is linear in one; the rule itself alone where it
    /// has one symbol.
    fn solution(&self, open: &[Option<Open<'a>>], index: usize) -> Option<(usize, QuantityId, Expr)> {
        let of = |index: usize| {
            let rule = open[index].as_ref()?;
            rule.unknowns.iter().find_map(|&x| Some((index, x, root(&rule.formula, x)?)))
        };
        let is_alone = open[index].as_ref().is_some_and(|rule| rule.unknowns.len() == 1);
        of(index).or_else(|| if is_alone { None } else { (0..open.len()).find_map(of) })
    }

    /// Lets all rules that are left determine their symbols together.
    fn seek_together(
        &self,
        open: &mut [Option<Open<'a>>],
        free: &mut HashMap<QuantityId, &'a str>,
        determined: &mut Vec<Determined<'a>>,
    ) {
        let rules: Vec<Open> = open.iter_mut().filter_map(Option::take).collect();
        if let Some(rule) = rules.iter().find(|rule| rule.formula.has_delay()) {
            return self.not_linear(rule, free);
        }
        let unknowns: BTreeSet<QuantityId> = rules.iter().flat_map(|rule| &rule.unknowns).copied().collect();
        let sought = Some(determined.len());
        for (rule, x) in rules.into_iter().zip(unknowns) {
            determined.push(Determined { math: rule.math, symbol: free.remove(&x).unwrap_or_default(), sought });
        }
    }

    /// Solves the algebraic rules for what they determine, once all quantities have their numbers.
    pub fn solve(&mut self, determined: &[Determined<'a>]) {
        let mut known = self.known(&determined.iter().map(|one| one.symbol).collect());
        for &Determined { math, symbol, sought } in determined {
            if sought.is_some() {
                self.seek(determined, sought, symbol, &known);
                continue;
            }
            let x = self.reader.symbols[symbol];
            let formula = self.put_in(&self.reader.formula(math), &known, &[]);
            let solution = root(&formula, x).unwrap_or(Expr::Number(f64::NAN));
            self.solved.insert(symbol, solution.clone());
            known.solved.insert(x, solution);
        }
    }

    /// Gives a symbol that is sought, with all that are sought together with it, its rule.
    fn seek(&mut self, determined: &[Determined<'a>], sought: Option<usize>, symbol: &'a str, known: &Known<'a>) {
        let all: Vec<&Determined> = determined.iter().filter(|other| other.sought == sought).collect();
        let index = all.iter().position(|other| other.symbol == symbol).unwrap_or(0);
        let equations = Equations {
            unknowns: all.iter().map(|other| self.reader.symbols[other.symbol]).collect(),
            residuals: all.iter().map(|other| self.put_in(&self.reader.formula(other.math), known, &[])).collect(),
            starts: all.iter().map(|other| self.value_given(other.symbol)).collect(),
        };
        self.solved.insert(symbol, Expr::Root(Box::new(equations), index as u32));
    }

    /// The value that the model gives a symbol that a rule determines; 1 where it gives none.
    fn value_given(&self, symbol: &str) -> Expr {
        let document = self.document;
        let value = match self.kinds.get(symbol) {
            Some(&Kind::Parameter(index)) => document.parameters[index].value,
            Some(&Kind::Compartment(index)) => document.compartments[index].size,
            Some(&Kind::Species(index)) => {
                let (species, size) = (&document.species[index], self.species_ids(index).size());
                return match (species.amount, species.concentration, species.only_amount) {
                    (Some(amount), _, true) => number(amount),
                    (Some(amount), _, false) => quotient(number(amount), size),
                    (None, Some(concentration), true) => product(number(concentration), size),
                    (None, Some(concentration), false) => number(concentration),
                    (None, None, _) => number(1.0),
                };
            }
            _ => None,
        };
        number(value.filter(|value| value.is_finite()).unwrap_or(1.0))
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
        let found =
            format!("the algebraic rule looks back and is not linear in {names}, which nothing else determines");
        let help = "give what was a time ago a parameter with an <assignmentRule> of its own";
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
