//! The order in which links carry their numbers, and loops among them that have no time step inside.
//!
//! At an exchange a link carries what its source is at that instant. A source that is defined by inputs of its system
//! must therefore come after the links that set these inputs. Variables break such chains: they change with time only.

use crate::cell::ends::Reading;
use crate::equations::tree::{QuantityId, Role, System};
use crate::sim::chemistry::{Control, Link, Owner, Reactor, Source, Target};

/// The numbers of the links in order.
///
/// # Errors
/// The numbers of links that close a loop.
pub(super) fn order(links: &[Link], systems: &[&System], reactors: &[Reactor]) -> Result<Vec<usize>, Vec<usize>> {
    let after: Vec<Vec<usize>> = links.iter().map(|link| before(link, links, systems, reactors)).collect();
    let mut done: Vec<usize> = Vec::new();
    while done.len() < links.len() {
        let ready = |n: &usize| !done.contains(n) && after[*n].iter().all(|other| done.contains(other));
        match (0..links.len()).find(ready) {
            Some(next) => done.push(next),
            None => return Err(a_loop(&after, &done)),
        }
    }
    Ok(done)
}

/// The links whose numbers a link uses in the same instant.
fn before(link: &Link, links: &[Link], systems: &[&System], reactors: &[Reactor]) -> Vec<usize> {
    let mut used: Vec<(usize, QuantityId)> = Vec::new();
    if let Owner::Reactor(number) = link.owner {
        link.needs.iter().for_each(|&quantity| inputs(systems[number], quantity, number, &mut used));
    }
    if let Some((number, quantity)) = link.from.quantity_of_other() {
        inputs(systems[number], quantity, number, &mut used);
    }
    let feeds = |other: &Link| match (other.owner, other.to, link.from) {
        (Owner::Reactor(number), Target::Own(open), _) => used.contains(&(number, reactors[number].program.open[open])),
        (Owner::Reactor(number), Target::Given(given), _) => {
            let membrane = reactors[number].membrane.as_ref();
            membrane.is_some_and(|membrane| used.contains(&(number, membrane.system.given_quantity(given))))
        }
        (_, Target::Cell(_, Control::Atom(atom, axis)), Source::Cell(_, Reading::Atom(read, along))) => {
            (atom, axis) == (read, along)
        }
        _ => false,
    };
    (0..links.len()).filter(|&other| feeds(&links[other])).collect()
}

/// The inputs that a quantity depends on without a variable between.
fn inputs(system: &System, quantity: QuantityId, number: usize, found: &mut Vec<(usize, QuantityId)>) {
    let mut open = vec![quantity];
    let mut seen = Vec::new();
    while let Some(quantity) = open.pop() {
        if seen.contains(&quantity) {
            continue;
        }
        seen.push(quantity);
        match &system.quantities[quantity as usize].role {
            Role::Input => found.push((number, quantity)),
            Role::Defined { rule } => rule.each_quantity(&mut |other| open.push(other)),
            Role::Parameter | Role::Variable { .. } => {}
        }
    }
}

/// Follows what waits for what until a link comes again.
fn a_loop(after: &[Vec<usize>], done: &[usize]) -> Vec<usize> {
    let Some(start) = (0..after.len()).find(|n| !done.contains(n)) else { return Vec::new() };
    let mut path = vec![start];
    loop {
        let last = path[path.len() - 1];
        let Some(&next) = after[last].iter().find(|other| !done.contains(other)) else { return path };
        if let Some(again) = path.iter().position(|&seen| seen == next) {
            let mut circle = path.split_off(again);
            circle.reverse();
            return circle;
        }
        path.push(next);
    }
}
