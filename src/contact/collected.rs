//! The pairs of all bodies, and where those were when they were collected: all at once, or those of a few bodies that have moved far.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::boxes::{Bounds, Pack, Steps};
use super::lists::{Boxes, Lists};
use super::motion::{Motion, Then, larger};
use super::near::Near;
use super::neighbours::Neighbours;
use super::renew::{Past, Spare};
use super::scene::Scene;
use crate::Vec3;

/// Bodies that have moved farther than this, over the margin, have their pairs collected anew when one has passed a half.
const FAR: f64 = 0.3;

/// Where more than one of so many bodies is that far, all pairs are collected anew: with its neighbours a body has twice its share of pairs.
const FEW: usize = 4;

/// How much farther than is needed bodies are listed as near each other, over the margin: the list lasts for some looks.
const SPARE: f64 = 2.0;

/// Bodies whose motion or roundness one job measures: it takes less than a microsecond each.
const BODIES_PER_JOB: usize = 16;

/// Pairs, and what they were collected from.
#[derive(Debug, Default)]
pub(super) struct Collected {
    pub boxes: Boxes,
    /// One per batch.
    pub lists: Vec<Lists>,
    /// How much farther than a contact pairs were collected from, µm.
    pub margin: f64,
    /// Where the atoms of each body were when its pairs were collected.
    at: Then,
    /// Which bodies are round now, and so have no contacts with themselves.
    pub round: Vec<bool>,
    /// Which bodies had their pairs with themselves collected, too: those that were not round.
    with_itself: Vec<bool>,
    /// Bodies that are near each other.
    pub near: Near,
    /// Boxes of the bodies of each batch.
    measured: Vec<Vec<Bounds>>,
    /// Who might touch whom before bodies moved far.
    before: Neighbours,
    /// Which bodies have.
    far: Vec<bool>,
    /// One per thread.
    spares: Vec<Mutex<Spare>>,
}

/// Scratch of threads outlasts nothing.
impl Clone for Collected {
    fn clone(&self) -> Self {
        Self {
            boxes: self.boxes.clone(),
            lists: self.lists.clone(),
            margin: self.margin,
            at: self.at.clone(),
            with_itself: self.with_itself.clone(),
            measured: self.measured.clone(),
            ..Self::default()
        }
    }
}

impl Collected {
    /// Forgets where the atoms were, so that all is collected anew.
    pub fn forget(&mut self) {
        self.at.forget();
    }

    /// Words of all lists.
    pub fn words(&self) -> usize {
        self.lists.iter().map(Lists::words).sum()
    }

    /// The largest displacement since pairs were collected, rounding included, µm; infinite when there are none
    /// for this scene, NaN or infinite when a position is not finite. That of each body is written to `of_bodies`.
    pub fn moved(&self, scene: &Scene, positions: &[Vec3], of_bodies: &mut Vec<Motion>) -> f64 {
        if !self.at.is_of(positions.len()) || self.lists.len() + 1 != scene.batches.len() {
            return f64::INFINITY;
        }
        let boxes = &self.boxes.bounds;
        let motion = |body: u32| self.at.motion(scene, body, &boxes[body as usize], positions);
        let bodies = 0..scene.bodies.len() as u32;
        bodies.into_par_iter().with_min_len(BODIES_PER_JOB).map(motion).collect_into_vec(of_bodies);
        of_bodies.iter().map(|motion| motion.farthest).fold(0.0, larger)
    }

    /// Finds out which bodies are round where they are now.
    pub fn find_round(&mut self, scene: &Scene, positions: &[Vec3]) {
        let bodies = (0..scene.bodies.len() as u32).into_par_iter().with_min_len(BODIES_PER_JOB);
        bodies.map(|body| scene.is_round(body, positions)).collect_into_vec(&mut self.round);
    }

    /// Whether bodies that are not round any more have no pairs with themselves yet. These count as moved far, so that theirs are collected anew.
    pub fn lack_themselves(&self, moved: &mut [Motion]) -> bool {
        let mut lack = false;
        for ((motion, is_round), with_itself) in moved.iter_mut().zip(&self.round).zip(&self.with_itself) {
            if !is_round && !with_itself {
                (motion.farthest, lack) = (f64::INFINITY, true);
            }
        }
        lack
    }

    /// Whether a body has all pairs with itself that it needs when it is round, or not.
    pub fn has_itself(&self, body: u32, is_round: bool) -> bool {
        is_round || self.with_itself[body as usize]
    }

    /// Whether a pair may be missing that touches by now: whether two bodies that are near each other have moved beside each other by more
    /// than the margin, or parts of one that is not round. However far they have moved together, their pairs go on.
    pub fn are_stale(&mut self, scene: &Scene, positions: &[Vec3], moved: &[Motion]) -> bool {
        let half = 0.5 * scene.reach.range();
        let bounds = |body: u32, more: f64| match scene.of_body(body, positions) {
            [] => Bounds::EMPTY,
            atoms => Bounds::around(atoms, half + more),
        };
        let spare = SPARE * self.margin;
        self.near.list(moved.len(), |body| bounds(body, 0.0), |body| bounds(body, spare));
        let (near, margin, round) = (&self.near, self.margin, &self.round);
        let is_stale = |body: u32| {
            let mut others =
                near.of(body).iter().filter(|other| **other > body || **other == body && !round[body as usize]);
            others.any(|other| moved[body as usize].beside(&moved[*other as usize]) > margin)
        };
        (0..scene.bodies.len() as u32).into_par_iter().with_min_len(BODIES_PER_JOB).any(is_stale)
    }

