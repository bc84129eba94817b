//! What cells release into fields in a step, and the fields meanwhile.
//!
//! Cells release all the time. Fields that take up what is released move by half of a part of the step, are given what is released in the whole
//! part, and move by the other half, eq. (coupling.4): second order, and exact in amount where they decay.

use super::super::model::Model;
use super::super::state::{State, vector};
use super::super::trouble::Trouble;
use super::super::workspace::Workspace;
use super::scratch::ChemistryScratch;
use crate::error::Error;
use crate::ode::{Numbers, Substeps};

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

    /// What a part releases, over the rate, s: as much as leaves (1 − e^(−kδ))/k at its end when the rest of it has decayed.
    fn released(&self, decay: f64) -> f64 {
        let turns = decay * self.length;
        let left = if turns == 0.0 { self.length } else { -f64::exp_m1(-turns) / decay };
        left * (decay * self.rest).exp()
    }
}

/// Moves all fields through a step, with what cells release into them meanwhile.
pub fn move_fields(
    model: &Model,
    (start, dt): (f64, f64),
    state: &mut State,
    ws: &mut Workspace,
) -> Result<(), Trouble> {
    for number in 0..model.chemistry.fields.len() {
        let all = model.chemistry.secreted.iter().chain(&state.chemistry.controls.secreted);
        let into = all.filter(|(field, _)| *field == number);
        let parts = Parts::new(dt, into.map(|(_, species)| decay((model, number), *species)));
        if parts.count == 0 {
            advance_field((model, number), (start, dt), state, ws)?;
        }
        let before = parts.length - parts.rest;
        for part in 0..parts.count {
            let begin = start + f64::from(part) * parts.length;
            advance_field((model, number), (begin, before), state, ws)?;
            deposit_secretion((model, number), parts, state, ws);
            deposit_at_atoms((model, number), parts, state, ws);
            advance_field((model, number), (begin + before, parts.rest), state, ws)?;
        }
    }
    Ok(())
}

/// The rate of decay of what is released, 1/s.
fn decay((model, field): (&Model, usize), species: usize) -> f64 {
    model.chemistry.fields[field].system.species()[species].decay
}

/// Releases into a field what cells secrete in a part of a step, spread evenly over the atoms.
fn deposit_secretion((model, field): (&Model, usize), parts: Parts, state: &State, ws: &mut Workspace) {
    let scratch = &mut ws.chemistry;
    let controls = &state.chemistry.controls;
    let channels = model.chemistry.secreted.iter().chain(&controls.secreted).zip(&controls.secretion);
    for (&(_, species), rates) in channels.filter(|((into, _), _)| *into == field) {
        let time = parts.released(decay((model, field), species));
        for (kind, now) in model.kinds.iter().zip(&state.kinds) {
            let atoms = kind.atoms();
            scratch.amounts.clear();
            scratch.positions.clear();
            for cell in 0..now.cells() {
                let rate = rates[now.first_cell + cell];
                if rate != 0.0 {
                    scratch.positions.extend((0..atoms).map(|atom| vector(kind, &now.positions, cell, atom)));
                    scratch.amounts.resize(scratch.positions.len(), rate * time / atoms as f64);
                }
            }
            scratch.fields[field].deposit_all(species, &scratch.positions, &scratch.amounts);
        }
    }
}

/// Releases into a field what atoms secrete in a part of a step, each on its own area.
fn deposit_at_atoms((model, field): (&Model, usize), parts: Parts, state: &State, ws: &mut Workspace) {
    let scratch = &mut ws.chemistry;
    let of_kinds = model.kinds.iter().zip(&state.kinds).zip(&state.chemistry.controls.of_atoms);
    for ((kind, now), controls) in of_kinds {
        let atoms = kind.atoms();
        for (channel, rates) in controls.secretion.iter().enumerate().filter(|(_, rates)| !rates.is_empty()) {
            let (into, species) = model.chemistry.secreted[channel];
            if into != field {
                continue;
            }
            let time = parts.released(decay((model, field), species));
            for cell in 0..now.cells() {
                let ChemistryScratch { positions, amounts, shapes, fields, .. } = scratch;
                positions.clear();
                positions.extend((0..atoms).map(|atom| vector(kind, &now.positions, cell, atom)));
                shapes.take(&kind.rest.facets, positions);
                amounts.clear();
                let own = &rates[cell * atoms..(cell + 1) * atoms];
                amounts.extend(own.iter().zip(&shapes.areas).map(|(rate, area)| rate * area * time));
                fields[field].deposit_all(species, positions, amounts);
            }
        }
    }
}

/// Noise, diffusion, decay and reactions of a field.
fn advance_field(
    (model, number): (&Model, usize),
    (start, dt): (f64, f64),
    state: &mut State,
    ws: &mut Workspace,
) -> Result<(), Trouble> {
    let trouble = |error: Error| match error {
        Error::Numbers { message, .. } => Trouble::Field { message },
        error => Trouble::Field { message: error.to_string() },
    };
    let reactor = &model.chemistry.fields[number];
    let (fields, now) = (&mut ws.chemistry.fields[number], &mut state.chemistry.fields[number]);
    fields.set_pace(now.pace);
    let numbers = Numbers { seed: model.seed, system: &reactor.name };
    let substeps = Substeps::new(reactor.pace, now.kicks, start, dt);
    for part in substeps {
        if let Some(kick) = part.kick {
            reactor.system.kick(fields, &now.inputs, kick, numbers).map_err(trouble)?;
        }
        let stepping = reactor.stepping.of(part.length);
        reactor.system.advance(fields, part.length, &now.inputs, stepping).map_err(trouble)?;
    }
    (now.pace, now.kicks) = (fields.pace(), substeps.kicks_at_end());
    Ok(())
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
                let found = parts.released(decay) * f64::exp(-decay * parts.rest);
                // What both round.
                assert!((found / exact - 1.0).abs() < 1e-12, "{decay} {dt}: {found} {exact}");
            }
        }
        assert_eq!(Parts::new(1.0, std::iter::empty()).count, 0);
    }
}
