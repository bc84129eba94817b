//! The least sum of squares within bounds: the method of Levenberg and Marquardt with projected steps.
//!
//! It knows no simulation: residuals come from a function of many points at once, so that whoever has them made can make them side by
//! side. Parameters are shares of their ranges. docs/decisions/0040-fit.md says why this is no crate.

use crate::error::Result;
use nalgebra::{DMatrix, DVector};

/// Residuals at each of some points, weighted by their errors; none where the model fails.
pub type Residuals<'a> = &'a (dyn Fn(&[Vec<f64>]) -> Result<Vec<Option<Vec<f64>>>> + Sync);

/// How a minimum is sought.
#[derive(Clone, Copy)]
pub struct Search<'a> {
    /// The residuals.
    pub residuals: Residuals<'a>,
    /// Half of the distance over which each parameter is changed for derivatives.
    pub steps: &'a [f64],
    /// The parameters that are sought; the others stay where they are.
    pub free: &'a [usize],
    /// What is said of each iteration.
    pub tell: &'a (dyn Fn(&Iterate) + Sync),
}

/// A point with what is known there.
#[derive(Debug, Clone, PartialEq)]
pub struct Iterate {
    /// Iterations that led to it.
    pub number: u32,
    /// The parameters, as shares of their ranges.
    pub point: Vec<f64>,
    /// The residuals.
    pub residuals: Vec<f64>,
    /// Their sum of squares.
    pub chi2: f64,
}

/// Where the search ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Minimum {
    /// The point.
    pub at: Iterate,
    /// The derivatives of the residuals there, a column for each free parameter; none where it has none, and none is free.
    pub jacobian: DMatrix<f64>,
    /// Whether it is a minimum as far as can be told, and not only the last of too many iterations.
    pub converged: bool,
}

/// Most iterations: after so many a sum of squares has a valley that no step follows.
const MOST_ITERATIONS: u32 = 60;
/// Most steps that are tried from one point.
const MOST_TRIALS: u32 = 12;
/// The search ends where the next step promises to lower χ² by less, in units of χ² over its degrees of freedom where that is above 1. A standard error is a
/// rise of 1, so what is left is a hundredth of a standard error, eq. (fit.5).
const PROMISE: f64 = 1e-4;
/// Where steps are shorter, shares of a range, nothing changes any more.
const SHORTEST: f64 = 1e-7;

/// The sum of squares.
fn squares(residuals: &[f64]) -> f64 {
    residuals.iter().map(|one| one * one).sum()
}

/// Seeks the least sum of squares from a point, eqs. (fit.1), (fit.4) and (fit.5); none where the model fails at the start.
///
/// # Errors
/// Those of the residuals.
pub fn minimise(search: &Search, start: &[f64]) -> Result<Option<Minimum>> {
    let Some(residuals) = one(search, start)? else { return Ok(None) };
    let mut at = Iterate { number: 0, point: start.to_vec(), chi2: squares(&residuals), residuals };
    let (mut damping, mut growth) = (1e-3, 2.0);
    loop {
        (search.tell)(&at);
        let Some(jacobian) = jacobian(search, &at)? else { return Ok(None) };
        let done = |at: Iterate, converged| Ok(Some(Minimum { at, jacobian: jacobian.clone(), converged }));
        if at.number >= MOST_ITERATIONS {
            return done(at, false);
        }
        let freedom = at.residuals.len().saturating_sub(search.free.len()).max(1) as f64;
        let enough = PROMISE * (at.chi2 / freedom).max(1.0);
        let (gradient, square) =
            (jacobian.tr_mul(&DVector::from_column_slice(&at.residuals)), jacobian.tr_mul(&jacobian));
        let (mut taken, mut first) = (None, None);
        for _ in 0..MOST_TRIALS {
            let step = step(search, &at.point, &gradient, &square, damping);
            let promised = -2.0 * gradient.dot(&step) - step.dot(&(&square * &step));
            first.get_or_insert(promised);
            if promised <= enough || step.amax() < SHORTEST {
                break;
            }
            let point = moved(search, &at.point, &step);
            let tried = one(search, &point)?;
            let chi2 = tried.as_deref().map_or(f64::INFINITY, squares);
            let ratio = (at.chi2 - chi2) / promised;
            if let (true, Some(residuals)) = (ratio > 1e-3, tried) {
                // Nielsen 1999: less damping where the promise was kept, and never less than a third at once.
                damping *= (1.0 - (2.0 * ratio - 1.0).powi(3)).clamp(1.0 / 3.0, 2.0);
                growth = 2.0;
                taken = Some(Iterate { number: at.number + 1, point, residuals, chi2 });
                break;
            }
            damping *= growth;
            growth *= 2.0;
        }
        match taken {
            Some(next) => at = next,
            // Where noise or a failure kept every step from being taken, what the first one promised tells how far it may be.
            None => return done(at, first.unwrap_or(0.0) <= 100.0 * enough),
        }
    }
}

