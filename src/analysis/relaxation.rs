//! The time in which a curve comes to rest: the fit of an exponential, or of the recovery of a red cell's length over width.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How something comes to rest, eq. (analysis.40).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Law {
    /// As an exponential.
    #[default]
    Exponential,
    /// As the length over width of a membrane that keeps its area.
    LengthOverWidth,
}

/// A fit by least squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relaxation {
    /// The time τ, in the unit of the times.
    pub time: f64,
    /// Where the curve comes to rest.
    pub end: f64,
    /// Root mean square of what the curve is off, in its unit.
    pub off: f64,
}

/// Times τ that are looked at first, from a tenth of the mean interval to ten times the whole.
const FIRST: usize = 60;

/// Sizes Λ that are looked at first.
const SIZES: usize = 24;

/// Rounds of the golden section.
const ROUNDS: usize = 60;

/// Fits a curve by least squares with time, size and end free; `None` where fewer than four points are given, and where the best time is at an end
/// of what is looked at, so that nothing tells it.
pub fn fit(law: Law, times: &[f64], values: &[f64]) -> Option<Relaxation> {
    let (first, last) = (*times.first()?, *times.last()?);
    if times.len() < 4 || last <= first {
        return None;
    }
    let whole = last - first;
    let bounds = [0.1 * whole / times.len() as f64, 10.0 * whole].map(f64::ln);
    let at = |log: f64| -> Relaxation {
        let time = log.exp();
        let shares: Vec<f64> = times.iter().map(|t| (-(t - first) / time).exp()).collect();
        let (off, end) = match law {
            Law::Exponential => line(&shares, values),
            Law::LengthOverWidth => length_over_width(&shares, values),
        };
        Relaxation { time, end, off }
    };
    let best = least(bounds, FIRST, |log| at(log).off);
    let inside = (best - bounds[0]).min(bounds[1] - best) > 0.01 * (bounds[1] - bounds[0]);
    Some(at(best)).filter(|found| inside && found.off.is_finite())
}

/// Root mean square of what a line through these points is off, and where it is at 0.
fn line(x: &[f64], y: &[f64]) -> (f64, f64) {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mx, my) = (mean(x), mean(y));
    let (mut along, mut squared) = (0.0, 0.0);
    for (x, y) in x.iter().zip(y) {
        along += (x - mx) * (y - my);
        squared += (x - mx) * (x - mx);
    }
    let slope = along / squared;
    let end = my - slope * mx;
    let off = x.iter().zip(y).map(|(x, y)| (y - end - slope * x).powi(2)).sum::<f64>();
    ((off / x.len() as f64).sqrt(), end)
}

/// The same for r = r∞ (1 + Λ s)/(1 − Λ s), with the best Λ.
fn length_over_width(shares: &[f64], values: &[f64]) -> (f64, f64) {
    let with = |size: f64| -> (f64, f64) {
        let shape = |share: &f64| (1.0 + size * share) / (1.0 - size * share);
        let (mut along, mut squared) = (0.0, 0.0);
        for (share, value) in shares.iter().zip(values) {
            along += shape(share) * value;
            squared += shape(share) * shape(share);
        }
        let end = along / squared;
        let off = shares.iter().zip(values).map(|(share, value)| (value - end * shape(share)).powi(2)).sum::<f64>();
        ((off / values.len() as f64).sqrt(), end)
    };
    with(least([-0.95, 0.95], SIZES, |size| with(size).0))
}

/// Where a function is least between two ends: the best of some points, and the golden section around it.
fn least([low, high]: [f64; 2], points: usize, of: impl Fn(f64) -> f64) -> f64 {
    let step = (high - low) / points as f64;
    let point = |number: usize| low + step * number as f64;
    let best = (0..=points).min_by(|a, b| of(point(*a)).total_cmp(&of(point(*b)))).map_or(low, point);
    let (mut low, mut high) = ((best - step).max(low), (best + step).min(high));
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..ROUNDS {
        let (one, other) = (high - share * (high - low), low + share * (high - low));
        if of(one) <= of(other) { high = other } else { low = one }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times() -> Vec<f64> {
        (0..25).map(|i| 3.0 + 0.4 * f64::from(i) / 24.0).collect()
    }

    #[test]
    fn times_are_found_whatever_size_and_end() {
        for (time, size, end) in [(0.126, 0.32, 1.1), (0.05, -0.2, 2.0), (0.3, 0.5, 1.0)] {
            let share = |t: &f64| size * (-(t - 3.0) / time).exp();
            let exponential: Vec<f64> = times().iter().map(|t| end + share(t)).collect();
            let found = fit(Law::Exponential, &times(), &exponential).unwrap();
            assert!((found.time / time - 1.0).abs() < 1e-6 && (found.end - end).abs() < 1e-6, "{found:?}");
            let ratio: Vec<f64> = times().iter().map(|t| end * (1.0 + share(t)) / (1.0 - share(t))).collect();
            let found = fit(Law::LengthOverWidth, &times(), &ratio).unwrap();
            assert!((found.time / time - 1.0).abs() < 1e-4 && (found.end - end).abs() < 1e-4, "{found:?}");
            assert!(found.off < 1e-6);
        }
    }

    #[test]
    fn what_does_not_come_to_rest_has_no_time() {
        let line: Vec<f64> = times().iter().map(|t| 2.0 - t).collect();
        assert_eq!(fit(Law::Exponential, &times(), &line), None);
        assert_eq!(fit(Law::Exponential, &times(), &[1.0; 25]), None);
        assert_eq!(fit(Law::Exponential, &times()[..3], &line[..3]), None);
    }
}
