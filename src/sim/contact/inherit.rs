//! Forces that contacts of edges take over from others that are gone.
//!
//! A corner that rests on an edge touches it by all edges that end in it, and by others of them with each tremor. What it bears acts on in
//! the free motion, as what an atom bears does that slides from one facet to the next, eq. (adhesion.28): else the corner would begin each
//! step as if it had just met the edge.

use super::scene::ContactScene;
use super::state::{ContactState, EdgeBond};
use crate::Vec3;
use crate::contact::{Contacts, EdgeContact};

/// What contacts of edges have taken over from others, and the scratch in which it is found.
#[derive(Debug, Clone, Default)]
pub struct Inherited {
    /// Contacts that were not there in the last step, by the atoms of their first edges.
    new: Vec<(u32, u32)>,
    /// Those of them that go on with what others bore, and the force on the first edge, pN; by their numbers.
    forces: Vec<(u32, Vec3)>,
}

impl Inherited {
    /// The force of a contact that was not there in the last step.
    pub fn of(&self, number: usize) -> [f32; 3] {
        let found = self.forces.binary_search_by_key(&(number as u32), |(number, _)| *number);
        found.map_or([0.0; 3], |at| self.forces[at].1.map(|axis| axis as f32).into())
    }

    /// Lets contacts of edges that were not there in the last step take over what those bore that are gone: each is shared evenly by all
    /// contacts whose edges both end where its edges end.
    pub fn find(&mut self, contact: &ContactScene, found: &Contacts, before: &ContactState) {
        let Self { new, forces } = self;
        new.clear();
        forces.clear();
        let scene = &contact.scene;
        let atoms = |edges: [u32; 2]| edges.map(|edge| scene.edge_atoms(scene.body_of_edge(edge), edge));
        let gone = |bond: &&EdgeBond| bond.force != [0.0; 3] && find_edges(&found.edges, bond.edges).is_none();
        let mut gone = before.edges.iter().filter(gone).peekable();
        if gone.peek().is_none() {
            return;
        }
        let mut bonds = before.edges.iter().peekable();
        for (number, contact) in found.edges.iter().enumerate() {
            while bonds.next_if(|bond| bond.edges < contact.edges).is_some() {}
            if bonds.peek().is_none_or(|bond| bond.edges != contact.edges) {
                new.extend(atoms(contact.edges)[0].map(|atom| (atom, number as u32)));
            }
        }
        new.sort_unstable();
        for bond in gone {
            let [[a, b], there] = atoms(bond.edges);
            let at = |atom: u32| {
                let first = new.partition_point(|(other, _)| *other < atom);
                new[first..].iter().take_while(move |(other, _)| *other == atom).map(|(_, number)| *number)
            };
            let ends = |number: &u32| atoms(found.edges[*number as usize].edges);
            let shares = |number: &u32| ends(number)[1].iter().any(|atom| there.contains(atom));
            let heirs = || at(a).chain(at(b).filter(|number| !ends(number)[0].contains(&a))).filter(shares);
            let share = Vec3::from(bond.force.map(f64::from)) / heirs().count().max(1) as f64;
            forces.extend(heirs().map(|number| (number, share)));
        }
        forces.sort_unstable_by_key(|(number, _)| *number);
        forces.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
    }
}

/// Where a contact stands in a list that is ordered by edges.
fn find_edges(contacts: &[EdgeContact], edges: [u32; 2]) -> Option<usize> {
    contacts.binary_search_by(|contact| contact.edges.cmp(&edges)).ok()
}

#[cfg(test)]
mod tests {
    use super::super::model::ContactModel;
    use super::*;
    use crate::contact::{Normal, Reach};
    use crate::geometry::icosphere;
    use crate::sim::kind::Kind;
    use crate::sim::state::KindState;

    const REACH: Reach = Reach { proximity: 0.1, prediction: 0.1, depth: 0.1, margin: 0.1 };

    /// Two balls of 12 atoms and 30 edges each.
    fn two_balls() -> (ContactModel, Vec<KindState>) {
        let kind = || Kind::new("ball", icosphere(1.0, 0), Vec::new());
        (ContactModel::new(&[kind(), kind()], &[], REACH), vec![KindState { ids: vec![0], ..KindState::default() }; 2])
    }

