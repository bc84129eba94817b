//! Which bodies are near each other, kept while they move little.

use rayon::prelude::*;

use super::boxes::Bounds;
use super::neighbours::Neighbours;

/// Bodies that a thread looks at at once, at least.
const BODIES_PER_JOB: usize = 64;

/// Bodies that are near each other: all whose boxes of now meet, and more. Scratch that decides nothing.
#[derive(Debug, Clone, Default)]
pub(super) struct Near {
    neighbours: Neighbours,
    /// The boxes by which they were listed.
    listed: Vec<Bounds>,
}

impl Near {
    /// Lists all of so many bodies whose `needed` boxes meet, with larger ones `with_spare`, unless those listed last hold these: what
    /// boxes do not meet what they hold does not meet, either.
    pub fn list(
        &mut self,
        bodies: usize,
        needed: impl Fn(u32) -> Bounds + Sync,
        with_spare: impl Fn(u32) -> Bounds + Sync + Send,
    ) {
        let all = (0..bodies as u32).into_par_iter().with_min_len(BODIES_PER_JOB);
        let listed = &self.listed;
        if listed.len() == bodies && all.clone().all(|body| listed[body as usize].holds(&needed(body))) {
            return;
        }
        all.map(with_spare).collect_into_vec(&mut self.listed);
        self.neighbours.find(&self.listed);
    }

    /// The bodies near a body, ascending, itself among them.
    pub fn of(&self, body: u32) -> &[u32] {
        self.neighbours.of(body)
    }

    /// Forgets them.
    pub fn forget(&mut self) {
        self.listed.clear();
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.neighbours.bytes() + size_of::<Bounds>() * self.listed.capacity()
    }
}
