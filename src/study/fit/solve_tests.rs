use super::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Residuals of a function of parameters, with a count of the points at which it was asked for.
fn sought(model: &(dyn Fn(&[f64]) -> Option<Vec<f64>> + Sync), start: &[f64]) -> (Minimum, usize) {
    let asked = AtomicUsize::new(0);
    let residuals = |points: &[Vec<f64>]| {
        asked.fetch_add(points.len(), Ordering::Relaxed);
        Ok(points.iter().map(|point| model(point)).collect())
    };
    let free: Vec<usize> = (0..start.len()).collect();
    let steps = vec![0.01; start.len()];
    let search = Search { residuals: &residuals, steps: &steps, free: &free, tell: &|_| () };
    let found = minimise(&search, start).unwrap().expect("a model that does not fail at its start");
    (found, asked.into_inner())
}

/// An exponential that decays, at ten instants, from a height to which data belong that decay with 0.3 of the range.
fn decay(at: &[f64]) -> Option<Vec<f64>> {
    let model = |height: f64, rate: f64, time: f64| height * (-5.0 * rate * time).exp();
    Some((0..10).map(|k| f64::from(k) / 5.0).map(|t| 100.0 * (model(at[0], at[1], t) - model(0.7, 0.3, t))).collect())
}

#[test]
fn the_parameters_that_data_were_made_with_are_found_in_few_evaluations() {
    let (found, asked) = sought(&decay, &[0.2, 0.9]);
    assert!(found.converged && found.at.chi2 < 1e-4, "{found:?}");
    assert!((found.at.point[0] - 0.7).abs() < 1e-3 && (found.at.point[1] - 0.3).abs() < 1e-3, "{:?}", found.at.point);
    assert!(asked <= 60, "{asked} evaluations");
}

#[test]
fn a_minimum_beyond_a_bound_is_found_at_the_bound_and_the_others_where_they_are_least_there() {
    // With the two correlated, the second is least at 0.5 - 0.5 (1 - 1.4) = 0.7 once the first ends at its bound.
    let model = |at: &[f64]| Some(vec![at[0] - 1.4, at[0] + 2.0 * at[1] - 2.4]);
    let (found, _) = sought(&model, &[0.2, 0.2]);
    assert!(found.converged && found.at.point[0] == 1.0, "{found:?}");
    assert!((found.at.point[1] - 0.7).abs() < 1e-3, "{:?}", found.at.point);
}

#[test]
fn a_start_at_a_bound_is_left_again() {
    let (found, _) = sought(&decay, &[0.0, 1.0]);
    assert!((found.at.point[0] - 0.7).abs() < 1e-3 && (found.at.point[1] - 0.3).abs() < 1e-3, "{:?}", found.at.point);
}

#[test]
fn a_region_where_the_model_fails_is_stepped_back_from() {
    let model = |at: &[f64]| (at[0] < 0.6).then(|| vec![10.0 * (at[0] * at[0] - 0.3)]);
    let (found, _) = sought(&model, &[0.1]);
    assert!(found.converged && (found.at.point[0] - 0.3_f64.sqrt()).abs() < 1e-3, "{found:?}");
}

#[test]
fn noise_below_the_errors_does_not_keep_the_search_from_ending() {
    // Steps of adaptive schemes leave such noise: a hundredth of the error of a datum.
    let model = |at: &[f64]| {
        let clean = decay(at)?;
        Some(clean.iter().enumerate().map(|(k, one)| one + 0.01 * (1e7 * at[0] * (1.0 + k as f64)).sin()).collect())
    };
    let (found, asked) = sought(&model, &[0.2, 0.9]);
    assert!(found.converged && asked < 100, "{asked} evaluations: {found:?}");
    assert!((found.at.point[0] - 0.7).abs() < 1e-3, "{:?}", found.at.point);
}

#[test]
fn a_parameter_of_no_effect_stays_where_it_is() {
    let model = |at: &[f64]| decay(&at[..2]);
    let (found, _) = sought(&model, &[0.2, 0.9, 0.4]);
    assert!(found.converged && found.at.point[2] == 0.4, "{found:?}");
    assert!((found.at.point[0] - 0.7).abs() < 1e-3, "{:?}", found.at.point);
}
