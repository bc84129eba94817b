//! The projection: atoms are moved so that contacts and volumes hold.

use super::gather::{gather, scatter};
use super::give::set_give;
use super::model::{ContactModel, Law};
use super::momentum::go_on;
use super::rows::{Pull, Row};
use super::scratch::ContactScratch;
use super::sweep::{Change, V4, VolumeRow, sweep_contacts, sweep_depths, sweep_volumes};
use crate::Vec3;
use crate::mechanics::integrator::Method;
use crate::mechanics::volume;
use crate::sim::model::{Kind, Model, VolumeRule};
use crate::sim::rooms::Rooms;
use crate::sim::state::{State, vector};
use crate::sim::trouble::Trouble;
use crate::sim::workspace::{KindScratch, Workspace};

/// Sweeps that mend depths. They need not come to rest: what is left is mended in the next step.
const MENDING: usize = 8;

/// What a step mends of a depth at most, over the travel that is safe.
const MENDED: f64 = 0.25;

/// Moves the atoms from where they went freely so that contacts and volumes hold, to first order in what they are
/// moved; the exact volumes are for the stage after this.
///
/// # Errors
/// When the sweeps do not come to rest.
pub fn hold_contacts(model: &Model, dt: f64, state: &mut State, ws: &mut Workspace) -> Result<(), Trouble> {
    let Some(contact) = &model.contact else { return Ok(()) };
    let Workspace { contact: s, kinds, rooms, .. } = ws;
    s.sweeps = 0;
    if s.rows.is_empty() || matches!(contact.law, Law::Penalty(_)) {
        return Ok(());
    }
    prepare(model, contact, dt, state, s, kinds, rooms);
    let left = sweep(model, contact, s, state);
    if s.care == 1.0 && s.rows.iter().any(|row| row.gap() < 0.0) {
        mend(model, contact, s);
    }
    s.adhesives.place_all(&s.start, &mut s.moved);
    put_back(model, contact, s, kinds, state);
    if left.largest <= contact.tolerance {
        return Ok(());
    }
    let owners = s.rows[left.worst].atoms.map(|atom| contact.owner(atom));
    let cells = [owners[0], owners[3]].map(|(kind, cell)| (model.kinds[kind].name.clone(), cell));
    Err(Trouble::Contact { cells, time: state.time + dt, left: left.largest, sweeps: s.sweeps })
}

/// Puts the atoms where their displacements take them.
pub(super) fn put_back(
    model: &Model,
    contact: &ContactModel,
    s: &ContactScratch,
    kinds: &[KindScratch],
    state: &mut State,
) {
    for (number, ((kind, now), w)) in model.kinds.iter().zip(&mut state.kinds).zip(kinds).enumerate() {
        let moved = &s.moved[contact.atoms_of(number)];
        let place = |cell: usize, atom: usize| {
            let [x, y, z, _] = moved[cell * kind.atoms() + atom];
            vector(kind, &w.start, cell, atom) + Vec3::new(x, y, z)
        };
        scatter(kind, place, &mut now.positions);
    }
}

/// Displacements, mobilities, volumes and stiffnesses before the first sweep.
fn prepare(
    model: &Model,
    contact: &ContactModel,
    dt: f64,
    state: &State,
    s: &mut ContactScratch,
    kinds: &mut [KindScratch],
    rooms: &Rooms,
) {
    s.moved.resize(contact.scene.atoms, [0.0; 4]);
    s.gradient.resize(contact.scene.atoms, [0.0; 3]);
    s.volumes.clear();
    s.held.clear();
    for (number, ((kind, now), w)) in model.kinds.iter().zip(&state.kinds).zip(kinds).enumerate() {
        let range = contact.atoms_of(number);
        let mobility = match model.integrator.method {
            Method::Implicit { .. } | Method::Explicit => dt / kind.drag,
            _ => dt * dt / kind.mass,
        };
        for (cell, moved) in s.moved[range.clone()].chunks_exact_mut(kind.atoms()).enumerate() {
            for (atom, moved) in moved.iter_mut().enumerate() {
                let way = vector(kind, &now.positions, cell, atom) - vector(kind, &w.start, cell, atom);
                *moved = [way.x, way.y, way.z, mobility];
            }
        }
        hold_atoms(kind, range.start, s);
        if matches!(kind.volume, VolumeRule::Exact(_)) {
            add_volumes(kind, &now.positions, range.start, mobility, s, w, rooms);
        }
    }
    for (row, pull) in s.rows.iter_mut().zip(&mut s.pulls) {
        *pull = Pull { force: pull.carried, carried: pull.carried, ..Pull::default() };
        let gives =
            row.atoms.iter().zip(row.weights()).map(|(atom, weight)| weight * weight * s.moved[*atom as usize][3]);
        row.give = gives.sum::<f64>() as f32;
        set_give(row, pull, s.in_account);
    }
    s.adhesives.begin();
}

