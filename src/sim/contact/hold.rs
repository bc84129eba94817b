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
use crate::sim::state::{State, index};
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
    let left = sweep(model, contact, s, kinds);
    if s.care == 1.0 && s.rows.iter().any(|row| row.gap() < 0.0) {
        mend(model, contact, s, kinds);
    }
    s.adhesives.place_all(&s.start, &mut s.moved);
    put_back(model, contact, s, state);
    if left.largest <= contact.tolerance {
        return Ok(());
    }
    let owners = s.rows[left.worst].atoms.map(|atom| contact.owner(atom));
    let cells = [owners[0], owners[3]].map(|(kind, cell)| (model.kinds[kind].name.clone(), cell));
    Err(Trouble::Contact { cells, time: state.time + dt, left: left.largest, sweeps: s.sweeps })
}

/// Puts the atoms where their displacements take them.
pub(super) fn put_back(model: &Model, contact: &ContactModel, s: &ContactScratch, state: &mut State) {
    for (number, (kind, now)) in model.kinds.iter().zip(&mut state.kinds).enumerate() {
        let first = contact.atoms_of(number).start;
        let place = |atom: usize| {
            let [x, y, z, _] = s.moved[first + atom];
            s.start[first + atom] + Vec3::new(x, y, z)
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
    s.volumes.clear();
    s.held.clear();
    for (number, ((kind, now), w)) in model.kinds.iter().zip(&state.kinds).zip(kinds).enumerate() {
        let range = contact.atoms_of(number);
        let mobility = match model.integrator.method {
            Method::Implicit { .. } | Method::Explicit => dt / kind.drag,
            _ => dt * dt / kind.mass,
        };
        gather(kind, &now.positions, &mut s.moved[range.clone()], |x| [x.x, x.y, x.z, mobility]);
        for (d, start) in s.moved[range.clone()].iter_mut().zip(&s.start[range.clone()]) {
            (0..3).for_each(|axis| d[axis] -= start[axis]);
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
    let KindScratch { gradient, left, target, .. } = w;
    let own = vectors(kind, gradient);
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

/// The start of an array of a kind that the free step has done with, as one vector for each of its atoms.
fn vectors<'a>(kind: &Kind, array: &'a mut [f64]) -> &'a mut [[f64; 3]] {
    &mut array.as_chunks_mut().0[..kind.cells * kind.atoms()]
}

/// What the sweeps need of a kind; the vectors stand in arrays that the free step has done with.
struct Part<'a> {
    volumes: &'a [VolumeRow],
    /// Gradients of the volumes, µm².
    gradient: &'a [[f64; 3]],
    moved: &'a mut [V4],
    /// Displacements before the sweep, µm.
    before: &'a mut [[f64; 3]],
    /// The last direction, µm.
    way: &'a mut [[f64; 3]],
}

/// Does something for each kind, in their order, with the number of its first atom.
fn for_each_part(
    model: &Model,
    contact: &ContactModel,
    (volumes, moved): (&[VolumeRow], &mut [V4]),
    kinds: &mut [KindScratch],
    mut work: impl FnMut(usize, Part),
) {
    let mut next = 0;
    for (number, (kind, w)) in model.kinds.iter().zip(kinds).enumerate() {
        let count = if matches!(kind.volume, VolumeRule::Exact(_)) { kind.cells } else { 0 };
        let range = contact.atoms_of(number);
        let part = Part {
            volumes: &volumes[next..next + count],
            gradient: vectors(kind, &mut w.gradient),
            moved: &mut moved[range.clone()],
            before: vectors(kind, &mut w.first),
            way: vectors(kind, &mut w.swell),
        };
        work(range.start, part);
        next += count;
    }
}

/// Sweeps until nothing moves any more; returns what the last sweep changed.
fn sweep(model: &Model, contact: &ContactModel, s: &mut ContactScratch, kinds: &mut [KindScratch]) -> Change {
    for_each_part(model, contact, (&s.volumes, &mut s.moved), kinds, |_, part| {
        part.before.iter_mut().zip(part.moved).for_each(|(before, &mut [x, y, z, _])| *before = [x, y, z]);
        part.way.fill([0.0; 3]);
    });
    s.momentum.begin();
    let (mut change, mut share) = (Change::default(), 0.0);
    for number in 1..=contact.most_sweeps {
        change = Change::default();
        sweep_contacts(&s.rows, &mut s.pulls, &mut s.moved, share, &mut change);
        s.adhesives.sweep(&s.start, &mut s.moved, share, &mut change);
        let mut held = s.held.iter().peekable();
        for_each_part(model, contact, (&s.volumes, &mut s.moved), kinds, |first, part| {
            while let Some((atom, axis)) = held.next_if(|(atom, _)| (*atom as usize) < first + part.moved.len()) {
                let (atom, axis) = (*atom as usize - first, *axis as usize);
                part.moved[atom][axis] = part.before[atom][axis];
            }
            sweep_volumes(part.volumes, part.gradient, part.moved, &mut change);
        });
        s.sweeps = number;
        // A change that is not a number is no rest either.
        if change.largest <= contact.tolerance * s.care || number == contact.most_sweeps {
            break;
        }
        share = s.momentum.share(change.work);
        for_each_part(model, contact, (&s.volumes, &mut s.moved), kinds, |_, part| {
            go_on(share, part.moved, part.before, part.way);
        });
    }
    change
}

/// Pushes out what is inside.
fn mend(model: &Model, contact: &ContactModel, s: &mut ContactScratch, kinds: &mut [KindScratch]) {
    let is_deep = |(_, row): &(u32, &Row)| row.give > 0.0 && row.gap() < 0.0;
    s.deep.clear();
    s.deep.extend((0..).zip(&s.rows).filter(is_deep).map(|(number, _)| (number, 0.0)));
    for _ in 0..MENDING {
        sweep_depths(&s.rows, &mut s.deep, &mut s.moved, MENDED * contact.scene.safe_travel());
        s.adhesives.place_all(&s.start, &mut s.moved);
        for_each_part(model, contact, (&s.volumes, &mut s.moved), kinds, |_, part| {
            sweep_volumes(part.volumes, part.gradient, part.moved, &mut Change::default());
        });
    }
}

/// The farthest that an atom moved in the step over what contacts allow; 0 without contacts.
pub fn travel(model: &Model, state: &State, ws: &Workspace) -> f64 {
    let Some(contact) = &model.contact else { return 0.0 };
    let mut farthest: f64 = 0.0;
    for (number, (kind, now)) in model.kinds.iter().zip(&state.kinds).enumerate() {
        for (cell, start) in ws.contact.start[contact.atoms_of(number)].chunks_exact(kind.atoms()).enumerate() {
            let first = index(kind, cell, 0, 0);
            for (atom, start) in start.iter().enumerate() {
                let at = first + 3 * atom * kind.lanes;
                let x = [0, 1, 2].map(|axis| now.positions[at + axis * kind.lanes]);
                farthest = farthest.max((Vec3::from(x) - start).norm_squared());
            }
        }
    }
    farthest.sqrt() / contact.scene.safe_travel()
}
