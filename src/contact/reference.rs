//! All pairs, without boxes or lists kept: slow, and what detection is held against.

use super::atom_facet::find_atom_contacts;
use super::detect::find_plane_contacts;
use super::edge_edge::find_edge_contacts;
use super::found::Contacts;
use super::lists::{BODY, Moved};
use super::scene::Scene;
use crate::Vec3;

/// Finds all contacts by looking at every pair of an atom and a facet and every pair of edges. The same contacts in
/// the same order as [`Detector::detect`](super::Detector::detect), at a cost that grows with the square of the atoms.
pub fn detect_all_pairs(scene: &Scene, positions: &[Vec3], contacts: &mut Contacts) {
    contacts.clear();
    let bodies = scene.bodies.len() as u32;
    let facets_of = |body: u32| 0..scene.shape(body).facets.len() as u32;
    let all_facets: Vec<Vec<u32>> =
        (0..bodies).map(|body| std::iter::once(body | BODY).chain(facets_of(body)).collect()).collect();
    let (mut list, mut lows) = (Vec::new(), Vec::new());
    for body in 0..bodies {
        let shape = scene.shape(body);
        for atom in 0..shape.atoms as u32 {
            for other in 0..bodies {
                let mut facets = &all_facets[other as usize];
                if other == body {
                    list.clear();
                    list.extend(facets.iter().filter(|&&facet| facet & BODY != 0 || !shape.is_near(atom, facet)));
                    facets = &list;
                }
                find_atom_contacts(
                    scene,
                    positions,
                    body,
                    atom,
                    facets,
                    &Moved::UNKNOWN,
                    &mut lows,
                    &mut contacts.atoms,
                );
            }
        }
        for edge in 0..shape.edges.len() as u32 {
            for other in body..bodies {
                list.clear();
                list.push(other | BODY);
                let edges = 0..scene.shape(other).edges.len() as u32;
                list.extend(edges.filter(|&e| other != body || (e > edge && !shape.are_edges_near(edge, e))));
                find_edge_contacts(scene, positions, body, edge, &list, &Moved::UNKNOWN, &mut contacts.edges);
            }
        }
        find_plane_contacts(scene, positions, body, &mut contacts.planes);
    }
}
