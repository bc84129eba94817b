//! The projection: atoms are moved so that contacts and volumes hold.

use std::ops::Range;

use super::compliance::set_compliance;
use super::gather::{gather, gather_positions, scatter};
use super::mobility::{Mobility, Response};
use super::momentum::{go_on, go_on_by_modes};
use super::rows::{Pull, Row};
use super::scene::ContactScene;
use super::scratch::{ContactScratch, SweepRules};
use super::sweep::{Change, VolumeRow, sweep_contacts, sweep_depths, sweep_volumes};
use super::vectors::V4;
use crate::Vec3;
use crate::mechanics::integrator::Method;
use crate::mechanics::volume;
use crate::sim::implicit::gamma;
use crate::sim::kind::{Kind, VolumeRule};
use crate::sim::model::Model;
use crate::sim::state::{KindState, State, vector};
use crate::sim::thread_buffers::ThreadBuffers;
use crate::sim::trouble::Trouble;
use crate::sim::workspace::{KindScratch, Workspace};

/// Sweeps that mend depths. They need not come to rest: what is left is mended in the next step.
const MENDING: usize = 8;

/// What a step mends of a depth at most, over the travel that is safe.
const MENDED: f64 = 0.25;

/// What the stiffest shape of a cell takes back of a displacement in a step, over what is left, up to which all shapes move as drag lets
/// them. Sweeps by modes take two to three times as long and hardly save steps below a hundred; but in long steps at 15 what hangs on a
/// cell may lose its hold without them.
const STIFF: f64 = 8.0;

/// Moves the atoms from where they went freely so that contacts and volumes hold, to first order in what they are
/// moved; the exact volumes are for the stage after this.
///
/// # Errors
/// When the sweeps do not come to rest.
pub fn hold_contacts(
    model: &Model,
    dt: f64,
    rules: SweepRules,
    from: &State,
    to: &mut State,
    ws: &mut Workspace,
) -> Result<(), Trouble> {
    let Workspace { contact: s, kinds, buffers, .. } = ws;
    let Some(contact) = &s.scene(model, &from.kinds) else { return Ok(()) };
    s.sweeps = 0;
    if s.rows.is_empty() || !contact.law.projects() {
        return Ok(());
    }
    prepare(model, contact, dt, from, to, s, kinds, buffers);
    load_rows(contact, rules, s);
    let left = sweep(model, contact, rules, s);
    if rules.mends && s.rows.iter().any(|row| row.gap() < 0.0) {
        mend(model, contact, s);
    }
    s.law.adhesives.align(&s.start, &mut s.moved);
    put_back(model, contact, s, from, to);
    let worst = s.rows[left.worst].atoms;
    if s.mobility.has_modes {
        s.mobility.turns.put_back(&mut s.rows);
        s.mobility.turns.put_back(&mut s.pulls);
    }
    if left.largest <= contact.tolerance {
        return Ok(());
    }
    let owners = worst.map(|atom| contact.owner(atom));
    let cells = [owners[0], owners[3]].map(|(kind, cell)| (model.kinds[kind].name.clone(), cell));
    Err(Trouble::Contact { cells, time: from.time + dt, left: left.largest, sweeps: s.sweeps })
}

/// Puts the atoms where their displacements take them.
pub(super) fn put_back(model: &Model, contact: &ContactScene, s: &ContactScratch, from: &State, to: &mut State) {
    for (number, ((kind, now), next)) in model.kinds.iter().zip(&from.kinds).zip(&mut to.kinds).enumerate() {
        let moved = &s.moved[contact.atoms_of(number)];
        let first_body = from.kinds[..number].iter().map(KindState::cells).sum::<usize>();
        let position = |cell: usize, atom: usize| {
            let [x, y, z, _] = moved[cell * kind.atoms() + atom];
            let start = vector(kind, &now.positions, cell, atom);
            let by_modes = match s.mobility.has_modes {
                true => s.mobility.of_atom(first_body + cell, atom, start),
                false => Vec3::zeros(),
            };
            start + (Vec3::new(x, y, z) + by_modes)
        };
        scatter(kind, now.cells(), position, &mut next.positions);
    }
}

/// Whether elasticity takes back much of what a force does in an implicit step, so that drag alone does not tell what it moves.
fn is_stiff(model: &Model, dt: f64, kinds: &[KindScratch]) -> bool {
    let Method::Implicit { order } = model.integrator.method else { return false };
    let taken_back = |(kind, w): (&Kind, &KindScratch)| {
        gamma(kind, order) * w.stiffening * kind.largest_stiffness * dt / kind.drag > STIFF
    };
    model.kinds.iter().zip(kinds).any(taken_back)
}

