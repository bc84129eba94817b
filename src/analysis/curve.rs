//! A simulated curve beside measured points: how near it comes, and how many error bars it meets.

use super::statistics::{interpolate, mean};
use crate::error::{Error, Fault, Result};

/// A curve y(x) with x ascending, made of the points of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    x: Vec<f64>,
    y: Vec<f64>,
}

/// Two x are the same when they differ by at most this share of the range of x: the round-off of a held load.
const SAME_X: f64 = 1e-9;

/// Number of held values of x that make a staircase.
const STAIRS: usize = 3;

impl Curve {
    /// Orders points, given in the order of time, by x. Of points at the same x the last in time counts: where a load
    /// is held, that is the end of the hold, when the cell has settled. When x is a staircase, which holds three values
    /// or more for two frames or longer, the frames from one hold to the next do not count, for there the
    /// cell lags behind its load; the first frame, before anything happened, does. Points that are not finite are left
    /// out.
    ///
    /// # Panics
    /// When x and y differ in number.
    pub fn new(x: &[f64], y: &[f64]) -> Self {
        assert_eq!(x.len(), y.len(), "each x needs its y");
        let finite: Vec<usize> = (0..x.len()).filter(|&i| x[i].is_finite() && y[i].is_finite()).collect();
        let (least, most) = finite
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &i| (least.min(x[i]), most.max(x[i])));
        let same = |a: f64, b: f64| (a - b).abs() <= SAME_X * (most - least);
        let holds: Vec<&[usize]> = finite.chunk_by(|&a, &b| same(x[a], x[b])).collect();
        let stairs = holds.iter().filter(|hold| hold.len() > 1).count() >= STAIRS;
        let counts = |(index, hold): &(usize, &[usize])| !stairs || *index == 0 || hold.len() > 1;
        let mut ends: Vec<usize> =
            holds.iter().copied().enumerate().filter(counts).map(|(_, hold)| hold[hold.len() - 1]).collect();
        ends.sort_by(|&a, &b| x[a].total_cmp(&x[b]));
        let groups = ends.chunk_by(|&a, &b| same(x[a], x[b]));
        let (x, y) = groups.filter_map(|group| group.iter().max()).map(|&last| (x[last], y[last])).unzip();
        Self { x, y }
    }

    /// The points, x ascending.
    pub fn points(&self) -> impl Iterator<Item = [f64; 2]> {
        self.x.iter().zip(&self.y).map(|(x, y)| [*x, *y])
    }

    /// The points with x between two ends, which count themselves even when round-off has moved them a little outside.
    pub fn between(&self, from: Option<f64>, to: Option<f64>) -> impl Iterator<Item = [f64; 2]> {
        let slack = self.slack();
        let within = move |x: f64| from.is_none_or(|from| from - slack <= x) && to.is_none_or(|to| x <= to + slack);
        self.points().filter(move |[x, _]| within(*x))
    }

    /// How far from an end of the curve an x may lie and still be meant to be that end.
    fn slack(&self) -> f64 {
        SAME_X * self.x.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
    }

    /// The curve at each measured point that is not NaN, with the number of its row.
    ///
    /// # Errors
    /// When a measured point lies outside of the curve, or none is left.
    fn at_rows(&self, abscissas: &[f64], values: &[f64]) -> Result<Vec<(usize, f64)>> {
        let rows = (0..abscissas.len()).filter(|&row| !abscissas[row].is_nan() && !values[row].is_nan());
        let found: Result<Vec<(usize, f64)>> = rows.map(|row| self.at(abscissas[row]).map(|y| (row, y))).collect();
        let found = found?;
        if found.is_empty() {
            let fault = Fault::new("the measured table has no row to compare with");
            return Err(Error::input(fault.help("name columns that hold numbers")));
        }
        Ok(found)
    }

    /// The curve at an x, between its points along straight lines.
    ///
    /// # Errors
    /// When x lies outside of the curve.
    pub fn at(&self, abscissa: f64) -> Result<f64> {
        let last = self.x.len().saturating_sub(1);
        // Rounded time courses may end short of the last measured point by a few units in the last digit.
        let slack = self.slack();
        let near = match (self.x.first(), self.x.get(last)) {
            (Some(&first), Some(&end)) if first - slack <= abscissa && abscissa <= end + slack => {
                abscissa.clamp(first, end)
            }
            _ => abscissa,
        };
        interpolate(&self.x, &self.y, near).ok_or_else(|| {
            let reach = match (self.x.first(), self.x.get(last)) {
                (Some(first), Some(end)) => format!("runs from {first} to {end}"),
                _ => "has no points".to_owned(),
            };
            let fault =
                Fault::new(format!("the simulated curve {reach} and does not reach the measured x = {abscissa}"));
            Error::input(fault.help("simulate as far as was measured, or give a table without that row"))
        })
    }

    /// The curve over what was measured, for each row.
    fn ratios(&self, abscissas: &[f64], values: &[f64]) -> Result<Vec<f64>> {
        let found = self.at_rows(abscissas, values)?;
        if let Some((row, _)) = found.iter().find(|(row, _)| values[*row] == 0.0) {
            let fault =
                Fault::new(format!("nothing can be told relative to the measured 0 at x = {}", abscissas[*row]));
            return Err(Error::input(fault.help("give a table without that row, or compare with its bars")));
        }
        Ok(found.into_iter().map(|(row, y)| y / values[row]).collect())
    }

    /// Root mean square of (curve − measured)/measured, eq. (analysis.7).
    ///
    /// # Errors
    /// When a measured point lies outside of the curve, a measured value is 0 or no row has numbers.
    pub fn relative_rms(&self, abscissas: &[f64], values: &[f64]) -> Result<f64> {
        let squares: Vec<f64> = self.ratios(abscissas, values)?.iter().map(|ratio| (ratio - 1.0).powi(2)).collect();
        Ok(mean(&squares).sqrt())
    }

    /// Mean of curve/measured.
    ///
    /// # Errors
    /// As [`Curve::relative_rms`].
    pub fn mean_ratio(&self, abscissas: &[f64], values: &[f64]) -> Result<f64> {
        Ok(mean(&self.ratios(abscissas, values)?))
    }

    /// Number of rows whose bar from `low` to `high` holds the curve, ends included.
    ///
    /// # Errors
    /// When a measured point lies outside of the curve or no row has numbers.
    pub fn rows_within(&self, abscissas: &[f64], low: &[f64], high: &[f64]) -> Result<usize> {
        let found = self.at_rows(abscissas, low)?;
        Ok(found.iter().filter(|&&(row, y)| low[row] <= y && y <= high[row]).count())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_a_hold_counts() {
        let curve = Curve::new(&[2.0, 0.0, 1.0 + 1e-12, 1.0, f64::NAN], &[8.0, 0.0, 3.0, 4.0, 1.0]);
        assert_eq!(curve.points().collect::<Vec<_>>(), [[0.0, 0.0], [1.0, 4.0], [2.0, 8.0]]);
    }

    #[test]
    fn frames_between_the_holds_of_a_staircase_do_not_count() {
        let x = [0.0, 1.0, 2.0, 2.0, 3.0, 4.0, 4.0 + 1e-12, 5.0, 6.0, 6.0, 7.0];
        let y = [0.0, 0.1, 1.0, 2.0, 2.1, 3.0, 4.0, 4.1, 5.0, 6.0, 6.1];
        let curve = Curve::new(&x, &y);
        assert_eq!(curve, Curve { x: vec![0.0, 2.0, 4.0 + 1e-12, 6.0], y: vec![0.0, 2.0, 4.0, 6.0] });
        // A load that rests, rises steadily and rests again is no staircase: its rise is what was asked for.
        let slow = Curve::new(&[0.0, 0.0, 1.0, 2.0, 3.0, 3.0], &[0.0, 0.0, 1.0, 2.0, 2.9, 3.0]);
        assert_eq!(slow, Curve { x: vec![0.0, 1.0, 2.0, 3.0], y: vec![0.0, 1.0, 2.0, 3.0] });
    }

    #[test]
    fn a_load_taken_off_again_counts_as_it_came_back() {
        let curve = Curve::new(&[0.0, 1.0, 2.0, 1.0, 0.0], &[0.0, 1.0, 2.0, 1.5, 0.5]);
        assert_eq!(curve, Curve { x: vec![0.0, 1.0, 2.0], y: vec![0.5, 1.5, 2.0] });
    }

    #[test]
    fn distances_are_relative_to_what_was_measured() {
        let curve = Curve::new(&[0.0, 10.0], &[0.0, 20.0]);
        // The curve has 10 and 20 there, a tenth less and a tenth more than measured.
        let (abscissas, values) = ([5.0, f64::NAN, 10.0], [10.0 / 0.9, 1.0, 20.0 / 1.1]);
        assert!((curve.relative_rms(&abscissas, &values).unwrap() - 0.1).abs() < 1e-14);
        assert!((curve.mean_ratio(&abscissas, &values).unwrap() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_measured_zero_has_no_relative_distance() {
        let curve = Curve::new(&[0.0, 10.0], &[0.0, 20.0]);
        let message = curve.relative_rms(&[0.0, 10.0], &[0.0, 20.0]).unwrap_err().to_string();
        assert_eq!(message, "nothing can be told relative to the measured 0 at x = 0");
        assert!(curve.mean_ratio(&[0.0, 10.0], &[0.0, 20.0]).is_err());
        assert_eq!(curve.rows_within(&[0.0], &[-1.0], &[1.0]).unwrap(), 1);
    }

    #[test]
    fn a_stretch_holds_its_ends_in_spite_of_round_off() {
        // 0.1 + 0.2 is not 0.3, but a load of 0.3 is what was meant.
        let curve = Curve::new(&[0.1, 0.2, 0.1 + 0.2, 0.4], &[1.0, 2.0, 3.0, 4.0]);
        let held = |from, to| curve.between(from, to).map(|[_, y]| y).collect::<Vec<_>>();
        assert_eq!(held(None, Some(0.3)), [1.0, 2.0, 3.0]);
        assert_eq!(held(Some(0.2), Some(0.3)), [2.0, 3.0]);
        assert_eq!(held(Some(0.3), None), [3.0, 4.0]);
        assert_eq!(held(Some(0.301), None), [4.0]);
    }

    #[test]
    fn bars_hold_their_ends() {
        let curve = Curve::new(&[0.0, 10.0], &[0.0, 20.0]);
        let within = curve.rows_within(&[0.0, 5.0, 10.0], &[0.0, 10.5, 15.0], &[1.0, 12.0, 19.0]);
        assert_eq!(within.unwrap(), 1);
    }

    #[test]
    fn a_curve_that_ends_early_is_refused() {
        let curve = Curve::new(&[0.0, 10.0], &[0.0, 20.0]);
        let message = curve.relative_rms(&[11.0], &[20.0]).unwrap_err().to_string();
        assert_eq!(message, "the simulated curve runs from 0 to 10 and does not reach the measured x = 11");
        assert!(Curve::new(&[], &[]).relative_rms(&[11.0], &[20.0]).unwrap_err().to_string().contains("no points"));
        assert!(curve.relative_rms(&[f64::NAN], &[1.0]).is_err());
        // 2e-10 beyond the end is round-off of a time course.
        assert!(curve.relative_rms(&[10.000_000_000_2], &[20.0]).unwrap() < 1e-9);
    }
}
