//! The facets of other bodies that are near each facet, kept until some atom has moved half of the margin.

use rayon::prelude::*;

use super::boxes::{Bounds, Pack, Steps};
use super::lists::{Boxes, visit};
use super::scene::Scene;
use crate::Vec3;

/// For each facet those of other bodies that are near it. What is near is what matters now and more: the lists change nothing that is
/// found.
#[derive(Debug, Clone, Default)]
pub struct NearFacets {
    boxes: Boxes,
    lists: Vec<List>,
    /// Where the atoms were when the lists were made.
    positions: Vec<Vec3>,
    /// From how far they were made, µm.
    reach: f64,
}

/// Those of a batch of bodies.
#[derive(Debug, Clone, Default)]
struct List {
    /// Where the facets near each facet begin, one more than there are facets.
    first: Vec<u32>,
    near: Vec<u32>,
    /// What each was apart then, as whoever asked for the lists measures it.
    apart: Vec<f32>,
    bounds: Vec<Bounds>,
}

/// The facets near one.
#[derive(Debug, Clone, Copy)]
pub struct Near<'a> {
    /// Numbered through the scene, ascending.
    pub facets: &'a [u32],
    /// What each was apart when the lists were made.
    pub apart: &'a [f32],
}

/// How much farther than what matters lists are made from, over that.
const MARGIN: f64 = 0.5;

impl NearFacets {
    /// Makes the lists complete for all facets nearer than `range` (µm) to others at these positions, and says whether they were made
    /// anew: then it is kept of each two what they are `apart`.
    pub fn follow(
        &mut self,
        scene: &Scene,
        positions: &[Vec3],
        range: f64,
        apart: impl Fn(u32, u32) -> f32 + Sync,
    ) -> bool {
        let are_made = !self.are_complete(positions, range);
        if are_made {
            self.collect(scene, positions, (1.0 + MARGIN) * range, apart);
        }
        are_made
    }

    /// Makes the lists for these positions alone.
    pub fn find(&mut self, scene: &Scene, positions: &[Vec3], range: f64, apart: impl Fn(u32, u32) -> f32 + Sync) {
        self.collect(scene, positions, range, apart);
    }

    /// Forgets the lists, so that they are made anew.
    pub fn forget(&mut self) {
        self.positions.clear();
    }

    /// The facets near those of a body, from its first facet on.
    pub fn of_body<'a>(&'a self, scene: &Scene, body: u32) -> impl Iterator<Item = Near<'a>> {
        let of = scene.bodies[body as usize];
        let list = &self.lists[of.batch as usize];
        let first_of_batch = scene.bodies[scene.bodies_of(of.batch as usize).start as usize].first_facet;
        let start = (of.first_facet - first_of_batch) as usize;
        let ends = &list.first[start..=start + scene.shape(body).facets.len()];
        ends.windows(2)
            .map(|ends| ends[0] as usize..ends[1] as usize)
            .map(|near| Near { facets: &list.near[near.clone()], apart: &list.apart[near] })
    }

    fn are_complete(&self, positions: &[Vec3], range: f64) -> bool {
        let slack = 0.5 * (self.reach - range);
        let stays = |(now, then): (&Vec3, &Vec3)| (now - then).norm_squared() <= slack * slack;
        self.positions.len() == positions.len() && slack >= 0.0 && positions.iter().zip(&self.positions).all(stays)
    }

    fn collect(&mut self, scene: &Scene, positions: &[Vec3], reach: f64, apart: impl Fn(u32, u32) -> f32 + Sync) {
        let batches = scene.batches.len() - 1;
        let Self { boxes, lists, .. } = self;
        lists.resize_with(batches, List::default);
        boxes.packs.resize_with(batches, Vec::new);
        boxes.packs.par_iter_mut().zip(lists.par_iter_mut()).enumerate().for_each(|(batch, (packs, list))| {
            list.bounds.clear();
            let bodies = scene.bodies_of(batch).map(|body| (body, &scene.bodies[body as usize]));
            let last = scene.bodies_of(batch).next_back().map(|body| &scene.bodies[body as usize]);
            let count = last.map_or(0, |last| last.first_pack as usize + scene.levels[last.shape as usize].packs());
            packs.resize(count, Pack::EMPTY);
            for (number, body) in bodies {
                let levels = &scene.levels[body.shape as usize];
                let packs = &mut packs[body.first_pack as usize..][..levels.packs()];
                let here = scene.of_body(number, positions);
                list.bounds.push(levels.measure(&scene.shapes[body.shape as usize], here, packs));
            }
        });
        boxes.bounds.clear();
        boxes.bounds.extend(lists.iter().flat_map(|list| list.bounds.iter().map(|bounds| bounds.grown(0.5 * reach))));
        boxes.neighbours.find(&boxes.bounds);
        boxes.bounds.clear();
        boxes.bounds.extend(lists.iter().flat_map(|list| list.bounds.iter().copied()));
        boxes.steps.clear();
        boxes.steps.extend(boxes.bounds.iter().map(Steps::of));
        let boxes = &*boxes;
        lists.par_iter_mut().enumerate().for_each(|(batch, list)| {
            list.collect(scene, batch, positions, boxes, reach);
            list.measure(scene, batch, &apart);
        });
        self.positions.clear();
        self.positions.extend_from_slice(positions);
        self.reach = reach;
    }
}