/// Lists what is held of a kind; atoms that are held along every axis get no mobility.
fn hold_atoms(kind: &Kind, first: usize, s: &mut ContactScratch) {
    for cell in 0..kind.cells {
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
    first: usize,
    mobility: f64,
    s: &mut ContactScratch,
    w: &mut KindScratch,
    rooms: &Rooms,
) {
    let KindScratch { left, target, .. } = w;
    let own = &mut s.gradient[first..first + kind.cells * kind.atoms()];
    let (length, per_block) = (kind.block_len(), kind.lanes * kind.atoms());
    for ((x, volumes), own) in
        (x.chunks_exact(length)).zip(left.chunks_exact_mut(kind.lanes)).zip(own.chunks_mut(per_block))
    {
        rooms.enter(length, |[gradient, ..]| {
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
        let offset = left[cell] - target[cell] - along;
        s.volumes.push(VolumeRow { first: start, end, offset, inverse: 1.0 / squared, mobility });
    }
}

/// What the sweeps need of a kind.
struct Part<'a> {
    volumes: &'a [VolumeRow],
    /// Gradients of the volumes, µm².
    gradient: &'a [[f64; 3]],
    moved: &'a mut [V4],
}

/// Does something for each kind, in their order, with its number, that of its first atom, and what is there of it.
fn for_each_part(
    model: &Model,
    contact: &ContactModel,
    (volumes, gradient, moved): (&[VolumeRow], &[[f64; 3]], &mut [V4]),
    mut work: impl FnMut(usize, usize, Part),
) {
    let mut next = 0;
    for (number, kind) in model.kinds.iter().enumerate() {
        let count = if matches!(kind.volume, VolumeRule::Exact(_)) { kind.cells } else { 0 };
        let range = contact.atoms_of(number);
        let volumes = &volumes[next..next + count];
        work(number, range.start, Part { volumes, gradient: &gradient[range.clone()], moved: &mut moved[range] });
        next += count;
    }
}

/// The vectors of all atoms of a kind in the order of its cells, in an array that has room for them.
fn vectors<'a>(kind: &Kind, array: &'a mut [f64]) -> &'a mut [[f64; 3]] {
    &mut array.as_chunks_mut().0[..kind.cells * kind.atoms()]
}

/// Sweeps until nothing moves any more; returns what the last sweep changed. Where the atoms went freely stands in the displacements
/// by now: the positions of the state are those before a sweep, as displacements, until atoms are put back.
fn sweep(model: &Model, contact: &ContactModel, s: &mut ContactScratch, state: &mut State) -> Change {
    // Adhesives move from where the step began.
    let keeps_start = contact.law != Law::Adhesives;
    let mut way = std::mem::take(if keeps_start { &mut s.way } else { &mut s.start });
    way.clear();
    way.resize(contact.scene.atoms, Vec3::zeros());
    for_each_part(model, contact, (&s.volumes, &s.gradient, &mut s.moved), |number, _, part| {
        let before = vectors(&model.kinds[number], &mut state.kinds[number].positions);
        before.iter_mut().zip(part.moved).for_each(|(before, &mut [x, y, z, _])| *before = [x, y, z]);
    });
    s.momentum.begin();
    let (mut change, mut share) = (Change::default(), 0.0);
    for number in 1..=contact.most_sweeps {
        change = Change::default();
        sweep_contacts(&s.rows, &mut s.pulls, &mut s.moved, share, &mut change);
        s.adhesives.sweep(&s.start, &mut s.moved, share, &mut change);
        let mut held = s.held.iter().peekable();
        for_each_part(model, contact, (&s.volumes, &s.gradient, &mut s.moved), |number, first, part| {
            let before = vectors(&model.kinds[number], &mut state.kinds[number].positions);
            while let Some((atom, axis)) = held.next_if(|(atom, _)| (*atom as usize) < first + part.moved.len()) {
                let (atom, axis) = (*atom as usize - first, *axis as usize);
                part.moved[atom][axis] = before[atom][axis];
            }
            sweep_volumes(part.volumes, part.gradient, part.moved, &mut change);
        });
        s.sweeps = number;
        // A change that is not a number is no rest either.
        if change.largest <= contact.tolerance * s.care || number == contact.most_sweeps {
            break;
        }
        share = s.momentum.share(change.work);
        for_each_part(model, contact, (&s.volumes, &s.gradient, &mut s.moved), |number, first, part| {
            let before = vectors(&model.kinds[number], &mut state.kinds[number].positions);
            let way = &mut way[first..first + part.moved.len()];
            go_on(share, part.moved, before, way);
        });
    }
    *(if keeps_start { &mut s.way } else { &mut s.start }) = way;
    change
}

/// Pushes out what is inside.
fn mend(model: &Model, contact: &ContactModel, s: &mut ContactScratch) {
    let is_deep = |(_, row): &(u32, &Row)| row.give > 0.0 && row.gap() < 0.0;
    s.deep.clear();
    s.deep.extend((0..).zip(&s.rows).filter(is_deep).map(|(number, _)| (number, 0.0)));
    for _ in 0..MENDING {
        sweep_depths(&s.rows, &mut s.deep, &mut s.moved, MENDED * contact.scene.safe_travel());
        s.adhesives.place_all(&s.start, &mut s.moved);
        for_each_part(model, contact, (&s.volumes, &s.gradient, &mut s.moved), |_, _, part| {
            sweep_volumes(part.volumes, part.gradient, part.moved, &mut Change::default());
        });
    }
}

/// The farthest that an atom moved in the step over what contacts allow; 0 without contacts.
pub fn travel(model: &Model, state: &State, ws: &Workspace) -> f64 {
    let Some(contact) = &model.contact else { return 0.0 };
    let mut farthest: f64 = 0.0;
    for ((kind, now), w) in model.kinds.iter().zip(&state.kinds).zip(&ws.kinds) {
        // Lanes beyond the last cell may go elsewhere.
        for cell in 0..kind.cells {
            let place = |x: &[f64], atom: usize| vector(kind, x, cell, atom);
            let ways = (0..kind.atoms()).map(|atom| place(&now.positions, atom) - place(&w.start, atom));
            farthest = ways.map(|way| way.norm_squared()).fold(farthest, f64::max);
        }
    }
    farthest.sqrt() / contact.scene.safe_travel()
}
