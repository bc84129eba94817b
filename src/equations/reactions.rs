//! What reactions make of the rates of variables, eq. (eml.1).

use super::pieces::{negative, number, product, quantity, total};
use super::tree::{Expr, QuantityId, Reaction, Role, System};
use std::collections::{BTreeMap, HashSet};

/// The rate of each variable that reactions change: the sum of stoichiometry times rate over all of them.
pub fn rates(reactions: &[Reaction]) -> BTreeMap<QuantityId, Expr> {
    let mut terms: BTreeMap<QuantityId, Vec<Expr>> = BTreeMap::new();
    for reaction in reactions {
        for (sign, participant) in reaction.participants().filter(|(_, participant)| !participant.is_held) {
            let term = product(number(participant.stoichiometry), quantity(reaction.rate));
            let term = if sign < 0.0 { negative(term) } else { term };
            terms.entry(participant.quantity).or_default().push(term);
        }
    }
    terms.into_iter().map(|(quantity, terms)| (quantity, total(terms))).collect()
}

/// Drops the reactions that do not say the whole rate of all that they change, and those that change nothing.
pub fn keep_whole(system: &mut System) {
    let mut kept = std::mem::take(&mut system.reactions);
    kept.retain(|reaction| {
        let has_rule = matches!(system.quantities[reaction.rate as usize].role, Role::Defined { .. });
        has_rule && system.before_start(reaction.rate).is_none() && reaction.changed().next().is_some()
    });
    system.reactions = kept;
    loop {
        let is_other = |(number, told): &(QuantityId, Expr)| !matches!(&system.quantities[*number as usize].role, Role::Variable { rate } if rate == told);
        let others: HashSet<QuantityId> =
            rates(&system.reactions).into_iter().filter(is_other).map(|(number, _)| number).collect();
        if others.is_empty() {
            return;
        }
        system.reactions.retain(|reaction| reaction.changed().all(|quantity| !others.contains(&quantity)));
    }
}
