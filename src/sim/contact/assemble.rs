//! Writes the rows of the system that the sweeps solve.

use std::ops::Range;

use rayon::prelude::*;

use super::inherit::Inherited;
use super::laws::{Faced, Facing, Strength, area_between};
use super::rows::{Pairing, Pull, Row};
use super::scene::ContactScene;
use super::scratch::resize_for;
use super::state::ContactState;
use super::together::Together;
use crate::Vec3;
use crate::contact::{AtomContact, Contacts, Normal, Scene};
use crate::sim::controls::Controls;

/// Both sides of an interface have atoms that touch the other: each carries half of its strength.
pub(super) const SHARE: f64 = 0.5;

/// How thick a surface with two outsides is on each side, over the prediction. What rests on it stays farther off than sweeps leave
/// unresolved, so that its side and, over ridges and in grooves, its normals are told by more than noise.
const SKIN: f64 = 0.05;

/// Contacts whose rows a thread writes at once.
const CONTACTS_PER_JOB: usize = 512;

/// What rows are written from.
#[derive(Clone, Copy)]
pub struct Written<'a> {
    /// Surfaces and their strengths.
    pub model: &'a ContactScene<'a>,
    /// What touches.
    pub found: &'a Contacts,
    /// What it carried in the last step.
    pub before: &'a ContactState,
    /// Factors of the strengths of cells.
    pub controls: &'a Controls,
    /// The areas of contact around atoms; where surfaces do not attract each other that at rest is taken.
    pub facing: &'a [Facing],
    /// What contacts of edges have taken over from others.
    pub inherited: &'a Inherited,
}

/// A row, and the force that it carried in the last step, pN.
type Known = (Row, [f32; 3]);

/// Writes the rows of all contacts, with the forces that they carried in the last step as far as they can bear them: atoms on facets, then
/// edges on edges, then atoms on obstacles. `index` is where a row goes by its number in this order.
pub fn write_rows(from: Written, index: impl Fn(usize) -> usize + Sync, rows: &mut Vec<Row>, pulls: &mut Vec<Pull>) {
    let found = from.found;
    let (of_atoms, of_edges) = (found.atoms.len(), found.edges.len());
    let count = of_atoms + of_edges + found.obstacles.len();
    resize_for(rows, count, Row::NOTHING);
    resize_for(pulls, count, Pull::default());
    let (rows, pulls) = (Together::new(rows), Together::new(pulls));
    let put = |number: usize, (row, force): Known| {
        let force = row.bound(Vec3::from(force.map(f64::from)));
        let force = [force.x as f32, force.y as f32, force.z as f32];
        let at = index(number);
        // SAFETY: each number has an index of its own, and is put once.
        unsafe {
            *rows.item(at) = row;
            *pulls.item(at) = Pull { force, carried: force, ..Pull::default() };
        }
    };
    let jobs = |count: usize| (0..count.div_ceil(CONTACTS_PER_JOB)).into_par_iter();
    let part = |job: usize, count: usize| job * CONTACTS_PER_JOB..count.min((job + 1) * CONTACTS_PER_JOB);
    jobs(of_atoms).for_each(|job| from.atoms(part(job, of_atoms), &put));
    jobs(of_edges).for_each(|job| from.edges(part(job, of_edges), &|edge, known| put(of_atoms + edge, known)));
    let of_obstacles = found.obstacles.len();
    let put = |obstacle: usize, known: Known| put(of_atoms + of_edges + obstacle, known);
    jobs(of_obstacles).for_each(|job| from.obstacles(part(job, of_obstacles), &put));
}

/// A row that has not been swept.
fn row(
    pairing: Pairing,
    atoms: [u32; 4],
    coordinates: [f32; 2],
    Normal([x, y, z]): Normal,
    gap: f64,
    [least, shear, friction]: [f64; 3],
    stored: f32,
) -> Row {
    let normal_and_gap = [x, y, z, gap as f32];
    let (least, shear, friction) = (least as f32, shear as f32, friction as f32);
    Row { atoms, coordinates, normal_and_gap, least, shear, friction, stored, pairing, ..Row::NOTHING }
}

