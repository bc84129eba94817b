//! How far cells wander: the mean squared displacement, its errors, and Fürth's law for persistent walks.

use super::statistics::{mean, standard_error};
pub use crate::cell::motility::furth;
use crate::error::{Error, Fault, Result};
use ndarray::ArrayView3;

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

/// The mean over cells and over all origins in time, eq. (analysis.5).
///
/// Displacements of one cell from neighbouring origins overlap, so each cell is first reduced to its own mean, and the
/// error is the standard error of these over the cells. Narrower than [`from_the_start`] at short lags.
///
/// * `positions` – µm, [frame, cell, axis], frames at equal intervals; NaN where a cell is not there.
/// * `interval` – time between frames, s.
/// * `lags` – in frames.
///
/// # Panics
/// When a lag reaches beyond the last frame.
pub fn over_origins(positions: ArrayView3<f64>, interval: f64, lags: &[usize]) -> Vec<Displacement> {
    let (frames, cells, _) = positions.dim();
    lags.iter()
        .map(|&lag| {
            assert!(lag < frames, "a lag of {lag} frames needs more than the {frames} frames given");
            let means: Vec<f64> = (0..cells)
                .map(|cell| {
                    let squares = (0..frames - lag).map(|origin| squared_distance(&positions, cell, origin, lag));
                    mean(&squares.filter(|square| !square.is_nan()).collect::<Vec<_>>())
                })
                .filter(|mean| !mean.is_nan())
                .collect();
            Displacement { lag: lag as f64 * interval, msd: mean(&means), error: standard_error(&means) }
        })
        .collect()
}

/// Squared distance between the positions of a cell at `origin` and `lag` frames later.
fn squared_distance(positions: &ArrayView3<f64>, cell: usize, origin: usize, lag: usize) -> f64 {
    (0..positions.dim().2)
        .map(|axis| (positions[[origin + lag, cell, axis]] - positions[[origin, cell, axis]]).powi(2))
        .sum()
}

/// Speed and persistence of a walk as its mean squared displacement tells them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PersistentWalk {
    /// Speed along a run, µm/s.
    pub speed: f64,
    /// Mean duration of a run, s.
    pub persistence: f64,
}

/// Most steps of the fit; it takes about ten.
const FIT_STEPS: usize = 200;

/// Fits Fürth's law to measured displacements by weighted least squares, eq. (analysis.6).
///
/// Levenberg and Marquardt's steps are made in the logarithms of both unknowns, which keeps them positive. Each
/// displacement is weighted by its error, or by its own size where errors are missing. Displacements at lag 0 say
/// nothing and are left out.
///
/// # Errors
/// When fewer than two lags are left, when a displacement is not positive, or when the fit does not settle, as for
/// lags that are all far shorter than the persistence.
pub fn fit_furth(displacements: &[Displacement]) -> Result<PersistentWalk> {
    let used: Vec<Displacement> = displacements.iter().copied().filter(|one| one.lag > 0.0).collect();
    if used.len() < 2 || used.iter().any(|one| one.msd.is_nan() || one.msd <= 0.0) {
        let found = format!("speed and persistence cannot be fitted to {} mean squared displacements", used.len());
        return Err(Error::input(Fault::new(found).help("give at least two lags at which the cells have moved")));
    }
    let mut unknowns = first_guess(&used);
    let (mut damping, mut misfit) = (1e-3, squared_misfit(&used, unknowns));
    for _ in 0..FIT_STEPS {
        let step = damped_step(&used, unknowns, damping);
        let tried = [unknowns[0] + step[0], unknowns[1] + step[1]];
        let tried_misfit = squared_misfit(&used, tried);
        if tried_misfit <= misfit {
            (unknowns, misfit, damping) = (tried, tried_misfit, damping / 10.0);
        } else {
            damping *= 10.0;
        }
        // A relative change of 1e-10 in both is far below any error of measurement.
        if step[0].abs().max(step[1].abs()) < 1e-10 {
            return Ok(PersistentWalk { speed: unknowns[0].exp(), persistence: unknowns[1].exp() });
        }
    }
    let found = "the fit of speed and persistence does not settle";
    Err(Error::input(Fault::new(found).help("give lags on both sides of the persistence time")))
}

/// Logarithms of a speed from the shortest lag, as if straight, and of a persistence in the middle of the lags.
fn first_guess(used: &[Displacement]) -> [f64; 2] {
    let shortest = used.iter().min_by(|a, b| a.lag.total_cmp(&b.lag)).expect("at least two");
    let longest = used.iter().max_by(|a, b| a.lag.total_cmp(&b.lag)).expect("at least two");
    [(shortest.msd.sqrt() / shortest.lag).ln(), 0.5 * (shortest.lag * longest.lag).ln()]
}

/// The error that weighs a displacement.
fn weighing_error(one: &Displacement) -> f64 {
    if one.error > 0.0 { one.error } else { one.msd }
}

fn squared_misfit(used: &[Displacement], [log_speed, log_persistence]: [f64; 2]) -> f64 {
    let expected = |one: &Displacement| furth(one.lag, log_speed.exp(), log_persistence.exp());
    used.iter().map(|one| ((one.msd - expected(one)) / weighing_error(one)).powi(2)).sum()
}

/// Solves the two damped normal equations for the change of the logarithms.
fn damped_step(used: &[Displacement], [log_speed, log_persistence]: [f64; 2], damping: f64) -> [f64; 2] {
    let (speed, persistence) = (log_speed.exp(), log_persistence.exp());
    let (mut aa, mut ab, mut bb, mut ra, mut rb) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for one in used {
        let expected = furth(one.lag, speed, persistence);
        let error = weighing_error(one);
        let by_speed = 2.0 * expected / error;
        let x = one.lag / persistence;
        let turned = 2.0 * (speed * persistence).powi(2) * x * -(-x).exp_m1();
        let by_persistence = (2.0 * expected - turned) / error;
        let residual = (one.msd - expected) / error;
        aa += by_speed * by_speed;
        ab += by_speed * by_persistence;
        bb += by_persistence * by_persistence;
        ra += by_speed * residual;
        rb += by_persistence * residual;
    }
    let (aa, bb) = (aa * (1.0 + damping), bb * (1.0 + damping));
    let determinant = aa * bb - ab * ab;
    [(ra * bb - rb * ab) / determinant, (aa * rb - ab * ra) / determinant]
}

#[cfg(test)]
#[path = "msd_tests.rs"]
mod tests;
