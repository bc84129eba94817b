//! The stages that keep what cells did to obstacles, to each other and to the medium over a step, atom by atom, eq. (traction.1): as the
//! attempt that stands has found it, so that over a cell all forces from outside add up to nothing.

use rayon::prelude::*;

use super::balance::AtomBalance;
use super::kind::Kind;
use super::model::Model;
use super::state::{KindState, State, index};
use super::workspace::{KindScratch, Workspace};
use crate::Vec3;
use crate::mechanics::integrator::Method;

/// Cells that a thread looks at at once, at least.
const CELLS_PER_JOB: usize = 16;

/// Begins an attempt: nothing was noted of it yet.
pub fn begin_tractions(model: &Model, from: &State, ws: &mut Workspace) {
    if !model.keeps_tractions {
        ws.contact.tractions.end();
        ws.kinds.iter_mut().for_each(|w| w.outer.clear());
        ws.kinds.iter_mut().for_each(|w| w.on_held.clear());
        return;
    }
    ws.contact.tractions.begin(from.atoms(model));
    // They carry what they carried also where nothing is swept.
    ws.contact.law.adhesives.begin();
    for ((kind, now), w) in model.kinds.iter().zip(&from.kinds).zip(&mut ws.kinds) {
        w.outer.clear();
        w.outer.resize(now.positions.len(), 0.0);
        w.on_held.clear();
        w.on_held.resize(if kind.is_held() { now.positions.len() } else { 0 }, 0.0);
        w.touch.iter_mut().for_each(|touch| touch.reactions.clear());
        w.project.iter_mut().for_each(|project| project.pushed.clear());
    }
}

/// Keeps what cells did to what is around them in a step of `dt` (s), as the attempt that stands has noted it.
pub fn keep_tractions(model: &Model, dt: f64, from: &State, to: &mut State, ws: &mut Workspace) {
    if !model.keeps_tractions {
        return;
    }
    ws.contact.note_adhesives();
    let noted = &ws.contact.tractions;
    for (((kind, from), to), w) in model.kinds.iter().zip(&from.kinds).zip(&mut to.kinds).zip(&ws.kinds) {
        to.balance.clear();
        to.balance.resize(from.cells() * kind.atoms(), AtomBalance::NONE);
        let mut balance = std::mem::take(&mut to.balance);
        let atoms = from.atoms(kind);
        let made = Made { kind, dt, method: model.integrator.method, from, to, w };
        let contacts = (&noted.on_obstacles[atoms.clone()], &noted.on_cells[atoms]);
        let cells = balance.par_chunks_mut(kind.atoms()).enumerate().with_min_len(CELLS_PER_JOB);
        cells.for_each(|(cell, own)| {
            for (atom, slot) in own.iter_mut().enumerate() {
                let number = cell * kind.atoms() + atom;
                *slot = made.of_atom(cell, atom, (contacts.0[number], contacts.1[number]));
            }
            share_what_is_left(kind, own);
        });
        to.balance = balance;
    }
}

/// A step that was made, as the cells of a kind have it.
struct Made<'a> {
    kind: &'a Kind,
    dt: f64,
    method: Method,
    from: &'a KindState,
    to: &'a KindState,
    w: &'a KindScratch,
}

impl Made<'_> {
    fn of_atom(&self, cell: usize, atom: usize, (on_obstacles, on_cells): (Vec3, Vec3)) -> AtomBalance {
        let &Self { kind, dt, method, from, to, w } = self;
        let vector = |values: &[f64]| Vec3::from_fn(|axis, _| values[index(kind, cell, atom, axis)]);
        let of_block = |values: &[f64]| {
            let first = index(kind, cell, atom, 0) % kind.block_len();
            let value = |axis: usize| values.get(first + axis * kind.lanes).copied().unwrap_or(0.0);
            Vec3::new(value(0), value(1), value(2))
        };
        let block = cell / kind.lanes;
        // Displacement over force of an atom by itself, µm/pN.
        let free = if method.is_inertial() { dt * dt / kind.mass } else { dt / kind.drag };
        let reaction = of_block(&w.touch[block].reactions) + of_block(&w.project[block].pushed) / free;
        let velocity = match method {
            Method::Implicit { .. } | Method::Explicit => (vector(&to.positions) - vector(&from.positions)) / dt,
            Method::SemiImplicitEuler => vector(&from.velocities),
            Method::Euler | Method::Verlet | Method::RungeKutta4 => (vector(&w.free) - vector(&from.positions)) / dt,
        };
        let inertia = match method.is_inertial() {
            true => kind.mass * (vector(&to.velocities) - vector(&from.velocities)) / dt,
            false => Vec3::zeros(),
        };
        let (traction, drag) = (on_obstacles - reaction, -kind.drag * velocity);
        // What holds an atom, or moves it on a course, bears all that acts on it.
        let held = match w.on_held.is_empty() {
            true => Vec3::zeros(),
            false => (traction + on_cells + inertia - drag - vector(&w.on_held)).component_mul(&holds(kind, atom)),
        };
        AtomBalance {
            traction: traction.into(),
            of_cells: on_cells.into(),
            drag: drag.into(),
            outer: vector(&w.outer).into(),
            held: held.into(),
            inertia: inertia.into(),
        }
    }
}

/// One along each axis along which an atom is held, and else nothing.
fn holds(kind: &Kind, atom: usize) -> Vec3 {
    Vec3::from_fn(|axis, _| 1.0 - kind.held.get(3 * atom + axis).copied().unwrap_or(1.0))
}

/// Shares among the atoms that hold a cell what is left of its sum: that of a step is exact, and that of the forces at single atoms as good as
/// the scheme.
fn share_what_is_left(kind: &Kind, own: &mut [AtomBalance]) {
    if !kind.is_held() {
        return;
    }
    let left: Vec3 = own.iter().map(AtomBalance::left).sum();
    let holding: Vec3 = (0..kind.atoms()).map(|atom| holds(kind, atom)).sum();
    for (atom, slot) in own.iter_mut().enumerate() {
        let share = holds(kind, atom).zip_map(&holding, |holds, all| if all > 0.0 { holds / all } else { 0.0 });
        slot.held = (Vec3::from(slot.held) - left.component_mul(&share)).into();
    }
}