impl List {
    fn collect(&mut self, scene: &Scene, batch: usize, positions: &[Vec3], boxes: &Boxes, reach: f64) {
        self.first.clear();
        self.near.clear();
        self.first.push(0);
        for body in scene.bodies_of(batch) {
            let (shape, here) = (scene.shape(body), scene.of_body(body, positions));
            for facet in 0..shape.facets.len() as u32 {
                let corners = shape.corners(facet, here);
                let bounds = Bounds::around(&corners, reach);
                let ball = ball_around(&corners);
                for &other in boxes.neighbours.of(body) {
                    if other == body || !bounds.meets(&boxes.bounds[other as usize]) {
                        continue;
                    }
                    let (start, there) = (self.near.len(), scene.of_body(other, positions));
                    let first = scene.bodies[other as usize].first_facet;
                    visit(scene, other, boxes, &bounds, &mut |candidate| {
                        let near = ball_around(&scene.shape(other).corners(candidate, there));
                        let most = reach + ball.1 + near.1;
                        if (ball.0 - near.0).norm_squared() <= most * most {
                            self.near.push(first + candidate);
                        }
                    });
                    self.near[start..].sort_unstable();
                }
                self.first.push(self.near.len() as u32);
            }
        }
    }

    /// Keeps what each two are apart.
    fn measure(&mut self, scene: &Scene, batch: usize, apart: &impl Fn(u32, u32) -> f32) {
        let first = scene.bodies_of(batch).next().map_or(0, |body| scene.bodies[body as usize].first_facet);
        let ends = (first..).zip(self.first.windows(2));
        self.apart.clear();
        self.apart.extend(ends.flat_map(|(facet, ends)| {
            self.near[ends[0] as usize..ends[1] as usize].iter().map(move |other| apart(facet, *other))
        }));
    }
}

/// A ball around a facet: its middle and radius, µm.
fn ball_around(corners: &[Vec3; 3]) -> (Vec3, f64) {
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    let squared = corners.iter().map(|corner| (corner - middle).norm_squared()).fold(0.0, f64::max);
    (middle, squared.sqrt())
}

#[cfg(test)]
mod tests {
    use super::super::Reach;
    use super::super::test_scenes::{Dice, packed_stage};
    use super::*;

    const REACH: Reach = Reach { proximity: 0.2, prediction: 0.2, depth: 0.2, margin: 0.1 };

    /// The least distance of points of two facets, roughly: never less than it is.
    fn apart(one: &[Vec3; 3], other: &[Vec3; 3]) -> f64 {
        let points = |corners: &[Vec3; 3]| -> Vec<Vec3> {
            let steps = (0..=6).flat_map(|i| (0..=6 - i).map(move |j| (f64::from(i) / 6.0, f64::from(j) / 6.0)));
            steps.map(|(u, v)| corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0])).collect()
        };
        let (here, there) = (points(one), points(other));
        here.iter().flat_map(|x| there.iter().map(move |y| (x - y).norm())).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn no_facet_of_another_body_that_is_near_is_missed_while_cells_move() {
        let mut stage = packed_stage(8, REACH, 1);
        let (mut near, mut dice, mut found) = (NearFacets::default(), Dice(3), 0);
        for _ in 0..4 {
            near.follow(&stage.scene, &stage.positions, 0.5, |_, _| 0.0);
            let corners = |facet: u32| {
                let body = stage.scene.body_of_facet(facet);
                stage.scene.facet_atoms(body, facet).map(|atom| stage.positions[atom as usize])
            };
            for body in 0..stage.scene.bodies.len() as u32 {
                let first = stage.scene.bodies[body as usize].first_facet;
                for (facet, near) in (first..).zip(near.of_body(&stage.scene, body)) {
                    assert!(near.facets.is_sorted() && near.apart.len() == near.facets.len());
                    for other in (0..stage.scene.facets as u32).filter(|o| stage.scene.body_of_facet(*o) != body) {
                        if apart(&corners(facet), &corners(other)) < 0.5 {
                            assert!(near.facets.binary_search(&other).is_ok(), "{facet} {other}");
                            found += 1;
                        }
                    }
                }
            }
            stage.positions.iter_mut().for_each(|x| *x += 0.1 * dice.vector());
        }
        assert!(found > 1000, "{found}");
    }
}
