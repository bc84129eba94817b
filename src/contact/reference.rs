//! All pairs, without boxes or lists kept: slow, and what detection is held against.

use super::atom_facet::find_atom_contacts;
use super::edge_edge::find_edge_contacts;
use super::found::Contacts;
use super::look::find_obstacle_contacts;
use super::scene::Scene;
use super::words::{HIGHEST, Part, Words};
use crate::Vec3;

/// Finds all contacts by looking at every pair of an atom and a facet and every pair of edges, but for those of a body with itself that is
/// round, (contacts.15). The same contacts in
/// the same order as [`Detector::detect`](super::Detector::detect), at a cost that grows with the square of the atoms.
pub fn detect_all_pairs(scene: &Scene, positions: &[Vec3], contacts: &mut Contacts) {
    contacts.clear();
    let bodies = scene.bodies.len() as u32;
    let (mut lows, mut words, mut pairs) = (Vec::new(), Words::default(), Vec::new());
    for body in 0..bodies {
        let shape = scene.shape(body);
        let is_round = scene.is_round(body, positions);
        let may_touch = |other: &u32| *other != body || !is_round;
        for atom in (0..shape.atoms as u32).filter(|atom| shape.is_outer(*atom as usize)) {
            for other in (0..bodies).filter(may_touch) {
                let facets = 0..scene.shape(other).facets.len() as u32;
                let facets = facets.filter(|&facet| other != body || !shape.is_near(atom, facet));
                let part = list(&mut words, &mut pairs, facets);
                find_atom_contacts(scene, positions, [body, other], atom, part, &mut lows, &mut contacts.atoms);
            }
        }
        for edge in 0..shape.edges.len() as u32 {
            let mut first = None;
            for other in (body..bodies).filter(may_touch) {
                let edges = 0..scene.shape(other).edges.len() as u32;
                let edges = edges.filter(|&e| other != body || (e > edge && !shape.are_edges_near(edge, e)));
                let part = list(&mut words, &mut pairs, edges);
                find_edge_contacts(scene, positions, [body, other], edge, part, &mut first, &mut contacts.edges);
            }
        }
        find_obstacle_contacts(scene, positions, body, &mut contacts.obstacles);
    }
}

/// Writes a list with one part and takes all of it.
fn list<'a>(words: &'a mut Words, pairs: &mut Vec<(u32, u32)>, numbers: impl Iterator<Item = u32>) -> (Part<'a>, u32) {
    pairs.clear();
    pairs.extend(numbers.map(|number| (number, 0)));
    words.clear();
    words.add(0, 0, pairs);
    (words.parts().next().map_or(Part::EMPTY, |(.., part)| part), HIGHEST)
}
