//! Contacts as rows of the system that the sweeps solve.

use super::model::{ContactModel, Strength};
use super::state::ContactState;
use crate::Vec3;
use crate::contact::Contacts;

/// One contact. The gap changes by `normal · Σ weights[i] D[atoms[i]]` when atoms are displaced by D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Its atoms; those that are not there have weight 0.
    pub atoms: [u32; 4],
    /// Their weights: positive on the first side of the contact, negative on the other; each side sums to ±1.
    pub weights: [f64; 4],
    /// From the other side to the first.
    pub normal: Vec3,
    /// Gap where the step began, µm.
    pub gap: f64,
    /// Least normal force, pN: minus the pull at which the contact parts.
    pub least: f64,
    /// Largest tangential force, pN.
    pub shear: f64,
    /// Force on the first side, pN.
    pub force: Vec3,
    /// Force over displacement, pN/µm.
    pub stiffness: f64,
}

/// Both sides of an interface have atoms that touch the other: each carries half of its strength.
const SHARE: f64 = 0.5;

/// Writes the rows of all contacts, with the forces that they carried in the last step as far as they can bear them.
pub fn write_rows(model: &ContactModel, found: &Contacts, before: &ContactState, rows: &mut Vec<Row>) {
    rows.clear();
    let scene = &model.scene;
    let (mut body, mut first) = (0, 0);
    for contact in &found.atoms {
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
        let slid = || of_atom().find(|bond| bond.body == contact.body && is_free(bond.facet));
        let force = same.or_else(slid).map_or([0.0; 3], |bond| bond.force);
        let [i, j, k] = scene.facet_atoms(contact.body, contact.facet);
        let [u, v, w] = contact.weights();
        let own = contact.body as usize == body;
        let (kind, other) = (model.kind_of(body as u32), model.kind_of(contact.body));
        let strength = if own { Strength::default() } else { model.between[kind * model.areas.len() + other] };
        let area = SHARE * model.areas[kind][(contact.atom - scene.bodies[body].first_atom) as usize];
        let mut row = Row {
            atoms: [contact.atom, i, j, k],
            weights: [1.0, -u, -v, -w],
            normal: contact.normal,
            gap: contact.gap,
            least: -strength.tensile * area,
            shear: strength.shear * area,
            force: Vec3::from(force),
            stiffness: 0.0,
        };
        row.bound();
        rows.push(row);
    }
    let mut first = 0;
    for contact in &found.edges {
        while before.edges.get(first).is_some_and(|bond| bond.edges < contact.edges) {
            first += 1;
        }
        let same = before.edges.get(first).filter(|bond| bond.edges == contact.edges);
        let [[a, b], [c, d]] = [0, 1].map(|side| scene.edge_atoms(contact.bodies[side], contact.edges[side]));
        let [s, t] = contact.along;
        let mut row = Row {
            atoms: [a, b, c, d],
            weights: [1.0 - s, s, t - 1.0, -t],
            normal: contact.normal,
            gap: contact.gap,
            least: 0.0,
            shear: 0.0,
            force: Vec3::from(same.map_or([0.0; 3], |bond| bond.force)),
            stiffness: 0.0,
        };
        row.bound();
        rows.push(row);
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
        let strength = model.on_planes[kind * scene.planes.len() + contact.plane as usize];
        let area = model.areas[kind][(contact.atom - scene.bodies[body].first_atom) as usize];
        let mut row = Row {
            atoms: [contact.atom; 4],
            weights: [1.0, 0.0, 0.0, 0.0],
            normal: scene.planes[contact.plane as usize].normal,
            gap: contact.gap,
            least: -strength.tensile * area,
            shear: strength.shear * area,
            force: Vec3::from(same.map_or([0.0; 3], |bond| bond.force)),
            stiffness: 0.0,
        };
        row.bound();
        rows.push(row);
    }
}

impl Row {
    /// Cuts the force to what the contact bears along its present normal.
    fn bound(&mut self) {
        let along = self.force.dot(&self.normal);
        let across = self.force - along * self.normal;
        let size = across.norm();
        let kept = if size > self.shear { self.shear / size } else { 1.0 };
        self.force = along.max(self.least) * self.normal + kept * across;
    }
}
