//! What touches where a step begins, and what it carried in the step before.

use rayon::prelude::*;

use super::assemble::{Written, write_rows};
use super::compliance::stored_after;
use super::gather::gather_positions;
use super::laws::Touching;
use super::remember::find_at;
use super::rows::Pull;
use super::rub::write_rubbing;
use super::scene::ContactScene;
use super::scratch::{ContactForces, ContactScratch, empty_for, resize_for};
use super::spread::{add_spreading, releases_energy};
use super::state::{AtomBond, ContactState, EdgeBond, ObstacleBond};
use super::turns::Turns;
use crate::Vec3;
use crate::contact::{AtomContact, Contacts, Facing, ObstacleContact};
use crate::sim::controls::Controls;
use crate::sim::kind::Kind;
use crate::sim::model::Model;
use crate::sim::state::{KindState, State};
use crate::sim::workspace::Workspace;

/// Finds the contacts of an instant, and the forces that they carry there.
pub fn find_contacts(model: &Model, state: &State, ws: &mut Workspace) {
    locate_contacts(model, state, ws);
    carry_forces(model, state, ws);
}

/// Finds the contacts of a step. Those that were there before go on carrying what they carried.
pub fn locate_contacts(model: &Model, state: &State, ws: &mut Workspace) {
    let s = &mut ws.contact;
    let Some(contact) = &s.scene(model, &state.kinds) else { return };
    let is_where_it_ended = gather_positions(model, contact, &state.kinds, &mut s.start);
    if !(std::mem::take(&mut s.has_looked) && is_where_it_ended) {
        find_at(contact, &state.contact, &s.start, &mut s.detector, &mut s.found);
    }
    let now =
        Touching { scene: &contact.scene, controls: &state.chemistry.controls, found: &s.found, positions: &s.start };
    contact.law.find(&model.kinds, now, &state.contact, state.time, &mut s.law);
    order_rows(contact, s);
    s.inherited.find(contact, &s.found, &state.contact);
    let facing = &s.law.cohesion.facing;
    let from = Written {
        model: contact,
        found: &s.found,
        before: &state.contact,
        controls: &state.chemistry.controls,
        facing,
        inherited: &s.inherited,
    };
    match s.is_in_turns {
        true => write_rows(from, |row| s.mobility.turns.of_row(row), &mut s.rows, &mut s.pulls),
        false => {
            write_rows(from, |row| row, &mut s.rows, &mut s.pulls);
            write_rubbing(contact, &s.found, &state.chemistry.controls, facing, &s.start, &mut s.rows, &mut s.pulls);
        }
    }
    if model.integrator.method.is_inertial() || !contact.law.projects() {
        s.pulls.fill(Pull::default());
    }
    s.law.adhesives.take_over(&mut s.rows, &mut s.pulls, &s.start);
}

/// Finds the order in which the contacts are swept that were found, where they are so many that threads share them: then their rows stand
/// in it from the begin. Those of few are put in order by the sweeps that need it.
fn order_rows(contact: &ContactScene, s: &mut ContactScratch) {
    let ContactScratch { found: Contacts { atoms, edges, obstacles }, mobility, is_in_turns, .. } = s;
    let (of_atoms, of_edges) = (atoms.len(), atoms.len() + edges.len());
    let count = of_edges + obstacles.len();
    // What rubs without touching has rows after those of contacts.
    let rubs = contact.law.cohesion().is_some_and(|table| table.has_friction());
    *is_in_turns = contact.law.moves_as_steps() && Turns::are_many(count) && !rubs;
    if !*is_in_turns {
        return;
    }
    let scene = &contact.scene;
    let between = |row: usize| match row {
        row if row < of_atoms => [scene.body_of_atom(atoms[row].atom), atoms[row].body(scene)],
        row if row < of_edges => edges[row - of_atoms].bodies(scene),
        row => [scene.body_of_atom(obstacles[row - of_edges].atom); 2],
    };
    mobility.turns.find(count, between, scene.bodies.len());
}

/// Sets the forces that contacts carry where the step begins. The state must be that of which they were found.
pub fn carry_forces(model: &Model, state: &State, ws: &mut Workspace) {
    let s = &mut ws.contact;
    let Some(contact) = &s.scene(model, &state.kinds) else { return };
    let has_looked = std::mem::take(&mut s.has_looked);
    if has_looked || releases_energy(contact) {
        gather_positions(model, contact, &state.kinds, &mut s.start);
    }
    if has_looked {
        // The attempt before was looked at to its end.
        find_at(contact, &state.contact, &s.start, &mut s.detector, &mut s.found);
    }
    let mut carried = std::mem::take(&mut s.forces.carried);
    carried.clear();
    carried.resize(contact.scene.atoms, Vec3::zeros());
    add_spreading(contact, &s.found, &state.chemistry.controls, &s.start, &mut s.relief, &mut carried);
    // In the order in which contacts are found, however they are swept.
    for number in 0..s.rows.len() {
        let at = s.row_of(number);
        let (row, force) = (&s.rows[at], s.pulls[at].carried());
        for (atom, weight) in row.atoms.iter().zip(row.weights()) {
            carried[*atom as usize] += weight * force;
        }
    }
    for one in &s.law.adhesives.atoms {
        carried[one.atom as usize] += Vec3::from(one.force);
    }
    s.forces.carried = carried;
}

