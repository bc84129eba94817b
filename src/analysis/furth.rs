//! Speed and persistence of walks, as Fürth's law tells them from mean squared displacements.

use super::bootstrap::{self, Estimate};
use super::msd::{Displacement, OfCells};
pub use crate::cell::motility::furth;
use crate::error::{Error, Fault, Result};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Whether positions are known as they are, or with an error that is new in every frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Localisation {
    /// Positions are exact, as those of a simulation.
    #[default]
    Exact,
    /// Positions have an error, as measured ones: it is fitted, too.
    Noisy,
}

/// Speed and persistence of a walk as its mean squared displacement tells them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PersistentWalk {
    /// Root mean square of the speed along the walk, µm/s.
    pub speed: f64,
    /// Persistence, s: the mean duration of a run, or the time in which the velocity is forgotten to 1/e.
    pub persistence: f64,
    /// What errors of localisation add to the mean squared displacement at every lag, eq. (analysis.26), µm².
    pub offset: f64,
}

impl PersistentWalk {
    /// The standard deviation of the error of localisation along each of some axes, µm.
    pub fn noise(&self, axes: usize) -> f64 {
        (self.offset / (2.0 * axes as f64)).sqrt()
    }
}

/// How far beyond the lags a persistence is looked for.
const BEYOND: f64 = 100.0;
/// Persistences in equal ratios that are tried first.
const COARSE: usize = 32;

/// Fits Fürth's law to measured displacements by weighted least squares, eq. (analysis.6).
///
/// At a given persistence the law is linear in the square of the speed and in what errors of localisation add, so these follow at once; the persistence is found by
/// trying some in equal ratios, and by the golden section about the best. Each displacement is weighted by its own size. Displacements at lag 0 say nothing and are left out.
///
/// # Errors
/// When too few lags are left, when a displacement is not positive, or when the best persistence lies far beyond the lags.
pub fn fit_furth(displacements: &[Displacement], localisation: Localisation) -> Result<PersistentWalk> {
    let used: Vec<Displacement> = displacements.iter().copied().filter(|one| one.lag > 0.0).collect();
    let least = if localisation == Localisation::Noisy { 3 } else { 2 };
    if used.len() < least || used.iter().any(|one| one.msd.is_nan() || one.msd <= 0.0) {
        let found = format!("speed and persistence cannot be fitted to {} mean squared displacements", used.len());
        return Err(Error::input(Fault::new(found).help(format!(
            "give at least {least} lags at which the cells have moved, by longer tracks or more frames"
        ))));
    }
    let shortest = used.iter().fold(f64::INFINITY, |least, one| least.min(one.lag));
    let longest = used.iter().fold(0.0, |most: f64, one| most.max(one.lag));
    let (low, high) = ((shortest / BEYOND).ln(), (longest * BEYOND).ln());
    let at = |index: usize| low + (high - low) * index as f64 / (COARSE - 1) as f64;
    let misfit = |log: f64| linear_part(&used, log.exp(), localisation).1;
    let best = (0..COARSE).min_by(|a, b| misfit(at(*a)).total_cmp(&misfit(at(*b)))).expect("some are tried");
    if best == 0 || best == COARSE - 1 {
        let kind = if best == 0 { "turn faster than the frames follow" } else { "hardly turn within the lags" };
        let fault = Fault::new(format!("the fit of speed and persistence does not settle: the cells {kind}"));
        return Err(Error::input(fault.help("give lags on both sides of the persistence time")));
    }
    let log = golden_section(misfit, at(best - 1), at(best + 1));
    let persistence = log.exp();
    let [square, offset] = linear_part(&used, persistence, localisation).0;
    Ok(PersistentWalk { speed: square.sqrt(), persistence, offset })
}

