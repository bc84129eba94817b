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

/// What a part of a step releases, over the rate times its length: as much as is there at the end of the part, (1 − e^(−kΔt))/k, when half of
/// its decay is before it.
fn grown(decay: f64, length: f64) -> f64 {
    let half = 0.5 * decay * length;
    // Below this the next term is round-off.
    if half < 1e-8 { 1.0 } else { half.sinh() / half }
}

/// Moves all fields through a step, with what cells release into them meanwhile.
pub fn move_fields(
    model: &Model,
    (start, dt): (f64, f64),
    state: &mut State,
    ws: &mut Workspace,
) -> Result<(), Trouble> {
    for number in 0..model.chemistry.fields.len() {
        let count = parts((model, number), dt, state);
        if count == 0 {
            advance_field((model, number), (start, dt), state, ws)?;
        }
        let length = dt / f64::from(count.max(1));
        for part in 0..count {
            let begin = start + f64::from(part) * length;
            advance_field((model, number), (begin, 0.5 * length), state, ws)?;
            deposit_secretion((model, number), length, state, ws);
            deposit_at_atoms((model, number), length, state, ws);
            advance_field((model, number), (begin + 0.5 * length, 0.5 * length), state, ws)?;
        }
    }
    Ok(())
}

/// Into how many parts the step of a field is cut; 0 where nothing is released into it.
fn parts((model, number): (&Model, usize), dt: f64, state: &State) -> u32 {
    let all = model.chemistry.secreted.iter().chain(&state.chemistry.controls.secreted);
    let into = all.filter(|(field, _)| *field == number);
    let count = |&(_, species): &(usize, usize)| (decay((model, number), species) * dt / LONGEST).ceil();
    into.map(|channel| count(channel).clamp(1.0, MOST_PARTS) as u32).max().unwrap_or(0)
}

/// The rate of decay of what is released, 1/s.
fn decay((model, field): (&Model, usize), species: usize) -> f64 {
    model.chemistry.fields[field].system.species()[species].decay
}

/// Releases into a field what cells secrete in a part of a step, spread evenly over the atoms.
fn deposit_secretion((model, field): (&Model, usize), dt: f64, state: &State, ws: &mut Workspace) {
    let scratch = &mut ws.chemistry;
    let controls = &state.chemistry.controls;
    let channels = model.chemistry.secreted.iter().chain(&controls.secreted).zip(&controls.secretion);
    for (&(_, species), rates) in channels.filter(|((into, _), _)| *into == field) {
        let time = dt * grown(decay((model, field), species), dt);
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
fn deposit_at_atoms((model, field): (&Model, usize), dt: f64, state: &State, ws: &mut Workspace) {
    let scratch = &mut ws.chemistry;
    let of_kinds = model.kinds.iter().zip(&state.kinds).zip(&state.chemistry.controls.of_atoms);
    for ((kind, now), controls) in of_kinds {
        let atoms = kind.atoms();
        for (channel, rates) in controls.secretion.iter().enumerate().filter(|(_, rates)| !rates.is_empty()) {
            let (into, species) = model.chemistry.secreted[channel];
            if into != field {
                continue;
            }
            let time = dt * grown(decay((model, field), species), dt);
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
    fn what_is_released_into_decay_is_there_in_full_at_the_end() {
        for (decay, length) in [(0.0, 3.0), (1e-12, 1.0), (0.3, 0.1), (2.0, 0.25), (0.7, 40.0)] {
            let exact = if decay < 1e-9 { length } else { -f64::exp_m1(-decay * length) / decay };
            let found = length * grown(decay, length) * f64::exp(-0.5 * decay * length);
            assert!((found / exact - 1.0).abs() < 1e-10, "{decay} {length}: {found} {exact}");
        }
    }
}