/// Whether contacts act with forces that change while a step is made.
pub fn has_live_forces(model: &Model) -> bool {
    model.contact.as_ref().is_some_and(|contact| contact.law.has_forces())
}

/// Sets the forces that the law of contact adds where the atoms are now: they change while a step is made, and its error estimate
/// must see that. What of these cells do to what they touch counts this share of the step; nothing is noted where that is 0.
pub fn pull_contacts(model: &Model, controls: &Controls, cells: &[KindState], s: &mut ContactScratch, share: f64) {
    let Some(contact) = &s.scene(model, cells).filter(|_| has_live_forces(model)) else { return };
    gather_positions(model, contact, cells, &mut s.positions);
    let live = &mut s.forces.live;
    live.clear();
    live.resize(contact.scene.atoms, Vec3::zeros());
    let noted = s.tractions.counting(share);
    contact.law.add_forces(&contact.scene, controls, (&s.rows, &mut s.law), (&s.start, &s.positions), live, noted);
}

/// The energy of the law of contact where cells stand, with what was found where the step began, pN·µm.
pub fn energy_of_law(model: &Model, cells: &[KindState], s: &mut ContactScratch) -> f64 {
    let Some(contact) = &s.scene(model, cells).filter(|_| has_live_forces(model)) else { return 0.0 };
    gather_positions(model, contact, cells, &mut s.positions);
    contact.law.energy(&contact.scene, &s.law, &s.positions)
}

/// Adds the force that contacts carried, and that of the law, to the forces of a block of a kind.
pub fn add_contact_forces(kind: &Kind, cells: &KindState, block: usize, forces: &ContactForces, f: &mut [f64]) {
    let atoms = cells.atoms(kind);
    let Some(carried) = forces.carried.get(atoms.clone()) else { return };
    let pulls = forces.live.get(atoms);
    for lane in 0..kind.lanes {
        let cell = (block * kind.lanes + lane).min(cells.cells() - 1);
        let own = cell * kind.atoms()..(cell + 1) * kind.atoms();
        for (atom, number) in own.enumerate() {
            for axis in 0..3 {
                let pull = pulls.map_or(0.0, |pulls| pulls[number][axis]);
                f[(3 * atom + axis) * kind.lanes + lane] += carried[number][axis] + pull;
            }
        }
    }
}

/// Keeps what contacts carry for the next step, where that was not done to look at the end of this one.
pub fn keep_contacts(model: &Model, from: &State, to: &mut State, ws: &mut Workspace) {
    let s = &mut ws.contact;
    if let Some(contact) = &s.scene(model, &from.kinds).filter(|_| !s.has_looked) {
        write_contacts(contact, &from.chemistry.controls, &mut to.contact, s);
    }
}

/// Writes all that contacts carry from a step to the next.
pub(super) fn write_contacts(
    contact: &ContactScene,
    controls: &Controls,
    to: &mut ContactState,
    s: &mut ContactScratch,
) {
    write_bonds(s, to);
    contact.law.keep(&contact.scene, controls, &s.found, &s.moved, &mut s.law, to);
}

/// Bonds that a thread writes at once, at least.
const BONDS_PER_JOB: usize = 1024;

/// Writes what contacts carry. The contacts must be those of the rows.
fn write_bonds(s: &ContactScratch, bonds: &mut ContactState) {
    let ContactState { atoms, edges, obstacles, .. } = bonds;
    let found = &s.found;
    let known = |number: usize| {
        let at = s.row_of(number);
        (&s.rows[at], &s.pulls[at])
    };
    let nothing = AtomBond { atom: 0, facet: 0, facing: Facing::Any, force: [0.0; 3], stored: 0.0 };
    resize_for(atoms, found.atoms.len(), nothing);
    let of_atoms = atoms.par_iter_mut().zip(&found.atoms).enumerate().with_min_len(BONDS_PER_JOB);
    of_atoms.for_each(|(number, (bond, contact))| {
        let (&AtomContact { atom, facet, facing, .. }, (row, pull)) = (contact, known(number));
        *bond = AtomBond { atom, facet, facing, force: pull.force, stored: stored_after(row, pull) };
    });
    // Edges are remembered for their force alone.
    let of_edges = (found.atoms.len()..).zip(&found.edges).map(|(number, contact)| (known(number).1.force, contact));
    let loaded = || of_edges.clone().filter(|(force, _)| *force != [0.0; 3]);
    empty_for(edges, loaded().count());
    for (force, contact) in loaded() {
        edges.push(EdgeBond { edges: contact.edges, normal: contact.normal.0, force });
    }
    empty_for(obstacles, found.obstacles.len());
    for (number, contact) in (found.atoms.len() + found.edges.len()..).zip(&found.obstacles) {
        let (&ObstacleContact { atom, obstacle, .. }, (row, pull)) = (contact, known(number));
        obstacles.push(ObstacleBond { atom, obstacle, force: pull.force, stored: stored_after(row, pull) });
    }
}
