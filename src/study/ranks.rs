//! Spearman's rank correlation, and how sure it is.

use crate::analysis::bootstrap::{Estimate, of_cells};
use std::collections::BTreeMap;

/// Ranks of values from 1; equal ones share the mean of theirs.
pub fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|one, other| values[*one].total_cmp(&values[*other]));
    let mut found = vec![0.0; values.len()];
    let mut start = 0;
    while start < order.len() {
        let alike = order[start..].iter().take_while(|index| values[**index] == values[order[start]]).count().max(1);
        let shared = start as f64 + 0.5 * (alike as f64 + 1.0);
        order[start..start + alike].iter().for_each(|index| found[*index] = shared);
        start += alike;
    }
    found
}

/// Spearman's correlation of two lists: Pearson's of their ranks; NaN where one of them does not vary.
pub fn spearman(one: &[f64], other: &[f64]) -> f64 {
    let (one, other) = (ranks(one), ranks(other));
    let middle = 0.5 * (one.len() as f64 + 1.0);
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - middle) * (b - middle)).sum::<f64>();
    sum(&one, &other) / (sum(&one, &one) * sum(&other, &other)).sqrt()
}

/// The correlation of a parameter with a measure, with the interval of the bootstrap: points are drawn anew, each with all of its runs, since runs
/// of a point are no more points.
///
/// * `points` – the point of each run
pub fn correlation(points: &[u32], parameter: &[f64], measure: &[f64], seed: u64) -> Estimate {
    let mut runs: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    points.iter().enumerate().for_each(|(run, point)| runs.entry(*point).or_default().push(run));
    let runs: Vec<Vec<usize>> = runs.into_values().collect();
    of_cells(runs.len(), seed, |drawn| {
        let drawn: Vec<usize> = drawn.iter().flat_map(|point| runs[*point].iter().copied()).collect();
        let of = |values: &[f64]| drawn.iter().map(|run| values[*run]).collect::<Vec<f64>>();
        spearman(&of(parameter), &of(measure))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_values_share_their_ranks() {
        assert_eq!(ranks(&[10.0, 30.0, 20.0, 20.0]), [1.0, 4.0, 2.5, 2.5]);
        assert_eq!(ranks(&[5.0; 3]), [2.0; 3]);
        assert!(ranks(&[]).is_empty());
    }

    #[test]
    fn correlations_are_those_of_the_textbook() {
        assert_eq!(spearman(&[1.0, 2.0, 3.0, 4.0], &[1.0, 8.0, 27.0, 64.0]), 1.0);
        assert_eq!(spearman(&[1.0, 2.0, 3.0], &[3.0, 2.0, 1.0]), -1.0);
        // 1 - 6 Σd²/(n(n² - 1)) with Σd² = 4: 0.8.
        assert!((spearman(&[1.0, 2.0, 3.0, 4.0, 5.0], &[2.0, 1.0, 4.0, 3.0, 5.0]) - 0.8).abs() < 1e-15);
        assert!(spearman(&[1.0, 2.0], &[5.0, 5.0]).is_nan());
    }

    #[test]
    fn repeating_runs_does_not_make_an_interval_narrower() {
        let x: Vec<f64> = (0..30).map(f64::from).collect();
        let y: Vec<f64> = (0..30).map(|k| f64::from((k * 7) % 30)).collect();
        let points: Vec<u32> = (0..30).collect();
        let once = correlation(&points, &x, &y, 1);
        let thrice = |values: &[f64]| [values, values, values].concat();
        let repeated = correlation(&[&points[..], &points, &points].concat(), &thrice(&x), &thrice(&y), 1);
        assert!((once.high - once.low - (repeated.high - repeated.low)).abs() < 1e-9, "{once:?} {repeated:?}");
        assert!(once.low < once.value && once.value < once.high);
    }
}
