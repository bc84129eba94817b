//! The profile of the likelihood along a parameter: how far it can go until χ², with all others as good as they can be, has risen too much.

use super::solve::{Iterate, Minimum, Search, minimise};
use crate::error::Result;

/// What is profiled.
pub struct Profile<'a> {
    /// How minima are sought; what is free of it is not looked at.
    pub search: Search<'a>,
    /// The minimum.
    pub minimum: &'a Minimum,
    /// The rise of χ² at which an interval ends, eq. (fit.7).
    pub rise: f64,
}

/// One end of an interval.
#[derive(Debug, Clone, PartialEq)]
pub struct End {
    /// Where it is, as a share; none where χ² does not rise that much up to the bound.
    pub at: Option<f64>,
    /// Points of the profile on the way, each with χ².
    pub points: Vec<[f64; 2]>,
    /// A point of less χ² than the minimum, should one be met.
    pub better: Option<Vec<f64>>,
}

/// An end is known once χ² there has this share of its rise, or so much more: 1 % of the distance.
const NEAR: f64 = 0.02;
/// Most points of one side.
const MOST_POINTS: usize = 14;
/// What counts as less χ² than at the minimum, as a share of the rise: what adaptive steps leave is less.
const BETTER: f64 = 0.02;

/// Which way to go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// To less.
    Below,
    /// To more.
    Above,
}

/// Finds an end of the interval of a parameter.
///
/// * `error` – its standard error, as a share, which tells where to look first
///
/// # Errors
/// Those of the residuals.
pub fn end(profile: &Profile, axis: usize, side: Side, error: f64) -> Result<End> {
    let from = &profile.minimum.at;
    let start = from.point[axis];
    let (sign, margin) = match side {
        Side::Below => (-1.0, start),
        Side::Above => (1.0, 1.0 - start),
    };
    let mut found = End { at: None, points: Vec::new(), better: None };
    let mut others = from.point.clone();
    // Distances with the square root of the share of the rise that χ² has there, which grows evenly where χ² is a parabola.
    let (mut inside, mut outside): ([f64; 2], Option<[f64; 2]>) = ([0.0, 0.0], None);
    let first = profile.rise.sqrt() * error;
    let mut away = if first.is_finite() { first.min(margin) } else { 0.25 * margin };
    for _ in 0..MOST_POINTS {
        if away <= 0.0 {
            break;
        }
        let share = if away >= margin { f64::from(side == Side::Above) } else { start + sign * away };
        let Some(at) = best_of_others(profile, axis, share, &others)? else {
            // The model fails there: what lies beyond is not known.
            outside = Some([away, 2.0]);
            away = 0.5 * (inside[0] + away);
            continue;
        };
        found.points.push([share, at.chi2]);
        others.clone_from(&at.point);
        let share_of_rise = (at.chi2 - from.chi2) / profile.rise;
        if share_of_rise < -BETTER {
            found.better = Some(at.point);
            return Ok(found);
        }
        let root = share_of_rise.max(0.0).sqrt();
        if (share_of_rise - 1.0).abs() <= NEAR {
            found.at = Some(share + sign * away * (1.0 / root - 1.0));
            return Ok(found);
        }
        match root < 1.0 {
            true if away >= margin => return Ok(found),
            true => inside = [away, root],
            false => outside = Some([away, root]),
        }
        away = next(inside, outside, margin);
    }
    // What was met last on both sides is between points some per cent apart at most.
    found.at = outside.map(|outside| start + sign * between(inside, outside));
    Ok(found)
}

/// Where to look next.
fn next(inside: [f64; 2], outside: Option<[f64; 2]>, margin: f64) -> f64 {
    let Some(outside) = outside else {
        // Never more than four times as far: what is flat here need not be so there.
        return (inside[0] * (1.02 / inside[1]).clamp(1.2, 4.0)).min(margin);
    };
    let width = outside[0] - inside[0];
    between(inside, outside).clamp(inside[0] + 0.05 * width, outside[0] - 0.05 * width)
}