impl Written<'_> {
    /// Tells the rows of some atoms on facets.
    fn atoms(&self, numbers: Range<usize>, put: &impl Fn(usize, Known)) {
        let &Self { model, found, before, controls, facing, .. } = self;
        let scene = &model.scene;
        let skin = SKIN * scene.reach.prediction;
        let begin = found.atoms[numbers.start].atom;
        let mut body = scene.body_of_atom(begin) as usize;
        let mut first = before.atoms.partition_point(|bond| bond.atom < begin);
        for number in numbers {
            let contact = &found.atoms[number];
            while scene.bodies.get(body + 1).is_some_and(|next| next.first_atom <= contact.atom) {
                body += 1;
            }
            while before.atoms.get(first).is_some_and(|bond| bond.atom < contact.atom) {
                first += 1;
            }
            // The same facet, or else another of the same body: the atom has slid.
            let of_atom = || before.atoms[first..].iter().take_while(|bond| bond.atom == contact.atom);
            let same = of_atom().find(|bond| bond.facet == contact.facet);
            let is_free = |facet: u32| {
                let near = found.atoms.partition_point(|other| (other.atom, other.facet) < (contact.atom, facet));
                found.atoms.get(near).is_none_or(|other| (other.atom, other.facet) != (contact.atom, facet))
            };
            let on = contact.body(scene);
            let slid = || of_atom().find(|bond| bond.body(scene) == on && is_free(bond.facet));
            let (force, stored) = same.or_else(slid).map_or(([0.0; 3], 0.0), |bond| (bond.force, bond.stored));
            let [i, j, k] = scene.facet_atoms(on, contact.facet);
            let other = on as usize;
            let own = other == body;
            let strength = if own { Strength::default() } else { model.strength_between(body, other) };
            let kind = model.kind_of(body as u32);
            let cohesive = if own { None } else { model.cohesion_of(body as u32, Faced::Body(on)) };
            let area = match cohesive {
                _ if !scene.reach.touches(contact.gap) => 0.0,
                Some(_) => area_between(facing, contact.atom, Faced::Body(on)),
                None => model.areas[kind][(contact.atom - scene.bodies[body].first_atom) as usize],
            };
            let area = SHARE * area / touching_on_body(scene, found, number).max(1) as f64;
            let area = area * controls.adhesion_of(body) * controls.adhesion_of(other);
            let [v, w] = contact.second_weights.map(f64::from);
            let area = area
                * controls.adhesion_of_atom(contact.atom)
                * controls.adhesion_between([i, j, k], [1.0 - v - w, v, w]);
            let row = row(
                Pairing::AtomOnFacet,
                [contact.atom, i, j, k],
                contact.second_weights,
                contact.normal,
                contact.gap - if own || model.is_thin(on) { skin } else { 0.0 },
                [-strength.tensile * area, strength.shear * area, cohesive.map_or(0.0, |it| it.friction * area)],
                stored,
            );
            put(number, (row, force));
        }
    }

    /// Tells the rows of some edges on edges.
    fn edges(&self, numbers: Range<usize>, put: &impl Fn(usize, Known)) {
        let &Self { model, found, before, inherited, .. } = self;
        let scene = &model.scene;
        let skin = SKIN * scene.reach.prediction;
        let begin = found.edges[numbers.start].edges;
        let mut first = before.edges.partition_point(|bond| bond.edges < begin);
        for number in numbers {
            let contact = &found.edges[number];
            while before.edges.get(first).is_some_and(|bond| bond.edges < contact.edges) {
                first += 1;
            }
            let same = before.edges.get(first).filter(|bond| bond.edges == contact.edges);
            let [one, other] = contact.bodies(scene);
            let [a, b] = scene.edge_atoms(one, contact.edges[0]);
            let [c, d] = scene.edge_atoms(other, contact.edges[1]);
            let is_thin = one == other || model.is_thin(one) || model.is_thin(other);
            let row = row(
                Pairing::Edges,
                [a, b, c, d],
                contact.along,
                contact.normal,
                contact.gap - if is_thin { skin } else { 0.0 },
                [0.0; 3],
                0.0,
            );
            put(number, (row, same.map_or_else(|| inherited.of(number), |bond| bond.force)));
        }
    }

    /// Tells the rows of some atoms on obstacles.
    fn obstacles(&self, numbers: Range<usize>, put: &impl Fn(usize, Known)) {
        let &Self { model, found, before, controls, facing, .. } = self;
        let scene = &model.scene;
        let key = |number: usize| (found.obstacles[number].atom, found.obstacles[number].obstacle);
        let mut body = scene.body_of_atom(key(numbers.start).0) as usize;
        let mut first = before.obstacles.partition_point(|bond| (bond.atom, bond.obstacle) < key(numbers.start));
        for number in numbers {
            let contact = &found.obstacles[number];
            while scene.bodies.get(body + 1).is_some_and(|next| next.first_atom <= contact.atom) {
                body += 1;
            }
            let key = key(number);
            while before.obstacles.get(first).is_some_and(|bond| (bond.atom, bond.obstacle) < key) {
                first += 1;
            }
            let same = before.obstacles.get(first).filter(|bond| (bond.atom, bond.obstacle) == key);
            let kind = model.kind_of(body as u32);
            let strength = model.strength_on(body, contact.obstacle);
            let cohesive = model.cohesion_of(body as u32, Faced::Obstacle(contact.obstacle));
            let area = match cohesive {
                _ if !scene.reach.touches(contact.gap) => 0.0,
                Some(_) => area_between(facing, contact.atom, Faced::Obstacle(contact.obstacle)),
                None => model.areas[kind][(contact.atom - scene.bodies[body].first_atom) as usize],
            };
            let area = area * controls.adhesion_of(body) * controls.adhesion_of_atom(contact.atom);
            let (force, stored) = same.map_or(([0.0; 3], 0.0), |bond| (bond.force, bond.stored));
            let row = row(
                Pairing::AtomOnObstacle,
                [contact.atom; 4],
                [0.0; 2],
                contact.normal,
                contact.gap,
                [-strength.tensile * area, strength.shear * area, cohesive.map_or(0.0, |it| it.friction * area)],
                stored,
            );
            put(number, (row, force));
        }
    }
}

/// At how many points the atom of a contact touches the body of it: in a groove at two or more, which share what it bears.
fn touching_on_body(scene: &Scene, found: &Contacts, number: usize) -> usize {
    let this = &found.atoms[number];
    let same = |other: &&AtomContact| other.atom == this.atom && other.body(scene) == this.body(scene);
    let touches = |other: &&AtomContact| scene.reach.touches(other.gap);
    let before = found.atoms[..number].iter().rev().take_while(same).filter(touches).count();
    before + found.atoms[number..].iter().take_while(same).filter(touches).count()
}
