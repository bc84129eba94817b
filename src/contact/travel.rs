//! How far bodies go in a step over what is safe: beside those that they may meet, eq. (contacts.6).

use rayon::prelude::*;

use super::boxes::Bounds;
use super::detect::Detector;
use super::motion::Motion;
use super::near::Near;
use super::round::{ROUND, is_round, least_cosine};
use super::scene::Scene;
use super::shape::Sides;
use crate::Vec3;

/// A share below this tells a step of nothing: it may grow by no more than four times.
const LEAST: f64 = 0.2;

/// How far an atom may go whatever is near it, over the safe travel: some one and a half edges, so that what is near stays few.
const FARTHEST: f64 = 32.0;

/// How much farther than is needed bodies are listed as near, over how far they go: the list lasts for some steps.
const SPARE: f64 = 3.0;

/// Bodies that a thread takes at once, at least.
const BODIES_PER_JOB: usize = 64;

/// How far bodies went in a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Travel {
    /// Beside those that they may meet, over what is safe, eq. (contacts.6); 0 where it is below a fifth.
    pub share: f64,
    /// The farthest that an atom went, over the safe travel.
    pub farthest: f64,
}

impl Travel {
    /// The same, where something else says of its share, too.
    pub fn or_farther(self, share: f64) -> Self {
        Self { share: self.share.max(share), ..self }
    }
}

/// Whether a body may touch itself.
#[derive(Debug, Clone, Copy)]
pub enum Itself<'a> {
    /// Never: it is rigid.
    Never,
    /// A closed surface of these facets: not where it is round enough.
    Closed(&'a [[u32; 3]]),
    /// Wherever it may fold to.
    Anywhere,
}

/// How a body moves in a step.
#[derive(Debug, Clone, Copy)]
pub struct Stride {
    motion: Motion,
    /// How far atoms go beside the mean of all, where it may come to touch itself, over what is safe.
    to_itself: f64,
    /// Its box where the step begins.
    bounds: Bounds,
    /// How far atoms go that are near obstacles, over what is safe.
    to_obstacles: f64,
}

impl Stride {
    /// None, of nothing.
    pub const NONE: Self = Self { motion: Motion::NONE, to_itself: 0.0, bounds: Bounds::EMPTY, to_obstacles: 0.0 };

    /// That of so many atoms, which go from one position to another, µm.
    #[inline]
    pub fn of(
        scene: &Scene,
        (atoms, itself): (usize, Itself),
        from: impl Fn(usize) -> Vec3,
        to: impl Fn(usize) -> Vec3,
    ) -> Self {
        let safe = scene.safe_travel();
        let (mut low, mut high, mut sum, mut middle) =
            (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY), Vec3::zeros(), Vec3::zeros());
        let (mut farthest, mut to_obstacles): (f64, f64) = (0.0, 0.0);
        for atom in 0..atoms {
            let (start, end) = (from(atom), to(atom));
            let displacement = end - start;
            (low, high, sum, middle) = (low.inf(&start), high.sup(&start), sum + displacement, middle + start);
            farthest = farthest.max(displacement.norm_squared());
            for obstacle in &scene.obstacles {
                let towards = obstacle.approach(&start, &displacement);
                to_obstacles = to_obstacles.max(towards / safe.max(obstacle.gap(&start)));
            }
        }
        let [mean, middle] = [sum, middle].map(|sum| sum / atoms.max(1) as f64);
        let beside = (0..atoms).map(|atom| (to(atom) - from(atom) - mean).norm_squared()).fold(0.0, f64::max);
        let motion = Motion { mean, beside: beside.sqrt(), farthest: farthest.sqrt() };
        let to_itself = motion.beside.min(motion.farthest) / safe;
        let to_itself = match itself {
            // A facet tilts by 0.1 in so little, where the prediction is half an edge: what was round ends with more than (contacts.16) asks.
            _ if to_itself < LEAST => 0.0,
            Itself::Never => 0.0,
            Itself::Closed(facets) => to_itself_if_closed(to_itself, facets, (from, middle), (to, middle + mean)),
            Itself::Anywhere => to_itself,
        };
        Self { motion, to_itself, bounds: Bounds::between(low, high), to_obstacles }
    }

    /// What it goes by itself, over what is safe: towards obstacles, beside itself, and from what is near.
    fn alone(&self, safe: f64) -> f64 {
        self.to_obstacles.max(self.to_itself).max(self.motion.farthest / (FARTHEST * safe))
    }

    /// What two bodies go beside each other, over what is safe: what would bring them to each other, or twice the safe travel where that is
    /// more. Where one is a sheet, in whose grooves walls are told from as far as the safe travel, no more than that, or each by itself.
    fn beside(&self, other: &Self, with_sheet: bool, safe: f64) -> f64 {
        let (apart, beside) = (self.bounds.apart(&other.bounds), self.motion.beside(&other.motion));
        if !with_sheet {
            return beside / apart.max(2.0 * safe);
        }
        let farther = self.motion.farthest.max(other.motion.farthest);
        (beside / apart.max(safe)).min(farther / (0.5 * apart).max(safe))
    }

    /// The box that those must not meet of which nothing needs to be known: all whose share of what is safe is below the least.
    fn reach(&self, safe: f64, spare: f64) -> Bounds {
        self.bounds.grown((self.motion.farthest / LEAST).min(FARTHEST * safe) + spare)
    }
}

