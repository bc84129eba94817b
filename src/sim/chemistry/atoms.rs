//! Links that carry a number for each atom of the cells that have a system.

use super::super::balance::AtomBalance;
use super::super::contact::near_cell;
use super::super::model::Model;
use super::super::state::{State, vector};
use super::super::trouble::Trouble;
use super::expected::missed;
use super::links::{AtAtoms, AtomControl, Control, Owner, Source, Target};
use super::measure::is_on_obstacle;
use super::model::Members;
use super::observe::pick;
use super::scratch::ChemistryScratch;
use crate::Vec3;
use crate::cell::ends::AtomReading;
use crate::contact::{AtomContact, Scene};
use crate::equations::eml::LinkDescription;
use crate::field::Sensed;

/// The kind whose atoms a link is carried at.
#[derive(Clone, Copy)]
struct AtKind {
    /// Number of the link.
    link: usize,
    /// Number of its system.
    reactor: usize,
    /// Number of the kind, and its number among those that have the system.
    kind: usize,
    at: usize,
    /// The first of its cells among the members of the system.
    first: usize,
}

/// Carries the numbers of a link at all atoms of all cells that have its system. What touches is what was found last, as for single cells.
///
/// # Errors
/// A number that is not finite, or that its target cannot be.
pub(super) fn carry_atoms(
    model: &Model,
    (number, source): (usize, AtAtoms),
    time: f64,
    state: &mut State,
    scratch: &mut ChemistryScratch,
    touching: (Option<&Scene>, &[AtomContact]),
) -> Result<(), Trouble> {
    let Owner::Reactor(reactor) = model.chemistry.links[number].owner else { return Ok(()) };
    let Members::Kinds(kinds) = &model.chemistry.reactors[reactor].members else { return Ok(()) };
    let mut first = 0;
    for (at, &kind) in kinds.iter().enumerate() {
        let here = AtKind { link: number, reactor, kind, at, first };
        let mut numbers = std::mem::take(&mut scratch.at_atoms);
        numbers.clear();
        match source {
            AtAtoms::Shown(shown) => show(model, here, (shown, time), state, scratch, &mut numbers),
            AtAtoms::Read(what) => read(model, (kind, what), state, scratch, touching, &mut numbers),
            AtAtoms::Sensed(field, species, sense) => {
                let of = |sensed: &Sensed| pick(sensed, sense);
                sense_at_atoms(model, (kind, field, species), state, scratch, |sensed| {
                    numbers.extend(sensed.iter().map(of))
                });
            }
        }
        transfer(model, here, time, scratch, &mut numbers);
        let done = check(model, here, time, &numbers);
        if done.is_ok() {
            put(model, here, &numbers, state);
        }
        first += state.kinds[kind].cells();
        scratch.at_atoms = numbers;
        done?;
    }
    Ok(())
}

/// What a membrane shows of its atoms, transfer included.
fn show(
    model: &Model,
    AtKind { reactor: number, at, first, .. }: AtKind,
    (shown, time): (usize, f64),
    state: &mut State,
    scratch: &mut ChemistryScratch,
    numbers: &mut Vec<f64>,
) {
    let reactor = &model.chemistry.reactors[number];
    let (Some(membrane), Members::Kinds(kinds)) = (&reactor.membrane, &reactor.members) else { return };
    let shape = (&membrane.meshes[at], &state.kinds[kinds[at]].positions[..]);
    let chemistry = &mut state.chemistry;
    let (cells, inside) = (&mut chemistry.membranes[number].kinds[at], (&mut chemistry.populations[number], first));
    let what = (shown, time / reactor.seconds);
    membrane.system.show(cells, inside, shape, what, &mut scratch.membranes[number], |_, own| numbers.extend(own));
}