/// Displacements, mobilities and volumes before the first sweep.
fn prepare(
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
    s.held.clear();
    s.mobility.clear(contact.law.moves_as_steps() && is_stiff(model, dt, kinds));
    let cells = from.kinds.iter().zip(&to.kinds);
    let mut first_body = 0;
    for (number, ((kind, (now, next)), w)) in model.kinds.iter().zip(cells).zip(kinds).enumerate() {
        let range = contact.atoms_of(number);
        let free = match model.integrator.method {
            Method::Implicit { .. } | Method::Explicit => dt / kind.drag,
            _ => dt * dt / kind.mass,
        };
        let modes = if s.mobility.has_modes { w.modes(kind) } else { None };
        let response = match (&modes, model.integrator.method) {
            (Some(modes), Method::Implicit { order }) => {
                Response::new(modes, w.stiffening, (order, gamma(kind, order)), dt, kind.drag)
            }
            _ => Response::alone(free),
        };
        let mobility = response.rest;
        if s.mobility.has_modes {
            s.mobility.add_kind(modes.as_deref(), &response, kind.atoms());
            for cell in 0..now.cells() {
                let x = (0..kind.atoms()).map(|atom| vector(kind, &now.positions, cell, atom));
                let turns = modes.is_some() && !kind.is_held();
                s.mobility.add_cell(range.start + cell * kind.atoms(), &response, !turns, x);
            }
        }
        for (cell, moved) in s.moved[range.clone()].chunks_exact_mut(kind.atoms()).enumerate() {
            for (atom, moved) in moved.iter_mut().enumerate() {
                let change = vector(kind, &next.positions, cell, atom) - vector(kind, &now.positions, cell, atom);
                *moved = [change.x, change.y, change.z, mobility];
            }
        }
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

/// Rows carry what they carried where the step begins; how they yield depends on the mobilities. Where cells move by modes they are put
/// in the order in which they are swept.
fn load_rows(contact: &ContactScene, rules: SweepRules, s: &mut ContactScratch) {
    let bodies_of = |row: &Row| [row.atoms[0], row.atoms[3]].map(|atom| contact.body_of(atom));
    let has_modes = s.mobility.has_modes;
    if has_modes {
        let Mobility { turns, bodies, .. } = &mut s.mobility;
        turns.find(s.rows.iter().map(bodies_of), bodies.len());
        turns.arrange(&mut s.rows);
        turns.arrange(&mut s.pulls);
    }
    for (row, pull) in s.rows.iter_mut().zip(&mut s.pulls) {
        *pull = Pull { force: pull.carried, carried: pull.carried, ..Pull::default() };
        let parts = row.atoms.iter().zip(row.weights());
        let alone: f64 = parts.map(|(atom, weight)| weight * weight * s.moved[*atom as usize][3]).sum();
        let by_modes = if has_modes { s.mobility.add_lever(row, bodies_of(row), &s.start) } else { [0.0; 2] };
        [row.compliance, row.across] = by_modes.map(|by_modes| (alone + by_modes) as f32);
        set_compliance(row, pull, rules.in_account);
    }
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
    for ((x, volumes), own) in
        (x.chunks_exact(length)).zip(free_volume.chunks_exact_mut(kind.lanes)).zip(own.chunks_mut(per_block))
    {
        buffers.enter(length, |[gradient, ..]| {
            volume::measure_block(&kind.rest.facets, x, &kind.held, gradient, volumes);
            gather(kind, gradient, own, <[f64; 3]>::from);
        });
    }
    for (cell, g) in own.chunks_exact(kind.atoms()).enumerate() {
        let (start, end) = (cell * kind.atoms(), (cell + 1) * kind.atoms());
        let (mut along, mut squared) = (0.0, 0.0);
        for (g, d) in g.iter().zip(&s.moved[first + start..first + end]) {
            along += (0..3).map(|axis| g[axis] * d[axis]).sum::<f64>();
            squared += (0..3).map(|axis| g[axis] * g[axis]).sum::<f64>();
        }
        let offset = free_volume[cell] - target[cell] - along;
        let mut row = VolumeRow {
            first: start,
            end,
            offset,
            inverse: 1.0 / (mobility * squared),
            mobility,
            swelling: mobility * mobility * squared,
            body: first_body + cell,
            modes: Default::default(),
        };
        if s.mobility.has_modes {
            row.modes = s.mobility.project(row.body, g);
            let response = s.mobility.response(row.body);
            let (mut compliance, mut swelling) = (mobility * squared, mobility * mobility * squared);
            for (response, part) in response.iter().zip(&row.modes) {
                let squared: f64 = part.iter().map(|part| part * part).sum();
                compliance += response * squared;
                // What is moved by a mode is moved by its response and by what each atom moves alone.
                swelling += response * (response + 2.0 * mobility) * squared;
            }
            (row.inverse, row.swelling) = (1.0 / compliance, swelling);
        }
        s.volumes.push(row);
    }
}

/// What the sweeps need of a kind.
struct Part<'a> {
    volumes: &'a [VolumeRow],
    /// Gradients of the volumes, µm².
    gradient: &'a [[f64; 3]],
    moved: &'a mut [V4],
    mobility: &'a mut Mobility,
}

/// Does something for each kind, in their order, with what is there of it.
fn for_each_part(
    model: &Model,
    contact: &ContactScene,
    (volumes, gradient, moved, mobility): (&[VolumeRow], &[[f64; 3]], &mut [V4], &mut Mobility),
    mut work: impl FnMut(Part),
) {
    let mut next = 0;
    for (number, kind) in model.kinds.iter().enumerate() {
        let range = contact.atoms_of(number);
        let count = if matches!(kind.volume, VolumeRule::Exact(_)) { range.len() / kind.atoms() } else { 0 };
        let volumes = &volumes[next..next + count];
        work(Part { volumes, gradient: &gradient[range.clone()], moved: &mut moved[range], mobility });
        next += count;
    }
}

/// Sweeps until nothing moves any more; returns what the last sweep changed.
fn sweep(model: &Model, contact: &ContactScene, rules: SweepRules, s: &mut ContactScratch) -> Change {
    let keeps_start = contact.law.needs_start();
    let mut before = std::mem::take(if keeps_start { &mut s.before } else { &mut s.start });
    let mut direction = std::mem::take(&mut s.forces.carried);
    before.clear();
    before.extend(s.moved.iter().map(|&[x, y, z, _]| Vec3::new(x, y, z)));
    direction.clear();
    direction.resize(contact.scene.atoms, Vec3::zeros());
    s.momentum.begin();
    let (mut change, mut share) = (Change::default(), 0.0);
    for number in 1..=contact.most_sweeps {
        change = Change::default();
        sweep_contacts(&s.rows, &mut s.pulls, &mut s.moved, &mut s.mobility, share, &mut change);
        s.law.adhesives.sweep(&s.start, &mut s.moved, share, &mut change);
        for &(atom, axis) in &s.held {
            s.moved[atom as usize][axis as usize] = before[atom as usize][axis as usize];
        }
        for_each_part(model, contact, (&s.volumes, &s.gradient, &mut s.moved, &mut s.mobility), |part| {
            sweep_volumes(part.volumes, part.gradient, part.moved, part.mobility, &mut change);
        });
        s.sweeps = number;
        // A change that is not a number is no rest either.
        if change.largest <= contact.tolerance * rules.tolerance_factor || number == contact.most_sweeps {
            break;
        }
        share = s.momentum.share(change.work);
        go_on(share, &mut s.moved, &mut before, &mut direction);
        if s.mobility.has_modes {
            go_on_by_modes(share, &mut s.mobility);
        }
    }
    s.forces.carried = direction;
    *(if keeps_start { &mut s.before } else { &mut s.start }) = before;
    change
}

/// Pushes out what is inside.
fn mend(model: &Model, contact: &ContactScene, s: &mut ContactScratch) {
    let is_deep = |(_, row): &(u32, &Row)| row.compliance > 0.0 && row.gap() < 0.0;
    s.deep.clear();
    s.deep.extend((0..).zip(&s.rows).filter(is_deep).map(|(number, _)| (number, 0.0)));
    for _ in 0..MENDING {
        sweep_depths(&s.rows, &mut s.deep, &mut s.moved, &mut s.mobility, MENDED * contact.reach.safe_travel());
        s.law.adhesives.align(&s.start, &mut s.moved);
        for_each_part(model, contact, (&s.volumes, &s.gradient, &mut s.moved, &mut s.mobility), |part| {
            sweep_volumes(part.volumes, part.gradient, part.moved, part.mobility, &mut Change::default());
        });
    }
}

/// The farthest that an atom moved in the step over what contacts allow; 0 without contacts.
pub fn travel(model: &Model, from: &State, to: &State) -> f64 {
    let Some(contact) = &model.contact else { return 0.0 };
    let mut farthest: f64 = 0.0;
    for ((kind, now), next) in model.kinds.iter().zip(&from.kinds).zip(&to.kinds) {
        // Lanes beyond the last cell may go elsewhere.
        for cell in 0..now.cells() {
            let position = |x: &[f64], atom: usize| vector(kind, x, cell, atom);
            let travels =
                (0..kind.atoms()).map(|atom| position(&next.positions, atom) - position(&now.positions, atom));
            farthest = travels.map(|travel| travel.norm_squared()).fold(farthest, f64::max);
        }
    }
    farthest.sqrt() / contact.reach.safe_travel()
}
