//! A number that models differ in which do not lead a state along the same course.

use std::fmt::{Debug, Write};

use crate::elementary::{FNV_START, fnv1a};
use crate::sim::contact::ContactModel;
use crate::sim::{Chemistry, Kind, Model};

/// FNV-1a in 64 bits over whatever is written to it.
struct Fnv(u64);

impl Fnv {
    fn bytes(&mut self, bytes: &[u8]) {
        self.0 = fnv1a(self.0, bytes.iter().copied());
    }

    /// Takes in a value as `Debug` writes it, which tells numbers of all bits apart. 0xff, which never occurs in UTF-8, parts
    /// it from the next.
    fn value(&mut self, value: &dyn Debug) {
        // Nothing here can fail.
        let _ = write!(self, "{value:?}");
        self.bytes(&[0xff]);
    }
}

impl Write for Fnv {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.bytes(text.as_bytes());
        Ok(())
    }
}

/// The fingerprint of a model: of all that decides the course of a state, and of nothing that follows from the rest.
pub fn fingerprint(model: &Model) -> u64 {
    let Model {
        seed,
        kinds,
        obstacles,
        contact,
        chemistry,
        integrator,
        until,
        rest,
        kinks: _,
        changes,
        keeps_tractions,
    } = model;
    let mut hash = Fnv(FNV_START);
    hash.value(&(seed, integrator, until, rest, obstacles, changes, keeps_tractions));
    kinds.iter().for_each(|kind| add_kind(&mut hash, kind));
    if let Some(contact) = contact {
        add_contact(&mut hash, contact);
    }
    add_chemistry(&mut hash, chemistry);
    hash.0
}

fn add_kind(hash: &mut Fnv, kind: &Kind) {
    hash.value(&(&kind.name, kind.lanes, &kind.rest.positions, &kind.rest.facets));
    // Surfaces have the fingerprint that they had before there were bodies.
    if !kind.tetrahedra.is_empty() {
        hash.value(&kind.tetrahedra);
    }
    hash.value(&kind.forces);
    hash.value(&(kind.drag, kind.mass, &kind.held, &kind.moved, &kind.rigid, &kind.volume));
    kind.behaviours.iter().for_each(|behaviour| hash.value(behaviour));
    hash.value(&(kind.fibre_budget, kind.fibre_limit, &kind.viscosity));
}

fn add_contact(hash: &mut Fnv, contact: &ContactModel) {
    let ContactModel { reach, law, between, on_obstacles, tolerance, most_sweeps, .. } = contact;
    hash.value(&(reach, law, between, on_obstacles, tolerance, most_sweeps));
}

fn add_chemistry(hash: &mut Fnv, chemistry: &Chemistry) {
    for reactor in &chemistry.reactors {
        hash.value(&(&reactor.name, &reactor.program, &reactor.events, &reactor.members));
        hash.value(&(reactor.seconds, reactor.method, reactor.tolerances, reactor.exchange));
        hash.value(&(&reactor.noise, &reactor.starts, reactor.pace));
        if let Some(membrane) = &reactor.membrane {
            hash.value(&membrane.system);
        }
    }
    for field in &chemistry.fields {
        hash.value(&(&field.name, field.system.equations(), field.system.grid(), field.system.species()));
        hash.value(&(field.system.inputs(), field.stepping, &field.constants));
        hash.value(&(field.system.noise(), field.pace));
        if let Some(beside) = field.system.beside() {
            hash.value(beside);
        }
        if let Some(transport) = field.system.transport() {
            hash.value(&transport);
        }
    }
    chemistry.links.iter().for_each(|link| hash.value(link));
}
