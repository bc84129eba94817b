//! The projection: atoms are moved so that contacts and volumes hold.

use rayon::prelude::*;

use super::change::Change;
use super::gather::scatter;
use super::mobility::Mobility;
use super::momentum::{begin, go_on, go_on_by_modes};
use super::prepare::{arrange_rows, load_rows, prepare};
use super::respond::find_columns;
use super::rounds::{Crew, with_crew};
use super::rows::Row;
use super::scene::ContactScene;
use super::scratch::{ContactScratch, SweepRules};
use super::sweep::{sweep_contacts, sweep_depths};
use super::vectors::V4;
use super::volumes::{InModes, VolumeRow, sweep_volumes};
use crate::Vec3;
use crate::contact::{Itself, Stride, Travel};
use crate::sim::kind::VolumeRule;
use crate::sim::model::Model;
use crate::sim::state::{KindState, State, vector};
use crate::sim::trouble::Trouble;
use crate::sim::workspace::Workspace;

/// Sweeps that mend depths. They need not come to rest: what is left is mended in the next step.
const MENDING: usize = 8;

/// Atoms from which on threads share the sweeps, if not by their rows: over fewer a sweep takes some microseconds, in which nobody wakes up.
const WORTH_A_CREW: usize = 4096;

/// Cells that a thread looks at at once, at least.
const CELLS_PER_JOB: usize = 64;

/// What a step mends of a depth at most, over the travel that is safe.
const MENDED: f64 = 0.25;

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
    arrange_rows(contact, s);
    find_columns(model, contact, dt, (from, to), s, kinds, buffers);
    load_rows(contact, rules, s);
    let mut left = Change::default();
    let is_deep = rules.mends && s.rows.iter().any(|row| row.gap() < 0.0);
    s.deep.clear();
    let is_worth_it = contact.scene.atoms >= WORTH_A_CREW || s.mobility.turns.jobs() > 1;
    with_crew(is_worth_it, |crew| {
        left = sweep(model, contact, dt, rules, s, crew);
        if is_deep {
            mend(model, contact, s, crew);
        }
    });
    s.law.adhesives.align(&s.start, &mut s.moved);
    put_back(model, contact, s, from, to);
    note_rows(contact, s);
    let worst = s.rows[left.worst].atoms;
    if s.mobility.is_arranged {
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

/// Volumes that are kept, and what their gradients are in modes, where cells move by them.
type Volumes<'a> = (&'a [VolumeRow], &'a [InModes]);

/// What the sweeps need of a kind.
struct Part<'a> {
    volumes: Volumes<'a>,
    /// Gradients of the volumes, µm².
    gradient: &'a [[f64; 3]],
    moved: &'a mut [V4],
    mobility: &'a mut Mobility,
}

/// Does something for each kind, in their order, with what is there of it.
fn for_each_part(
    model: &Model,
    contact: &ContactScene,
    ((volumes, modes), gradient, moved, mobility): (Volumes, &[[f64; 3]], &mut [V4], &mut Mobility),
    mut work: impl FnMut(Part),
) {
    let mut next = 0;
    for (number, kind) in model.kinds.iter().enumerate() {
        let range = contact.atoms_of(number);
        let count = if matches!(kind.volume, VolumeRule::Exact(_)) { range.len() / kind.atoms() } else { 0 };
        let volumes = (&volumes[next..next + count], modes.get(next..next + count).unwrap_or_default());
        work(Part { volumes, gradient: &gradient[range.clone()], moved: &mut moved[range], mobility });
        next += count;
    }
}

