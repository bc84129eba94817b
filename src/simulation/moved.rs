//! What is recorded of atoms that are moved on courses: how far they are, and the force that it takes.

use crate::Vec3;
use crate::mechanics::moved::Moved;
use crate::recorded::series_of_moved;
use crate::sim::{Kind, KindState, Model, State};

/// Names and units of their series.
pub fn names(model: &Model) -> Vec<(String, String)> {
    let own = |kind: &Kind| kind.moved.iter().map(|moved| moved.name.clone()).collect();
    let types: Vec<(&str, Vec<String>)> = model.kinds.iter().map(|kind| (kind.name.as_str(), own(kind))).collect();
    series_of_moved(&types).into_iter().map(|(name, unit)| (name, unit.to_owned())).collect()
}

/// Adds their values at this instant; the force is that on the atoms of all cells of the type together, along the direction, in the mean over
/// the last step.
pub fn record(model: &Model, state: &State, values: &mut Vec<f64>) {
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        for moved in &kind.moved {
            values.extend([moved.displacement.at(state.time), force_on(kind, now, moved)]);
        }
    }
}

fn force_on(kind: &Kind, now: &KindState, moved: &Moved) -> f64 {
    let of_cell = |cell: usize| {
        let own = now.balance.get(cell * kind.atoms()..(cell + 1) * kind.atoms()).unwrap_or_default();
        moved.atoms.iter().filter_map(|atom| own.get(*atom as usize)).map(|atom| Vec3::from(atom.held)).sum::<Vec3>()
    };
    (0..now.cells()).map(of_cell).sum::<Vec3>().dot(&moved.direction)
}
