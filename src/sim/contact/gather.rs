//! Between the blocks of lanes of the kinds and one list of all atoms.

use rayon::prelude::*;

use super::scene::ContactScene;
use crate::Vec3;
use crate::sim::kind::Kind;
use crate::sim::model::Model;
use crate::sim::state::{KindState, index, vector};

/// Cells whose atoms a thread takes at once, at least.
const CELLS_PER_JOB: usize = 64;

/// Takes the vectors of a kind in the order of its cells, and what `make` makes of each.
pub fn gather<T>(kind: &Kind, values: &[f64], to: &mut [T], make: impl Fn(Vec3) -> T) {
    for (cell, to) in to.chunks_exact_mut(kind.atoms()).enumerate() {
        let first = index(kind, cell, 0, 0);
        for (atom, to) in to.iter_mut().enumerate() {
            let at = first + 3 * atom * kind.lanes;
            *to = make(Vec3::new(values[at], values[at + kind.lanes], values[at + 2 * kind.lanes]));
        }
    }
}

/// Takes the positions of all atoms in the order of cells. Returns whether they were the same already.
pub fn gather_positions(model: &Model, contact: &ContactScene, cells: &[KindState], positions: &mut Vec<Vec3>) -> bool {
    let mut same = positions.len() == contact.scene.atoms;
    positions.resize(contact.scene.atoms, Vec3::zeros());
    for (number, (kind, now)) in model.kinds.iter().zip(cells).enumerate() {
        let take = |(cell, positions): (usize, &mut [Vec3])| {
            let mut same = true;
            for (atom, position) in positions.iter_mut().enumerate() {
                let now = vector(kind, &now.positions, cell, atom);
                same &= *position == now;
                *position = now;
            }
            same
        };
        let of_cells = positions[contact.atoms_of(number)].par_chunks_exact_mut(kind.atoms()).enumerate();
        same &= of_cells.with_min_len(CELLS_PER_JOB).map(take).reduce(|| true, |one, other| one & other);
    }
    same
}

/// Puts the vectors of a kind back, `from` the numbers of a cell and an atom of it; lanes beyond the last cell repeat it.
pub fn scatter(kind: &Kind, cells: usize, from: impl Fn(usize, usize) -> Vec3 + Sync, values: &mut [f64]) {
    values.par_chunks_exact_mut(kind.block_len()).enumerate().for_each(|(block, values)| {
        for lane in 0..kind.lanes {
            let cell = (block * kind.lanes + lane).min(cells - 1);
            for atom in 0..kind.atoms() {
                let x = from(cell, atom);
                let at = 3 * atom * kind.lanes + lane;
                (values[at], values[at + kind.lanes], values[at + 2 * kind.lanes]) = (x.x, x.y, x.z);
            }
        }
    });
}
