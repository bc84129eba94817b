//! What the sweeps begin with: displacements, how cells give way, volumes and rows.

use std::ops::Range;

use rayon::prelude::*;

use super::compliance::set_compliance;
use super::gather::{gather, gather_positions};
use super::mobility::{Mobility, Response};
use super::rows::{Pull, Row};
use super::scene::ContactScene;
use super::scratch::{ContactScratch, SweepRules};
use super::volumes::{InModes, VolumeRow};
use crate::mechanics::integrator::Method;
use crate::mechanics::volume;
use crate::sim::kind::{Kind, VolumeRule};
use crate::sim::model::Model;
use crate::sim::scheme::gamma;
use crate::sim::state::{State, vector};
use crate::sim::thread_buffers::ThreadBuffers;
use crate::sim::workspace::KindScratch;

/// Atoms and rows that a thread takes at once, at least.
const ATOMS_PER_JOB: usize = 1024;
const ROWS_PER_JOB: usize = 1024;

/// What the stiffest shape of a cell takes back of a displacement in a step, over what is left, up to which all shapes move as drag lets
/// them. Sweeps by modes take two to three times as long and hardly save steps below a hundred; but in long steps at 15 what hangs on a
/// cell may lose its hold without them.
const STIFF: f64 = 8.0;

/// Whether elasticity takes back much of what a force does to a cell in an implicit step, so that drag alone does not tell what it moves.
fn is_stiff(model: &Model, dt: f64, kind: &Kind, w: &KindScratch) -> bool {
    let Method::Implicit { order } = model.integrator.method else { return false };
    gamma(kind, order) * w.stiffening * kind.largest_stiffness * dt / kind.drag > STIFF
}

/// Displacements, mobilities and volumes before the first sweep.
pub fn prepare(
    model: &Model,
    contact: &ContactScene,
    dt: f64,
    from: &State,
    to: &State,
    s: &mut ContactScratch,
    kinds: &mut [KindScratch],
    buffers: &ThreadBuffers,
) {
    s.moved.resize(contact.scene.atoms, [0.0; 4]);
    s.gradient.resize(contact.scene.atoms, [0.0; 3]);
    s.volumes.clear();
    s.volume_modes.clear();
    s.held.clear();
    let as_steps = contact.law.moves_as_steps();
    let stiff = |(kind, w): (&Kind, &KindScratch)| as_steps && (kind.rigid.is_some() || is_stiff(model, dt, kind, w));
    s.mobility.clear(model.kinds.iter().zip(&*kinds).any(|both| both.0.tangent.is_none() && stiff(both)));
    s.mobility.columns.begin(model.kinds.iter().zip(&*kinds).map(|both| both.0.tangent.is_some() && stiff(both)));
    let cells = from.kinds.iter().zip(&to.kinds);
    let mut first_body = 0;
    for (number, ((kind, (now, next)), w)) in model.kinds.iter().zip(cells).zip(kinds).enumerate() {
        let range = contact.atoms_of(number);
        let free = match model.integrator.method {
            Method::Implicit { .. } | Method::Explicit => dt / kind.drag,
            _ => dt * dt / kind.mass,
        };
        let modes = if s.mobility.has_modes && kind.tangent.is_none() { w.modes(kind) } else { None };
        let response = match (&modes, model.integrator.method) {
            (Some(modes), Method::Implicit { order }) => {
                Response::new(modes, w.stiffening, (order, gamma(kind, order)), dt, kind.drag)
            }
            _ if s.mobility.columns.are_of(number) => Response::alone(0.0),
            _ => Response::alone(free),
        };
        let mobility = response.rest;
        if s.mobility.has_modes {
            s.mobility.add_kind(modes.as_deref(), &response, kind.atoms());
            for cell in 0..now.cells() {
                let x = (0..kind.atoms()).map(|atom| vector(kind, &now.positions, cell, atom));
                let turns = modes.is_some() && kind.may_turn();
                s.mobility.add_cell(range.start + cell * kind.atoms(), &response, !turns, x);
            }
        }
        let cells = s.moved[range.clone()].par_chunks_exact_mut(kind.atoms()).enumerate();
        cells.with_min_len(ATOMS_PER_JOB / kind.atoms()).for_each(|(cell, moved)| {
            for (atom, moved) in moved.iter_mut().enumerate() {
                let change = vector(kind, &next.positions, cell, atom) - vector(kind, &now.positions, cell, atom);
                *moved = [change.x, change.y, change.z, mobility];
            }
        });
        hold_atoms(kind, now.cells(), range.start, s);
        if matches!(kind.volume, VolumeRule::Exact(_)) {
            add_volumes(kind, &next.positions, range, (first_body, mobility), s, w, buffers);
        }
        first_body += now.cells();
    }
    s.law.adhesives.begin();
    if s.mobility.has_modes {
        // The sweeps of an attempt before may have taken their memory.
        gather_positions(model, contact, &from.kinds, &mut s.start);
        s.mobility.begin();
    }
}

/// Where cells move by modes rows are put in the order in which they are swept.
pub fn arrange_rows(contact: &ContactScene, s: &mut ContactScratch) {
    let bodies_of = |row: &Row| [row.atoms[0], row.atoms[3]].map(|atom| contact.body_of(atom));
    let has_modes = s.mobility.has_modes;
    let Mobility { turns, is_arranged, .. } = &mut s.mobility;
    // Many stand in the order of sweeps from the begin of the step on.
    *is_arranged = has_modes && !s.is_in_turns;
    if *is_arranged {
        turns.find(s.rows.len(), |row| bodies_of(&s.rows[row]), contact.scene.bodies.len());
        turns.arrange(&mut s.rows);
        turns.arrange(&mut s.pulls);
    } else if !s.is_in_turns {
        turns.leave(s.rows.len());
    }
}

