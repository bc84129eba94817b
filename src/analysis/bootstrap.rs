//! How uncertain a number is that comes from many cells: cells are drawn anew with replacement, and the number computed from each draw.

use crate::random::{Purpose, Stream};

/// How often cells are drawn anew where nobody says else.
pub const DRAWS: u32 = 1_000;

/// The share of draws within an interval.
pub const LEVEL: f64 = 0.95;

/// A number and the interval in which it lies by the bootstrap, eq. (analysis.19).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The number, of all cells.
    pub value: f64,
    /// The lower end of the interval; NaN for fewer than two cells.
    pub low: f64,
    /// The upper end of the interval; NaN for fewer than two cells.
    pub high: f64,
}

/// Calls `of` with each draw of as many cells as there are, by their numbers. The same for the same seed, whatever was drawn before.
pub fn resample(cells: usize, draws: u32, seed: u64, mut of: impl FnMut(&[usize])) {
    let mut drawn = vec![0; cells];
    for draw in 0..draws {
        let mut stream = Stream::new(seed, Purpose::Bootstrap, draw, 0);
        for pair in drawn.chunks_mut(2) {
            let uniform = stream.uniform_pair();
            for (cell, uniform) in pair.iter_mut().zip(uniform) {
                *cell = ((uniform * cells as f64) as usize).min(cells - 1);
            }
        }
        of(&drawn);
    }
}

/// The ends of the interval that holds the middle [`LEVEL`] of some values, by percentiles; NaN for fewer than two. Values that are not numbers are left out.
pub fn interval(values: &[f64]) -> [f64; 2] {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
    sorted.sort_by(f64::total_cmp);
    if sorted.len() < 2 {
        return [f64::NAN; 2];
    }
    // Between the values at either side, as the quantiles of type 7 of R.
    let quantile = |share: f64| {
        let at = share * (sorted.len() - 1) as f64;
        let below = (at as usize).min(sorted.len() - 2);
        sorted[below] + (at - below as f64) * (sorted[below + 1] - sorted[below])
    };
    [quantile(0.5 * (1.0 - LEVEL)), quantile(0.5 * (1.0 + LEVEL))]
}

/// The mean of values of cells with its interval; values that are not numbers are left out.
pub fn of_mean(values: &[f64], seed: u64) -> Estimate {
    let values: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
    of_cells(values.len(), seed, |cells| cells.iter().map(|cell| values[*cell]).sum::<f64>() / cells.len() as f64)
}

/// A number that `of` makes of some cells: of all of them, with its interval.
pub fn of_cells(cells: usize, seed: u64, mut of: impl FnMut(&[usize]) -> f64) -> Estimate {
    let all: Vec<usize> = (0..cells).collect();
    let value = of(&all);
    if cells < 2 {
        return Estimate { value, low: f64::NAN, high: f64::NAN };
    }
    let mut drawn = Vec::with_capacity(DRAWS as usize);
    resample(cells, DRAWS, seed, |cells| drawn.push(of(cells)));
    let [low, high] = interval(&drawn);
    Estimate { value, low, high }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::noise;

    #[test]
    fn intervals_of_means_hold_the_truth_as_often_as_they_say() {
        // 400 samples of 40 values of the exponential law of mean 1. The share that holds 1 has a standard error of 0.011, and percentiles
        // of skewed means of 40 values are known to be short by about 0.02 (Efron & Tibshirani 1993, ch. 13).
        let mut held = 0;
        for sample in 0..400 {
            let mut uniform = noise::uniform(sample);
            let values: Vec<f64> = (0..40).map(|_| -(-uniform()).ln_1p()).collect();
            let mean = of_mean(&values, sample);
            held += u32::from(mean.low <= 1.0 && 1.0 <= mean.high);
        }
        println!("{held} of 400");
        assert!((360..=392).contains(&held), "{held} of 400");
    }

    #[test]
    fn draws_are_the_same_for_a_seed_and_fair() {
        let draws = |seed| {
            let mut all = Vec::new();
            resample(7, 50, seed, |cells| all.extend_from_slice(cells));
            all
        };
        assert_eq!(draws(1), draws(1));
        assert_ne!(draws(1), draws(2));
        let mut counts = [0.0_f64; 7];
        resample(7, 10_000, 3, |cells| cells.iter().for_each(|cell| counts[*cell] += 1.0));
        // Binomial with 70 000 draws of probability 1/7: standard deviation 93; five of them.
        assert!(counts.iter().all(|count| (count - 10_000.0).abs() < 465.0), "{counts:?}");
    }

    #[test]
    fn too_few_values_have_no_interval() {
        assert!(of_mean(&[3.0], 0).low.is_nan() && of_mean(&[3.0, f64::NAN], 0).value == 3.0);
        assert!(of_mean(&[], 0).value.is_nan());
        assert_eq!(interval(&[1.0; 9]), [1.0, 1.0]);
        let hundred: Vec<f64> = (0..=1000).map(f64::from).collect();
        assert_eq!(interval(&hundred).map(f64::round), [25.0, 975.0]);
    }
}