    /// How many bodies have moved far, if they are few.
    pub fn few_far(&self, moved: &[Motion]) -> Option<usize> {
        let far = moved.iter().filter(|motion| motion.farthest > FAR * self.margin).count();
        (FEW * far <= moved.len()).then_some(far)
    }

    /// Collects all pairs, of bodies that are round none with themselves.
    pub fn collect(&mut self, scene: &Scene, positions: &[Vec3]) {
        let batches = scene.batches.len() - 1;
        self.lists.resize_with(batches, Lists::default);
        self.measured.resize_with(batches, Vec::new);
        self.boxes.packs.resize_with(batches, Vec::new);
        self.boxes.packs.par_iter_mut().zip(&mut self.measured).enumerate().for_each(|(batch, (packs, measured))| {
            measured.clear();
            let bodies = &scene.bodies[scene.batches[batch] as usize..scene.batches[batch + 1] as usize];
            let count =
                bodies.last().map_or(0, |last| last.first_pack as usize + scene.levels[last.shape as usize].packs());
            packs.resize(count, Pack::EMPTY);
            measured.extend(scene.bodies_of(batch).map(|body| measure(scene, body, positions, packs)));
        });
        self.find_neighbours(scene);
        let Self { boxes, margin, lists, round, .. } = self;
        let lists = lists.par_iter_mut().enumerate();
        lists.for_each(|(batch, lists)| lists.collect(scene, batch, positions, boxes, (*margin, round)));
        self.with_itself.clear();
        self.with_itself.extend(self.round.iter().map(|is_round| !is_round));
        self.at.take(scene, positions, &self.boxes.bounds);
    }

    /// Collects anew the pairs of bodies that have moved far, which have not moved then; all others keep theirs.
    pub fn renew(&mut self, scene: &Scene, positions: &[Vec3], moved: &mut [Motion]) {
        let limit = FAR * self.margin;
        self.far.clear();
        self.far.extend(moved.iter().map(|motion| motion.farthest > limit));
        let far = &self.far;
        self.boxes.packs.par_iter_mut().zip(&mut self.measured).enumerate().for_each(|(batch, (packs, measured))| {
            let bodies = scene.bodies_of(batch).zip(measured).filter(|(body, _)| far[*body as usize]);
            bodies.for_each(|(body, measured)| *measured = measure(scene, body, positions, packs));
        });
        std::mem::swap(&mut self.before, &mut self.boxes.neighbours);
        self.find_neighbours(scene);
        for (body, motion) in (0..).zip(moved).filter(|(body, _)| self.far[*body as usize]) {
            self.at.take_again(scene, body, positions, &self.boxes.bounds[body as usize]);
            *motion = Motion::NONE;
            self.with_itself[body as usize] = !self.round[body as usize];
        }
        let threads = rayon::current_num_threads();
        self.spares.resize_with(threads.max(self.spares.len()), Mutex::default);
        let Self { boxes, lists, at, before, far, spares, with_itself, .. } = self;
        let past = Past { far, at, neighbours: before, with_itself };
        lists.par_iter_mut().enumerate().filter(|(batch, _)| past.concerns(scene, *batch, boxes)).for_each(
            |(batch, lists)| {
                let own = &spares[rayon::current_thread_index().unwrap_or(0) % spares.len()];
                let mut own = own.lock().unwrap_or_else(PoisonError::into_inner);
                lists.renew(scene, batch, positions, boxes, &past, &mut own);
            },
        );
    }

    /// Who may touch whom by the boxes that were measured.
    fn find_neighbours(&mut self, scene: &Scene) {
        let Self { boxes, measured, margin, .. } = self;
        // Bodies may touch when the boxes grown by half of the reach meet.
        let half = 0.5 * (scene.reach.range() + *margin);
        boxes.bounds.clear();
        boxes.bounds.extend(measured.iter().flatten().map(|bounds| bounds.grown(half)));
        boxes.neighbours.find(&boxes.bounds);
        boxes.bounds.clear();
        boxes.bounds.extend(measured.iter().flatten().copied());
        boxes.steps.clear();
        boxes.steps.extend(boxes.bounds.iter().map(Steps::of));
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let packs: usize = self.boxes.packs.iter().map(|packs| size_of::<Pack>() * packs.capacity()).sum();
        let lists: usize = self.lists.iter().map(Lists::bytes).sum();
        let measured: usize = self.measured.iter().map(|of_batch| size_of::<Bounds>() * of_batch.capacity()).sum();
        let bounds =
            size_of::<Bounds>() * self.boxes.bounds.capacity() + size_of::<Steps>() * self.boxes.steps.capacity();
        let neighbours = self.boxes.neighbours.bytes()
            + self.before.bytes()
            + self.far.capacity()
            + self.round.capacity()
            + self.with_itself.capacity();
        packs + lists + measured + bounds + neighbours + self.near.bytes() + self.at.bytes()
    }
}

/// Puts the boxes of a body into the packs of its batch; its own box comes back.
fn measure(scene: &Scene, body: u32, positions: &[Vec3], packs: &mut [Pack]) -> Bounds {
    let of = &scene.bodies[body as usize];
    let levels = &scene.levels[of.shape as usize];
    let packs = &mut packs[of.first_pack as usize..][..levels.packs()];
    levels.measure(&scene.shapes[of.shape as usize], scene.of_body(body, positions), packs)
}
