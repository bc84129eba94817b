//! Links: numbers go from chemistry to cells and from cells and fields to chemistry.

use rayon::prelude::*;

use super::super::model::Model;
use super::super::state::{State, index, vector};
use super::super::trouble::Trouble;
use super::super::workspace::Workspace;
use super::measure::measure_cells;
use super::model::{Control, Link, Owner, Source, Target, Whole};
use super::scratch::{ChemistryScratch, cells_of};
use super::stages::is_due;
use crate::cell::ends::{Reading, Sense};
use crate::equations::eml::LinkDescription;
use crate::field::Sensed;
use crate::mechanics::CONTROLLED;

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
    if chemistry.measures_cells {
        measure_cells(model, state, &ws.contact.found.atoms, &mut ws.chemistry.cells);
    }
    sense_fields(model, state, &mut ws.chemistry);
    for link in &chemistry.links {
        let due = match link.owner {
            Owner::Reactor(number) => start || is_due(&chemistry.reactors[number], time),
            Owner::Field(_) => true,
        };
        if due {
            carry(model, link, time, state, &mut ws.chemistry)?;
        }
    }
    Ok(())
}

/// What cells sense: the mean of value and gradient over the atoms of each.
fn sense_fields(model: &Model, state: &State, scratch: &mut ChemistryScratch) {
    for (&(field, species), cells) in model.chemistry.sensed.iter().zip(&mut scratch.sensed) {
        for (kind, now) in model.kinds.iter().zip(&state.kinds) {
            let atoms = kind.atoms();
            for cell in 0..kind.cells {
                scratch.places.clear();
                scratch.places.extend((0..atoms).map(|atom| vector(kind, &now.positions, cell, atom)));
                scratch.senses.resize(atoms, Sensed::default());
                scratch.fields[field].sense_all(species, &scratch.places, &mut scratch.senses);
                let sum = scratch.senses.iter().fold(Sensed::default(), |sum, one| Sensed {
                    value: sum.value + one.value,
                    gradient: sum.gradient + one.gradient,
                });
                let share = 1.0 / atoms as f64;
                cells[kind.first_cell + cell] = Sensed { value: sum.value * share, gradient: sum.gradient * share };
            }
        }
    }
}

/// Carries the numbers of one link, for every member of its system.
fn carry(
    model: &Model,
    link: &Link,
    time: f64,
    state: &mut State,
    scratch: &mut ChemistryScratch,
) -> Result<(), Trouble> {
    let chemistry = &model.chemistry;
    let (members, number) = match link.owner {
        Owner::Reactor(number) => (chemistry.reactors[number].members.len(), Some(number)),
        Owner::Field(_) => (1, None),
    };
    if let Some(number) = number {
        observe(model, number, &link.uses, state, &mut scratch.observed);
    }
    for member in 0..members {
        let own = number.and_then(|number| chemistry.reactors[number].members.cell(member));
        let used = |quantity: u32| match link.owner {
            Owner::Field(field) => chemistry.fields[field].constants[quantity as usize],
            Owner::Reactor(_) => {
                let at = link.uses.iter().position(|used| *used == quantity).expect("all that is used is observed");
                scratch.observed[at][member]
            }
        };
        let value = match link.from {
            Source::Own(quantity) => used(quantity),
            other => read(model, &other, own, time, state, scratch),
        };
        let seconds = number.map_or(1.0, |number| chemistry.reactors[number].seconds);
        let carried = link.transfer.evaluate(time / seconds, &|quantity| {
            if quantity == LinkDescription::VALUE { value } else { used(quantity) }
        });
        let carried = link.gain * carried;
        if let Some(expected) = missed(link.to, carried) {
            let owner = own.map(|cell| model.kind_of(cell)).map(|(kind, cell)| (model.kinds[kind].name.clone(), cell));
            return Err(Trouble::Link { link: link.text.clone(), owner, value: carried, expected, time });
        }
        match (link.to, link.owner) {
            (Target::Own(open), Owner::Reactor(number)) => {
                state.chemistry.populations[number].set_given(member, open, carried);
            }
            (Target::Own(input), Owner::Field(field)) => state.chemistry.fields[field].inputs[input] = carried,
            (Target::Cell(whose, control), _) => {
                for cell in cells_of(model, whose, own) {
                    set_control(model, cell, control, carried, state);
                }
            }
        }
    }
    Ok(())
}

/// What a target expects, if it cannot be set to a number.
pub fn missed(target: Target, value: f64) -> Option<&'static str> {
    if !value.is_finite() {
        return Some("a finite number");
    }
    match target {
        Target::Cell(_, Control::MotilitySpeed | Control::Stiffness | Control::Adhesion) if value < 0.0 => {
            Some("a number not below 0")
        }
        Target::Cell(_, Control::Force(handle, _)) if !CONTROLLED[handle].allows(value) => {
            Some(CONTROLLED[handle].expected)
        }
        Target::Cell(_, Control::RestVolume | Control::RestVolumeRatio) if value <= 0.0 => Some("a number above 0"),
        _ => None,
    }
}

