//! What forces depend on beside positions: time, and what chemistry or a program sets of them by their names.

use std::ops::Range;

use super::lanes::LANES;

/// A kind of force of which a number can be set, as `cell.load[NAME]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Handle {
    /// Its word, `load`.
    pub word: &'static str,
    /// The key of documents that lists such forces, `loads`.
    pub key: &'static str,
    /// The least and the most that may be set.
    pub range: [f64; 2],
    /// What may be set, in words.
    pub expected: &'static str,
    /// The number that stands where nothing is set.
    pub unset: f64,
}

impl Handle {
    /// Whether a number may be set.
    pub fn allows(&self, value: f64) -> bool {
        (self.range[0]..=self.range[1]).contains(&value)
    }
}

/// What forces on a block of cells depend on beside positions.
#[derive(Debug, Clone)]
pub struct Context<'a> {
    /// Time, s.
    pub time: f64,
    /// Mass of an atom, pN·s²/µm.
    pub mass: f64,
    /// The cells of the lanes, in the order of the lists below; lanes beyond the last are empty.
    pub cells: Range<usize>,
    /// Factor of the elastic forces of every cell; empty where all are 1.
    pub stiffness: &'a [f64],
    /// What is set of forces: for each handle a list of such forces in the order of a kind, and of each a number for each cell. What
    /// is missing is not set.
    pub controls: &'a [Vec<Vec<f64>>],
}

impl Context<'_> {
    /// A time at which nothing is set; atoms have the mass 1.
    pub fn at(time: f64) -> Self {
        Self { time, mass: 1.0, cells: 0..0, stiffness: &[], controls: &[] }
    }

    /// What is set in each lane of the force of this number among those with a handle of this number.
    pub(super) fn control(&self, handle: usize, number: usize, unset: f64) -> [f64; LANES] {
        let set = self.controls.get(handle).and_then(|forces| forces.get(number));
        set.map_or([unset; LANES], |list| self.in_lanes(list, unset))
    }

    /// Factors of the elastic forces, lane by lane.
    pub(super) fn stiffness(&self) -> [f64; LANES] {
        self.in_lanes(self.stiffness, 1.0)
    }

    fn in_lanes(&self, list: &[f64], empty: f64) -> [f64; LANES] {
        let mut lanes = [empty; LANES];
        let own = list.get(self.cells.clone()).unwrap_or_default();
        lanes.iter_mut().zip(own).for_each(|(lane, number)| *lane = *number);
        lanes
    }
}
