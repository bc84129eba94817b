//! What keeps a step, and a run, from leading cells past curved obstacles between their atoms and edges.

use rayon::prelude::*;

use super::model::Model;
use super::state::State;
use super::trouble::Trouble;
use crate::contact::winding_number;
use crate::geometry;

/// Looks whether a tool has come into a closed cell through a facet, which only atoms and edges keep from it.
///
/// # Errors
/// The first such cell.
pub fn check_pierced(model: &Model, time: f64, state: &State) -> Result<(), Trouble> {
    for obstacle in &model.obstacles {
        let geometry::Obstacle::Turned(body) = &obstacle.surface else { continue };
        let point = body.a_point() + obstacle.gone(time);
        for (kind, now) in model.kinds.iter().zip(&state.kinds).filter(|(kind, _)| kind.closed) {
            let is_in = |cell: &usize| winding_number(point, &now.cell(kind, *cell), &kind.rest.facets) > 0.5;
            if let Some(cell) = (0..now.cells()).into_par_iter().find_first(is_in) {
                let cell = (kind.name.clone(), cell);
                return Err(Trouble::Pierced { tool: obstacle.name.clone(), cell, time });
            }
        }
    }
    Ok(())
}

/// How far an atom may go beside a tool that it touches, over the distance of the thinnest part of the tool from its axis: it cannot have gone
/// past it then.
const PASSING: f64 = 0.25;

/// How far atoms have gone in a step that ends at a time (s) beside curved obstacles, over what is safe: what is between them and the obstacle and [`PASSING`] besides.
pub fn travel_past(model: &Model, from: &State, to: &State, end: f64) -> f64 {
    let mut share: f64 = 0.0;
    for obstacle in &model.obstacles {
        let geometry::Obstacle::Turned(body) = &obstacle.surface else { continue };
        let safe = PASSING * body.thinnest();
        let gone = obstacle.gone(end) - obstacle.gone(from.time);
        for ((kind, before), now) in model.kinds.iter().zip(&from.kinds).zip(&to.kinds) {
            for (cell, atom) in (0..now.cells()).flat_map(|cell| (0..kind.atoms()).map(move |atom| (cell, atom))) {
                let start = before.position(kind, cell, atom);
                let displacement = (now.position(kind, cell, atom) - start - gone).norm();
                // Most go nowhere near as far.
                if displacement > share * safe {
                    share = share.max(displacement / (obstacle.beside(from.time, &start).gap.max(0.0) + safe));
                }
            }
        }
    }
    share
}
