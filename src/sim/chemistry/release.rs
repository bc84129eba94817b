//! What cells release into fields in a step, and the fields meanwhile.
//!
//! Cells release all the time. Fields that take up what is released move by half of a part of the step, are given what is released in the whole
//! part, and move by the other half, eq. (coupling.4): second order, and exact in amount where they decay.

use super::super::controls::Controls;
use super::super::model::Model;
use super::super::state::{State, vector};
use super::super::trouble::Trouble;
use super::super::workspace::Workspace;
use super::fields::advance_field;
use super::released::parabola;
use super::scratch::ChemistryScratch;

/// The longest part of a step over the time in which what is released decays: it does not spread much farther than what lives so long.
const LONGEST: f64 = 0.5;

/// Parts of a step at most.
const MOST_PARTS: f64 = 64.0;

/// How the step of a field is cut into parts of equal lengths.
#[derive(Debug, Clone, Copy)]
struct Parts {
    /// How many; 0 where nothing is released.
    count: u32,
    /// The length of each, s.
    length: f64,
    /// How long before the end of a part it is released, s: half of it, or less where the parts are still long for what decays fastest.
    rest: f64,
}

impl Parts {
    /// Of a step of this length into which substances with these rates of decay, 1/s, are released.
    fn new(dt: f64, decays: impl Iterator<Item = f64>) -> Self {
        let Some(decay) = decays.reduce(f64::max) else { return Self { count: 0, length: dt, rest: 0.0 } };
        let count = (decay * dt / LONGEST).ceil().clamp(1.0, MOST_PARTS);
        let length = dt / count;
        Self { count: count as u32, length, rest: 0.5 * length.min(LONGEST / decay) }
    }

    /// The length of a part over that of the step.
    fn share(&self) -> f64 {
        1.0 / f64::from(self.count)
    }

    /// What a part releases, over the rates where it begins, in its middle and where it ends, s: as much as is left at its end of what flows in at a
    /// rate on a parabola through the three, when the rest of the part has decayed.
    fn released(&self, decay: f64) -> [f64; 3] {
        let [constant, rising, square] = left_of_powers(decay * self.length);
        let left = [constant - 3.0 * rising + 2.0 * square, 4.0 * (rising - square), 2.0 * square - rising];
        left.map(|left| left * self.length * (decay * self.rest).exp())
    }
}

/// What is left at 1 of what flows in from 0 on at the rates 1, u and u² and decays with a rate x.
fn left_of_powers(x: f64) -> [f64; 3] {
    // Of that which rises with the power n, (1 − n times that of the power before) / x; of small x the sum of its powers.
    if x < 1.0 {
        return [0.0, 1.0, 2.0].map(|n| {
            let (mut term, mut sum, mut next) = (1.0 / (n + 1.0), 0.0, n + 2.0);
            while term != 0.0 && sum + term != sum {
                sum += term;
                term *= -x / next;
                next += 1.0;
            }
            sum
        });
    }
    let constant = -f64::exp_m1(-x) / x;
    let rising = (1.0 - constant) / x;
    [constant, rising, (1.0 - 2.0 * rising) / x]
}

/// A piece of a step of a field into which something is released: the number of the field, which piece it is and the shares of the step at which it
/// begins and ends, its parts, and the states between whose rates those of atoms in the step lie.
#[derive(Clone, Copy)]
struct Release<'a> {
    model: &'a Model,
    field: usize,
    piece: (usize, [f64; 2]),
    parts: Parts,
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
        for piece in 0..ws.chemistry.released.pieces.len() {
            let shares @ [begins, ends] = ws.chemistry.released.pieces[piece];
            let into = channels(model, &state.chemistry.controls).filter(|(field, _)| *field == number);
            let parts = Parts::new((ends - begins) * dt, into.map(|(_, species)| decay((model, number), species)));
            let before = parts.length - parts.rest;
            for part in 0..parts.count {
                let begin = start + begins * dt + f64::from(part) * parts.length;
                advance_field((model, number), (begin, before), state, ws)?;
                let (from, to) = (&from.chemistry.controls, &state.chemistry.controls);
                let release = Release { model, field: number, piece: (piece, shares), parts, from, to };
                release.deposit(f64::from(part) * parts.share(), state, &mut ws.chemistry);
                advance_field((model, number), (begin + before, parts.rest), state, ws)?;
            }
        }
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
    /// Releases what comes in the part of the piece that begins at a share of it.
    fn deposit(self, part: f64, state: &State, scratch: &mut ChemistryScratch) {
        let shares = [0.0, 0.5, 1.0].map(|within| part + within * self.parts.share());
        // What atoms release is on one line through the step.
        let [begins, ends] = self.piece.1;
        let of_step = shares.map(|share| begins + share * (ends - begins));
        for (channel, (_, species)) in
            channels(self.model, self.to).enumerate().filter(|(_, into)| into.0 == self.field)
        {
            let released = self.parts.released(decay((self.model, self.field), species));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_released_into_decay_is_there_in_full_at_the_end_however_fast_it_is() {
        for (decay, dt, count) in [
            (0.0, 3.0, 1),
            (1e-12, 1.0, 1),
            (8e-9, 1.0, 1),
            (0.3, 0.1, 1),
            (2.0, 1.0, 4),
            (0.7, 400.0, 64),
            (1e7, 10.0, 64),
        ] {
            let parts = Parts::new(dt, [decay, 0.5 * decay].into_iter());
            assert_eq!(parts.count, count, "{decay} {dt}");
            assert!(parts.rest > 0.0 && parts.rest <= 0.5 * parts.length && decay * parts.rest <= 0.25, "{parts:?}");
            for decay in [decay, 0.5 * decay] {
                let turns = decay * parts.length;
                // Of what flowed in at all times before; the sum of its powers where it hardly decays.
                let exact = if turns < 1e-3 {
                    parts.length * (1.0 - turns / 2.0 * (1.0 - turns / 3.0 * (1.0 - turns / 4.0)))
                } else {
                    (1.0 - (-turns).exp()) / decay
                };
                let weights = parts.released(decay).map(|left| left * f64::exp(-decay * parts.rest));
                // What both round.
                let whole = weights.iter().sum::<f64>();
                assert!((whole / exact - 1.0).abs() < 1e-12, "{decay} {dt}: {weights:?} {exact}");
                // Of rates on parabolas, by Simpson's rule. Where parts are at their most and much decays in each, 2 000 points do not resolve it.
                for powers in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
                    let rate = |u: f64| powers[0] + powers[1] * u + powers[2] * u * u;
                    let n = 2000;
                    let weight = |i: usize| if i.is_multiple_of(n) { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
                    let left = |i: usize| {
                        let share = i as f64 / n as f64;
                        rate(share) * (-turns * (1.0 - share)).exp() * weight(i)
                    };
                    let wanted = (0..=n).map(left).sum::<f64>() * parts.length / (3 * n) as f64;
                    let found: f64 = weights.iter().zip([0.0, 0.5, 1.0]).map(|(weight, u)| weight * rate(u)).sum();
                    assert!(turns > 10.0 || (found / wanted - 1.0).abs() < 1e-9, "{decay} {dt}: {found} {wanted}");
                }
            }
        }
        assert_eq!(Parts::new(1.0, std::iter::empty()).count, 0);
    }
}
