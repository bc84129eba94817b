//! What all parts of surfaces do to atoms, added up in the order of parts by however many threads: each atom's sum is the same to the last bit.

use std::ops::Range;

use rayon::prelude::*;

use super::patch::{Partner, Patch, PatchPull};
use crate::Vec3;
use crate::contact::Scene;
use crate::sim::contact::together::Together;
use crate::sim::contact::tractions::ContactTractions;

/// Batches of bodies for each thread whose parts are looked at before what they do is added up.
const BATCHES_A_THREAD: usize = 4;

/// What the parts of some batches do.
#[derive(Debug, Clone, Default)]
pub struct Acting {
    of_batches: Vec<OfBatch>,
    /// The batches with atoms that they act on, ascending.
    acted_on: Vec<u32>,
}

/// What the parts of a batch do.
#[derive(Debug, Clone, Default)]
struct OfBatch {
    /// What each does, one for each part.
    pulls: Vec<Option<PatchPull>>,
    /// Where parts follow each other that the same batch attracts: that batch, the first part, and one behind the last; by batches.
    runs: Vec<(u32, u32, u32)>,
}

impl OfBatch {
    /// Finds what parts do, and which batches attract them.
    fn find(&mut self, scene: &Scene, patches: &[Patch], pull: impl Fn(usize, &Patch) -> Option<PatchPull>) {
        self.pulls.clear();
        self.pulls.extend(patches.iter().enumerate().map(|(number, patch)| pull(number, patch)));
        self.runs.clear();
        for (number, patch) in (0..).zip(patches) {
            let Partner::Facet([atom, ..], _) = patch.other else { continue };
            let batch = scene.batch_of(scene.body_of_atom(atom));
            match self.runs.last_mut() {
                Some((of, _, end)) if *of == batch && *end == number => *end += 1,
                _ => self.runs.push((batch, number, number + 1)),
            }
        }
        self.runs.sort_unstable();
    }

    /// The batches that attract parts.
    fn attracted_by(&self) -> impl Iterator<Item = u32> {
        self.runs.chunk_by(|one, next| one.0 == next.0).map(|runs| runs[0].0)
    }

    /// The runs of parts that a batch attracts.
    fn runs_of(&self, batch: u32) -> impl Iterator<Item = Range<usize>> {
        let begin = self.runs.partition_point(|(of, ..)| *of < batch);
        let runs = self.runs[begin..].iter().take_while(move |(of, ..)| *of == batch);
        runs.map(|(_, begin, end)| *begin as usize..*end as usize)
    }
}

/// Adds what all parts do, each by its batch and its number there, to the forces on atoms, and notes it.
pub fn add_forces(
    scene: &Scene,
    patches: &[Vec<Patch>],
    acting: &mut Acting,
    pull: impl Fn(usize, usize, &Patch) -> Option<PatchPull> + Sync,
    force: &mut [Vec3],
    mut noted: Option<&mut ContactTractions>,
) {
    let Acting { of_batches, acted_on } = acting;
    of_batches.resize_with(BATCHES_A_THREAD * rayon::current_num_threads(), OfBatch::default);
    let mut first = 0;
    for patches in patches.chunks(of_batches.len()) {
        let of_batches = &mut of_batches[..patches.len()];
        of_batches.par_iter_mut().zip(patches).enumerate().for_each(|(number, (of_batch, patches))| {
            let batch = first as usize + number;
            of_batch.find(scene, patches, |number, patch| pull(batch, number, patch));
        });
        acted_on.clear();
        acted_on.extend(first..first + patches.len() as u32);
        acted_on.extend(of_batches.iter().flat_map(OfBatch::attracted_by));
        acted_on.sort_unstable();
        acted_on.dedup();
        add(scene, acted_on, (first, patches), of_batches, force);
        if let Some(noted) = noted.as_deref_mut() {
            let parts = patches.iter().flatten().zip(of_batches.iter().flat_map(|of_batch| &of_batch.pulls));
            let acting = parts.filter_map(|(patch, pull)| Some((patch, pull.as_ref()?)));
            acting.for_each(|(patch, pull)| note(patch, pull, noted));
        }
        first += patches.len() as u32;
    }
}

/// Adds what parts do to the atoms of the batches that they act on, those of all at the same time: `patches` are those of the batches from
/// the `first` on.
fn add(
    scene: &Scene,
    acted_on: &[u32],
    (first, patches): (u32, &[Vec<Patch>]),
    of_batches: &[OfBatch],
    force: &mut [Vec3],
) {
    let force = Together::new(force);
    acted_on.par_iter().for_each(|&to| {
        let atoms = scene.atoms_of(to as usize);
        // SAFETY: each batch is there once, and has atoms of its own.
        let force = unsafe { force.part(atoms.clone()) };
        let mut add = |of: [u32; 3], forces: &[Vec3; 3]| {
            of.iter().zip(forces).for_each(|(atom, pull)| force[*atom as usize - atoms.start] += pull);
        };
        for (batch, (patches, of_batch)) in (first..).zip(patches.iter().zip(of_batches)) {
            let mut act = |parts: Range<usize>| {
                for (patch, pull) in patches[parts.clone()].iter().zip(&of_batch.pulls[parts]) {
                    let Some(pull) = pull else { continue };
                    if batch == to {
                        add(patch.own, &pull.on_own);
                    }
                    if let Partner::Facet(other, _) = patch.other
                        && atoms.contains(&(other[0] as usize))
                    {
                        add(other, &pull.on_other);
                    }
                }
            };
            match batch == to {
                true => act(0..patches.len()),
                false => of_batch.runs_of(to).for_each(act),
            }
        }
    });
}

/// Notes what a part does to what attracts it, with what spreads it along the other: that has no sum, but a moment.
fn note(patch: &Patch, pull: &PatchPull, noted: &mut ContactTractions) {
    let own = patch.own.into_iter().zip(pull.on_own);
    match patch.other {
        Partner::Obstacle(_) => own.for_each(|(atom, force)| noted.by_obstacle(atom, force)),
        Partner::Facet(atoms, _) => {
            own.chain(atoms.into_iter().zip(pull.on_other)).for_each(|(atom, force)| noted.by_cell(atom, force));
        }
    }
}