/// Rows carry what they carried where the step begins; how they yield depends on the mobilities.
pub fn load_rows(contact: &ContactScene, rules: SweepRules, s: &mut ContactScratch) {
    let bodies_of = |row: &Row| [row.atoms[0], row.atoms[3]].map(|atom| contact.body_of(atom));
    let has_modes = s.mobility.has_modes;
    let ContactScratch { rows, pulls, moved, mobility, start, .. } = s;
    let columns = std::mem::take(&mut mobility.columns);
    let load = |row: &mut Row, pull: &mut Pull, by_modes: [f64; 2]| {
        *pull = Pull { force: pull.carried, carried: pull.carried, ..Pull::default() };
        let parts = row.atoms.iter().zip(row.weights());
        let alone: f64 = parts.map(|(atom, weight)| weight * weight * moved[*atom as usize][3]).sum();
        [row.compliance, row.across] = by_modes.map(|by_modes| (alone + by_modes) as f32);
        set_compliance(row, pull, rules.in_account);
    };
    let both = rows.par_iter_mut().zip(pulls).enumerate().with_min_len(ROWS_PER_JOB);
    if has_modes {
        let mut levers = std::mem::take(&mut mobility.levers);
        let with_levers = both.map(|(number, (row, pull))| {
            let (lever, by_modes) = mobility.lever(row, bodies_of(row), start);
            let by_columns = columns.response(number, row);
            load(row, pull, [by_modes[0] + by_columns[0], by_modes[1] + by_columns[1]]);
            lever
        });
        with_levers.collect_into_vec(&mut levers);
        mobility.levers = levers;
    } else {
        both.for_each(|(number, (row, pull))| load(row, pull, columns.response(number, row)));
    }
    mobility.columns = columns;
}

/// Lists what is held of a kind; atoms that are held along every axis get no mobility.
fn hold_atoms(kind: &Kind, cells: usize, first: usize, s: &mut ContactScratch) {
    for cell in 0..cells {
        for (atom, factors) in kind.held.chunks_exact(3).enumerate() {
            let number = first + cell * kind.atoms() + atom;
            if factors.iter().all(|factor| *factor == 0.0) {
                s.moved[number][3] = 0.0;
            } else {
                let held = (0..3).filter(|axis| factors[*axis as usize] == 0.0);
                s.held.extend(held.map(|axis| (number as u32, axis)));
            }
        }
    }
}

/// The volumes of a kind and their gradients where the atoms went freely.
fn add_volumes(
    kind: &Kind,
    x: &[f64],
    atoms: Range<usize>,
    (first_body, mobility): (usize, f64),
    s: &mut ContactScratch,
    w: &mut KindScratch,
    buffers: &ThreadBuffers,
) {
    let KindScratch { free_volume, target, .. } = w;
    let (first, own) = (atoms.start, &mut s.gradient[atoms]);
    let (length, per_block) = (kind.block_len(), kind.lanes * kind.atoms());
    (x.par_chunks_exact(length).zip(free_volume.par_chunks_exact_mut(kind.lanes)))
        .zip(own.par_chunks_mut(per_block))
        .for_each(|((x, volumes), own)| {
            buffers.enter(length, |[gradient, ..]| {
                volume::measure_block(&kind.rest.facets, x, &kind.held, gradient, volumes);
                gather(kind, gradient, own, <[f64; 3]>::from);
            });
        });
    let moved = &s.moved[first..];
    let volume = |(cell, g): (usize, &[[f64; 3]])| {
        let (start, end) = (cell * kind.atoms(), (cell + 1) * kind.atoms());
        let (mut along, squared) = (0.0, squared(g));
        for (g, d) in g.iter().zip(&moved[start..end]) {
            along += (0..3).map(|axis| g[axis] * d[axis]).sum::<f64>();
        }
        VolumeRow {
            first: start,
            end,
            offset: free_volume[cell] - target[cell] - along,
            inverse: 1.0 / (mobility * squared),
            mobility,
            swelling: mobility * mobility * squared,
            column: None,
            body: first_body + cell,
        }
    };
    let cells = own.par_chunks_exact(kind.atoms()).enumerate().with_min_len(ATOMS_PER_JOB / kind.atoms());
    s.volumes.par_extend(cells.map(volume));
    if s.mobility.has_modes {
        let begin = s.volumes.len() - own.len() / kind.atoms();
        for (row, g) in s.volumes[begin..].iter_mut().zip(own.chunks_exact(kind.atoms())) {
            s.volume_modes.push(yield_by_modes(row, g, &s.mobility));
        }
    }
}

/// Lets a volume yield by the modes of its cell, too; returns what its gradient is in these.
fn yield_by_modes(row: &mut VolumeRow, g: &[[f64; 3]], mobility: &Mobility) -> InModes {
    let alone = row.mobility;
    let modes = mobility.project(row.body, g);
    let mut compliance = alone * squared(g);
    for (response, part) in mobility.response(row.body).iter().zip(&modes) {
        let squared: f64 = part.iter().map(|part| part * part).sum();
        compliance += response * squared;
        // What is moved by a mode is moved by its response and by what each atom moves alone.
        row.swelling += response * (response + 2.0 * alone) * squared;
    }
    row.inverse = 1.0 / compliance;
    modes
}

/// Of a gradient.
fn squared(g: &[[f64; 3]]) -> f64 {
    let mut squared = 0.0;
    for g in g {
        squared += g.iter().map(|g| g * g).sum::<f64>();
    }
    squared
}
