//! Where reactions plug in: a function that moves the values of all species at some points by a step of time.

use rayon::iter::{IndexedParallelIterator, IntoParallelRefMutIterator, ParallelIterator};

use super::grid::Grid;
use super::reactor_scratch::ReactorScratch;
use super::rows::ROW;
use super::species::Species;
use crate::equations::Range;
use crate::equations::program::Lanes;

/// Points that react at a time; a multiple of every processor's lanes.
pub const POINTS: usize = 256;

/// Points of a field with the values of all species there.
pub struct Chunk<'a> {
    /// `[species][point]`, rows of [`POINTS`]. Rows are full: after the last point its values are repeated.
    pub values: &'a mut [f64],
    /// Number of points that count.
    pub points: usize,
    /// Index in memory of the first point; see [`Grid::centre`].
    pub first: usize,
    /// Time at the start of the step, s.
    pub time: f64,
    /// The step, s.
    pub dt: f64,
    /// What the reactions of a document work in; nobody else has it while the chunk is.
    pub(super) scratch: &'a mut Option<Box<ReactorScratch>>,
    /// Registers of what noise works in.
    pub(super) kicks: &'a mut Vec<Lanes<ROW>>,
}

/// What the boxes of one part of a grid need while they react.
#[derive(Debug, Clone)]
pub struct PartScratch {
    /// The values of a chunk.
    values: Vec<f64>,
    reactor: Option<Box<ReactorScratch>>,
    kicks: Vec<Lanes<ROW>>,
}

impl PartScratch {
    /// Scratch for so many species.
    pub fn new(species: usize) -> Self {
        Self { values: vec![0.0; species * POINTS], reactor: None, kicks: Vec::new() }
    }

    /// Writes NaN over all numbers.
    pub fn poison(&mut self) {
        self.values.fill(f64::NAN);
        self.reactor = None;
        self.kicks.fill([f64::NAN; ROW]);
    }
}

impl Chunk<'_> {
    /// The values of each species.
    ///
    /// # Panics
    /// If there are not N species.
    pub fn rows<const N: usize>(&mut self) -> [&mut [f64]; N] {
        assert_eq!(self.values.len(), N * POINTS, "number of species");
        let mut rows = self.values.chunks_exact_mut(POINTS);
        std::array::from_fn(|_| rows.next().expect("as many rows as species"))
    }
}

/// Moves the values of a chunk from its time by its step, as exactly as one likes and at least second order. It is
/// called from several threads, for the chunks of a grid in any order, and must not depend on that.
pub type React<'a> = dyn Fn(&mut Chunk) + Sync + 'a;

/// Lets all points react. What would fall below zero and may not is set to zero.
pub fn react(
    grid: &Grid,
    species: &[Species],
    function: &React,
    (time, dt): (f64, f64),
    values: &mut [f64],
    parts: &mut [PartScratch],
) {
    let (len, count) = (grid.len(), parts.len());
    let chunks = len.div_ceil(POINTS);
    let shared = super::shared::Shared::new(values);
    let work = |(part, PartScratch { values, reactor, kicks }): (usize, &mut PartScratch)| {
        for chunk in part * chunks / count..(part + 1) * chunks / count {
            let first = chunk * POINTS;
            let points = POINTS.min(len - first);
            // SAFETY: no other part has these points.
            let row = |s: usize| unsafe { shared.part(s * len + first, points) };
            for (s, to) in values.chunks_exact_mut(POINTS).enumerate() {
                let from = row(s);
                to[..points].copy_from_slice(from);
                to[points..].fill(from[points - 1]);
            }
            function(&mut Chunk { values: &mut values[..], points, first, time, dt, scratch: &mut *reactor, kicks });
            for (s, from) in values.chunks_exact(POINTS).enumerate() {
                let floor = if species[s].range == Range::NonNegative { 0.0 } else { f64::NEG_INFINITY };
                for (to, from) in row(s).iter_mut().zip(from) {
                    // A value that is not a number stays so, to be found.
                    *to = if *from < floor { floor } else { *from };
                }
            }
        }
    };
    if chunks >= 8 && rayon::current_num_threads() > 1 {
        parts.par_iter_mut().enumerate().for_each(work);
    } else {
        parts.iter_mut().enumerate().for_each(work);
    }
}
