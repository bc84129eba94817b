//! What cells release into fields in a step, and the fields meanwhile.
//!
//! Cells release all the time. Fields that take up what is released move to the middle of each part of the step, where they are given what is
//! released in the whole part, eq. (coupling.4): second order, and exact in amount where they decay.

use super::super::controls::Controls;
use super::super::model::Model;
use super::super::state::{State, vector};
use super::super::trouble::Trouble;
use super::super::workspace::Workspace;
use super::fields::advance_field;
use super::release_parts::{Near, Part};
use super::released::parabola;
use super::scratch::ChemistryScratch;

/// A piece of a step of a field into which something is released: the number of the field, which piece it is and the shares of the step at which it
/// begins and ends, the part of it, and the states between whose rates those of atoms in the step lie.
#[derive(Clone, Copy)]
struct Release<'a> {
    model: &'a Model,
    field: usize,
    piece: (usize, [f64; 2]),
    part: Part,
    from: &'a Controls,
    to: &'a Controls,
}

/// Moves all fields through a step, with what cells release into them meanwhile: at rates that go on parabolas, piece after piece, from those
/// where it began to those to which the systems have come at its end.
pub fn move_fields(
    model: &Model,
    (start, dt): (f64, f64),
    from: &State,
    state: &mut State,
    ws: &mut Workspace,
) -> Result<(), Trouble> {
    for number in 0..model.chemistry.fields.len() {
        if !channels(model, &state.chemistry.controls).any(|(field, _)| field == number) {
            advance_field((model, number), (start, dt), state, ws)?;
            continue;
        }
        let into = || channels(model, &state.chemistry.controls).filter(|(field, _)| *field == number);
        let fastest = into().map(|(_, species)| decay((model, number), species)).fold(0.0, f64::max);
        let near = Near::of(model, number, into().map(|(_, species)| species));
        let mut moved = start;
        for piece in 0..ws.chemistry.released.pieces.len() {
            let shares @ [begins, ends] = ws.chemistry.released.pieces[piece];
            let (length, age) = ((ends - begins) * dt, (1.0 - ends) * dt);
            let mut left = Some(length);
            while let Some(part) = left.and_then(|left| Part::next((length, left), age, fastest, near)) {
                left = part.left;
                let at = start + begins * dt + part.begin * length + (part.length - part.rest);
                advance_field((model, number), (moved, at - moved), state, ws)?;
                let (from, to) = (&from.chemistry.controls, &state.chemistry.controls);
                let release = Release { model, field: number, piece: (piece, shares), part, from, to };
                release.deposit(state, &mut ws.chemistry);
                moved = at;
            }
        }
        advance_field((model, number), (moved, start + dt - moved), state, ws)?;
    }
    Ok(())
}

/// Fields and species that anything is released into, one for each list of rates.
fn channels<'a>(model: &'a Model, controls: &'a Controls) -> impl Iterator<Item = (usize, usize)> + 'a {
    model.chemistry.secreted.iter().chain(&controls.secreted).copied()
}

/// The rate of decay of what is released, 1/s.
fn decay((model, field): (&Model, usize), species: usize) -> f64 {
    model.chemistry.fields[field].system.species()[species].decay
}

impl Release<'_> {
    /// Releases what comes in the part of the piece.
    fn deposit(self, state: &State, scratch: &mut ChemistryScratch) {
        let shares = [0.0, 0.5, 1.0].map(|within| self.part.begin + within * self.part.share);
        // What atoms release is on one line through the step.
        let [begins, ends] = self.piece.1;
        let of_step = shares.map(|share| begins + share * (ends - begins));
        for (channel, (_, species)) in
            channels(self.model, self.to).enumerate().filter(|(_, into)| into.0 == self.field)
        {
            let released = self.part.released(decay((self.model, self.field), species));
            let mut of_nodes = [0.0; 3];
            for (share, released) in shares.into_iter().zip(released) {
                of_nodes.iter_mut().zip(parabola(share)).for_each(|(sum, weight)| *sum += released * weight);
            }
            self.by_cells((channel, species), state, scratch, of_nodes);
            let at_end = of_step.iter().zip(released).map(|(share, released)| share * released).sum::<f64>();
            let of_ends = [released.iter().sum::<f64>() - at_end, at_end];
            self.by_atoms((channel, species), state, scratch, of_ends);
        }
    }

    /// What cells secrete, spread evenly over their atoms, with the weights of the rates where the piece begins, in its middle and where it ends, s.
    fn by_cells(
        self,
        (channel, species): (usize, usize),
        state: &State,
        scratch: &mut ChemistryScratch,
        weights: [f64; 3],
    ) {
        let Some(cells) = self.to.secretion.get(channel).map(Vec::len) else { return };
        for (kind, now) in self.model.kinds.iter().zip(&state.kinds) {
            let atoms = kind.atoms();
            let ChemistryScratch { positions, amounts, fields, released, .. } = &mut *scratch;
            let [before, between, after] = released.of_channel(self.piece.0, channel, cells);
            amounts.clear();
            positions.clear();
            for cell in now.numbers() {
                let rates = [before[cell], between[cell], after[cell]];
                if rates != [0.0; 3] {
                    let amount = rates.iter().zip(weights).map(|(rate, weight)| rate * weight).sum::<f64>();
                    let own = cell - now.first_cell;
                    positions.extend((0..atoms).map(|atom| vector(kind, &now.positions, own, atom)));
                    amounts.resize(positions.len(), amount / atoms as f64);
                }
            }
            fields[self.field].deposit_all(species, positions, amounts);
        }
    }

    /// What atoms secrete, each on its own area, with the weights of the rates where the step begins and where it ends, s.
    fn by_atoms(
        self,
        (channel, species): (usize, usize),
        state: &State,
        scratch: &mut ChemistryScratch,
        [first, last]: [f64; 2],
    ) {
        let of_kinds = self.model.kinds.iter().zip(&state.kinds).zip(self.from.of_atoms.iter().zip(&self.to.of_atoms));
        for ((kind, now), (before, after)) in of_kinds {
            let (Some(before), Some(after)) = (before.secretion.get(channel), after.secretion.get(channel)) else {
                continue;
            };
            if before.is_empty() || after.is_empty() {
                continue;
            }
            let atoms = kind.atoms();
            for cell in 0..now.cells() {
                let ChemistryScratch { positions, amounts, shapes, fields, .. } = scratch;
                positions.clear();
                positions.extend((0..atoms).map(|atom| vector(kind, &now.positions, cell, atom)));
                shapes.take(&kind.rest.facets, positions);
                amounts.clear();
                let own = cell * atoms..(cell + 1) * atoms;
                let rates = before[own.clone()].iter().zip(&after[own]).zip(&shapes.areas);
                amounts.extend(rates.map(|((begin, end), area)| (first * begin + last * end) * area));
                fields[self.field].deposit_all(species, positions, amounts);
            }
        }
    }
}
