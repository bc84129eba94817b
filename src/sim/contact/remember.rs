//! What contacts remember from step to step beside their forces: positions alone do not tell on which side of a sheet an atom is, and
//! contacts that come and go with every tremor move their load about.

use super::model::ContactModel;
use super::state::{AtomBond, ContactState};
use crate::Vec3;
use crate::contact::{Contacts, Detector, Facing, Feature, add_walls_of_grooves, edges_still_touch};

/// Finds what touches at these positions, with what is remembered of contacts that were there before.
pub fn find_at(
    contact: &ContactModel,
    before: &ContactState,
    positions: &[Vec3],
    detector: &mut Detector,
    found: &mut Contacts,
) {
    detector.detect(&contact.scene, positions, found);
    keep_edges(contact, before, positions, found);
    keep_sides(contact, before, found);
    add_walls_of_grooves(&contact.scene, positions, contact.scene.safe_travel(), found);
}

/// How far behind a ridge or a corner of a surface an atom counts as having come through it and not around it, over the proximity.
const PASSED: f64 = 0.1;

/// Leaves atoms on the side where they were of surfaces that have two outsides. Sweeps leave an atom at a distance that is zero but
/// for what they do not resolve; by its position alone it would then be on the other side, and would go on there.
fn keep_sides(contact: &ContactModel, before: &ContactState, found: &mut Contacts) {
    let mut bonds = before.atoms.iter().filter(|bond| bond.facing != Facing::Any).peekable();
    for near in found.atoms.iter_mut().filter(|near| near.facing != Facing::Any) {
        while bonds.next_if(|bond| bond.atom < near.atom).is_some() {}
        let same_atom = bonds.clone().take_while(|bond| bond.atom == near.atom).filter(|bond| bond.body == near.body);
        let beside = |facet: u32| {
            let [here, there] = [near.facet, facet].map(|facet| contact.scene.facet_atoms(near.body, facet));
            here.iter().any(|atom| there.contains(atom))
        };
        let was = same_atom.min_by_key(|bond| (bond.facet != near.facet, !beside(bond.facet)));
        let is_close = near.gap <= PASSED * contact.scene.reach.proximity;
        let passed = |bond: &AtomBond| match bond.facet == near.facet && near.feature == Feature::Face {
            true => bond.facing.is_opposite(near.facing),
            false => bond.facing.is_opposite(near.facing) && is_close && beside(bond.facet),
        };
        if let Some(bond) = was.copied().filter(passed) {
            (near.gap, near.normal, near.facing) = (-near.gap, -near.normal, bond.facing);
        }
    }
}

/// Adds edges that carried a force and still touch to those found: between surfaces that are nearly flat they come and
/// go with every tremor.
fn keep_edges(contact: &ContactModel, before: &ContactState, positions: &[Vec3], found: &mut Contacts) {
    let count = found.edges.len();
    for bond in before.edges.iter().filter(|bond| bond.force != [0.0; 3]) {
        if found.edges[..count].binary_search_by(|edge| edge.edges.cmp(&bond.edges)).is_err() {
            let normal = Vec3::from(bond.normal.map(f64::from));
            found.edges.extend(edges_still_touch(&contact.scene, positions, bond.edges, &normal));
        }
    }
    found.edges.sort_unstable_by_key(|edge| edge.edges);
}
