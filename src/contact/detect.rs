//! Finding all contacts of a scene: pairs are collected when something has moved far enough, and looked at each time.

use rayon::prelude::*;

use super::atom_facet::Low;
use super::collected::Collected;
use super::found::Contacts;
use super::lists::{Boxes, Lists, Moved, levels_over};
use super::look::{Who, look};
use super::motion::Motion;
use super::near::Near;
use super::neighbours::Neighbours;
use super::scene::Scene;
use crate::Vec3;

/// What a detection did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// Whether pairs were collected anew.
    pub collected: bool,
    /// Bodies whose pairs were collected anew: none, a few that have moved far, or all.
    pub renewed: usize,
    /// The largest displacement of an atom since the pairs were collected, before this detection, µm; infinite at
    /// first.
    pub moved: f64,
    /// Number of pairs kept.
    pub pairs: usize,
}

/// The scratch of detection: boxes and pairs, kept from step to step. Nothing in it changes what is found: contacts
/// depend on the positions alone.
#[derive(Debug, Clone, Default)]
pub struct Detector {
    pairs: Collected,
    /// Detections since every body has had its pairs collected anew, in the mean, and bodies that have had them since.
    looks: u32,
    renewed: usize,
    /// How each body has moved since its pairs were collected.
    moved_of: Vec<Motion>,
    /// What several threads find before it is put in order.
    found: Vec<Found>,
    lows: Vec<Low>,
}

/// What is found in one batch, and scratch.
#[derive(Debug, Clone, Default)]
struct Found {
    contacts: Contacts,
    lows: Vec<Low>,
}

/// Detections for which pairs should last: fewer cost more in collecting, more in looking at pairs that are far apart.
const LASTING: std::ops::RangeInclusive<u32> = 6..=20;

/// What the margin is multiplied or divided by when pairs lasted too short or too long, and the most it becomes, over
/// the scene's.
const WIDER: f64 = 1.5;
const WIDEST: f64 = 6.0;

/// Words of pairs an atom from which on the margin is not made wider: where bodies are packed more pairs would cost more than
/// collecting them less often saves, in time and in memory.
const MOST_WORDS: usize = 12;

/// Batches that each thread looks at before what is found is put in order.
const BATCHES_PER_THREAD: usize = 8;

impl Detector {
    /// Finds all contacts at these positions (µm, one per atom of the scene) and writes them over `contacts`. For a
    /// scene that is not that of the last call, [`forget`](Self::forget) the pairs first.
    ///
    /// The same positions give the same contacts in the same order, bit by bit, whatever was detected before and with
    /// any number of threads. Nothing is allocated once the lists have grown to their size.
    ///
    /// # Panics
    /// When there are not as many positions as atoms.
    pub fn detect(&mut self, scene: &Scene, positions: &[Vec3], contacts: &mut Contacts) -> Detection {
        assert_eq!(positions.len(), scene.atoms, "one position per atom of the scene");
        let mut moved_of = std::mem::take(&mut self.moved_of);
        let moved = self.moved(scene, positions, &mut moved_of);
        self.pairs.find_round(scene, positions);
        let collected = !moved.is_finite()
            || self.pairs.lack_themselves(&mut moved_of)
            || moved > 0.5 * self.pairs.margin && self.pairs.are_stale(scene, positions, &moved_of);
        let renewed = if collected { self.collect(scene, positions, moved, &mut moved_of) } else { 0 };
        self.looks += 1;
        contacts.clear();
        let since = Moved { of_bodies: &moved_of, scale: levels_over(self.pairs.margin, scene.reach.range()) };
        let Collected { boxes: Boxes { neighbours, .. }, lists: all, round, .. } = &self.pairs;
        let who = Who { neighbours, round };
        if rayon::current_num_threads() == 1 {
            for (batch, lists) in all.iter().enumerate() {
                look(scene, positions, batch, lists, &who, &since, &mut self.lows, contacts);
            }
        } else {
            // So many at a time that threads seldom wait for each other, and few contacts are held twice.
            let together = BATCHES_PER_THREAD * rayon::current_num_threads();
            self.found.resize_with(together.min(all.len()).max(self.found.len()), Found::default);
            for (first, lists) in (0..).step_by(together).zip(all.chunks(together)) {
                self.found[..lists.len()].par_iter_mut().zip(lists).enumerate().for_each(|(number, (found, lists))| {
                    found.contacts.clear();
                    let (batch, lows, to) = (first + number, &mut found.lows, &mut found.contacts);
                    look(scene, positions, batch, lists, &who, &since, lows, to);
                });
                self.found[..lists.len()].iter().for_each(|found| contacts.append(&found.contacts));
            }
        }
        self.moved_of = moved_of;
        Detection { collected, renewed, moved, pairs: self.pairs.words() }
    }

