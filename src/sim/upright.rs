//! How far filled bodies deform in a step, and whether those whose material has no energy inside out are so nowhere.
//!
//! Stiff motion costs an error nothing, eq. (step.9): a grip may go far in a long step, and the layer of atoms beside it would come out on its
//! other side, where springs are at rest, too. So no tetrahedron changes its volume by more than half of it in a step that the error chooses.

use rayon::prelude::*;

use super::model::Model;
use super::state::{KindState, State};
use super::trouble::Trouble;
use crate::geometry::solid::tetrahedron_volume;
use crate::mechanics::integrator::StepSize;

/// By how much of its volume at rest a tetrahedron may change in a step.
const MOST: f64 = 0.5;

/// Tetrahedra that one job looks at.
const TETRAHEDRA_PER_JOB: usize = 1024;

/// An error estimate that refuses attempts in which a tetrahedron changes its volume too far, over the mean edge; 0 where steps have a fixed size.
pub fn change_of_volumes(model: &Model, from: &State, to: &State) -> f64 {
    let StepSize::Adaptive { tolerance, .. } = model.integrator.size else { return 0.0 };
    let mut most: f64 = 0.0;
    for ((kind, before), after) in model.kinds.iter().zip(&from.kinds).zip(&to.kinds) {
        for cell in 0..before.cells() {
            let change = |atoms: &[u32; 4]| {
                let volume =
                    |state: &KindState| tetrahedron_volume(atoms.map(|atom| state.position(kind, cell, atom as usize)));
                let rest = tetrahedron_volume(atoms.map(|atom| kind.rest.positions[atom as usize]));
                (volume(after) - volume(before)).abs() / rest
            };
            let of_all = kind.tetrahedra.par_iter().with_min_len(TETRAHEDRA_PER_JOB).map(change);
            most = most.max(of_all.reduce(|| 0.0, f64::max));
        }
    }
    // Errors grow with the square of the step.
    tolerance * (most / MOST).powi(2)
}

/// Looks for a tetrahedron that has no volume left, where its material tells no way back from there; `time` is that of the message, s.
///
/// # Errors
/// The first that there is.
pub fn check_upright(model: &Model, time: f64, state: &State) -> Result<(), Trouble> {
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        for solid in kind.solids() {
            let found = (0..now.cells()).into_par_iter().find_map_first(|cell| {
                let atoms = solid.inside_out(|atom| now.position(kind, cell, atom as usize))?;
                Some((cell, atoms))
            });
            if let Some((cell, atoms)) = found {
                return Err(Trouble::InsideOut { kind: kind.name.clone(), cell, atoms, time });
            }
        }
    }
    Ok(())
}
