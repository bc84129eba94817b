//! Sobol's indices: which share of the variance of a number comes from which of the parameters that it depends on.

use super::bootstrap::{DRAWS, Estimate, interval, resample};

/// Values that differ by less than this share of the largest are the same: what is left are the last digits of sums.
const SAME: f64 = 1e-12;

/// The indices of one parameter, eq. (analysis.38).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Indices {
    /// Of first order: the share of the variance that is due to the parameter alone.
    pub first: Estimate,
    /// Total: the share that is due to it alone and together with others.
    pub total: Estimate,
}

/// How the variance of a number is shared out.
#[derive(Debug, Clone, PartialEq)]
pub struct Shares {
    /// The variance over the ranges of the parameters, in the square of the unit of the values; NaN without values.
    pub variance: f64,
    /// The indices of each parameter; NaN where the values do not vary.
    pub indices: Vec<Indices>,
}

/// Shares out the variance of a number by eq. (analysis.39), with the intervals of the bootstrap over base points, eq. (analysis.19).
///
/// * `rows` – for each base point the value at A, at A with one parameter after the other from B, and at B
/// * `parameters` – how many parameters there are
/// * `seed` – of the draws of the bootstrap
///
/// # Panics
/// For a row that does not have two values more than there are parameters.
pub fn shares(rows: &[Vec<f64>], parameters: usize, seed: u64) -> Shares {
    assert!(rows.iter().all(|row| row.len() == parameters + 2), "a row has a value for each parameter and two more");
    let all: Vec<usize> = (0..rows.len()).collect();
    let (variance, found) = of_drawn(rows, parameters, &all);
    let mut drawn_values = vec![[Vec::new(), Vec::new()]; parameters];
    if rows.len() > 1 {
        resample(rows.len(), DRAWS, seed, |drawn| {
            for (kept, values) in drawn_values.iter_mut().zip(of_drawn(rows, parameters, drawn).1) {
                kept.iter_mut().zip(values).for_each(|(kept, value)| kept.push(value));
            }
        });
    }
    let estimate = |value: f64, drawn: &[f64]| {
        let [low, high] = interval(drawn);
        Estimate { value, low, high }
    };
    let of_parameter = |(values, drawn): (&[f64; 2], &[Vec<f64>; 2])| Indices {
        first: estimate(values[0], &drawn[0]),
        total: estimate(values[1], &drawn[1]),
    };
    Shares { variance, indices: found.iter().zip(&drawn_values).map(of_parameter).collect() }
}

/// The variance, and the indices of each parameter of first order and total, of base points by their numbers.
fn of_drawn(rows: &[Vec<f64>], parameters: usize, drawn: &[usize]) -> (f64, Vec<[f64; 2]>) {
    let base = || drawn.iter().map(|number| &rows[*number]);
    let ends = || base().flat_map(|row| [row[0], row[parameters + 1]]);
    let number = drawn.len() as f64;
    let middle = ends().sum::<f64>() / (2.0 * number);
    let variance = ends().map(|value| (value - middle).powi(2)).sum::<f64>() / (2.0 * number);
    let [low, high] = ends().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
    if drawn.len() < 2 || high - low <= SAME * low.abs().max(high.abs()) {
        return (if drawn.is_empty() { f64::NAN } else { 0.0 }, vec![[f64::NAN; 2]; parameters]);
    }
    // The mean does not count in the exact integrals; taken off, the sum over points comes much nearer to them.
    let mean = base().flatten().sum::<f64>() / (number * (parameters + 2) as f64);
    let of_parameter = |parameter: usize| {
        let [mut first, mut total] = [0.0; 2];
        for row in base() {
            let (a, mixed, b) = (row[0], row[1 + parameter], row[parameters + 1]);
            first += (b - mean) * (mixed - a);
            total += (a - mixed).powi(2);
        }
        [first / number / variance, 0.5 * total / number / variance]
    };
    (variance, (0..parameters).map(of_parameter).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_are_those_that_others_find() {
        // analyze.sobol.analyze(…, calc_second_order=False) of SALib 1.6.0 of these numbers, two parameters.
        let rows: [[f64; 4]; 6] = [
            [3.0, 5.0, 2.0, 8.0],
            [1.0, 4.0, 1.0, 9.0],
            [7.0, 2.0, 6.0, 3.0],
            [5.0, 5.0, 4.0, 1.0],
            [0.0, 6.0, 3.0, 2.0],
            [9.0, 8.0, 7.0, 5.0],
        ];
        let found = shares(&rows.map(Vec::from), 2, 0);
        let values = [0, 1].map(|k| [found.indices[k].first.value, found.indices[k].total.value]);
        let known = [[0.22480058013052942, 0.6526468455402467], [-0.12472806381435826, 0.13923132704858596]];
        for (value, known) in values.as_flattened().iter().zip(known.as_flattened()) {
            assert!((value - known).abs() < 1e-14, "{value} for {known}");
        }
    }

    #[test]
    fn what_does_not_vary_has_no_shares() {
        for value in [0.0, 0.1, -7e300] {
            let found = shares(&vec![vec![value, value, value * (1.0 + 1e-14), value]; 9], 2, 0);
            assert_eq!(found.variance, 0.0);
            assert!(found.indices.iter().all(|one| one.first.value.is_nan() && one.total.low.is_nan()));
        }
        let nothing = shares(&[], 3, 0);
        assert!(nothing.variance.is_nan() && nothing.indices.len() == 3 && nothing.indices[0].first.high.is_nan());
        assert!(shares(&[vec![1.0, 2.0, 3.0]], 1, 0).indices[0].total.value.is_nan(), "a single base point");
    }

    #[test]
    fn intervals_are_the_same_for_a_seed() {
        let rows: Vec<Vec<f64>> = (0..20).map(|k| (0..3).map(|j| f64::from((k * 7 + j * 3) % 11)).collect()).collect();
        assert_eq!(shares(&rows, 1, 4), shares(&rows, 1, 4));
        assert_ne!(shares(&rows, 1, 4), shares(&rows, 1, 5));
    }
}
