//! Which equations determine which unknowns, alone or together: those that are straight are solved for, the others by a search.

use super::linear::{line, root};
use super::pieces::{extent, replaced};
use super::tree::{Equations, Expr, Quantity, QuantityId, Role};
use std::collections::{BTreeSet, HashMap, HashSet};

/// Most unknowns that are solved for together.
pub const TOGETHER: usize = 100;
/// Most parts of equations into which definitions are put.
const LARGEST: usize = 200_000;

/// An equation of a document and the unknown that it stands with.
#[derive(Debug, Clone)]
pub struct Unknown {
    /// The unknown.
    pub quantity: QuantityId,
    /// What is nothing.
    pub residual: Expr,
    /// Where a search begins.
    pub start: Option<Expr>,
}

/// Why an unknown is not determined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Undetermined {
    /// The equation does not use it, or what is left of it when others are solved does not.
    Unused,
    /// Its equation is not straight, and it is not said where the search begins.
    NoStart,
    /// More unknowns than [`TOGETHER`] depend on each other.
    TooMany,
    /// The equation is too large with all definitions put in.
    TooLarge,
}

/// Finds the rule of each unknown, or why one is not determined; `quantities` have the rules of all that is defined otherwise.
pub fn rules(unknowns: &[Unknown], quantities: &[Quantity]) -> Vec<(QuantityId, Result<Expr, Undetermined>)> {
    let numbers: HashMap<QuantityId, usize> =
        unknowns.iter().enumerate().map(|(number, unknown)| (unknown.quantity, number)).collect();
    let known = Known { quantities, numbers: &numbers };
    let uses: Vec<BTreeSet<usize>> = unknowns.iter().map(|unknown| known.uses(&unknown.residual)).collect();
    let mut found = Vec::new();
    for block in blocks(&uses) {
        let block: Vec<&Unknown> = block.iter().map(|&number| &unknowns[number]).collect();
        match known.solved(&block) {
            Ok(rules) => found.extend(rules.into_iter().map(|(quantity, rule)| (quantity, Ok(rule)))),
            Err((quantity, why)) => found.push((quantity, Err(why))),
        }
    }
    found
}

/// What is known of a document's quantities.
struct Known<'a> {
    quantities: &'a [Quantity],
    /// The unknowns, by their quantities.
    numbers: &'a HashMap<QuantityId, usize>,
}

