//! What is recorded of tools: the force of the cells on each, how far they reach past its point, and how far it has gone.

use crate::Vec3;
use crate::geometry;
use crate::recorded::series_of_tool;
use crate::sim::{Kind, KindState, Model, Obstacle, State};

/// The obstacles that are tools, by number.
fn tools(model: &Model) -> impl Iterator<Item = (usize, &Obstacle)> {
    model.obstacles.iter().enumerate().filter(|(_, obstacle)| !obstacle.is_flat())
}

/// Names and units of their series.
pub fn names(model: &Model) -> Vec<(String, String)> {
    let series = tools(model).flat_map(|(_, tool)| series_of_tool(&tool.name, tool.going.is_some()));
    series.map(|(name, unit)| (name, unit.to_owned())).collect()
}

/// Adds their values at this instant; forces are those in the mean over the last step. What an atom does to obstacles counts for the one that is
/// nearest to it.
pub fn record(model: &Model, state: &State, values: &mut Vec<f64>) {
    let forces = if tools(model).next().is_some() { forces(model, state) } else { Vec::new() };
    for (number, tool) in tools(model) {
        values.extend(forces[number].iter());
        values.push(reach(model, state, tool));
        values.extend(tool.going.as_ref().map(|going| going.displacement.at(state.time)));
    }
}

/// Forces of the cells on all obstacles, pN.
fn forces(model: &Model, state: &State) -> Vec<Vec3> {
    let mut forces = vec![Vec3::zeros(); model.obstacles.len()];
    for_each_atom(model, state, |kind, now, cell, atom| {
        let Some(balance) = now.balance.get(cell * kind.atoms() + atom) else { return };
        let traction = Vec3::from(balance.traction);
        if traction != Vec3::zeros() {
            let at = now.position(kind, cell, atom);
            let gaps = model.obstacles.iter().map(|obstacle| obstacle.beside(state.time, &at).gap.abs());
            let nearest = gaps.enumerate().min_by(|one, other| one.1.total_cmp(&other.1));
            nearest.into_iter().for_each(|(number, _)| forces[number] += traction);
        }
    });
    forces
}

/// How far the farthest atom is along the axis of a tool from its point, µm; NaN without cells.
fn reach(model: &Model, state: &State, tool: &Obstacle) -> f64 {
    let geometry::Obstacle::Turned(body) = &tool.surface else { return f64::NAN };
    let mut farthest = f64::NAN;
    let point = body.point + tool.gone(state.time);
    for_each_atom(model, state, |kind, now, cell, atom| {
        farthest = farthest.max((now.position(kind, cell, atom) - point).dot(&body.axis));
    });
    farthest
}

fn for_each_atom(model: &Model, state: &State, mut work: impl FnMut(&Kind, &KindState, usize, usize)) {
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        (0..now.cells()).for_each(|cell| (0..kind.atoms()).for_each(|atom| work(kind, now, cell, atom)));
    }
}
