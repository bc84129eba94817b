//! The turnover of the bonds of surfaces in an attempt of a step: what loads them, and what the step misses of it.

use super::assemble::SHARE;
use super::gather::gather_positions;
use super::laws::{Faced, Facing, number_of};
use super::rows::{Pairing, Pull, Row};
use super::rub::rubs;
use super::scene::ContactScene;
use super::scratch::ContactScratch;
use crate::Vec3;
use crate::mechanics::integrator::Method;
use crate::sim::controls::Controls;
use crate::sim::kind::Kind;
use crate::sim::model::Model;
use crate::sim::state::State;
use crate::sim::workspace::Workspace;

/// Lets the bonds of surfaces close and open over an attempt of a step, eq. (adhesion.25), in whose forces they are as they were where it
/// begins. Returns what atoms miss by that, over the mean edge, eq. (adhesion.26).
pub fn turn_over_bonds(model: &Model, dt: f64, from: &State, to: &State, ws: &mut Workspace) -> f64 {
    let s = &mut ws.contact;
    let Some(contact) = &s.scene(model, &from.kinds) else { return 0.0 };
    let Some(table) = contact.law.cohesion().filter(|table| table.has_bonds()) else { return 0.0 };
    let mut shear = std::mem::take(&mut s.shear);
    find_shear(contact, &from.chemistry.controls, s, &mut shear);
    gather_positions(model, contact, &to.kinds, &mut s.positions);
    let change = s.law.cohesion.turn_over(table, (&contact.scene, &s.positions), (dt, &shear));
    s.shear = shear;
    let error_of = |(number, kind): (usize, &Kind)| {
        let free = match model.integrator.method {
            Method::Implicit { .. } | Method::Explicit => dt / kind.drag,
            _ => dt * dt / kind.mass,
        };
        let moves = |(number, change): (usize, &Vec3)| {
            let held = kind.held.get(3 * (number % kind.atoms())..).unwrap_or_default();
            Vec3::from_fn(|axis, _| held.get(axis).unwrap_or(&1.0) * change[axis]).norm()
        };
        let largest = change[contact.atoms_of(number)].iter().enumerate().map(moves).fold(0.0, f64::max);
        // The change grows from nothing to this in the step.
        0.5 * largest * free / kind.edge
    };
    model.kinds.iter().enumerate().map(error_of).fold(0.0, f64::max)
}

/// Finds what each bond bears along the surface where the attempt ends, pN, around each atom and what it faces, eq. (adhesion.23).
fn find_shear(contact: &ContactScene, controls: &Controls, s: &ContactScratch, shear: &mut Vec<f64>) {
    let facing = &s.law.cohesion.facing;
    shear.clear();
    shear.resize(facing.len(), 0.0);
    if facing.is_empty() {
        return;
    }
    let of_row = |number: usize| {
        let at = s.row_of(number);
        (&s.rows[at], &s.pulls[at])
    };
    let mut add = |(row, pull): (&Row, &Pull), other: Faced| {
        if let Some(at) = number_of(facing, row.atoms[0], other) {
            shear[at] += across(row, pull);
        }
    };
    let on = |row: &Row| Faced::Body(contact.body_of(row.atoms[1]));
    let (of_atoms, of_edges) = (s.found.atoms.len(), s.found.atoms.len() + s.found.edges.len());
    for number in 0..of_atoms {
        let (row, pull) = of_row(number);
        add((row, pull), on(row));
    }
    for (number, near) in (of_edges..).zip(&s.found.obstacles) {
        add(of_row(number), Faced::Obstacle(near.obstacle));
    }
    // Rows of what rubs without touching stand after those of contacts, in the order of what faces something.
    let mut rubbing = facing.iter().filter(|this| rubs(contact, &s.found, this) > 0.0);
    for number in of_edges + s.found.obstacles.len()..s.rows.len() {
        let (row, pull) = of_row(number);
        let is_of = |this: &&Facing| match row.pairing {
            Pairing::AtomOnObstacle => this.atom == row.atoms[0] && matches!(this.other, Faced::Obstacle(_)),
            _ => this.atom == row.atoms[0] && this.other == on(row),
        };
        if let Some(this) = rubbing.find(is_of) {
            add((row, pull), this.other);
        }
    }
    for (shear, this) in shear.iter_mut().zip(facing) {
        let bonds = bonds_around(contact, controls, this);
        *shear = if bonds > 0.0 { *shear / bonds } else { 0.0 };
    }
}

/// How large the part of the force of a contact along the surface is, pN.
fn across(row: &Row, pull: &Pull) -> f64 {
    let (force, normal) = (pull.force(), row.normal());
    (force - force.dot(&normal) * normal).norm()
}

/// How many bonds are closed around an atom to what it faces; 0 where surfaces have none.
fn bonds_around(contact: &ContactScene, controls: &Controls, this: &Facing) -> f64 {
    let body = contact.body_of(this.atom);
    let density =
        contact.cohesion_of(body, this.other).and_then(|cohesive| cohesive.bonds).map_or(0.0, |it| it.density);
    let of_other = match this.other {
        Faced::Body(other) => SHARE * controls.adhesion_of(other as usize),
        Faced::Obstacle(_) => 1.0,
    };
    density * this.area * controls.adhesion_of(body as usize) * controls.adhesion_of_atom(this.atom) * of_other
}
