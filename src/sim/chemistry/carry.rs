//! Links: numbers go from chemistry to cells and from cells and fields to chemistry.

use super::super::model::Model;
use super::super::state::{State, index, vector};
use super::super::trouble::Trouble;
use super::super::workspace::Workspace;
use super::atoms::{carry_atoms, set_all};
use super::census::{cell_of_member, cells_of, member_of_cell, names_nobody};
use super::exchange::is_due;
use super::expected::missed;
use super::links::{Control, Link, Observation, Owner, Source, Target};
use super::measure::measure_cells;
use super::model::Members;
use super::observe::{observe, read_cell};
use super::scratch::ChemistryScratch;
use crate::cell::ends::PodSetting;
use crate::equations::eml::LinkDescription;
use crate::field::Sensed;

/// Carries the numbers of all links whose system exchanges with the model at `time`.
/// The values of the fields must be with their solvers. At the start every system exchanges.
///
/// # Errors
/// A number that is not finite, or that its target cannot be.
pub(super) fn carry_links(
    model: &Model,
    time: f64,
    start: bool,
    state: &mut State,
    ws: &mut Workspace,
) -> Result<(), Trouble> {
    let chemistry = &model.chemistry;
    let contact = chemistry.reads_contact().then(|| ws.contact.scene(model, &state.kinds)).flatten();
    if chemistry.measures_cells {
        measure_cells(model, state, contact.as_ref(), &ws.contact.found.atoms, &mut ws.chemistry.cells);
    }
    if chemistry.reads_neighbours() {
        let touching = contact.as_ref().map(|contact| (&*contact.scene, &ws.contact.found.atoms[..]));
        ws.chemistry.neighbours.find(model, state, touching);
    }
    sense_fields(model, state, &mut ws.chemistry);
    ws.chemistry.observed.forget(&chemistry.observations);
    for (number, link) in chemistry.links.iter().enumerate() {
        let due = match link.owner {
            Owner::Reactor(number) => start || is_due(&chemistry.reactors[number], time),
            Owner::Field(_) => true,
        };
        match link.from {
            _ if !due => {}
            Source::Atoms(source) => {
                let touching = (contact.as_ref().map(|contact| &*contact.scene), &ws.contact.found.atoms[..]);
                observe(model, number, time, state, &mut ws.chemistry);
                carry_atoms(model, (number, source), time, state, &mut ws.chemistry, touching)?;
            }
            _ => carry(model, number, time, state, &mut ws.chemistry)?,
        }
    }
    Ok(())
}

/// Carries what cells and atoms release by links of a choice, as their systems have come to it by themselves at `time`: what these are told then
/// comes after.
///
/// # Errors
/// As [`carry_links`].
pub(super) fn carry_releases(
    model: &Model,
    time: f64,
    state: &mut State,
    scratch: &mut ChemistryScratch,
    is_chosen: impl Fn(&Link) -> bool,
) -> Result<(), Trouble> {
    let chemistry = &model.chemistry;
    scratch.observed.forget(&chemistry.observations);
    let chosen = chemistry.links.iter().enumerate().filter(|(_, link)| link.is_own_release() && is_chosen(link));
    for (number, link) in chosen {
        let Owner::Reactor(owner) = link.owner else { continue };
        match link.from {
            _ if !is_due(&chemistry.reactors[owner], time) => {}
            Source::Atoms(source) => {
                observe(model, number, time, state, scratch);
                carry_atoms(model, (number, source), time, state, scratch, (None, &[]))?;
            }
            _ => carry(model, number, time, state, scratch)?,
        }
    }
    Ok(())
}

/// What cells sense: the mean of value and gradient over the atoms of each.
fn sense_fields(model: &Model, state: &State, scratch: &mut ChemistryScratch) {
    for (&(field, species), cells) in model.chemistry.sensed.iter().zip(&mut scratch.sensed) {
        for (kind, now) in model.kinds.iter().zip(&state.kinds) {
            let atoms = kind.atoms();
            for cell in 0..now.cells() {
                scratch.positions.clear();
                scratch.positions.extend((0..atoms).map(|atom| vector(kind, &now.positions, cell, atom)));
                scratch.senses.resize(atoms, Sensed::default());
                scratch.fields[field].sense_all(species, &scratch.positions, &mut scratch.senses);
                let sum = scratch.senses.iter().fold(Sensed::default(), |sum, one| Sensed {
                    value: sum.value + one.value,
                    gradient: sum.gradient + one.gradient,
                });
                let share = 1.0 / atoms as f64;
                cells[now.first_cell + cell] = Sensed { value: sum.value * share, gradient: sum.gradient * share };
            }
        }
    }
}