    /// Collects pairs anew: those of the bodies that have moved far, or all where these are many or another margin is better by now.
    /// Returns how many these are.
    fn collect(&mut self, scene: &Scene, positions: &[Vec3], moved: f64, moved_of: &mut Vec<Motion>) -> usize {
        let few = self.pairs.few_far(moved_of).filter(|_| moved.is_finite());
        self.renewed += few.unwrap_or(scene.bodies.len());
        let mut margin = self.pairs.margin;
        if self.renewed >= scene.bodies.len() {
            margin = self.next_margin(scene, moved);
            (self.looks, self.renewed) = (0, 0);
        }
        if let Some(few) = few.filter(|_| margin == self.pairs.margin) {
            self.pairs.renew(scene, positions, moved_of);
            return few;
        }
        self.pairs.margin = margin;
        self.pairs.collect(scene, positions);
        moved_of.clear();
        moved_of.resize(scene.bodies.len(), Motion::NONE);
        scene.bodies.len()
    }

    /// The margin to collect with: wider when the last pairs did not last, narrower when they lasted long.
    fn next_margin(&self, scene: &Scene, moved: f64) -> f64 {
        let least = scene.reach.margin;
        if !moved.is_finite() {
            return least;
        }
        let (before, is_packed) = (self.pairs.margin, self.pairs.words() > MOST_WORDS * scene.atoms);
        let margin = match self.looks {
            looks if looks < *LASTING.start() && !is_packed => before * WIDER,
            looks if looks > *LASTING.end() => before / WIDER,
            _ => before,
        };
        margin.clamp(least, WIDEST * least)
    }

    /// Forgets the pairs, so that the next detection collects them anew. Contacts do not depend on it.
    pub fn forget(&mut self) {
        self.pairs.forget();
        self.pairs.near.forget();
    }

    /// Whether a body has all pairs with itself that it needs when it is round, or not.
    pub(super) fn has_itself(&self, body: u32, is_round: bool) -> bool {
        self.pairs.has_itself(body, is_round)
    }

    /// Bodies that are near each other.
    pub(super) fn near(&mut self) -> &mut Near {
        &mut self.pairs.near
    }

    /// How much farther than a contact the pairs were collected from, µm.
    pub(super) fn margin(&self) -> f64 {
        self.pairs.margin
    }

    /// The lists of pairs, one per batch, and the bodies that they name.
    pub(super) fn lists(&self) -> (&[Lists], &Neighbours) {
        (&self.pairs.lists, &self.pairs.boxes.neighbours)
    }

    /// The largest displacement since the pairs were collected, rounding included, µm; infinite when there are none
    /// for this scene, NaN or infinite when a position is not finite. That of each body is written to `of_bodies`.
    pub(super) fn moved(&self, scene: &Scene, positions: &[Vec3], of_bodies: &mut Vec<Motion>) -> f64 {
        self.pairs.moved(scene, positions, of_bodies)
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let of_found = |found: &Found| found.contacts.bytes() + size_of::<Low>() * found.lows.capacity();
        let found: usize = self.found.iter().map(of_found).sum();
        self.pairs.bytes() + found + size_of::<Motion>() * self.moved_of.capacity()
    }
}
