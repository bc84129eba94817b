//! How far cells wander: the mean squared displacement and its errors.

use super::bootstrap;
use super::statistics::{mean, standard_error};
use ndarray::{Array2, ArrayView3};

/// A mean squared displacement with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Displacement {
    /// Lag, s.
    pub lag: f64,
    /// Mean squared displacement, µm².
    pub msd: f64,
    /// Standard error, µm²; NaN for a single cell.
    pub error: f64,
}

/// The mean over cells of the squared distance from the first frame, eq. (analysis.4). Cells that are not there in the
/// first frame, or not at a lag, do not count at that lag.
///
/// Cells that wander independently make independent squares, so the error is their standard deviation over √cells.
/// Frames need not be at equal intervals.
///
/// * `positions` – µm, [frame, cell, axis]; NaN where a cell is not there.
/// * `times` – of the frames, s.
/// * `frames` – those to measure at.
///
/// # Panics
/// When one of `frames` lies beyond the last.
pub fn from_the_start(positions: ArrayView3<f64>, times: &[f64], frames: &[usize]) -> Vec<Displacement> {
    let cells = positions.dim().1;
    frames
        .iter()
        .map(|&frame| {
            let squares = (0..cells).map(|cell| squared_distance(&positions, cell, 0, frame));
            let squares: Vec<f64> = squares.filter(|square| !square.is_nan()).collect();
            Displacement { lag: times[frame] - times[0], msd: mean(&squares), error: standard_error(&squares) }
        })
        .collect()
}

/// The mean squared displacements of each cell by itself, over all origins in time: windows that overlap.
#[derive(Debug, Clone, PartialEq)]
pub struct OfCells {
    /// Lags, s: the mean of those of all windows.
    pub lags: Vec<f64>,
    /// Means of the squared displacements, µm², [lag, cell]; NaN where a cell has no window of that lag.
    pub squares: Array2<f64>,
}

/// Windows may be this part of the interval between frames longer or shorter than their lag says.
const SLACK: f64 = 0.25;

/// Squared displacements of each cell, averaged over all pairs of frames that lie a lag apart: the brackets of eq. (analysis.5).
///
/// Frames may be at unequal intervals. A lag is a number of median intervals, from each frame the nearest one to that lag is taken, and those that
/// miss it by more than a quarter of an interval are passed over.
///
/// * `positions` – µm, [frame, cell, axis]; NaN where a cell is not there.
/// * `times` – of the frames, s.
/// * `lags` – in frames.
pub fn of_cells(positions: ArrayView3<f64>, times: &[f64], lags: &[usize]) -> OfCells {
    let cells = positions.dim().1;
    let interval = median_interval(times);
    let mut found = OfCells { lags: Vec::with_capacity(lags.len()), squares: Array2::zeros((lags.len(), cells)) };
    for (row, &lag) in lags.iter().enumerate() {
        let windows = windows(times, lag as f64 * interval, SLACK * interval);
        let mean_lag = mean(&windows.iter().map(|[from, to]| times[*to] - times[*from]).collect::<Vec<_>>());
        found.lags.push(mean_lag);
        for cell in 0..cells {
            let squares = windows.iter().map(|[from, to]| squared_distance(&positions, cell, *from, *to));
            found.squares[[row, cell]] = mean(&squares.filter(|square| !square.is_nan()).collect::<Vec<_>>());
        }
    }
    found
}

/// The median time between frames, s; NaN for fewer than two.
pub fn median_interval(times: &[f64]) -> f64 {
    let mut intervals: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    intervals.sort_by(f64::total_cmp);
    intervals.get(intervals.len().saturating_sub(1) / 2).copied().unwrap_or(f64::NAN)
}

/// For each frame the one nearest to a lag later, where there is one within the slack.
fn windows(times: &[f64], lag: f64, slack: f64) -> Vec<[usize; 2]> {
    let end = |from: usize| {
        let due = times[from] + lag;
        let after = times.partition_point(|time| *time < due);
        let away = |frame: &usize| (times[*frame] - due).abs();
        let near = after.saturating_sub(1)..(after + 1).min(times.len());
        near.min_by(|a, b| away(a).total_cmp(&away(b))).filter(|frame| away(frame) <= slack)
    };
    (0..times.len()).filter_map(|from| Some([from, end(from)?])).collect()
}

impl OfCells {
    /// The mean over some cells, by their numbers, at each lag; NaN where none of them has a window.
    pub fn mean_of(&self, cells: &[usize]) -> Vec<f64> {
        let of_row = |row: ndarray::ArrayView1<f64>| {
            let (mut sum, mut number) = (0.0, 0_usize);
            for value in cells.iter().map(|cell| row[*cell]).filter(|value| !value.is_nan()) {
                sum += value;
                number += 1;
            }
            sum / number as f64
        };
        self.squares.rows().into_iter().map(of_row).collect()
    }

    /// The mean over cells with its standard error at each lag, eq. (analysis.5). Displacements of one cell from neighbouring origins overlap, so the
    /// error is that of the means of cells.
    pub fn displacements(&self) -> Vec<Displacement> {
        let of_row = |(row, lag): (ndarray::ArrayView1<f64>, &f64)| {
            let means: Vec<f64> = row.iter().copied().filter(|mean| !mean.is_nan()).collect();
            Displacement { lag: *lag, msd: mean(&means), error: standard_error(&means) }
        };
        self.squares.rows().into_iter().zip(&self.lags).map(of_row).collect()
    }

    /// The interval of the mean at each lag by the bootstrap over cells.
    pub fn intervals(&self, seed: u64) -> Vec<[f64; 2]> {
        let mut drawn = vec![Vec::new(); self.lags.len()];
        bootstrap::resample(self.squares.dim().1, bootstrap::DRAWS, seed, |cells| {
            for (drawn, mean) in drawn.iter_mut().zip(self.mean_of(cells)) {
                drawn.push(mean);
            }
        });
        drawn.iter().map(|drawn| bootstrap::interval(drawn)).collect()
    }
}

/// Squared distance between the positions of a cell in two frames.
fn squared_distance(positions: &ArrayView3<f64>, cell: usize, from: usize, to: usize) -> f64 {
    (0..positions.dim().2).map(|axis| (positions[[to, cell, axis]] - positions[[from, cell, axis]]).powi(2)).sum()
}

#[cfg(test)]
#[path = "msd_tests.rs"]
mod tests;