/// Carries the numbers of one link, for every member of its system; nothing where it reads cells that are no more.
fn carry(
    model: &Model,
    number: usize,
    time: f64,
    state: &mut State,
    scratch: &mut ChemistryScratch,
) -> Result<(), Trouble> {
    if model.chemistry.links[number].from.whose().is_some_and(|whose| names_nobody(state, whose)) {
        return Ok(());
    }
    observe(model, number, time, state, scratch);
    let chemistry = &model.chemistry;
    let (link, seen) = (&chemistry.links[number], &chemistry.observations.links[number]);
    let (reactor, members) = match link.owner {
        Owner::Reactor(number) => (Some(&chemistry.reactors[number]), state.chemistry.populations[number].cells()),
        Owner::Field(_) => (None, 1),
    };
    let seconds = reactor.map_or(1.0, |reactor| reactor.seconds);
    for member in 0..members {
        let own = reactor.and_then(|reactor| cell_of_member(&state.kinds, &reactor.members, member));
        let used = |quantity: u32| match link.owner {
            Owner::Field(field) => chemistry.fields[field].constants[quantity as usize],
            Owner::Reactor(_) => {
                let at = link.uses.iter().position(|used| *used == quantity).expect("all that is used is observed");
                scratch.observed.quantity(seen.quantities[at], member)
            }
        };
        let value = match seen.from {
            Observation::Own(slot) => scratch.observed.quantity(slot, member),
            Observation::Shared(slot) => scratch.observed.shared(slot),
            Observation::Cell => own.map_or(f64::NAN, |cell| read_cell(model, &link.from, cell, state, scratch)),
            Observation::OfNeighbours(slot) => match (link.from, own) {
                (Source::Neighbours(reading), Some(cell)) => {
                    let known = (&scratch.observed, &scratch.cells[..]);
                    scratch.neighbours.read(model, state, (reading, slot), cell, known)
                }
                _ => f64::NAN,
            },
            Observation::OfOwnCell(slot) => {
                let members = &chemistry.reactors[chemistry.observations.quantities[slot].0].members;
                let other = own.and_then(|cell| member_of_cell(&state.kinds, members, cell));
                other.map_or(f64::NAN, |other| scratch.observed.quantity(slot, other))
            }
        };
        let carried = link.transfer.evaluate(time / seconds, &|quantity| {
            if quantity == LinkDescription::VALUE { value } else { used(quantity) }
        });
        let carried = link.gain * carried;
        if let Some(expected) = missed(link.to, carried) {
            let owner = own.map(|cell| state.kind_of(cell)).map(|(kind, cell)| (model.kinds[kind].name.clone(), cell));
            return Err(Trouble::Link { link: link.text.clone(), owner, value: carried, expected, time });
        }
        match (link.to, link.owner) {
            (Target::Own(open), Owner::Reactor(number)) => {
                state.chemistry.populations[number].set_open(member, open, carried);
            }
            (Target::Given(given), Owner::Reactor(number)) => {
                set_at_all_atoms(model, (number, member), given, carried, state)
            }
            (Target::Given(_), Owner::Field(_)) => {}
            (Target::Own(input), Owner::Field(field)) => state.chemistry.fields[field].inputs[input] = carried,
            (Target::Cell(whose, control), _) => {
                for cell in cells_of(state, whose, own) {
                    set_control(model, cell, control, carried, state);
                }
            }
        }
    }
    if let Target::Cell(_, Control::Atom(..)) = link.to {
        scratch.observed.forget_at_atoms(&chemistry.observations);
    }
    Ok(())
}

/// Carries one number to all atoms of a member of a system on membranes.
fn set_at_all_atoms(model: &Model, (number, member): (usize, usize), given: usize, value: f64, state: &mut State) {
    let Some(cell) = cell_of_member(&state.kinds, &model.chemistry.reactors[number].members, member) else { return };
    let (kind, local) = state.kind_of(cell);
    let Members::Kinds(kinds) = &model.chemistry.reactors[number].members else { return };
    let at = kinds.iter().position(|&other| other == kind).unwrap_or(0);
    let cells = &mut state.chemistry.membranes[number].kinds[at];
    (0..model.kinds[kind].atoms()).for_each(|atom| cells.set_given(local, given, atom, value));
}

/// Sets what mechanics reads of a cell.
pub fn set_control(model: &Model, cell: usize, control: Control, value: f64, state: &mut State) {
    let controls = &mut state.chemistry.controls;
    match control {
        Control::MotilitySpeed => controls.speed[cell] = value,
        Control::Bias(axis) => controls.bias[cell][axis] = value,
        Control::Pseudopods(PodSetting::Cue(axis)) => controls.pseudopods[cell].cue[axis] = value,
        Control::Pseudopods(PodSetting::Protrusion) => controls.pseudopods[cell].protrusion = value,
        Control::Pseudopods(PodSetting::Retraction) => controls.pseudopods[cell].retraction = value,
        Control::Stiffness => controls.stiffness[cell] = value,
        Control::Adhesion => controls.adhesion[cell] = value,
        Control::Force(handle, number) => controls.forces[handle][number][cell] = value,
        Control::Secretion(channel) => controls.secretion[channel][cell] = value,
        Control::Atoms(control) => set_all(model, cell, control, value, state),
        Control::RestVolume | Control::RestVolumeRatio => {
            let (kind, local) = state.kind_of(cell);
            let unit = if control == Control::RestVolume { 1.0 } else { model.chemistry.rest[kind][0] };
            state.kinds[kind].rest_volumes[local] = value * unit;
        }
        Control::Atom(atom, axis) => {
            let (kind, local) = state.kind_of(cell);
            let at = index(&model.kinds[kind], local, atom, axis);
            state.kinds[kind].positions[at] = value;
        }
    }
}