/// Sweeps until nothing moves any more; returns what the last sweep changed.
fn sweep(
    model: &Model,
    contact: &ContactScene,
    dt: f64,
    rules: SweepRules,
    s: &mut ContactScratch,
    crew: Crew,
) -> Change {
    let keeps_start = contact.law.needs_start();
    let mut before = std::mem::take(if keeps_start { &mut s.before } else { &mut s.start });
    let mut direction = std::mem::take(&mut s.forces.carried);
    begin(&s.moved, &mut before, &mut direction);
    s.momentum.begin();
    let (mut change, mut share) = (Change::default(), 0.0);
    for number in 1..=contact.most_sweeps {
        change = Change::default();
        sweep_contacts(&s.rows, &mut s.pulls, &mut s.moved, &mut s.mobility, (dt, share), &mut change, crew);
        s.law.adhesives.sweep(&s.start, &mut s.moved, share, &mut change);
        for &(atom, axis) in &s.held {
            s.moved[atom as usize][axis as usize] = before[atom as usize][axis as usize];
        }
        for_each_part(
            model,
            contact,
            ((&s.volumes, &s.volume_modes), &s.gradient, &mut s.moved, &mut s.mobility),
            |part| {
                sweep_volumes(part.volumes, part.gradient, part.moved, part.mobility, &mut change, crew);
            },
        );
        s.sweeps = number;
        // A change that is not a number is no rest either.
        if change.largest <= contact.tolerance * rules.tolerance_factor || number == contact.most_sweeps {
            break;
        }
        share = s.momentum.share(change.work);
        go_on(share, &mut s.moved, &mut before, &mut direction, crew);
        if s.mobility.has_modes {
            go_on_by_modes(share, &mut s.mobility, crew);
        }
    }
    s.forces.carried = direction;
    *(if keeps_start { &mut s.before } else { &mut s.start }) = before;
    change
}

/// Pushes out what is inside.
fn mend(model: &Model, contact: &ContactScene, s: &mut ContactScratch, crew: Crew) {
    let is_deep = |(_, row): &(u32, &Row)| row.compliance > 0.0 && row.gap() < 0.0;
    s.deep.clear();
    s.deep.extend((0..).zip(&s.rows).filter(is_deep).map(|(number, _)| (number, 0.0)));
    for _ in 0..MENDING {
        let most = MENDED * contact.reach.safe_travel();
        sweep_depths(&s.rows, &mut s.deep, &mut s.moved, &mut s.mobility, most, crew);
        s.law.adhesives.align(&s.start, &mut s.moved);
        for_each_part(
            model,
            contact,
            ((&s.volumes, &s.volume_modes), &s.gradient, &mut s.moved, &mut s.mobility),
            |part| {
                let unheeded = &mut Change::default();
                sweep_volumes(part.volumes, part.gradient, part.moved, part.mobility, unheeded, crew);
            },
        );
    }
}

/// Notes what rows do, and what pushed out what was inside.
fn note_rows(contact: &ContactScene, s: &mut ContactScratch) {
    let Some(noted) = s.tractions.counting(1.0) else { return };
    s.rows.iter().zip(&s.pulls).for_each(|(row, pull)| noted.by_row(&contact.scene, row, pull.force()));
    for (number, pushed) in &s.deep {
        let row = &s.rows[*number as usize];
        noted.by_row(&contact.scene, row, *pushed * row.normal());
    }
}

/// How far bodies moved in the step beside those that they may meet, over what contacts allow, eq. (contacts.6); 0 without contacts.
pub fn travel(model: &Model, from: &State, to: &State, ws: &mut Workspace) -> Travel {
    let s = &mut ws.contact;
    let Some(contact) = &s.scene(model, &from.kinds) else { return Travel::default() };
    let scene = &contact.scene;
    s.strides.resize(scene.bodies.len(), Stride::NONE);
    let mut rest = &mut s.strides[..];
    for ((kind, now), next) in model.kinds.iter().zip(&from.kinds).zip(&to.kinds) {
        let (own, others) = rest.split_at_mut(now.cells());
        rest = others;
        let itself = match (&kind.rigid, kind.closed) {
            (Some(_), _) => Itself::Never,
            (None, true) => Itself::Closed(&kind.rest.facets),
            (None, false) => Itself::Anywhere,
        };
        own.par_iter_mut().with_min_len(CELLS_PER_JOB).enumerate().for_each(|(cell, stride)| {
            let position = |x: &[f64], atom: usize| vector(kind, x, cell, atom);
            let ends = [&now.positions, &next.positions].map(|x| move |atom| position(x, atom));
            let [start, end] = ends;
            *stride = Stride::of(scene, (kind.atoms(), itself), start, end);
        });
    }
    s.detector.travel(scene, &s.strides)
}
