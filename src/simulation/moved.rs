//! What is recorded of atoms that are moved on courses, how far they are and the force that it takes, of pressures, torques, traps and flexible plates.

use crate::Vec3;
use crate::mechanics::moved::Moved;
use crate::recorded::{
    Motion, series_of_moved, series_of_plates, series_of_pressures, series_of_torques, series_of_traps,
};
use crate::sim::{Kind, KindState, Model, State};

/// Names and units of their series.
pub fn names(model: &Model) -> Vec<(String, String)> {
    let own = |kind: &Kind| kind.moved.iter().map(motion).collect();
    let types: Vec<(&str, Vec<Motion>)> = model.kinds.iter().map(|kind| (kind.name.as_str(), own(kind))).collect();
    series_of_moved(&types).into_iter().map(|(name, unit)| (name, unit.to_owned())).collect()
}

fn motion(moved: &Moved) -> Motion {
    Motion { name: moved.name.clone(), goes: moved.translation.is_some(), turns: moved.rotation.is_some() }
}

/// Adds their values at this instant: how far they have gone and turned, and the force along the direction and the torque about the axis that this
/// takes, in the mean over the last step on the atoms of all cells of the type together.
pub fn record(model: &Model, state: &State, values: &mut Vec<f64>) {
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        for moved in &kind.moved {
            let (force, torque) = force_and_torque(kind, now, moved, state.time);
            if let Some(line) = &moved.translation {
                values.extend([line.displacement.at(state.time), force.dot(&line.direction)]);
            }
            if let Some(turn) = &moved.rotation {
                values.extend([turn.angle.at(state.time), torque.dot(&turn.axis)]);
            }
        }
    }
}

/// Force (pN) on the atoms, and torque (pN·µm) about a point of the axis where it is now.
fn force_and_torque(kind: &Kind, now: &KindState, moved: &Moved, time: f64) -> (Vec3, Vec3) {
    let centre = moved.centre(time);
    let of_atom = |cell: usize, atom: usize| {
        let held = Vec3::from(now.balance.get(cell * kind.atoms() + atom)?.held);
        Some((held, (now.position(kind, cell, atom) - centre).cross(&held)))
    };
    let all = (0..now.cells()).flat_map(|cell| moved.atoms.iter().map(move |atom| (cell, *atom as usize)));
    all.filter_map(|(cell, atom)| of_atom(cell, atom))
        .fold((Vec3::zeros(), Vec3::zeros()), |(force, torque), own| (force + own.0, torque + own.1))
}

/// Names and units of the series of pressures: `pressure.NAME`.
pub fn names_of_pressures(model: &Model) -> Vec<(String, String)> {
    let own = |kind: &Kind| kind.pressures().map(|pressure| pressure.name.clone()).collect();
    let types: Vec<(&str, Vec<String>)> = model.kinds.iter().map(|kind| (kind.name.as_str(), own(kind))).collect();
    series_of_pressures(&types).into_iter().map(|name| (name, "pN/um^2".to_owned())).collect()
}

/// Adds the pressures at this instant.
pub fn record_pressures(model: &Model, state: &State, values: &mut Vec<f64>) {
    values.extend(model.kinds.iter().flat_map(Kind::pressures).map(|own| own.pressure.at(state.time)));
}

/// Names and units of the series of torques.
pub fn names_of_torques(model: &Model) -> Vec<(String, String)> {
    let own = |kind: &Kind| kind.torques().map(|torque| torque.name.clone()).collect();
    let types: Vec<(&str, Vec<String>)> = model.kinds.iter().map(|kind| (kind.name.as_str(), own(kind))).collect();
    series_of_torques(&types).into_iter().map(|(name, unit)| (name, unit.to_owned())).collect()
}

/// Adds the torques at this instant, and by how much cells have turned under each in the mean; NaN where there is no cell.
pub fn record_torques(model: &Model, state: &State, values: &mut Vec<f64>) {
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        for torque in kind.torques() {
            let angle = |cell: usize| torque.angle(|atom| now.position(kind, cell, atom as usize));
            let mean = (0..now.cells()).map(angle).sum::<f64>() / now.cells() as f64;
            values.extend([torque.torque.at(state.time), mean]);
        }
    }
}

/// Names and units of the series of traps.
pub fn names_of_traps(model: &Model) -> Vec<(String, String)> {
    let own = |kind: &Kind| kind.traps().map(|trap| trap.name.clone()).collect();
    let types: Vec<(&str, Vec<String>)> = model.kinds.iter().map(|kind| (kind.name.as_str(), own(kind))).collect();
    series_of_traps(&types).into_iter().map(|name| (name, "pN".to_owned())).collect()
}

/// Adds the forces of traps at this instant, on all bodies of the type together.
pub fn record_traps(model: &Model, state: &State, values: &mut Vec<f64>) {
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        for trap in kind.traps() {
            let centre = |cell: usize| now.cell(kind, cell).iter().sum::<Vec3>() / kind.atoms() as f64;
            let force: Vec3 = (0..now.cells()).map(|cell| trap.force(state.time, centre(cell))).sum();
            values.extend(force.iter());
        }
    }
}

/// Names and units of the series of flexible plates.
pub fn names_of_plates(model: &Model) -> Vec<(String, String)> {
    let own = |kind: &Kind| kind.plates().map(|plate| plate.name.clone()).collect();
    let types: Vec<(&str, Vec<String>)> = model.kinds.iter().map(|kind| (kind.name.as_str(), own(kind))).collect();
    series_of_plates(&types).into_iter().map(|(name, unit)| (name, unit.to_owned())).collect()
}

/// Adds the forces of plates on their cells at this instant, and how far they have gone; NaN where the cell is gone.
pub fn record_plates(model: &Model, state: &State, values: &mut Vec<f64>) {
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        for plate in kind.plates() {
            let gone = match now.cells() {
                0 => f64::NAN,
                _ => plate.gone(state.time, |atom| now.position(kind, 0, atom as usize)),
            };
            values.extend([plate.force(state.time, gone), gone]);
        }
    }
}
