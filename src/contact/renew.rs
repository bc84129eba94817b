//! Pairs of a few bodies collected anew, while all others keep theirs: what one fast atom costs does not grow with the population.

use std::iter::Peekable;

use super::boxes::Bounds;
use super::lists::{Boxes, Edge, Lists, next_near};
use super::motion::Then;
use super::neighbours::Neighbours;
use super::scene::Scene;
use super::words::{Part, Parts, Words};
use crate::Vec3;

/// What was collected before some bodies moved far.
pub(super) struct Past<'a> {
    /// Which bodies those are.
    pub far: &'a [bool],
    /// Where all atoms were when their pairs were collected; those of bodies that moved far are where they are now.
    pub at: &'a Then,
    /// Who might touch whom.
    pub neighbours: &'a Neighbours,
    /// Who might touch itself, of those that moved far where they are now.
    pub with_itself: &'a [bool],
}

/// Scratch of a thread.
#[derive(Debug, Clone, Default)]
pub(super) struct Spare {
    facets: Words,
    edges: Words,
    origins: Vec<Origin>,
    /// Where the atoms of a body and of neighbours are that have pairs collected anew, µm.
    points: Vec<Vec3>,
}

/// Where the pairs with a neighbour come from.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Origin {
    /// They are those there were, with this index among the neighbours.
    Kept(u32),
    /// They are collected; the first of its atoms in the list of points.
    Anew(u32),
    /// There are none: the neighbour is the body itself, which is round.
    None,
}

/// Lists as they were, read in their order.
struct Kept<'a>(Peekable<Parts<'a>>);

impl<'a> Kept<'a> {
    fn of(words: &'a Words) -> Self {
        Self(words.parts().peekable())
    }

    /// What is listed of an owner and the body with this index. Both must ascend from call to call.
    fn part(&mut self, owner: u32, index: u32) -> Option<Part<'a>> {
        let key = (owner, index as usize);
        while self.0.next_if(|part| (part.0, part.1) < key).is_some() {}
        self.0.next_if(|part| (part.0, part.1) == key).map(|part| part.2)
    }
}

impl Past<'_> {
    /// Whether the lists of a batch are to be made again: where a body of it, or a neighbour, has moved far, or neighbours have come or gone.
    pub fn concerns(&self, scene: &Scene, batch: usize, boxes: &Boxes) -> bool {
        let is_far = |body: &u32| self.far[*body as usize];
        scene.bodies_of(batch).any(|body| {
            let neighbours = boxes.neighbours.of(body);
            neighbours.iter().any(is_far) || neighbours != self.neighbours.of(body)
        })
    }

    /// Finds out where the pairs of a body with each of its neighbours come from, and where the atoms of those to be collected are.
    fn trace(&self, scene: &Scene, body: u32, positions: &[Vec3], boxes: &Boxes, spare: &mut Spare) {
        let Spare { origins, points, .. } = spare;
        origins.clear();
        points.clear();
        let mut add = |body: u32| {
            let first = points.len() as u32;
            match self.far[body as usize] {
                true => points.extend_from_slice(scene.of_body(body, positions)),
                false => self.at.positions_of(scene, body, &boxes.bounds[body as usize], points),
            }
            first
        };
        let before = self.neighbours.of(body);
        // The body itself is always the first of the points.
        add(body);
        for &other in boxes.neighbours.of(body) {
            let kept = before.binary_search(&other).ok();
            let kept = kept.filter(|_| !self.far[body as usize] && !self.far[other as usize]);
            origins.push(match kept {
                Some(index) => Origin::Kept(index as u32),
                None if other == body && self.with_itself[body as usize] => Origin::Anew(0),
                None if other == body => Origin::None,
                None => Origin::Anew(add(other)),
            });
        }
    }
}

impl Lists {
    /// Makes the lists of a batch again: pairs of bodies that moved far are collected from where these are now, all others are those
    /// there were.
    pub fn renew(
        &mut self,
        scene: &Scene,
        batch: usize,
        positions: &[Vec3],
        boxes: &Boxes,
        past: &Past,
        spare: &mut Spare,
    ) {
        let (old_facets, old_edges) = (std::mem::take(&mut self.facets), std::mem::take(&mut self.edges));
        let (mut facets_there, mut edges_there) = (Kept::of(&old_facets), Kept::of(&old_edges));
        spare.facets.clear();
        spare.edges.clear();
        let (mut first_atom, mut first_edge) = (0, 0);
        for body in scene.bodies_of(batch) {
            past.trace(scene, body, positions, boxes, spare);
            let Spare { facets, edges, origins, points } = &mut *spare;
            let shape = scene.shape(body);
            let here = &points[..shape.atoms];
            let neighbours = boxes.neighbours.of(body);
            let there = |first: u32, other: u32| &points[first as usize..][..scene.shape(other).atoms];
            for atom in (0..shape.atoms).filter(|atom| shape.is_outer(*atom)) {
                let (bounds, owner) = (Bounds::around(&here[atom..=atom], self.reach), first_atom + atom as u32);
                for ((&other, origin), position) in neighbours.iter().zip(&*origins).zip(0..) {
                    match *origin {
                        Origin::Kept(index) => {
                            let part = facets_there.part(owner, index);
                            part.into_iter().for_each(|part| facets.add_part(owner, position, part));
                        }
                        Origin::Anew(first) if bounds.meets(&boxes.bounds[other as usize]) => {
                            let both = [here, there(first, other)];
                            self.collect_facets(scene, [body, other], atom, &bounds, both, boxes);
                            facets.add(owner, position, &self.pairs);
                        }
                        Origin::Anew(_) | Origin::None => {}
                    }
                }
            }
            for facet in 0..shape.facets.len() as u32 {
                self.gather_near(scene, body, facet, here, boxes, |at| matches!(origins[at], Origin::Anew(_)));
                let near = std::mem::take(&mut self.near);
                for edge in shape.edges_of(facet) {
                    let (owner, mut rest) = (first_edge + edge, &near[..]);
                    let first = (!rest.is_empty()).then(|| Edge::of(shape, here, edge, self.reach));
                    for ((&other, origin), position) in neighbours.iter().zip(&*origins).zip(0..) {
                        match (*origin, &first) {
                            (Origin::Kept(index), _) => {
                                let part = edges_there.part(owner, index);
                                part.into_iter().for_each(|part| edges.add_part(owner, position, part));
                            }
                            (Origin::Anew(start), Some(edge)) if rest.first() == Some(&position) => {
                                let facets = next_near(&mut rest).map_or(&[][..], |(_, facets)| facets);
                                self.collect_edges(scene, [body, other], edge, facets, there(start, other));
                                edges.add(owner, position, &self.pairs);
                            }
                            (Origin::Anew(_) | Origin::None, _) => {}
                        }
                    }
                }
                self.near = near;
            }
            first_atom += shape.atoms as u32;
            first_edge += shape.edges.len() as u32;
        }
        (self.facets, self.edges) = (old_facets, old_edges);
        self.facets.copy(&spare.facets);
        self.edges.copy(&spare.edges);
    }
}