/// What is read of the shape of the cells of a kind, and of what they touch.
fn read(
    model: &Model,
    (number, what): (usize, AtomReading),
    state: &State,
    scratch: &mut ChemistryScratch,
    (scene, found): (Option<&Scene>, &[AtomContact]),
    numbers: &mut Vec<f64>,
) {
    let (kind, now) = (&model.kinds[number], &state.kinds[number]);
    let (atoms, ChemistryScratch { positions, shapes, rest_areas, .. }) = (kind.atoms(), scratch);
    if what == AtomReading::AreaStrain {
        shapes.take(&kind.rest.facets, &kind.rest.positions);
        rest_areas.clone_from(&shapes.areas);
    }
    for cell in 0..now.cells() {
        positions.clear();
        positions.extend((0..atoms).map(|atom| vector(kind, &now.positions, cell, atom)));
        let truth = |holds: bool| if holds { 1.0 } else { 0.0 };
        match what {
            AtomReading::OnPlane(which) => {
                let obstacles = which.map_or(&model.obstacles[..], |number| &model.obstacles[number..=number]);
                numbers.extend(positions.iter().map(|x| truth(is_on_obstacle(obstacles, kind, x))));
            }
            AtomReading::InContact(with) => {
                let (begin, near) = near_cell(kind, now, found, cell);
                let own = now.first_cell + cell;
                let is_meant = |body: usize| body != own && with.is_none_or(|number| state.kind_of(body).0 == number);
                let touches = |atom: usize| {
                    let mut of_atom = near.iter().filter(|contact| contact.atom as usize == begin as usize + atom);
                    scene.is_some_and(|scene| {
                        of_atom.any(|near| scene.reach.touches(near.gap) && is_meant(near.body(scene) as usize))
                    })
                };
                numbers.extend((0..atoms).map(|atom| truth(touches(atom))));
            }
            AtomReading::Normal(axis) => {
                shapes.take(&kind.rest.facets, positions);
                numbers.extend((0..atoms).map(|atom| shapes.normal(atom)[axis]));
            }
            AtomReading::Curvature => {
                shapes.take(&kind.rest.facets, positions);
                numbers.extend((0..atoms).map(|atom| shapes.curvature(atom)));
            }
            AtomReading::Traction => {
                shapes.take(&kind.rest.facets, positions);
                let of_atom = |atom: &AtomBalance| (Vec3::from(atom.traction) + Vec3::from(atom.of_cells)).norm();
                let own = now.balance.get(cell * atoms..(cell + 1) * atoms).unwrap_or_default();
                // Before the first step there is none.
                let forces = own.iter().map(of_atom).chain(std::iter::repeat(0.0));
                numbers
                    .extend(shapes.areas.iter().zip(forces).map(|(area, force)| force / area.max(f64::MIN_POSITIVE)));
            }
            AtomReading::AreaStrain => {
                shapes.take(&kind.rest.facets, positions);
                numbers.extend(shapes.areas.iter().zip(&*rest_areas).map(|(now, rest)| now / rest - 1.0));
            }
        }
    }
}

/// A field at all atoms of the cells of a kind, cell after cell.
fn sense_at_atoms(
    model: &Model,
    (number, field, species): (usize, usize, usize),
    state: &State,
    scratch: &mut ChemistryScratch,
    mut take: impl FnMut(&[Sensed]),
) {
    let (kind, now) = (&model.kinds[number], &state.kinds[number]);
    for cell in 0..now.cells() {
        scratch.positions.clear();
        scratch.positions.extend((0..kind.atoms()).map(|atom| vector(kind, &now.positions, cell, atom)));
        scratch.senses.resize(kind.atoms(), Sensed::default());
        scratch.fields[field].sense_all(species, &scratch.positions, &mut scratch.senses);
        take(&scratch.senses);
    }
}

/// Makes of what was read what is carried; what a membrane shows has the transfer in it already.
fn transfer(
    model: &Model,
    AtKind { link: number, reactor, kind, first, .. }: AtKind,
    time: f64,
    scratch: &ChemistryScratch,
    numbers: &mut [f64],
) {
    let (link, seen) = (&model.chemistry.links[number], &model.chemistry.observations.links[number]);
    if matches!(link.from, Source::Atoms(AtAtoms::Shown(_))) {
        numbers.iter_mut().for_each(|value| *value *= link.gain);
        return;
    }
    let (atoms, seconds) = (model.kinds[kind].atoms(), model.chemistry.reactors[reactor].seconds);
    for (index, value) in numbers.iter_mut().enumerate() {
        let used = |quantity: u32| {
            let at = link.uses.iter().position(|used| *used == quantity).expect("all that is used is observed");
            scratch.observed.quantity(seen.quantities[at], first + index / atoms)
        };
        let of = |quantity| if quantity == LinkDescription::VALUE { *value } else { used(quantity) };
        *value = link.gain * link.transfer.evaluate(time / seconds, &of);
    }
}

/// Whether all numbers can be what they are carried to.
fn check(model: &Model, AtKind { link, kind, .. }: AtKind, time: f64, numbers: &[f64]) -> Result<(), Trouble> {
    let (link, kind) = (&model.chemistry.links[link], &model.kinds[kind]);
    let wrong = numbers.iter().enumerate().find_map(|(index, value)| Some((index, *value, missed(link.to, *value)?)));
    wrong.map_or(Ok(()), |(index, value, expected)| {
        let owner = Some((kind.name.clone(), index / kind.atoms()));
        Err(Trouble::Link { link: link.text.clone(), owner, value, expected, time })
    })
}

/// Puts the numbers of the atoms of a kind where the link leads: to its system, or to what mechanics reads.
fn put(model: &Model, here: AtKind, numbers: &[f64], state: &mut State) {
    let atoms = model.kinds[here.kind].atoms();
    match model.chemistry.links[here.link].to {
        Target::Given(given) => {
            let cells = &mut state.chemistry.membranes[here.reactor].kinds[here.at];
            for (index, value) in numbers.iter().enumerate() {
                cells.set_given(index / atoms, given, index % atoms, *value);
            }
        }
        Target::Cell(_, Control::Atoms(control)) => {
            state.chemistry.controls.of_atoms[here.kind].list(control).copy_from_slice(numbers);
        }
        Target::Own(_) | Target::Cell(..) => {}
    }
}

/// Sets something of all atoms of a cell to one number.
pub(super) fn set_all(model: &Model, cell: usize, control: AtomControl, value: f64, state: &mut State) {
    let (kind, local) = state.kind_of(cell);
    let atoms = model.kinds[kind].atoms();
    state.chemistry.controls.of_atoms[kind].list(control)[local * atoms..(local + 1) * atoms].fill(value);
}