/// The distance at which χ² has its rise, by a straight line through two.
fn between(inside: [f64; 2], outside: [f64; 2]) -> f64 {
    inside[0] + (1.0 - inside[1]) * (outside[0] - inside[0]) / (outside[1] - inside[1])
}

/// The least χ² with a parameter held.
fn best_of_others(profile: &Profile, axis: usize, share: f64, others: &[f64]) -> Result<Option<Iterate>> {
    let mut start = others.to_vec();
    start[axis] = share;
    let free: Vec<usize> = (0..start.len()).filter(|other| *other != axis).collect();
    let search = Search { free: &free, tell: &|_| (), ..profile.search };
    Ok(minimise(&search, &start)?.map(|minimum| minimum.at))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ends of the interval of the first parameter of a model in the unit square, at a rise of 3.84.
    fn ends(model: &(dyn Fn(&[f64]) -> Vec<f64> + Sync), start: &[f64]) -> [End; 2] {
        let residuals = |points: &[Vec<f64>]| Ok(points.iter().map(|point| Some(model(point))).collect());
        let (steps, free) = (vec![0.01; start.len()], (0..start.len()).collect::<Vec<_>>());
        let search = Search { residuals: &residuals, steps: &steps, free: &free, tell: &|_| () };
        let minimum = minimise(&search, start).unwrap().unwrap();
        let error = crate::study::fit::uncertainty::covariance(&minimum, 1.0).errors[0];
        let profile = Profile { search, minimum: &minimum, rise: 3.84 };
        [Side::Below, Side::Above].map(|side| end(&profile, 0, side, error).unwrap())
    }

    #[test]
    fn of_a_line_the_profile_ends_where_the_covariance_does() {
        // JᵀJ = [[200, 100], [100, 200]]: the first parameter has a variance of 2/300.
        let model = |at: &[f64]| vec![10.0 * (at[0] - 0.5), 10.0 * (at[1] - 0.5), 10.0 * (at[0] + at[1] - 1.0)];
        let away = (3.84_f64 * 2.0 / 300.0).sqrt();
        let [low, high] = ends(&model, &[0.3, 0.3]).map(|end| end.at.unwrap());
        assert!((low - 0.5 + away).abs() < 0.01 * away && (high - 0.5 - away).abs() < 0.01 * away, "{low} {high}");
    }

    #[test]
    fn of_a_bent_law_the_profile_is_lopsided_where_the_covariance_is_not() {
        // 20 (x² - 0.09) is ±1.96 at x² = 0.188 and -0.008, which is nowhere: no end below.
        let model = |at: &[f64]| vec![20.0 * (at[0] * at[0] - 0.09)];
        let [low, high] = ends(&model, &[0.4]);
        assert_eq!(low.at, None);
        assert!((high.at.unwrap() - (0.09_f64 + 3.84_f64.sqrt() / 20.0).sqrt()).abs() < 0.002, "{high:?}");
    }

    #[test]
    fn a_parameter_that_others_make_up_for_has_no_ends() {
        let model = |at: &[f64]| vec![10.0 * (at[0] + at[1] - 1.0)];
        let found = ends(&model, &[0.3, 0.3]);
        assert!(found.iter().all(|end| end.at.is_none() && end.better.is_none()), "{found:?}");
    }

    #[test]
    fn a_deeper_minimum_on_the_way_is_told() {
        // Minima near 0.2 and 0.8, the second of which is the deeper one; between them χ² rises by less than 3.84.
        let model = |at: &[f64]| vec![12.0 * (at[0] - 0.2) * (at[0] - 0.8), 1.0 - at[0]];
        let [_, high] = ends(&model, &[0.15]);
        assert!(high.better.as_ref().is_some_and(|better| better[0] > 0.6), "{high:?}");
    }
}