impl Known<'_> {
    fn rule(&self, quantity: QuantityId) -> Option<&Expr> {
        match self.quantities.get(quantity as usize).map(|quantity| &quantity.role) {
            Some(Role::Defined { rule }) if !self.numbers.contains_key(&quantity) => Some(rule),
            _ => None,
        }
    }

    /// The unknowns that an expression uses, also through definitions.
    fn uses(&self, expr: &Expr) -> BTreeSet<usize> {
        let (mut found, mut seen, mut open) = (BTreeSet::new(), HashSet::new(), Vec::new());
        expr.each_quantity(&mut |quantity| open.push(quantity));
        while let Some(quantity) = open.pop() {
            if !seen.insert(quantity) {
                continue;
            }
            found.extend(self.numbers.get(&quantity));
            if let Some(rule) = self.rule(quantity) {
                rule.each_quantity(&mut |other| open.push(other));
            }
        }
        found
    }

    /// The rules of unknowns that determine each other.
    fn solved(&self, block: &[&Unknown]) -> Result<Vec<(QuantityId, Expr)>, (QuantityId, Undetermined)> {
        let first = block[0].quantity;
        if block.len() > TOGETHER {
            return Err((first, Undetermined::TooMany));
        }
        let members: BTreeSet<usize> = block.iter().map(|unknown| self.numbers[&unknown.quantity]).collect();
        let mut equations = Vec::new();
        for unknown in block {
            let whole = self.with_definitions(&unknown.residual, &members, &mut Vec::new());
            let whole = whole.ok_or((unknown.quantity, Undetermined::TooLarge))?;
            equations.push((unknown.quantity, whole));
        }
        let mut rules = Vec::new();
        let mut left: Vec<QuantityId> = block.iter().map(|unknown| unknown.quantity).collect();
        // Together with others only what has a number for its slope, which is never nothing.
        while let Some((at, x, solution)) = equations.iter().enumerate().find_map(|(at, (_, equation))| {
            left.iter().find_map(|&x| {
                let is_good = left.len() == 1 || matches!(line(equation, x)?, (Expr::Number(_), _));
                Some((at, x, root(equation, x).filter(|_| is_good)?))
            })
        }) {
            equations.remove(at);
            left.retain(|other| *other != x);
            for (_, equation) in &mut equations {
                *equation = replaced(equation, &|quantity| (quantity == x).then(|| solution.clone()));
                if extent(equation).1 > LARGEST {
                    return Err((x, Undetermined::TooLarge));
                }
            }
            rules.push((x, solution));
        }
        self.searched(block, &left, equations, &mut rules)?;
        Ok(rules)
    }

    /// Adds the rules of unknowns that only a search finds.
    fn searched(
        &self,
        block: &[&Unknown],
        left: &[QuantityId],
        equations: Vec<(QuantityId, Expr)>,
        rules: &mut Vec<(QuantityId, Expr)>,
    ) -> Result<(), (QuantityId, Undetermined)> {
        let uses = |equation: &Expr, x: QuantityId| {
            let mut found = false;
            equation.each_quantity(&mut |quantity| found |= quantity == x);
            found
        };
        if let Some((told, _)) = equations.iter().find(|(_, equation)| !left.iter().any(|&x| uses(equation, x))) {
            return Err((*told, Undetermined::Unused));
        }
        if let Some(&x) = left.iter().find(|&&x| !equations.iter().any(|(_, equation)| uses(equation, x))) {
            return Err((x, Undetermined::Unused));
        }
        // Straight equations are solved in one step from anywhere.
        let is_straight = equations.iter().all(|(_, equation)| {
            left.iter().all(|&x| line(equation, x).is_some_and(|(slope, _)| !left.iter().any(|&y| uses(&slope, y))))
        });
        let mut starts = Vec::new();
        for x in left {
            let own = block.iter().find(|unknown| unknown.quantity == *x).and_then(|unknown| unknown.start.clone());
            let start = own.or(is_straight.then_some(Expr::Number(0.0)));
            starts.push(start.ok_or((*x, Undetermined::NoStart))?);
        }
        let residuals = equations.into_iter().map(|(_, equation)| equation).collect();
        let equations = Equations { unknowns: left.to_vec(), residuals, starts };
        let root = |(index, &x): (usize, &QuantityId)| (x, Expr::Root(Box::new(equations.clone()), index as u32));
        rules.extend(left.iter().enumerate().map(root));
        Ok(())
    }

    /// An equation with the definitions behind which unknowns of its block hide.
    fn with_definitions(&self, expr: &Expr, members: &BTreeSet<usize>, path: &mut Vec<QuantityId>) -> Option<Expr> {
        let mut by = HashMap::new();
        let mut used = Vec::new();
        expr.each_quantity(&mut |quantity| used.push(quantity));
        for quantity in used {
            let Some(rule) = self.rule(quantity).filter(|_| !by.contains_key(&quantity)) else { continue };
            // Definitions in a circle are told elsewhere.
            if path.contains(&quantity) || self.uses(rule).is_disjoint(members) {
                continue;
            }
            path.push(quantity);
            let whole = self.with_definitions(rule, members, path)?;
            path.pop();
            by.insert(quantity, whole);
        }
        let whole = if by.is_empty() { expr.clone() } else { replaced(expr, &|quantity| by.get(&quantity).cloned()) };
        (extent(&whole).1 <= LARGEST).then_some(whole)
    }
}

/// Numbers that reach each other, together, and in each block in order; `uses` says which others one leads to.
fn blocks(uses: &[BTreeSet<usize>]) -> Vec<Vec<usize>> {
    let mut reached: Vec<BTreeSet<usize>> = Vec::with_capacity(uses.len());
    for first in uses {
        let (mut found, mut open) = (first.clone(), first.iter().copied().collect::<Vec<_>>());
        while let Some(next) = open.pop() {
            open.extend(uses[next].iter().copied().filter(|other| found.insert(*other)));
        }
        reached.push(found);
    }
    let mut found: Vec<Vec<usize>> = Vec::new();
    let mut is_taken = vec![false; uses.len()];
    for number in 0..uses.len() {
        if is_taken[number] {
            continue;
        }
        let is_same =
            |&other: &usize| other == number || (reached[number].contains(&other) && reached[other].contains(&number));
        let block: Vec<usize> = (number..uses.len()).filter(is_same).collect();
        block.iter().for_each(|&other| is_taken[other] = true);
        found.push(block);
    }
    found
}
