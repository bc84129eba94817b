//! Contacts as rows of the system that the sweeps solve.

use super::model::{ContactModel, Strength};
use super::scratch::empty_for;
use super::state::ContactState;
use crate::Vec3;
use crate::contact::{AtomContact, Contacts, Normal, Scene};
use crate::sim::chemistry::Controls;

/// One contact as it stands in a step, eq. (adhesion.1). The gap changes by `normal · Σ weights[i] D[atoms[i]]` when atoms are displaced by
/// D. A packed population has almost as many contacts as atoms, and every sweep reads them all: what need not be exact to
/// more than seven digits has four bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Its atoms; those that are not there have weight 0.
    pub atoms: [u32; 4],
    /// Where it is: the weights of the second and third atom of a facet, or the places along two edges; see [`Row::weights`].
    pub places: [f64; 2],
    /// From the other side to the first, and the gap where the step began, µm.
    pub normal_and_gap: [f32; 4],
    /// Least normal force, pN: minus the pull at which the contact parts.
    pub least: f32,
    /// Largest tangential force, pN.
    pub shear: f32,
    /// Displacement over force, µm/pN; 0 where nothing can move.
    pub give: f32,
    /// What it holds of a change of its force; the rest gives way.
    pub kept: f32,
    /// What went into its give and has not come back where the step began, pN·µm.
    pub given: f32,
    /// What touches.
    pub pairing: Pairing,
}

/// What touches in a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pairing {
    /// An atom, and the three of a facet.
    AtomOnFacet,
    /// The two atoms of an edge, and those of another.
    Edges,
    /// An atom, four times.
    AtomOnPlane,
    /// All atoms move as one, so that the contact does nothing.
    Rigid,
}

/// What a contact carries; forces on the first side, pN.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pull {
    /// Now.
    pub force: [f32; 3],
    /// Where the step began.
    pub carried: [f32; 3],
    /// What the last sweep changed.
    pub(super) change: [f32; 3],
    /// The direction that speeds the sweeps up.
    pub(super) way: [f32; 3],
}

/// Both sides of an interface have atoms that touch the other: each carries half of its strength.
pub(super) const SHARE: f64 = 0.5;

/// How thick a surface with two outsides is on each side, over the proximity. What rests on it stays farther off than sweeps leave
/// unresolved, so that its side and, over ridges and in grooves, its normals are told by more than noise.
const SKIN: f64 = 0.05;

/// Writes the rows of all contacts, with the forces that they carried in the last step as far as they can bear them.
pub fn write_rows(
    model: &ContactModel,
    found: &Contacts,
    before: &ContactState,
    controls: &Controls,
    rows: &mut Vec<Row>,
    pulls: &mut Vec<Pull>,
) {
    let count = found.atoms.len() + found.edges.len() + found.planes.len();
    empty_for(rows, count);
    empty_for(pulls, count);
    let mut add = |pairing,
                   atoms,
                   places,
                   Normal([x, y, z]),
                   gap: f64,
                   [least, shear]: [f64; 2],
                   (force, given): ([f32; 3], f32)| {
        let normal_and_gap = [x, y, z, gap as f32];
        let (least, shear) = (least as f32, shear as f32);
        let row = Row { atoms, places, normal_and_gap, least, shear, give: 0.0, kept: 1.0, given, pairing };
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
        let carried = same.or_else(slid).map_or(([0.0; 3], 0.0), |bond| (bond.force, bond.given));
        let [i, j, k] = scene.facet_atoms(on, contact.facet);
        let other = on as usize;
        let own = other == body;
        let strength = if own { Strength::default() } else { model.strength_between(body, other) };
        let kind = model.kind_of(body as u32);
        let area = SHARE * model.areas[kind][(contact.atom - scene.bodies[body].first_atom) as usize];
        let area = area / places_on_body(scene, found, number) as f64;
        let area = area * controls.adhesion_of(body) * controls.adhesion_of(other);
        add(
            Pairing::AtomOnFacet,
            [contact.atom, i, j, k],
            contact.second_weights,
            contact.normal,
            contact.gap - if own || model.is_thin(on) { skin } else { 0.0 },
            [-strength.tensile * area, strength.shear * area],
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
            [0.0, 0.0],
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
        let area = model.areas[kind][(contact.atom - scene.bodies[body].first_atom) as usize];
        let area = area * controls.adhesion_of(body);
        add(
            Pairing::AtomOnPlane,
            [contact.atom; 4],
            [0.0; 2],
            scene.planes[contact.plane as usize].normal.into(),
            contact.gap,
            [-strength.tensile * area, strength.shear * area],
            same.map_or(([0.0; 3], 0.0), |bond| (bond.force, bond.given)),
        );
    }
}

/// In how many places the atom of a contact touches the body of it: in a groove in two or more, which share what it bears.
fn places_on_body(scene: &Scene, found: &Contacts, number: usize) -> usize {
    let this = &found.atoms[number];
    let same = |other: &&AtomContact| other.atom == this.atom && other.body(scene) == this.body(scene);
    let before = found.atoms[..number].iter().rev().take_while(same).count();
    before + found.atoms[number..].iter().take_while(same).count()
}

impl Row {
    /// The weights of its atoms: positive on the first side of the contact, negative on the other; each side sums to ±1.
    #[inline(always)]
    pub fn weights(&self) -> [f64; 4] {
        let [s, t] = self.places;
        match self.pairing {
            Pairing::AtomOnFacet => [1.0, -(1.0 - s - t), -s, -t],
            Pairing::Edges => [1.0 - s, s, t - 1.0, -t],
            Pairing::AtomOnPlane => [1.0, 0.0, 0.0, 0.0],
            Pairing::Rigid => [0.0; 4],
        }
    }

    /// Force over displacement, pN/µm.
    #[inline(always)]
    pub fn stiffness(&self) -> f64 {
        f64::from(1.0 / self.give)
    }

    /// Unit vector from the other side to the first.
    pub fn normal(&self) -> Vec3 {
        let [x, y, z, _] = self.normal_and_gap.map(f64::from);
        Vec3::new(x, y, z)
    }

    /// Gap where the step began, µm.
    pub fn gap(&self) -> f64 {
        f64::from(self.normal_and_gap[3])
    }

    /// Cuts a force to what the contact bears along its present normal.
    fn bound(&self, force: Vec3) -> Vec3 {
        let (normal, shear) = (self.normal(), f64::from(self.shear));
        let along = force.dot(&normal);
        let across = force - along * normal;
        let size = across.norm();
        let kept = if size > shear { shear / size } else { 1.0 };
        along.max(f64::from(self.least)) * normal + kept * across
    }
}

impl Pull {
    /// The force on the first side, pN.
    pub fn force(&self) -> Vec3 {
        vector(&self.force)
    }

    /// The force on the first side where the step began, pN.
    pub(super) fn carried(&self) -> Vec3 {
        vector(&self.carried)
    }
}

fn vector(numbers: &[f32; 3]) -> Vec3 {
    Vec3::from(numbers.map(f64::from))
}
