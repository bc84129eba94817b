//! A check after a step: what passed through what, among the pairs kept.

use super::detect::Detector;
use super::scene::Scene;
use super::swept::{atom_meets_facet, edges_meet};
use super::words::HIGHEST;
use crate::Vec3;

/// Two things that met while they moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pair {
    /// An atom and a facet, numbered through the scene.
    AtomFacet {
        /// The atom.
        atom: u32,
        /// The facet.
        facet: u32,
    },
    /// Two edges, numbered through the scene.
    Edges([u32; 2]),
}

/// A meeting during a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// What met.
    pub pair: Pair,
    /// The bodies of the two.
    pub bodies: [u32; 2],
    /// The share of the step until which they surely have not met.
    pub share: f64,
}

/// Whether the pairs kept are all that could meet in a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coverage {
    /// No atom was farther than half of the margin from where the pairs were collected, and those without pairs with themselves were round.
    Complete,
    /// Some atom was: meetings may be missing.
    Partial,
}

impl Detector {
    /// Finds all pairs that meet while every atom moves along a straight line from `before` to `after` (µm), and writes
    /// them over `passages`: atoms and facets first, by atom, then edges, for one batch of bodies after the other. What
    /// is nearer than `thickness` (µm) counts as meeting. A check for tests and diagnosis: it costs some times more than
    /// a detection, and pairs that touch before the step meet in it.
    ///
    /// # Panics
    /// When there are not as many positions as atoms, before or after.
    pub fn find_passages(
        &self,
        scene: &Scene,
        before: &[Vec3],
        after: &[Vec3],
        thickness: f64,
        passages: &mut Vec<Passage>,
    ) -> Coverage {
        assert_eq!([before.len(), after.len()], [scene.atoms; 2], "one position per atom of the scene");
        passages.clear();
        let (half, mut moved_of) = (0.5 * self.margin(), Vec::new());
        if self.moved(scene, before, &mut moved_of).is_infinite() {
            return Coverage::Partial;
        }
        let (lists, neighbours) = self.lists();
        for (batch, lists) in lists.iter().enumerate() {
            let Some(first) = scene.bodies.get(scene.bodies_of(batch).start as usize) else { continue };
            for (atom, point, facets) in lists.facets.parts() {
                let atom = first.first_atom + atom;
                let body = scene.body_of_atom(atom);
                let other = neighbours.of(body)[point];
                for facet in facets.up_to(HIGHEST).map(|facet| facet + scene.bodies[other as usize].first_facet) {
                    let corners = scene.facet_atoms(other, facet);
                    let facet_at = [before, after].map(|at| corners.map(|corner| at[corner as usize]));
                    let atom_at = [before, after].map(|at| at[atom as usize]);
                    if let Some(share) = atom_meets_facet(atom_at, facet_at, thickness) {
                        let pair = Pair::AtomFacet { atom, facet };
                        passages.push(Passage { pair, bodies: [body, other], share });
                    }
                }
            }
            for (edge, point, edges) in lists.edges.parts() {
                let edge = first.first_edge + edge;
                let body = scene.body_of_edge(edge);
                let other = neighbours.of(body)[point];
                let ends = |body: u32, edge: u32| {
                    let atoms = scene.edge_atoms(body, edge);
                    [before, after].map(|at| atoms.map(|atom| at[atom as usize]))
                };
                for second in edges.up_to(HIGHEST).map(|edge| edge + scene.bodies[other as usize].first_edge) {
                    if let Some(share) = edges_meet(ends(body, edge), ends(other, second), thickness) {
                        passages.push(Passage { pair: Pair::Edges([edge, second]), bodies: [body, other], share });
                    }
                }
            }
        }
        let covered = [before, after].iter().all(|positions| {
            let mut bodies = 0..scene.bodies.len() as u32;
            self.moved(scene, positions, &mut moved_of) <= half
                && bodies.all(|body| self.has_itself(body, scene.is_round(body, positions)))
        });
        if covered { Coverage::Complete } else { Coverage::Partial }
    }
}