/// What a closed body goes to itself whose atoms go so far beside their mean, over what is safe: nothing where it is round and stays so. Of one
/// that was round no pairs with itself are held in the step, so that its surface must be far from going through itself where that ends, too, eq. (contacts.16).
fn to_itself_if_closed(
    beside: f64,
    facets: &[[u32; 3]],
    (from, middle): (impl Fn(usize) -> Vec3, Vec3),
    (to, middle_after): (impl Fn(usize) -> Vec3, Vec3),
) -> f64 {
    if !is_round(facets, &from, middle) {
        return beside;
    }
    let after = least_cosine(facets, to, middle_after);
    if after > ROUND {
        return 0.0;
    }
    let before = least_cosine(facets, from, middle);
    beside.max((before - after) / (before - 0.5 * ROUND))
}

/// How far bodies go beside those that they may meet, over what is safe, eq. (contacts.6), where they move by these strides, one a body; 0
/// where it is below a fifth. It depends on them alone, not on what is kept of who is near whom.
fn share(scene: &Scene, strides: &[Stride], near: &mut Near) -> f64 {
    let safe = scene.safe_travel();
    let reach = |body: u32| strides[body as usize].reach(safe, 0.0);
    near.list(strides.len(), reach, |body| {
        let stride = &strides[body as usize];
        stride.reach(safe, SPARE * stride.motion.farthest.min(safe))
    });
    let is_sheet = |body: u32| scene.shape(body).sides == Sides::Both;
    let near = &*near;
    let of_body = |body: u32| {
        let own = &strides[body as usize];
        let others = near.of(body).iter().filter(|other| **other > body);
        let beside = others.map(|other| {
            let with_sheet = is_sheet(body) || is_sheet(*other);
            own.beside(&strides[*other as usize], with_sheet, safe)
        });
        beside.fold(own.alone(safe), f64::max)
    };
    let bodies = (0..strides.len() as u32).into_par_iter().with_min_len(BODIES_PER_JOB);
    let share = bodies.map(of_body).reduce(|| 0.0, f64::max);
    if share < LEAST { 0.0 } else { share }
}

impl Detector {
    /// How far bodies go in a step where they move by these strides, one a body. It depends on them alone, not on what was detected before.
    pub fn travel(&mut self, scene: &Scene, strides: &[Stride]) -> Travel {
        let farthest = strides.iter().map(|stride| stride.motion.farthest).fold(0.0, f64::max);
        Travel { share: share(scene, strides, self.near()), farthest: farthest / scene.safe_travel() }
    }
}
