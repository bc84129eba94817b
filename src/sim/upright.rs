//! Whether bodies whose material has no energy inside out are so nowhere.

use rayon::prelude::*;

use super::kind::Kind;
use super::model::Model;
use super::state::{State, index};
use super::trouble::Trouble;
use crate::Vec3;
use crate::mechanics::Force;

/// Looks for a tetrahedron that has no volume left, where its material tells no way back from there; `time` is that of the message, s.
///
/// # Errors
/// The first that there is.
pub fn check_upright(model: &Model, time: f64, state: &State) -> Result<(), Trouble> {
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        let position = |cell: usize, atom: u32| {
            Vec3::from([0, 1, 2].map(|axis| now.positions[index(kind, cell, atom as usize, axis)]))
        };
        for solid in solids(kind) {
            let found = (0..now.cells()).into_par_iter().find_map_first(|cell| {
                let atoms = solid.inside_out(|atom| position(cell, atom))?;
                Some((cell, atoms))
            });
            if let Some((cell, atoms)) = found {
                return Err(Trouble::InsideOut { kind: kind.name.clone(), cell, atoms, time });
            }
        }
    }
    Ok(())
}

fn solids(kind: &Kind) -> impl Iterator<Item = &crate::mechanics::solid::Solid> {
    kind.forces.iter().filter_map(|force| match force {
        Force::Solid(solid) => Some(solid),
        _ => None,
    })
}