fn one(search: &Search, point: &[f64]) -> Result<Option<Vec<f64>>> {
    Ok((search.residuals)(&[point.to_vec()])?.pop().flatten())
}

/// The derivatives at a point by differences to both sides, eq. (fit.3), at a bound or beside a failure to one; none where the model fails on both sides.
fn jacobian(search: &Search, at: &Iterate) -> Result<Option<DMatrix<f64>>> {
    let sides: Vec<[f64; 2]> = search
        .free
        .iter()
        .map(|&axis| [-1.0, 1.0].map(|side| (at.point[axis] + side * search.steps[axis]).clamp(0.0, 1.0)))
        .collect();
    let points: Vec<Vec<f64>> = search
        .free
        .iter()
        .zip(&sides)
        .flat_map(|(&axis, ends)| {
            ends.map(|end| {
                let mut point = at.point.clone();
                point[axis] = end;
                point
            })
        })
        .collect();
    let found = (search.residuals)(&points)?;
    let mut jacobian = DMatrix::zeros(at.residuals.len(), search.free.len());
    for (column, &axis) in search.free.iter().enumerate() {
        let side = |end: usize| match &found[2 * column + end] {
            Some(residuals) => (sides[column][end], residuals),
            None => (at.point[axis], &at.residuals),
        };
        let ((low, below), (high, above)) = (side(0), side(1));
        if low == high {
            return Ok(None);
        }
        for row in 0..at.residuals.len() {
            jacobian[(row, column)] = (above[row] - below[row]) / (high - low);
        }
    }
    Ok(Some(jacobian))
}

/// The damped step, eq. (fit.4), of the parameters that no bound holds; where it would cross a bound it ends there, and the others are found anew.
fn step(search: &Search, point: &[f64], gradient: &DVector<f64>, square: &DMatrix<f64>, damping: f64) -> DVector<f64> {
    let number = search.free.len();
    let margin = |column: usize| {
        let at = point[search.free[column]];
        [-at, 1.0 - at]
    };
    let largest = (0..number).map(|column| square[(column, column)]).fold(0.0, f64::max);
    // What the data do not tell of has no curvature of its own; that of the others keeps it where it is.
    let scale = |column: usize| square[(column, column)].max(1e-12 * largest).max(f64::MIN_POSITIVE);
    let mut held: Vec<Option<f64>> = vec![None; number];
    for column in 0..number {
        let [down, up] = margin(column);
        if (down >= 0.0 && gradient[column] > 0.0) || (up <= 0.0 && gradient[column] < 0.0) {
            held[column] = Some(0.0);
        }
    }
    loop {
        let loose: Vec<usize> = (0..number).filter(|column| held[*column].is_none()).collect();
        let mut step = DVector::from_fn(number, |column, _| held[column].unwrap_or(0.0));
        if loose.is_empty() {
            return step;
        }
        let pulled = gradient + square * &step;
        let right = DVector::from_fn(loose.len(), |row, _| -pulled[loose[row]]);
        let matrix = DMatrix::from_fn(loose.len(), loose.len(), |row, column| {
            let (row, column) = (loose[row], loose[column]);
            square[(row, column)] + if row == column { damping * scale(row) } else { 0.0 }
        });
        let Some(found) = matrix.cholesky().map(|factor| factor.solve(&right)) else { return DVector::zeros(number) };
        let mut crossed = false;
        for (row, &column) in loose.iter().enumerate() {
            let [down, up] = margin(column);
            if found[row] < down || found[row] > up {
                held[column] = Some(found[row].clamp(down, up));
                crossed = true;
            }
            step[column] = found[row];
        }
        if !crossed {
            return step;
        }
    }
}

/// The point that a step leads to.
fn moved(search: &Search, point: &[f64], step: &DVector<f64>) -> Vec<f64> {
    let mut moved = point.to_vec();
    for (column, &axis) in search.free.iter().enumerate() {
        moved[axis] = (moved[axis] + step[column]).clamp(0.0, 1.0);
    }
    moved
}

#[cfg(test)]
#[path = "solve_tests.rs"]
mod tests;
