//! What contacts remember from step to step beside their forces: positions alone do not tell on which side of a sheet an atom is, and
//! contacts that come and go with every tremor move their load about.

use rayon::prelude::*;

use super::scene::ContactScene;
use super::state::{AtomBond, ContactState};
use crate::Vec3;
use crate::contact::{Contacts, Detector, Facing, Feature, Normal, add_walls_of_grooves, edges_still_touch};

/// Finds what touches at these positions, with what is remembered of contacts that were there before.
pub fn find_at(
    contact: &ContactScene,
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

/// How far behind a ridge or a corner of a surface an atom counts as having come through it and not around it, over the prediction.
const PASSED: f64 = 0.1;

/// Leaves atoms on the side where they were of surfaces that have two outsides. Sweeps leave an atom at a distance that is zero but
/// for what they do not resolve; by its position alone it would then be on the other side, and would go on there.
fn keep_sides(contact: &ContactScene, before: &ContactState, found: &mut Contacts) {
    let mut bonds = before.atoms.iter().filter(|bond| bond.facing != Facing::Any).peekable();
    for near in found.atoms.iter_mut().filter(|near| near.facing != Facing::Any) {
        while bonds.next_if(|bond| bond.atom < near.atom).is_some() {}
        let body = near.body(&contact.scene);
        let same_atom =
            bonds.clone().take_while(|bond| bond.atom == near.atom).filter(|bond| bond.body(&contact.scene) == body);
        let beside = |facet: u32| {
            let [here, there] = [near.facet, facet].map(|facet| contact.scene.facet_atoms(body, facet));
            here.iter().any(|atom| there.contains(atom))
        };
        let was = same_atom.min_by_key(|bond| (bond.facet != near.facet, !beside(bond.facet)));
        let is_close = near.gap <= PASSED * contact.scene.reach.prediction;
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
fn keep_edges(contact: &ContactScene, before: &ContactState, positions: &[Vec3], found: &mut Contacts) {
    let count = found.edges.len();
    for bond in before.edges.iter().filter(|bond| bond.force != [0.0; 3]) {
        if found.edges[..count].binary_search_by(|edge| edge.edges.cmp(&bond.edges)).is_err() {
            let normal = Normal(bond.normal).wide();
            found.edges.extend(edges_still_touch(&contact.scene, positions, bond.edges, &normal));
        }
    }
    if found.edges.len() > count {
        found.edges.par_sort_unstable_by_key(|edge| edge.edges);
    }
}

#[cfg(test)]
mod tests {
    use super::super::model::ContactModel;
    use super::super::state::EdgeBond;
    use super::*;
    use crate::contact::Reach;
    use crate::geometry::{Surface, icosphere, sheet};
    use crate::sim::kind::Kind;
    use crate::sim::state::KindState;

    const REACH: Reach = Reach { proximity: 0.1, prediction: 0.1, depth: 0.1, margin: 0.1 };

    fn scene(surfaces: Vec<Surface>) -> (ContactModel, Vec<Vec3>) {
        let kinds: Vec<Kind> = surfaces.into_iter().map(|rest| Kind::new("body", rest, Vec::new())).collect();
        let positions = kinds.iter().flat_map(|kind| kind.rest.positions.clone()).collect();
        (ContactModel::new(&kinds, &[], REACH), positions)
    }

    /// One cell of each kind.
    fn of_one_each(model: &ContactModel) -> ContactScene<'_> {
        model.scene_of(&vec![KindState { ids: vec![0], ..KindState::default() }; model.shapes.len()])
    }

    fn found(model: &ContactModel, before: &ContactState, positions: &[Vec3]) -> Contacts {
        let (mut detector, mut found) = (Detector::default(), Contacts::default());
        find_at(&of_one_each(model), before, positions, &mut detector, &mut found);
        found
    }

    fn bonds_of(found: &Contacts) -> ContactState {
        let atoms = found.atoms.iter().map(|near| AtomBond {
            atom: near.atom,
            facet: near.facet,
            facing: near.facing,
            force: [0.0; 3],
            stored: 0.0,
        });
        ContactState { atoms: atoms.collect(), ..ContactState::default() }
    }

    /// A sheet in the plane z = 0 and a ball whose lowest atom is at a height over the middle of one of its facets.
    fn ball_over_a_sheet(height: f64) -> (ContactModel, Vec<Vec3>) {
        let ground = sheet(4.0, 4.0, 4, 4);
        let [a, b, c] = ground.facets[9].map(|atom| ground.positions[atom as usize]);
        let mut ball = icosphere(1.0, 1);
        let lowest = ball.positions.iter().copied().min_by(|one, other| one.z.total_cmp(&other.z)).expect("a ball");
        let shift = (a + b + c) / 3.0 + Vec3::z() * height - lowest;
        ball.positions.iter_mut().for_each(|x| *x += shift);
        scene(vec![ground, ball])
    }

    #[test]
    fn an_atom_stays_on_its_side_of_a_sheet_though_it_is_behind_it_by_what_sweeps_leave() {
        let (model, positions) = ball_over_a_sheet(0.01);
        let above = found(&model, &ContactState::default(), &positions);
        let touches = |found: &Contacts| {
            let lowest = found
                .atoms
                .iter()
                .find(|near| near.body(&of_one_each(&model).scene) == 0)
                .copied()
                .expect("the lowest atom touches");
            (lowest.gap, lowest.normal.wide().z, lowest.facing)
        };
        let (gap, up, front) = touches(&above);
        assert!((gap - 0.01).abs() < 1e-12 && up > 0.999 && front != Facing::Any, "{gap} {up} {front:?}");
        let (model, below) = ball_over_a_sheet(-0.001);
        let (gap, up, back) = touches(&found(&model, &ContactState::default(), &below));
        assert!(
            (gap - 0.001).abs() < 1e-12 && up < -0.999 && back.is_opposite(front),
            "by its place alone: {gap} {up}"
        );
        let (gap, up, side) = touches(&found(&model, &bonds_of(&above), &below));
        assert!((gap + 0.001).abs() < 1e-12 && up > 0.999 && side == front, "as it was before: {gap} {up} {side:?}");
    }

    #[test]
    fn edges_that_carried_a_force_stay_until_they_are_apart() {
        // Two tetrahedra with an edge on top and below, across each other and 0.02 µm apart.
        let tetrahedron = |up: f64| {
            let corners = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, -1.2], [0.0, -1.0, -1.2]];
            let mut surface = Surface {
                positions: corners.map(Vec3::from).to_vec(),
                facets: vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
            };
            if up > 0.0 {
                // Upside down, a quarter turn about z.
                surface.positions.iter_mut().for_each(|x| *x = Vec3::new(x.y, x.x, up - x.z));
            }
            if crate::geometry::volume(&surface) < 0.0 {
                surface.facets.iter_mut().for_each(|facet| facet.swap(1, 2));
            }
            surface
        };
        let (model, positions) = scene(vec![tetrahedron(0.0), tetrahedron(0.02)]);
        let first = found(&model, &ContactState::default(), &positions);
        let [near] = first.edges[..] else { panic!("one pair of edges: {:?}", first.edges) };
        let bond = |force: f32| ContactState {
            edges: vec![EdgeBond { edges: near.edges, normal: near.normal.0, force: [0.0, 0.0, force] }],
            ..ContactState::default()
        };
        // A facet of the lower one is lifted towards the upper one; its flank is 1.4 µm long.
        let lifted = |height: f64| {
            let mut positions = positions.clone();
            positions[2].z = height;
            positions
        };
        let slightly = found(&model, &ContactState::default(), &lifted(0.1));
        assert!(slightly.edges.iter().any(|edge| edge.edges == near.edges), "a sine of 0.07 leaves it a contact");
        // A sine of 0.14: more than makes a contact, less than ends one.
        let mut risen = lifted(0.2);
        assert!(found(&model, &ContactState::default(), &risen).edges.iter().all(|edge| edge.edges != near.edges));
        assert!(found(&model, &bond(0.0), &risen).edges.iter().all(|edge| edge.edges != near.edges), "carried nothing");
        let kept = found(&model, &bond(1.0), &risen);
        let kept = kept.edges.iter().find(|edge| edge.edges == near.edges).expect("still there");
        assert!(
            (kept.gap - near.gap).abs() < 1e-12
                && kept.edges == near.edges
                && kept.normal.wide().dot(&near.normal.wide()) > 0.99
        );
        risen[4..].iter_mut().for_each(|x| x.z += 0.2);
        assert!(found(&model, &bond(1.0), &risen).edges.is_empty(), "apart");
    }
}
