//! What links read: each thing is observed once an exchange, however many links and members read it.

use rayon::prelude::*;

use super::super::model::Model;
use super::super::state::{State, vector};
use super::census::{cells_of, member_of_cell};
use super::links::{Observation, Source, Whole};
use super::model::Members;
use super::scratch::ChemistryScratch;
use crate::cell::ends::{Reading, Sense};
use crate::field::{Fields, Sensed};

/// Observes what a link reads, if that has not been done in this exchange. When a link is carried all numbers that it reads are final:
/// the links that set them come before it.
pub(super) fn observe(model: &Model, link: usize, time: f64, state: &State, scratch: &mut ChemistryScratch) {
    let seen = &model.chemistry.observations.links[link];
    observe_quantities(model, &seen.quantities, state, scratch);
    if let Observation::Shared(slot) = seen.from
        && scratch.observed.shared[slot].is_none()
    {
        let value = shared(model, &model.chemistry.observations.shared[slot], time, state, scratch);
        scratch.observed.shared[slot] = Some(value);
    }
}

/// Observes quantities for all members of their systems, those of one system together.
fn observe_quantities(model: &Model, slots: &[usize], state: &State, scratch: &mut ChemistryScratch) {
    let list = &model.chemistry.observations.quantities;
    let ChemistryScratch { observed, populations, .. } = scratch;
    for (at, &first) in slots.iter().enumerate() {
        if observed.known[first] {
            continue;
        }
        let number = list[first].0;
        let (reactor, population) = (&model.chemistry.reactors[number], &state.chemistry.populations[number]);
        let time = state.chemistry.times[number] / reactor.seconds;
        let same = || slots[at..].iter().copied().filter(|&slot| list[slot].0 == number);
        for slot in same() {
            observed.quantities[slot].resize(population.cells(), 0.0);
            observed.known[slot] = true;
        }
        population.observe_blocks(&reactor.program, time, &mut populations[number], |block| {
            for slot in same() {
                observed.quantities[slot][block.cells.clone()].copy_from_slice(block.values(list[slot].1));
            }
            observed.blocks += 1;
        });
    }
}

/// A number that is the same for all members of a system.
fn shared(model: &Model, from: &Source, time: f64, state: &State, scratch: &mut ChemistryScratch) -> f64 {
    match *from {
        Source::Own(_) | Source::Neighbours(_) | Source::Atoms(_) => f64::NAN,
        Source::Time => time,
        Source::Whole(field, species, what) => whole(&scratch.fields[field], species, what, &mut scratch.observed.sums),
        Source::Cell(whose, _) | Source::Sensed(whose, ..) | Source::AtAtom(whose, ..) => {
            mean(cells_of(state, whose, None), |cell| read_cell(model, from, cell, state, scratch))
        }
        Source::Other(number, quantity, whose) => {
            let list = &model.chemistry.observations.quantities;
            let slot = list.iter().position(|known| *known == (number, quantity)).expect("listed with the link");
            let members = &model.chemistry.reactors[number].members;
            let of = |cell| {
                let member = member_of_cell(&state.kinds, members, cell);
                member.map_or(f64::NAN, |member| scratch.observed.quantity(slot, member))
            };
            match members {
                Members::Scene => scratch.observed.quantity(slot, 0),
                Members::Kinds(_) => mean(cells_of(state, whose, None), of),
            }
        }
    }
}

fn mean(cells: std::ops::Range<usize>, one: impl Fn(usize) -> f64) -> f64 {
    let number = cells.len() as f64;
    cells.map(one).sum::<f64>() / number
}

/// What a source says of one cell.
pub(super) fn read_cell(model: &Model, from: &Source, cell: usize, state: &State, scratch: &ChemistryScratch) -> f64 {
    let position = |atom: usize| {
        let (kind, local) = state.kind_of(cell);
        vector(&model.kinds[kind], &state.kinds[kind].positions, local, atom)
    };
    match *from {
        Source::Cell(_, Reading::Atom(atom, axis)) => position(atom)[axis],
        Source::Cell(_, reading) => scratch.cells[cell].read(reading),
        Source::Sensed(_, channel, sense) => pick(&scratch.sensed[channel][cell], sense),
        Source::AtAtom(_, atom, field, species, sense) => {
            pick(&scratch.fields[field].sense(species, position(atom)), sense)
        }
        Source::Own(_)
        | Source::Time
        | Source::Whole(..)
        | Source::Other(..)
        | Source::Neighbours(_)
        | Source::Atoms(_) => f64::NAN,
    }
}

pub(super) fn pick(sensed: &Sensed, sense: Sense) -> f64 {
    match sense {
        Sense::Value => sensed.value,
        Sense::Gradient(axis) => sensed.gradient[axis],
        Sense::Steepness => sensed.gradient.norm(),
    }
}

/// A number of a whole field.
fn whole(fields: &Fields, species: usize, what: Whole, sums: &mut Vec<f64>) -> f64 {
    let values = fields.values(species);
    match what {
        Whole::Amount => fields.amount(species),
        // Sums of whole fields run in a fixed order of pieces, so that threads do not matter.
        Whole::Mean => {
            values.par_chunks(4096).map(|part| part.iter().sum()).collect_into_vec(sums);
            sums.iter().sum::<f64>() / values.len() as f64
        }
        Whole::Largest => values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        Whole::Smallest => values.iter().copied().fold(f64::INFINITY, f64::min),
    }
}