    fn near(edges: [u32; 2]) -> EdgeContact {
        EdgeContact { edges, along: [0.5; 2], gap: 0.01, normal: Normal([0.0, 0.0, 1.0]) }
    }

    fn bond(edges: [u32; 2], force: [f32; 3]) -> EdgeBond {
        EdgeBond { edges, normal: [0.0, 0.0, 1.0], force }
    }

    /// What contacts of these edges of two balls take over from bonds.
    fn taken_over(pairs: &[[u32; 2]], bonds: &[EdgeBond]) -> Vec<[f32; 3]> {
        let (model, cells) = two_balls();
        let scene = model.scene_of(&cells);
        let found = Contacts { edges: pairs.iter().map(|pair| near(*pair)).collect(), ..Contacts::default() };
        let before = ContactState { edges: bonds.to_vec(), ..ContactState::default() };
        let mut inherited = Inherited::default();
        inherited.find(&scene, &found, &before);
        (0..pairs.len()).map(|number| inherited.of(number)).collect()
    }

    /// Edges of the first ball, the first of which ends where the others do but the last, and one of the second, with one that ends where it does,
    /// and one that does not.
    fn edges() -> ([u32; 4], [u32; 3]) {
        let (model, cells) = two_balls();
        let scene = model.scene_of(&cells);
        let ends = |edge: u32| scene.scene.edge_atoms(scene.scene.body_of_edge(edge), edge);
        let meet = |one: u32, other: u32| ends(one).iter().any(|atom| ends(other).contains(atom));
        let [a, b] = [1..30, 31..60].map(|rest| {
            let first = rest.start - 1;
            let beside: Vec<u32> = rest.clone().filter(|edge| meet(first, *edge)).collect();
            let apart = rest.clone().find(|edge| !meet(first, *edge)).expect("an edge elsewhere");
            (first, beside, apart)
        });
        ([a.0, a.1[0], a.1[1], a.2], [b.0, b.1[0], b.2])
    }

    #[test]
    fn what_is_gone_is_shared_by_the_new_contacts_beside_it() {
        let ([gone, one, other, apart], [there, beside, elsewhere]) = edges();
        let mut pairs = [[one, there], [one, elsewhere], [other, there], [other, beside], [apart, there]];
        pairs.sort_unstable();
        let force = [0.0, 3.0, 6.0];
        let taken = taken_over(&pairs, &[bond([gone, there], force)]);
        for (pair, taken) in pairs.iter().zip(taken) {
            let is_heir = [[one, there], [other, there], [other, beside]].contains(pair);
            assert_eq!(taken, if is_heir { [0.0, 1.0, 2.0] } else { [0.0; 3] }, "{pair:?}");
        }
    }

    #[test]
    fn what_is_still_there_or_carried_before_takes_over_nothing() {
        let ([gone, one, other, _], [there, ..]) = edges();
        let mut pairs = [[gone, there], [one, there]];
        pairs.sort_unstable();
        let none = taken_over(&pairs, &[bond([gone, there], [0.0, 0.0, 5.0])]);
        assert_eq!(none, [[0.0; 3]; 2], "the contact is still there");
        let mut bonds = [bond([gone, there], [0.0, 0.0, 5.0]), bond([one, there], [0.0, 0.0, 1.0])];
        bonds.sort_unstable_by_key(|bond| bond.edges);
        let mut pairs = [[one, there], [other, there]];
        pairs.sort_unstable();
        let taken = taken_over(&pairs, &bonds);
        for (pair, taken) in pairs.iter().zip(taken) {
            assert_eq!(taken, if *pair == [other, there] { [0.0, 0.0, 5.0] } else { [0.0; 3] }, "{pair:?}");
        }
    }

    #[test]
    fn two_that_are_gone_add_up() {
        let ([gone, one, other, _], [there, ..]) = edges();
        let mut bonds = [bond([gone, there], [0.0, 0.0, 5.0]), bond([one, there], [1.0, 0.0, 1.0])];
        bonds.sort_unstable_by_key(|bond| bond.edges);
        assert_eq!(taken_over(&[[other, there]], &bonds), [[1.0, 0.0, 6.0]], "the heir is beside both");
    }
}
