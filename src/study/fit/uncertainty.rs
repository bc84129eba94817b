//! How well a minimum is determined, as far as derivatives there tell: standard errors and correlations.

use super::solve::Minimum;
use nalgebra::DMatrix;

/// Standard errors and correlations of parameters, by Gauss and Newton, eq. (fit.6).
#[derive(Debug, Clone, PartialEq)]
pub struct Covariance {
    /// Standard errors, shares of the ranges; infinite where the data do not determine a parameter.
    pub errors: Vec<f64>,
    /// Correlations, a row and a column for each parameter; NaN where there are none.
    pub correlations: DMatrix<f64>,
}

/// The least share of an eigenvalue in the largest one, of the matrix scaled to ones on its diagonal, at which it still counts: derivatives
/// are good to some 1e-4.
const LEAST: f64 = 1e-10;

/// The covariance at a minimum. `variance` is that of a weighted residual: 1 where errors are given.
pub fn covariance(minimum: &Minimum, variance: f64) -> Covariance {
    let square = minimum.jacobian.tr_mul(&minimum.jacobian);
    let number = square.nrows();
    let scale: Vec<f64> = (0..number).map(|k| square[(k, k)].sqrt()).collect();
    let told: Vec<usize> = (0..number).filter(|k| scale[*k] > 0.0).collect();
    let scaled =
        DMatrix::from_fn(told.len(), told.len(), |i, j| square[(told[i], told[j])] / (scale[told[i]] * scale[told[j]]));
    let mut errors = vec![f64::INFINITY; number];
    let mut correlations = DMatrix::from_element(number, number, f64::NAN);
    let eigen = scaled.symmetric_eigen();
    let largest = eigen.eigenvalues.iter().copied().fold(0.0, f64::max);
    let entry = |i: usize, j: usize| -> f64 {
        let part = |k: usize| {
            let value = eigen.eigenvalues[k].max(LEAST * largest);
            eigen.eigenvectors[(i, k)] * eigen.eigenvectors[(j, k)] / value
        };
        (0..told.len()).map(part).sum()
    };
    for (i, &row) in told.iter().enumerate() {
        errors[row] = (variance * entry(i, i)).sqrt() / scale[row];
        for (j, &column) in told.iter().enumerate() {
            correlations[(row, column)] = entry(i, j) / (entry(i, i) * entry(j, j)).sqrt();
        }
    }
    Covariance { errors, correlations }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::fit::solve::Iterate;

    fn minimum(jacobian: DMatrix<f64>) -> Minimum {
        let at = Iterate { number: 1, point: vec![0.5; jacobian.ncols()], residuals: Vec::new(), chi2: 0.0 };
        Minimum { at, jacobian, converged: true }
    }

    #[test]
    fn standard_errors_and_correlations_are_those_of_the_inverse() {
        // The inverse of JᵀJ = [[2, 1], [1, 2]] is [[2, -1], [-1, 2]]/3.
        let found = covariance(&minimum(DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 0.0, 1.0, 1.0, 1.0])), 4.0);
        let error = 2.0 * (2.0_f64 / 3.0).sqrt();
        assert!(found.errors.iter().all(|one| (one - error).abs() < 1e-12), "{found:?}");
        assert!((found.correlations[(0, 1)] + 0.5).abs() < 1e-12 && (found.correlations[(1, 1)] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_parameter_without_effect_has_an_error_without_end_and_leaves_the_others_theirs() {
        let found = covariance(&minimum(DMatrix::from_row_slice(2, 2, &[2.0, 0.0, 0.0, 0.0])), 1.0);
        assert_eq!(found.errors, [0.5, f64::INFINITY]);
        assert!(found.correlations[(0, 1)].is_nan());
    }
}