/// The square of the speed and the offset, neither negative, that suit a persistence best, and their squared misfit.
fn linear_part(used: &[Displacement], persistence: f64, localisation: Localisation) -> ([f64; 2], f64) {
    let (mut aa, mut ab, mut bb, mut ra, mut rb) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for one in used {
        let (law, rest) = (furth(one.lag, 1.0, persistence) / one.msd, 1.0 / one.msd);
        aa += law * law;
        ab += law * rest;
        bb += rest * rest;
        ra += law;
        rb += rest;
    }
    let mut parts = [ra / aa, 0.0];
    let determinant = aa * bb - ab * ab;
    if localisation == Localisation::Noisy && determinant > 0.0 {
        let both = [(ra * bb - rb * ab) / determinant, (aa * rb - ab * ra) / determinant];
        // The misfit is convex: where the offset would be negative, none is best.
        if both[1] > 0.0 {
            parts = [both[0].max(0.0), both[1]];
        }
    }
    let squares = used.iter().map(|one| {
        let expected = parts[0] * furth(one.lag, 1.0, persistence) + parts[1];
        (1.0 - expected / one.msd).powi(2)
    });
    (parts, squares.sum())
}

/// The least value of a function between two ends, to 1e-8.
fn golden_section(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let mut inner = [high - ratio * (high - low), low + ratio * (high - low)];
    let mut values = inner.map(&f);
    while high - low > 1e-8 {
        if values[0] < values[1] {
            high = inner[1];
            inner = [high - ratio * (high - low), inner[0]];
            values = [f(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + ratio * (high - low)];
            values = [values[1], f(inner[1])];
        }
    }
    0.5 * (low + high)
}

/// Speed, persistence and noise of walks with their intervals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PersistentWalkEstimate {
    /// Root mean square of the speed, µm/s.
    pub speed: Estimate,
    /// Persistence, s.
    pub persistence: Estimate,
    /// Standard deviation of the error of localisation along an axis, µm.
    pub noise: Estimate,
}

/// Fits Fürth's law to the mean of all cells, and to draws of cells for the intervals, eq. (analysis.19). Draws that cannot be fitted count as the end at which their persistence lies: they are left out, and more than a twentieth of them is an error.
///
/// * `axes` – along which positions were measured, 2 or 3.
///
/// # Errors
/// As [`fit_furth`] for all cells, or for more than a twentieth of the draws.
pub fn estimate(of: &OfCells, axes: usize, localisation: Localisation, seed: u64) -> Result<PersistentWalkEstimate> {
    let cells = of.squares.dim().1;
    let fit = |cells: &[usize]| {
        let means = of.lags.iter().zip(of.mean_of(cells));
        // Lags that only some cells have may be lacking in a draw.
        let points: Vec<Displacement> = means
            .map(|(lag, msd)| Displacement { lag: *lag, msd, error: f64::NAN })
            .filter(|one| !one.msd.is_nan())
            .collect();
        fit_furth(&points, localisation)
    };
    let all = fit(&(0..cells).collect::<Vec<_>>())?;
    let mut drawn = [Vec::new(), Vec::new(), Vec::new()];
    let mut missed = 0;
    if cells > 1 {
        bootstrap::resample(cells, bootstrap::DRAWS, seed, |cells| match fit(cells) {
            Ok(walk) => {
                let values = [walk.speed, walk.persistence, walk.noise(axes)];
                drawn.iter_mut().zip(values).for_each(|(drawn, value)| drawn.push(value));
            }
            Err(_) => missed += 1,
        });
    }
    if missed > bootstrap::DRAWS / 20 {
        let found = format!("the persistence of {missed} of {} draws of the cells cannot be told", bootstrap::DRAWS);
        return Err(Error::input(
            Fault::new(found).help("give more cells, or lags on both sides of the persistence time"),
        ));
    }
    let [speed, persistence, noise] = drawn.map(|drawn| bootstrap::interval(&drawn));
    let with = |value: f64, [low, high]: [f64; 2]| Estimate { value, low, high };
    Ok(PersistentWalkEstimate {
        speed: with(all.speed, speed),
        persistence: with(all.persistence, persistence),
        noise: with(all.noise(axes), noise),
    })
}

#[cfg(test)]
#[path = "furth_tests.rs"]
mod tests;
