//! What a fit found.

use super::document::Errors;
use super::observed::Observed;
use super::space::{Axis, Space};
use nalgebra::DMatrix;
use std::path::PathBuf;

/// What a fit found.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Its parameters, in the order of the document.
    pub space: Space,
    /// The same with what was found of them.
    pub parameters: Vec<Estimated>,
    /// Their correlations; NaN where the data tell of none.
    pub correlations: DMatrix<f64>,
    /// The data with what stands beside them.
    pub compared: Vec<Compared>,
    /// The least sum of squares of residuals over errors.
    pub chi2: f64,
    /// Degrees of freedom: data less parameters.
    pub freedom: usize,
    /// Whether errors are what they say.
    pub errors: Errors,
    /// The confidence of intervals.
    pub confidence: f64,
    /// The rise of χ² at which a profile ends.
    pub rise: f64,
    /// Whether the best search came to an end, and was not only stopped after too many iterations.
    pub converged: bool,
    /// What each start led to.
    pub starts: Vec<Started>,
    /// Points at which the experiment was evaluated.
    pub evaluations: Vec<Evaluation>,
    /// Runs that were made for it; those that were there before are not among them.
    pub made: usize,
}

/// What was found of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimated {
    /// The best value, in the unit of its column.
    pub value: f64,
    /// Where it lies in its range: 0 at the lower bound, 1 at the upper one.
    pub share: f64,
    /// Its interval by the covariance of Gauss and Newton, eq. (fit.6); from −∞ to ∞ (from 0 on a scale of ratios) where there is none.
    pub covariance: [f64; 2],
    /// Its interval by the profile of the likelihood, eq. (fit.7): an end is absent where χ² does not rise enough up to the bound.
    pub profile: Option<[Option<f64>; 2]>,
    /// The points of the profile, by value, each with χ²; the best among them.
    pub points: Vec<[f64; 2]>,
}

/// Data with what stands beside them.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// The data.
    pub observed: Observed,
    /// The number of the best run beside each: the mean of the replicates.
    pub predicted: Vec<f64>,
    /// The points of the best run, of the first replicate.
    pub course: Vec<[f64; 2]>,
}

impl Compared {
    /// Residuals over errors.
    pub fn residuals(&self) -> impl Iterator<Item = f64> + '_ {
        self.observed.data.iter().zip(&self.predicted).map(|(datum, predicted)| (predicted - datum.y) / datum.error)
    }
}

/// What a start led to.
#[derive(Debug, Clone, PartialEq)]
pub struct Started {
    /// Where it was.
    pub from: Vec<f64>,
    /// Where it ended and the χ² there; none where the experiment fails.
    pub to: Option<(Vec<f64>, f64)>,
}

/// A point at which the experiment was evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// The parameters as tables show them.
    pub cells: Vec<String>,
    /// The result of the first replicate, from the folder of the fit.
    pub result: PathBuf,
    /// χ²; none where the run failed.
    pub chi2: Option<f64>,
}

impl Outcome {
    /// χ² over its degrees of freedom; NaN where there are none.
    pub fn reduced(&self) -> f64 {
        self.chi2 / self.freedom as f64
    }

    /// Each parameter with what was found of it.
    pub fn each(&self) -> impl Iterator<Item = (&Axis, &Estimated)> {
        self.space.axes.iter().zip(&self.parameters)
    }

    /// Starts that led to the best χ², as far as can be told.
    pub fn starts_that_agree(&self) -> usize {
        let near = |(_, chi2): &(Vec<f64>, f64)| chi2 - self.chi2 <= 0.02 * self.rise;
        self.starts.iter().filter(|start| start.to.as_ref().is_some_and(near)).count()
    }
}
