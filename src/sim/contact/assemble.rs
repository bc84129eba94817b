//! Writes the rows of the system that the sweeps solve.

use super::laws::{Faced, Facing, Strength, area_between};
use super::rows::{Pairing, Pull, Row};
use super::scene::ContactScene;
use super::scratch::empty_for;
use super::state::ContactState;
use crate::Vec3;
use crate::contact::{AtomContact, Contacts, Normal, Scene};
use crate::sim::controls::Controls;

/// Both sides of an interface have atoms that touch the other: each carries half of its strength.
pub(super) const SHARE: f64 = 0.5;

/// How thick a surface with two outsides is on each side, over the proximity. What rests on it stays farther off than sweeps leave
/// unresolved, so that its side and, over ridges and in grooves, its normals are told by more than noise.
const SKIN: f64 = 0.05;

/// Writes the rows of all contacts, with the forces that they carried in the last step as far as they can bear them. `facing` has the
/// areas of contact around atoms; where surfaces do not attract each other that at rest is taken.
pub fn write_rows(
    model: &ContactScene,
    found: &Contacts,
    before: &ContactState,
    controls: &Controls,
    facing: &[Facing],
    rows: &mut Vec<Row>,
    pulls: &mut Vec<Pull>,
) {
    let count = found.atoms.len() + found.edges.len() + found.planes.len();
    empty_for(rows, count);
    empty_for(pulls, count);
    let mut add = |pairing,
                   atoms,
                   coordinates,
                   Normal([x, y, z]),
                   gap: f64,
                   [least, shear, friction]: [f64; 3],
                   (force, stored): ([f32; 3], f32)| {
        let normal_and_gap = [x, y, z, gap as f32];
        let (least, shear) = (least as f32, shear as f32);
        let row = Row {
            atoms,
            coordinates,
            normal_and_gap,
            least,
            shear,
            friction: friction as f32,
            compliance: 0.0,
            across: 0.0,
            kept: 1.0,
            stored,
            pairing,
        };
        let force = row.bound(Vec3::from(force.map(f64::from)));
        let force = [force.x as f32, force.y as f32, force.z as f32];
        rows.push(row);
        pulls.push(Pull { force, carried: force, ..Pull::default() });
    };
    let scene = &model.scene;
    let skin = SKIN * scene.reach.proximity;
    let (mut body, mut first) = (0, 0);
    for (number, contact) in found.atoms.iter().enumerate() {
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
        let carried = same.or_else(slid).map_or(([0.0; 3], 0.0), |bond| (bond.force, bond.stored));
        let [i, j, k] = scene.facet_atoms(on, contact.facet);
        let other = on as usize;
        let own = other == body;
        let strength = if own { Strength::default() } else { model.strength_between(body, other) };
        let kind = model.kind_of(body as u32);
        let cohesive = if own { None } else { model.cohesion_of(body as u32, Faced::Body(on)) };
        let area = match cohesive {
            Some(_) => area_between(facing, contact.atom, Faced::Body(on)),
            None => model.areas[kind][(contact.atom - scene.bodies[body].first_atom) as usize],
        };
        let area = area / contacts_on_body(scene, found, number) as f64;
        let area = SHARE * area;
        let area = area * controls.adhesion_of(body) * controls.adhesion_of(other);
        add(
            Pairing::AtomOnFacet,
            [contact.atom, i, j, k],
            contact.second_weights,
            contact.normal,
            contact.gap - if own || model.is_thin(on) { skin } else { 0.0 },
            [-strength.tensile * area, strength.shear * area, cohesive.map_or(0.0, |it| it.friction * area)],
            carried,
        );
    }
    let mut first = 0;
    for contact in &found.edges {
        while before.edges.get(first).is_some_and(|bond| bond.edges < contact.edges) {
            first += 1;
        }
        let same = before.edges.get(first).filter(|bond| bond.edges == contact.edges);
        let [one, other] = contact.bodies(scene);
        let [a, b] = scene.edge_atoms(one, contact.edges[0]);
        let [c, d] = scene.edge_atoms(other, contact.edges[1]);
        let is_thin = one == other || model.is_thin(one) || model.is_thin(other);
        add(
            Pairing::Edges,
            [a, b, c, d],
            contact.along,
            contact.normal,
            contact.gap - if is_thin { skin } else { 0.0 },
            [0.0; 3],
            (same.map_or([0.0; 3], |bond| bond.force), 0.0),
        );
    }
    let (mut body, mut first) = (0, 0);
    for contact in &found.planes {
        while scene.bodies.get(body + 1).is_some_and(|next| next.first_atom <= contact.atom) {
            body += 1;
        }
        let key = (contact.atom, contact.plane);
        while before.planes.get(first).is_some_and(|bond| (bond.atom, bond.plane) < key) {
            first += 1;
        }
        let same = before.planes.get(first).filter(|bond| (bond.atom, bond.plane) == key);
        let kind = model.kind_of(body as u32);
        let strength = model.strength_on(body, contact.plane);
        let cohesive = model.cohesion_of(body as u32, Faced::Plane(contact.plane));
        let area = match cohesive {
            Some(_) => area_between(facing, contact.atom, Faced::Plane(contact.plane)),
            None => model.areas[kind][(contact.atom - scene.bodies[body].first_atom) as usize],
        };
        let area = area * controls.adhesion_of(body);
        add(
            Pairing::AtomOnPlane,
            [contact.atom; 4],
            [0.0; 2],
            scene.planes[contact.plane as usize].normal.into(),
            contact.gap,
            [-strength.tensile * area, strength.shear * area, cohesive.map_or(0.0, |it| it.friction * area)],
            same.map_or(([0.0; 3], 0.0), |bond| (bond.force, bond.stored)),
        );
    }
}

/// How many contacts the atom of a contact has with the body of it: in a groove in two or more, which share what it bears.
fn contacts_on_body(scene: &Scene, found: &Contacts, number: usize) -> usize {
    let this = &found.atoms[number];
    let same = |other: &&AtomContact| other.atom == this.atom && other.body(scene) == this.body(scene);
    let before = found.atoms[..number].iter().rev().take_while(same).count();
    before + found.atoms[number..].iter().take_while(same).count()
}
