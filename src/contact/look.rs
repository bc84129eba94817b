//! What touches among the pairs that are kept.

use super::atom_facet::{Low, find_atom_contacts};
use super::edge_edge::find_edge_contacts;
use super::found::{Contacts, ObstacleContact, push};
use super::lists::{Lists, Moved};
use super::neighbours::Neighbours;
use super::scene::Scene;
use crate::Vec3;
use crate::geometry::Beside;

/// Who may touch whom.
pub(super) struct Who<'a> {
    pub neighbours: &'a Neighbours,
    /// Which bodies are round now, and so have no contacts with themselves.
    pub round: &'a [bool],
}

impl Who<'_> {
    /// A body and one of its neighbours; none where that is the body itself and cannot touch itself now.
    #[inline]
    fn pair(&self, body: u32, position: usize) -> Option<[u32; 2]> {
        let other = self.neighbours.of(body)[position];
        (other != body || !self.round[body as usize]).then_some([body, other])
    }
}

/// Looks at the pairs of a batch and adds its contacts.
pub(super) fn look(
    scene: &Scene,
    positions: &[Vec3],
    batch: usize,
    lists: &Lists,
    who: &Who,
    moved: &Moved,
    lows: &mut Vec<Low>,
    contacts: &mut Contacts,
) {
    let bodies = scene.bodies_of(batch);
    let Some(first) = scene.bodies.get(bodies.start as usize).filter(|_| !bodies.is_empty()) else { return };
    let mut body = bodies.start;
    for (atom, position, part) in lists.facets.parts() {
        let mut atom = first.first_atom + atom - scene.bodies[body as usize].first_atom;
        while atom as usize >= scene.shape(body).atoms {
            atom -= scene.shape(body).atoms as u32;
            body += 1;
        }
        let Some(pair) = who.pair(body, position) else { continue };
        let limit = moved.limit(pair);
        if part.has(limit) {
            find_atom_contacts(scene, positions, pair, atom, (part, limit), lows, &mut contacts.atoms);
        }
    }
    let mut body = bodies.start;
    let (mut ridge, mut last) = (None, None);
    for (edge, position, part) in lists.edges.parts() {
        if last.replace(edge) != Some(edge) {
            ridge = None;
        }
        let mut edge = first.first_edge + edge - scene.bodies[body as usize].first_edge;
        while edge as usize >= scene.shape(body).edges.len() {
            edge -= scene.shape(body).edges.len() as u32;
            body += 1;
        }
        let Some(pair) = who.pair(body, position) else { continue };
        let limit = moved.limit(pair);
        if part.has(limit) {
            find_edge_contacts(scene, positions, pair, edge, (part, limit), &mut ridge, &mut contacts.edges);
        }
    }
    for body in bodies {
        find_obstacle_contacts(scene, positions, body, &mut contacts.obstacles);
    }
}

/// Adds the atoms of a body that are near an obstacle or behind it.
pub(super) fn find_obstacle_contacts(
    scene: &Scene,
    positions: &[Vec3],
    body: u32,
    contacts: &mut Vec<ObstacleContact>,
) {
    if scene.obstacles.is_empty() {
        return;
    }
    let (first, shape) = (scene.bodies[body as usize].first_atom, scene.shape(body));
    let atoms = scene.of_body(body, positions).iter().zip(first..);
    for (position, atom) in atoms.filter(|(_, atom)| shape.is_outer((atom - first) as usize)) {
        for (obstacle, number) in scene.obstacles.iter().zip(0..) {
            let Beside { gap, normal } = obstacle.beside(position);
            if gap < scene.reach.prediction {
                push(contacts, ObstacleContact { atom, obstacle: number, gap, normal: normal.into() });
            }
        }
    }
}
