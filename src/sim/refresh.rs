//! The stage that keeps the stiffness K of the implicit step fit for cells that deform strongly.
//!
//! K is made for the rest shape and shared by all cells of a kind, unless each cell has its own tangent stiffness. The factor of that is
//! made in every step where there are several cells, and kept for a cell that stands alone until it has changed its shape or turned.
//!
//! A cell that is stretched or squeezed far may grow several times stiffer than a K that is shared, eq. (step.8), and then only tiny
//! steps are stable. A kind of one cell therefore makes K again for the shape that the cell has now, whenever an edge has changed enough
//! since K was last made.

use super::elasticity;
use super::kind::Kind;
use super::model::Model;
use super::state::{KindState, State};
use super::workspace::Workspace;
use crate::Vec3;
use crate::mechanics::integrator::Method;

/// K is made again when the square of some edge's length has changed by this factor: by then a cell that hardens with
/// the fourth power of its stretch is two times stiffer than K takes it to be, which the scheme still bears.
const CHANGE: f64 = 1.4;

/// A cell's own stiffness is made again when an edge has changed by this part of its length, in length or direction: by then what it is off
/// shows in the steps.
const TURN: f64 = 0.05;

/// Makes K fit for the step, where the scheme has one.
pub fn fit_stiffness(model: &Model, from: &State, to: &mut State, ws: &mut Workspace) {
    if let Method::Implicit { .. } = model.integrator.method {
        refresh_stiffness(model, from, to, ws);
        cover_stiffening(model, from, ws);
    }
}

/// Makes K again where a cell has changed its shape; which shape K belongs to is part of the state.
fn refresh_stiffness(model: &Model, from: &State, to: &mut State, ws: &mut Workspace) {
    let cells = from.kinds.iter().zip(&mut to.kinds);
    for ((kind, (now, next)), w) in model.kinds.iter().zip(cells).zip(&mut ws.kinds) {
        let is_due = if kind.tangent.is_some() { has_turned } else { has_changed };
        // The factor that is kept is that of a block of one lane. What is viscous is so in the shape where a step begins, and a slender body is so
        // much stiffer along itself than across that none may have turned.
        let is_kept = kind.lanes == 1 && kind.viscosity.is_none() && kind.tetrahedra.is_empty();
        let is_alone = now.cells() == 1 && (kind.tangent.is_none() || is_kept);
        if !is_alone {
            next.stiffness_shape.clear();
        } else if is_due(kind, now) {
            next.stiffness_shape.clear();
            next.stiffness_shape
                .extend((0..kind.atoms()).flat_map(|atom| <[f64; 3]>::from(now.position(kind, 0, atom))));
        }
        if w.stiffness_shape != next.stiffness_shape {
            let shape: Vec<Vec3> = next.stiffness_shape.chunks_exact(3).map(Vec3::from_column_slice).collect();
            let is_shared = kind.tangent.is_none() && !shape.is_empty();
            w.set_stiffness(is_shared.then(|| kind.stiffness_at(&shape)), &next.stiffness_shape);
        }
    }
}

/// Raises K to cover the stiffest cell of each kind where chemistry sets the stiffness, in powers of two so that few
/// factorisations are made. A K that is too large costs some accuracy, one that is too small stability. A cell that has its own
/// stiffness has exactly what is set.
fn cover_stiffening(model: &Model, from: &State, ws: &mut Workspace) {
    let controls = &from.chemistry.controls;
    for ((kind, now), w) in model.kinds.iter().zip(&from.kinds).zip(&mut ws.kinds) {
        w.stiffening = match controls.stiffness.get(now.numbers()) {
            Some(&[own]) if kind.tangent.is_some() && kind.lanes == 1 => own,
            Some(cells) => cells.iter().copied().fold(1.0, f64::max).log2().ceil().exp2(),
            None => 1.0,
        };
        if let Some(own) = elasticity::factors(kind, now, controls) {
            w.stiffening *= elasticity::largest_factor(own).log2().ceil().exp2();
        }
    }
}

/// Whether an edge of a single cell differs from what it was in the shape that its own stiffness was made for, in length or direction.
fn has_turned(kind: &Kind, now: &KindState) -> bool {
    let shape = &now.stiffness_shape;
    let then = |atom: u32| Vec3::from_column_slice(&shape[3 * atom as usize..3 * atom as usize + 3]);
    let has_turned = |(i, j): (u32, u32)| {
        let before = then(j) - then(i);
        let edge = now.position(kind, 0, j as usize) - now.position(kind, 0, i as usize);
        (edge - before).norm_squared() > TURN * TURN * before.norm_squared()
    };
    let of_facet = |&[a, b, c]: &[u32; 3]| [(a, b), (b, c), (c, a)].into_iter().any(has_turned);
    let inside =
        |&[a, b, c, d]: &[u32; 4]| [(a, b), (a, c), (a, d), (b, c), (b, d), (c, d)].into_iter().any(has_turned);
    shape.is_empty() || kind.rest.facets.iter().any(of_facet) || kind.tetrahedra.iter().any(inside)
}

/// Whether an edge of a single cell has another length than in the shape that K was made for (the rest shape, if none).
fn has_changed(kind: &Kind, now: &KindState) -> bool {
    let shape = &now.stiffness_shape;
    let squared = |position: &dyn Fn(u32) -> Vec3, i: u32, j: u32| (position(i) - position(j)).norm_squared();
    let then = |atom: u32| Vec3::from_column_slice(&shape[3 * atom as usize..3 * atom as usize + 3]);
    let rest = |atom: u32| kind.rest.positions[atom as usize];
    kind.rest.facets.iter().any(|&[a, b, c]| {
        [(a, b), (b, c), (c, a)].into_iter().any(|(i, j)| {
            let then = if shape.is_empty() { squared(&rest, i, j) } else { squared(&then, i, j) };
            let ratio = squared(&|atom| now.position(kind, 0, atom as usize), i, j) / then;
            !(1.0 / CHANGE..=CHANGE).contains(&ratio)
        })
    })
}
