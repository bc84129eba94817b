//! What the statistics promise.

use super::*;
use crate::analysis::noise;

/// Exponential numbers of mean 1.
fn exponential(number: usize, seed: u64) -> Vec<f64> {
    let mut uniform = noise::uniform(1 + seed);
    (0..number).map(|_| -(-uniform()).ln_1p()).collect()
}

#[test]
fn mean_and_errors_of_four_numbers() {
    let values = [1.0, 2.0, 3.0, 6.0];
    assert_eq!(mean(&values), 3.0);
    // Σ(x − 3)² = 14, over n − 1 = 3.
    assert!((standard_deviation(&values) - (14.0_f64 / 3.0).sqrt()).abs() < 1e-15);
    assert!((standard_error(&values) - (14.0_f64 / 12.0).sqrt()).abs() < 1e-15);
    assert!(standard_error(&values[..1]).is_nan());
}

#[test]
fn a_line_through_anscombes_first_set() {
    // Anscombe 1973: slope 0.500, intercept 3.00, R² 0.67, standard error of the slope 0.118.
    let x = [10.0, 8.0, 13.0, 9.0, 11.0, 14.0, 6.0, 4.0, 12.0, 7.0, 5.0];
    let y = [8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68];
    let line = fit_line(&x, &y).unwrap();
    assert!((line.slope - 0.500).abs() < 5e-4);
    assert!((line.intercept - 3.00).abs() < 5e-3);
    assert!((line.r_squared - 0.667).abs() < 5e-4);
    assert!((line.slope_error - 0.118).abs() < 5e-4);
}

#[test]
fn a_line_through_one_point_is_refused() {
    let message = fit_line(&[2.0, 2.0], &[1.0, 3.0]).unwrap_err().to_string();
    assert!(message.contains("all 2 values of x are 2"), "{message}");
    assert!(fit_line(&[2.0], &[1.0]).is_err());
}

#[test]
fn interpolation_meets_the_points_and_ends_with_them() {
    let (x, y) = ([0.0, 1.0, 3.0], [2.0, 4.0, 0.0]);
    assert_eq!(interpolate(&x, &y, 0.0), Some(2.0));
    assert_eq!(interpolate(&x, &y, 3.0), Some(0.0));
    assert_eq!(interpolate(&x, &y, 2.0), Some(2.0));
    assert_eq!(interpolate(&x, &y, 3.1), None);
    assert_eq!(interpolate(&x, &y, f64::NAN), None);
    assert_eq!(interpolate(&[], &[], 0.0), None);
}

#[test]
fn kolmogorovs_law_has_its_tabled_values() {
    // The critical values of the limit law: 1.2238, 1.3581 and 1.6276 for 10, 5 and 1 %; its median 0.8276.
    for (x, tail) in [(1.223_85, 0.10), (1.358_10, 0.05), (1.627_62, 0.01), (0.827_574, 0.5)] {
        assert!((kolmogorov_tail(x) - tail).abs() < 1e-5, "{x}: {}", kolmogorov_tail(x));
    }
    // The two series agree where one takes over from the other.
    assert!((kolmogorov_tail(1.0 - 1e-12) - kolmogorov_tail(1.0)).abs() < 1e-11);
    assert_eq!(kolmogorov_tail(0.0), 1.0);
}

#[test]
fn p_values_of_true_laws_are_uniform_and_of_wrong_ones_small() {
    let law = |x: f64| 1.0 - (-x).exp();
    let number = 400;
    let low = (0..number).filter(|&seed| kolmogorov_smirnov(&exponential(50, seed), law).unwrap().p_value < 0.1);
    // 40 expected of 400; binomial, four standard deviations of sqrt(400·0.1·0.9) = 6.
    let count = low.count();
    assert!((16..=64).contains(&count), "{count} of {number} p-values below 0.1");
    let wrong = kolmogorov_smirnov(&exponential(2_000, 1), |x| 1.0 - (-x / 1.5).exp()).unwrap();
    // The two laws lie 0.15 apart, seven times what chance does to 2 000 values.
    assert!(wrong.p_value < 1e-6, "{wrong:?}");
}

#[test]
fn the_distance_is_taken_on_both_sides_of_a_step() {
    let uniform = |x: f64| x;
    assert!((kolmogorov_smirnov(&[0.9], uniform).unwrap().distance - 0.9).abs() < 1e-15);
    assert!((kolmogorov_smirnov(&[0.1], uniform).unwrap().distance - 0.9).abs() < 1e-15);
    assert!(kolmogorov_smirnov(&[], uniform).is_err());
    assert!(kolmogorov_smirnov(&[f64::NAN], uniform).is_err());
}
