//! Means, straight lines through points and the question whether numbers follow a law.

use crate::error::{Error, Fault, Result};

/// The mean of some values; NaN for none.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The sample standard deviation, with n − 1 in the denominator; NaN for fewer than two values.
pub fn standard_deviation(values: &[f64]) -> f64 {
    if values.len() < 2 {
        return f64::NAN;
    }
    let centre = mean(values);
    let squares: f64 = values.iter().map(|value| (value - centre).powi(2)).sum();
    (squares / (values.len() - 1) as f64).sqrt()
}

/// The standard error of the mean of independent values, eq. (analysis.1); NaN for fewer than two values.
pub fn standard_error(values: &[f64]) -> f64 {
    standard_deviation(values) / (values.len() as f64).sqrt()
}

/// The straight line y = intercept + slope·x nearest to some points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Slope, in units of y over units of x.
    pub slope: f64,
    /// Value at x = 0, in units of y.
    pub intercept: f64,
    /// Share of the variance of y that the line explains; NaN when all y are equal.
    pub r_squared: f64,
    /// Standard error of the slope; NaN for two points.
    pub slope_error: f64,
}

/// Fits a line by ordinary least squares, eq. (analysis.2).
///
/// # Errors
/// When there are fewer than two points, when x and y differ in number, or when all x are equal.
pub fn fit_line(x: &[f64], y: &[f64]) -> Result<Line> {
    if x.len() != y.len() || x.len() < 2 {
        let found = format!("a line cannot be fitted through {} values of x and {} of y", x.len(), y.len());
        return Err(Error::input(Fault::new(found).help("give at least two points, with one x and one y each")));
    }
    let (centre_x, centre_y) = (mean(x), mean(y));
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for (x, y) in x.iter().zip(y) {
        let (dx, dy) = (x - centre_x, y - centre_y);
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
    }
    if xx == 0.0 {
        let found = format!("a line cannot be fitted: all {} values of x are {centre_x}", x.len());
        return Err(Error::input(
            Fault::new(found).help("record the series while x changes, or widen x_from and x_to"),
        ));
    }
    let slope = xy / xx;
    let left = (yy - slope * xy).max(0.0);
    Ok(Line {
        slope,
        intercept: centre_y - slope * centre_x,
        r_squared: if yy > 0.0 { 1.0 - left / yy } else { f64::NAN },
        slope_error: if x.len() > 2 { (left / (x.len() - 2) as f64 / xx).sqrt() } else { f64::NAN },
    })
}

/// The value at `x` of the broken line through points given in ascending order of `xs`; none outside of them.
///
/// # Panics
/// When `xs` and `ys` differ in number.
pub fn interpolate(xs: &[f64], ys: &[f64], x: f64) -> Option<f64> {
    assert_eq!(xs.len(), ys.len(), "each x needs its y");
    let (first, last) = (*xs.first()?, *xs.last()?);
    if !(first <= x && x <= last) {
        return None;
    }
    let after = xs.partition_point(|&known| known < x);
    if xs[after] == x {
        return Some(ys[after]);
    }
    let share = (x - xs[after - 1]) / (xs[after] - xs[after - 1]);
    Some(ys[after - 1] + share * (ys[after] - ys[after - 1]))
}

/// How far some numbers lie from a law, and how often chance alone would take them that far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KolmogorovSmirnov {
    /// Greatest distance between the empirical and the expected distribution function.
    pub distance: f64,
    /// Probability that numbers which do follow the law lie at least that far from it.
    pub p_value: f64,
}

/// Compares independent values with a law that was not fitted to them, eq. (analysis.3).
///
/// The p-value is Kolmogorov's limit with the correction of Stephens 1970 for a finite number, good to about 0.01 from
/// five values on.
///
/// * `distribution` – the expected distribution function: the probability of a value of at most x.
///
/// # Errors
/// When there are no values or one is not a number.
pub fn kolmogorov_smirnov(values: &[f64], distribution: impl Fn(f64) -> f64) -> Result<KolmogorovSmirnov> {
    if values.is_empty() || values.iter().any(|value| value.is_nan()) {
        let found = format!("{} values, of which some are missing, cannot be compared with a law", values.len());
        return Err(Error::input(Fault::new(found).help("give at least one value, and only finite ones")));
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let number = sorted.len() as f64;
    let mut distance: f64 = 0.0;
    for (index, &value) in sorted.iter().enumerate() {
        let expected = distribution(value);
        distance = distance.max(expected - index as f64 / number).max((index + 1) as f64 / number - expected);
    }
    let root = number.sqrt();
    Ok(KolmogorovSmirnov { distance, p_value: kolmogorov_tail((root + 0.12 + 0.11 / root) * distance) })
}

/// Kolmogorov's limit law: the probability of a scaled distance above `x`. Two series, each used where it is quick.
fn kolmogorov_tail(x: f64) -> f64 {
    if x < 0.2 {
        return 1.0; // the tail misses 1 by less than 1e-12 there
    }
    if x < 1.0 {
        // Jacobi's other form of the sum, which converges for small x.
        let terms = (1..=4).map(|k| (-(f64::from(2 * k - 1) * std::f64::consts::PI / x).powi(2) / 8.0).exp());
        return 1.0 - (2.0 * std::f64::consts::PI).sqrt() / x * terms.sum::<f64>();
    }
    let term = |k: i32| (-2.0 * (f64::from(k) * x).powi(2)).exp();
    (2.0 * (term(1) - term(2) + term(3) - term(4))).clamp(0.0, 1.0)
}

#[cfg(test)]
#[path = "statistics_tests.rs"]
mod tests;
