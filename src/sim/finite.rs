//! Whether all positions are numbers.

use rayon::prelude::*;

use super::model::Model;
use super::state::{State, index};
use super::trouble::Trouble;

/// Numbers that a thread looks at at once.
const NUMBERS_PER_JOB: usize = 16_384;

/// Finds the first position that is not finite; `time` is that of the message, s.
///
/// # Errors
/// The atom whose position it is.
pub fn check_finite(model: &Model, time: f64, state: &State) -> Result<(), Trouble> {
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        // A sum is not finite when a part is not, or when it overflows, which is no better.
        let is_finite = |part: &[f64]| part.iter().map(|x| x * 1e-30).sum::<f64>().is_finite();
        if now.positions.par_chunks(NUMBERS_PER_JOB).all(is_finite) {
            continue;
        }
        for cell in 0..now.cells() {
            for atom in 0..kind.atoms() {
                if (0..3).any(|axis| !now.positions[index(kind, cell, atom, axis)].is_finite()) {
                    return Err(Trouble::NotFinite { kind: kind.name.clone(), cell, atom, time });
                }
            }
        }
    }
    Ok(())
}
