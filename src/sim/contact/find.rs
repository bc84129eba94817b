//! What touches where a step begins, and what it carried in the step before.

use super::assemble::write_rows;
use super::compliance::stored_after;
use super::gather::gather_positions;
use super::laws::Touching;
use super::remember::find_at;
use super::rows::{Pull, Row};
use super::rub::write_rubbing;
use super::scene::ContactScene;
use super::scratch::{ContactForces, ContactScratch, empty_for};
use super::spread::{add_spreading, releases_energy};
use super::state::{AtomBond, ContactState, EdgeBond, PlaneBond};
use crate::Vec3;
use crate::contact::{AtomContact, Contacts, PlaneContact};
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
    let facing = &s.law.cohesion.facing;
    let controls = &state.chemistry.controls;
    write_rows(contact, &s.found, &state.contact, controls, facing, &mut s.rows, &mut s.pulls);
    write_rubbing(contact, &s.found, controls, facing, &s.start, &mut s.rows, &mut s.pulls);
    if model.integrator.method.is_inertial() || !contact.law.projects() {
        s.pulls.fill(Pull::default());
    }
    s.law.adhesives.take_over(&mut s.rows, &mut s.pulls, &s.start);
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
    let carried = &mut s.forces.carried;
    carried.clear();
    carried.resize(contact.scene.atoms, Vec3::zeros());
    add_spreading(contact, &s.found, &state.chemistry.controls, &s.start, &mut s.relief, carried);
    for (row, pull) in s.rows.iter().zip(&s.pulls) {
        for (atom, weight) in row.atoms.iter().zip(row.weights()) {
            carried[*atom as usize] += weight * pull.carried();
        }
    }
    for one in &s.law.adhesives.atoms {
        carried[one.atom as usize] += Vec3::from(one.force);
    }
}

/// Whether contacts act with forces that change while a step is made.
pub fn has_live_forces(model: &Model) -> bool {
    model.contact.as_ref().is_some_and(|contact| contact.law.has_forces())
}

/// Sets the forces that the law of contact adds where the atoms are now: they change while a step is made, and its error estimate
/// must see that.
pub fn pull_contacts(model: &Model, controls: &Controls, cells: &[KindState], s: &mut ContactScratch) {
    let Some(contact) = &s.scene(model, cells).filter(|_| has_live_forces(model)) else { return };
    gather_positions(model, contact, cells, &mut s.positions);
    let live = &mut s.forces.live;
    live.clear();
    live.resize(contact.scene.atoms, Vec3::zeros());
    contact.law.add_forces(&contact.scene, controls, (&s.rows, &s.law), (&s.start, &s.positions), live);
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
    write_bonds(&s.found, &s.rows, &s.pulls, to);
    contact.law.keep(&contact.scene, controls, &s.found, &s.moved, &mut s.law, to);
}

/// Writes what contacts carry. The contacts must be those of the rows.
fn write_bonds(found: &Contacts, rows: &[Row], pulls: &[Pull], bonds: &mut ContactState) {
    let ContactState { atoms, edges, planes, .. } = bonds;
    let (of_atoms, others) = pulls.split_at(found.atoms.len());
    let (of_edges, others) = others.split_at(found.edges.len());
    // What rubs without touching is found anew in each step.
    let of_planes = &others[..found.planes.len()];
    empty_for(atoms, found.atoms.len());
    for ((pull, row), contact) in of_atoms.iter().zip(rows).zip(&found.atoms) {
        let &AtomContact { atom, facet, facing, .. } = contact;
        atoms.push(AtomBond { atom, facet, facing, force: pull.force, stored: stored_after(row, pull) });
    }
    // Edges are remembered for their force alone.
    let loaded = || of_edges.iter().zip(&found.edges).filter(|(pull, _)| pull.force != [0.0; 3]);
    empty_for(edges, loaded().count());
    for (pull, contact) in loaded() {
        edges.push(EdgeBond { edges: contact.edges, normal: contact.normal.0, force: pull.force });
    }
    empty_for(planes, found.planes.len());
    let rows = &rows[found.atoms.len() + found.edges.len()..];
    for ((pull, row), contact) in of_planes.iter().zip(rows).zip(&found.planes) {
        let &PlaneContact { atom, plane, .. } = contact;
        planes.push(PlaneBond { atom, plane, force: pull.force, stored: stored_after(row, pull) });
    }
}