/// Values of quantities of a system, for all its members.
fn observe(model: &Model, number: usize, uses: &[u32], state: &State, observed: &mut Vec<Vec<f64>>) {
    let (reactor, population) = (&model.chemistry.reactors[number], &state.chemistry.populations[number]);
    observed.resize_with(observed.len().max(uses.len()), Vec::new);
    for (quantity, values) in uses.iter().zip(observed.iter_mut()) {
        values.resize(population.cells(), 0.0);
        let time = state.chemistry.times[number] / reactor.seconds;
        population.observe(&reactor.program, *quantity, time, values);
    }
}

/// A number of the model.
fn read(model: &Model, from: &Source, own: Option<usize>, time: f64, state: &State, scratch: &ChemistryScratch) -> f64 {
    let mean = |whose, one: &dyn Fn(usize) -> f64| {
        let cells = cells_of(model, whose, own);
        let number = cells.len() as f64;
        cells.map(one).sum::<f64>() / number
    };
    match *from {
        Source::Own(_) => f64::NAN,
        Source::Time => time,
        Source::Cell(whose, Reading::Atom(atom, axis)) => mean(whose, &|cell| {
            let (kind, local) = model.kind_of(cell);
            vector(&model.kinds[kind], &state.kinds[kind].positions, local, atom)[axis]
        }),
        Source::Cell(whose, reading) => mean(whose, &|cell| scratch.cells[cell].read(reading)),
        Source::Sensed(whose, channel, sense) => mean(whose, &|cell| pick(&scratch.sensed[channel][cell], sense)),
        Source::AtAtom(whose, atom, field, species, sense) => mean(whose, &|cell| {
            let (kind, local) = model.kind_of(cell);
            let place = vector(&model.kinds[kind], &state.kinds[kind].positions, local, atom);
            pick(&scratch.fields[field].sense(species, place), sense)
        }),
        Source::Whole(field, species, what) => {
            let fields = &scratch.fields[field];
            let values = fields.values(species);
            match what {
                Whole::Amount => fields.amount(species),
                // Sums of whole fields run in a fixed order of pieces, so that threads do not matter.
                Whole::Mean => {
                    let sums: Vec<f64> = values.par_chunks(4096).map(|part| part.iter().sum()).collect();
                    sums.iter().sum::<f64>() / values.len() as f64
                }
                Whole::Largest => values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
                Whole::Smallest => values.iter().copied().fold(f64::INFINITY, f64::min),
            }
        }
        Source::Other(number, quantity, whose) => {
            let reactor = &model.chemistry.reactors[number];
            let (population, time) = (&state.chemistry.populations[number], state.chemistry.times[number]);
            let mut values = vec![0.0; population.cells()];
            population.observe(&reactor.program, quantity, time / reactor.seconds, &mut values);
            match &reactor.members {
                super::Members::Scene => values[0],
                super::Members::Cells(cells) => {
                    mean(whose, &|cell| cells.binary_search(&(cell as u32)).map_or(f64::NAN, |member| values[member]))
                }
            }
        }
    }
}

fn pick(sensed: &Sensed, sense: Sense) -> f64 {
    match sense {
        Sense::Value => sensed.value,
        Sense::Gradient(axis) => sensed.gradient[axis],
        Sense::Steepness => sensed.gradient.norm(),
    }
}

/// Sets what mechanics reads of a cell.
pub fn set_control(model: &Model, cell: usize, control: Control, value: f64, state: &mut State) {
    let controls = &mut state.chemistry.controls;
    match control {
        Control::MotilitySpeed => controls.speed[cell] = value,
        Control::Bias(axis) => controls.bias[cell][axis] = value,
        Control::Stiffness => controls.stiffness[cell] = value,
        Control::Adhesion => controls.adhesion[cell] = value,
        Control::Force(handle, number) => controls.forces[handle][number][cell] = value,
        Control::Secretion(channel) => controls.secretion[channel][cell] = value,
        Control::RestVolume | Control::RestVolumeRatio => {
            let (kind, local) = model.kind_of(cell);
            let unit = if control == Control::RestVolume { 1.0 } else { model.chemistry.rest[kind][0] };
            state.kinds[kind].rest_volumes[local] = value * unit;
        }
        Control::Atom(atom, axis) => {
            let (kind, local) = model.kind_of(cell);
            let at = index(&model.kinds[kind], local, atom, axis);
            state.kinds[kind].positions[at] = value;
        }
    }
}
