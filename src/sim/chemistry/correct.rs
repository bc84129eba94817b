//! Systems and fields are told the mean of what links carry where a step begins and where it ends, eq. (coupling.7).
//!
//! At first a step is made with what links carried where it begins. Where that has changed until the end by more than what does not matter, it is made
//! once more from its beginning, with the means.

use super::links::{Link, Owner, Target};
use super::model::Chemistry;
use super::state::ChemistryState;

/// What a step may change of a number, over the largest that any member has, before its mean is told: half of it is how far what was told is off.
const UNCHANGED: f64 = 5e-3;

/// How far what links carry at the end of a step may move when systems are told means, over the largest that any member has.
const BEARABLE: f64 = 2e-3;

/// Bounds of the factor by which the next step may differ.
const SHRINK: f64 = 0.2;
const GROW: f64 = 2.0;

/// Links whose numbers drive a system or fields that exchange with the model in every step.
fn driving(chemistry: &Chemistry) -> impl Iterator<Item = &Link> {
    let each_step = |owner: Owner| match owner {
        Owner::Reactor(number) => chemistry.reactors[number].exchange.is_none(),
        Owner::Field(_) => true,
    };
    chemistry.links.iter().filter(move |link| link.drives && each_step(link.owner))
}

/// How many members are told a number by a link.
fn members(state: &ChemistryState, owner: Owner) -> usize {
    match owner {
        Owner::Reactor(number) => state.populations[number].cells(),
        Owner::Field(_) => 1,
    }
}

/// What a link has told a member.
fn told(state: &ChemistryState, link: &Link, member: usize) -> f64 {
    match (link.owner, link.to) {
        (Owner::Reactor(number), Target::Own(open)) => state.populations[number].open_value(member, open),
        (Owner::Field(number), Target::Own(input)) => state.fields[number].inputs[input],
        _ => 0.0,
    }
}

/// Whether what drives systems has changed in a step by more than what does not matter.
pub(super) fn has_changed(chemistry: &Chemistry, from: &ChemistryState, to: &ChemistryState) -> bool {
    driving(chemistry).any(|link| {
        let pairs = (0..members(from, link.owner)).map(|member| [from, to].map(|state| told(state, link, member)));
        let (mut change, mut size): (f64, f64) = (0.0, 0.0);
        pairs.for_each(|[before, after]| {
            change = change.max((after - before).abs());
            size = size.max(before.abs()).max(after.abs());
        });
        change > UNCHANGED * size
    })
}

/// How far what links carry at the end of a step is off from what they carried there when systems had been told what was at its begin, over the largest
/// that any member has: the worst of all links. `means` are those that the step was made with.
pub(super) fn moved(chemistry: &Chemistry, from: &ChemistryState, means: &[f64], to: &ChemistryState) -> f64 {
    let (mut means, mut worst): (_, f64) = (means.iter(), 0.0);
    for link in driving(chemistry) {
        let (mut apart, mut size): (f64, f64) = (0.0, 0.0);
        for (member, mean) in (0..members(from, link.owner)).zip(means.by_ref()) {
            let (before, now) = (told(from, link, member), told(to, link, member));
            let first = 2.0 * mean - before;
            apart = apart.max((now - first).abs());
            size = size.max(before.abs()).max(now.abs());
        }
        worst = if size > 0.0 { worst.max(apart / size) } else { worst };
    }
    worst
}

/// The longest step, s, that may follow one of a length in which what links carry has moved so far: it moves with the square of the step.
pub(super) fn longest_next(dt: f64, moved: f64) -> f64 {
    if moved > 0.0 { dt * (BEARABLE / moved).sqrt().clamp(SHRINK, GROW) } else { GROW * dt }
}

/// Notes the means of what links have told at both ends of a step.
pub(super) fn note_means(chemistry: &Chemistry, from: &ChemistryState, to: &ChemistryState, means: &mut Vec<f64>) {
    means.clear();
    for link in driving(chemistry) {
        let mean = |member: usize| 0.5 * (told(from, link, member) + told(to, link, member));
        means.extend((0..members(from, link.owner)).map(mean));
    }
}

/// Tells the means in place of what links have told where the step begins.
pub(super) fn tell_means(chemistry: &Chemistry, means: &[f64], state: &mut ChemistryState) {
    let mut means = means.iter();
    for link in driving(chemistry) {
        for (member, mean) in (0..members(state, link.owner)).zip(means.by_ref()) {
            match (link.owner, link.to) {
                (Owner::Reactor(number), Target::Own(open)) => state.populations[number].set_open(member, open, *mean),
                (Owner::Field(number), Target::Own(input)) => state.fields[number].inputs[input] = *mean,
                _ => {}
            }
        }
    }
}
