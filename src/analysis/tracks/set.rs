//! Some tracks on common frames, whether they were simulated or measured.

use crate::analysis::msd;
use crate::analysis::recording::Recording;
use crate::analysis::waves;
use crate::error::{Error, Fault, Result};
use ndarray::{Array3, Axis, Slice};

/// Tracks of cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Tracks {
    /// Times of the frames, s, ascending.
    pub times: Vec<f64>,
    /// What each track is called.
    pub names: Vec<String>,
    /// The type of each track's cell; empty where it is not known.
    pub types: Vec<String>,
    /// Positions, µm, [frame, track, axis]; NaN where a cell is not there or was not found. Two axes in the plane, three in space.
    pub positions: Array3<f64>,
}

impl Tracks {
    /// The tracks of the cells of a type, or of all cells, of a run, in space.
    ///
    /// # Errors
    /// When there is no such type or no such cell, or positions were not read.
    pub fn of(recording: &Recording, kind: Option<&str>) -> Result<Self> {
        let cells = recording.cells_of(kind)?;
        let name = |cell: &usize| recording.ids.get(*cell).map_or_else(|| cell.to_string(), u64::to_string);
        let kind = |cell: &usize| recording.types[recording.cell_types[*cell] as usize].clone();
        Ok(Self {
            times: recording.times.clone(),
            names: cells.iter().map(name).collect(),
            types: cells.iter().map(kind).collect(),
            positions: recording.positions(&cells)?,
        })
    }

    /// Number of tracks.
    pub fn number(&self) -> usize {
        self.names.len()
    }

    /// Number of axes.
    pub fn axes(&self) -> usize {
        self.positions.dim().2
    }

    /// The same tracks along the first axes alone.
    pub fn along(mut self, axes: usize) -> Self {
        let axes = axes.min(self.axes());
        self.positions.slice_axis_inplace(Axis(2), Slice::from(..axes));
        self
    }

    /// The tracks of one type of cells.
    ///
    /// # Errors
    /// When no track has that type.
    pub fn of_type(self, kind: &str) -> Result<Self> {
        let chosen: Vec<usize> = (0..self.number()).filter(|track| self.types[*track] == kind).collect();
        if chosen.is_empty() {
            let mut known: Vec<&str> = self.types.iter().map(String::as_str).filter(|kind| !kind.is_empty()).collect();
            known.sort_unstable();
            known.dedup();
            let help = match known.is_empty() {
                true => "they have no types: a column TYPE would say them".to_owned(),
                false => format!("their types are {}", known.join(", ")),
            };
            return Err(Error::input(Fault::new(format!("no track is of the type \"{kind}\"")).help(help)));
        }
        let of = |texts: &[String]| chosen.iter().map(|track| texts[*track].clone()).collect();
        let positions = self.positions.select(Axis(1), &chosen);
        Ok(Self { names: of(&self.names), types: of(&self.types), positions, times: self.times })
    }

    /// The part of the tracks from one time to another, s.
    ///
    /// # Errors
    /// When fewer than two frames lie there.
    pub fn between(mut self, from: Option<f64>, to: Option<f64>) -> Result<Self> {
        let first = waves::first_frame(&self.times, from);
        // Round-off of a sum of steps does not cost a frame.
        let slack = 1e-9 * self.times.last().map_or(0.0, |last| last.abs());
        let end = to.map_or(self.times.len(), |to| self.times.partition_point(|time| *time <= to + slack));
        if end < first + 2 {
            let found = format!("the path of cells is not known from {} frames", end.saturating_sub(first));
            return Err(Error::input(Fault::new(found).help("give times with two frames or more between them")));
        }
        self.times = self.times[first..end].to_vec();
        self.positions.slice_axis_inplace(Axis(0), Slice::from(first..end));
        Ok(self)
    }

    /// The median time between frames, s.
    pub fn interval(&self) -> f64 {
        msd::median_interval(&self.times)
    }

    /// The frames in which a track has a position, in order.
    pub fn frames_of(&self, track: usize) -> impl DoubleEndedIterator<Item = usize> + '_ {
        (0..self.times.len()).filter(move |frame| !self.positions[[*frame, track, 0]].is_nan())
    }

    /// Where a track is in a frame, µm; along axes that it does not have 0.
    pub fn position(&self, frame: usize, track: usize) -> [f64; 3] {
        std::array::from_fn(|axis| if axis < self.axes() { self.positions[[frame, track, axis]] } else { 0.0 })
    }

    /// The lags, in frames, at which displacements are looked at where nobody says which: one to a quarter of the frames.
    pub fn usual_lags(&self) -> Vec<usize> {
        (1..=(self.times.len().saturating_sub(1) / 4).max(1)).collect()
    }
}
