//! Membranes whose moduli differ from atom to atom, as chemistry sets them, eq. (membrane.6).

use super::controls::Controls;
use super::kind::Kind;
use super::model::Model;
use super::state::{KindState, State};
use crate::mechanics::Force;
use crate::mechanics::lanes::{Vectors, VectorsMut};

/// Gathers the factors of all atoms where links set those of some; nothing where none does.
pub fn gather_elasticity(model: &Model, state: &mut State) {
    let count = state.atoms(model);
    let State { kinds, chemistry, .. } = state;
    let controls = &mut chemistry.controls;
    let any = controls.of_atoms.iter().any(|own| !own.elasticity.is_empty());
    controls.elasticity_of_atoms.clear();
    controls.elasticity_of_atoms.resize(if any { count } else { 0 }, 1.0);
    for ((kind, now), own) in model.kinds.iter().zip(&*kinds).zip(&controls.of_atoms) {
        if any && !own.elasticity.is_empty() {
            controls.elasticity_of_atoms[now.atoms(kind)].copy_from_slice(&own.elasticity);
        }
    }
}

/// The factors of the atoms of the cells of a kind, cell after cell; none where all are 1.
pub fn factors<'a>(kind: &Kind, cells: &KindState, controls: &'a Controls) -> Option<&'a [f64]> {
    controls.elasticity_of_atoms.get(cells.atoms(kind)).filter(|own| !own.is_empty() && kind.has_membrane())
}

/// Adds what membranes do more, or less, where their atoms have factors of their own, and the energy of that; the factor of elastic forces
/// of each cell counts, too.
pub fn add_local_elasticity(
    kind: &Kind,
    cells: &KindState,
    (block, controls): (usize, &Controls),
    x: &[f64],
    f: &mut [f64],
    energy: &mut [f64],
) {
    let Some(own) = factors(kind, cells, controls) else { return };
    for lane in 0..kind.lanes {
        let cell = (block * kind.lanes + lane).min(cells.cells() - 1);
        let factors = &own[cell * kind.atoms()..(cell + 1) * kind.atoms()];
        let whole = controls.stiffness_of(cells.first_cell + cell);
        let x = Vectors::<f64>::new((), x, kind.lanes, lane);
        let mut f = VectorsMut::<f64>::new((), f, kind.lanes, lane);
        for force in &kind.forces {
            if let Force::Membrane(membrane) = force {
                energy[lane] += membrane.add_excess(whole, factors, &x, &mut f);
            }
        }
    }
}

/// The largest factor that an atom of a cell has, at least 1.
pub fn largest_factor(factors: &[f64]) -> f64 {
    factors.iter().copied().fold(1.0, f64::max)
}
