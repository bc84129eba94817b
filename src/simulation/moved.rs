//! What is recorded of atoms that are moved on courses: how far they are, and the force that it takes.

use crate::Vec3;
use crate::mechanics::moved::Moved;
use crate::sim::{Kind, KindState, Model, State};

/// Names and units of their series: `displacement.NAME` and `force.NAME`, with the name of the type in between where several types have one of
/// this name.
pub fn names(model: &Model) -> impl Iterator<Item = (String, String)> {
    let has = |kind: &Kind, name: &str| kind.moved.iter().any(|moved| moved.name == name);
    each(model).flat_map(move |(number, moved)| {
        let shared = model.kinds.iter().filter(|kind| has(kind, &moved.name)).count() > 1;
        let owner = if shared { format!("{}.", model.kinds[number].name) } else { String::new() };
        let series = |(word, unit): (&str, &str)| (format!("{word}.{owner}{}", moved.name), unit.to_owned());
        [("displacement", "um"), ("force", "pN")].map(series)
    })
}

/// Adds their values at this instant; the force is that on the atoms of all cells of the type together, along the direction, in the mean over
/// the last step.
pub fn record(model: &Model, state: &State, values: &mut Vec<f64>) {
    for (number, moved) in each(model) {
        let force = force_on(&model.kinds[number], &state.kinds[number], moved);
        values.extend([moved.displacement.at(state.time), force]);
    }
}

fn each(model: &Model) -> impl Iterator<Item = (usize, &Moved)> {
    model.kinds.iter().enumerate().flat_map(|(number, kind)| kind.moved.iter().map(move |moved| (number, moved)))
}

fn force_on(kind: &Kind, now: &KindState, moved: &Moved) -> f64 {
    let of_cell = |cell: usize| {
        let own = now.balance.get(cell * kind.atoms()..(cell + 1) * kind.atoms()).unwrap_or_default();
        moved.atoms.iter().filter_map(|atom| own.get(*atom as usize)).map(|atom| Vec3::from(atom.held)).sum::<Vec3>()
    };
    (0..now.cells()).map(of_cell).sum::<Vec3>().dot(&moved.direction)
}
