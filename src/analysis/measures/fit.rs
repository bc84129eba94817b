//! The straight line fitted to a part of a curve: its slope and R².

use super::declared::Declared;
use crate::analysis::curve::Curve;
use crate::analysis::over::Over;
use crate::analysis::recording::Recording;
use crate::analysis::statistics::{self, Line};
use crate::error::Result;
use crate::values::OneOrMany;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A part of a curve to which a straight line is fitted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Fit {
    /// The series along x.
    #[schemars(extend("x-text" = "series"))]
    pub x: String,
    /// The series along y; of several the mean is taken.
    #[schemars(extend("x-text" = "series"))]
    pub y: OneOrMany<String>,
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// Only points with x from here on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_from: Option<f64>,
    /// Only points with x up to here.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_to: Option<f64>,
}

impl Fit {
    pub(super) fn series(&self) -> Vec<&str> {
        std::iter::once(&self.x).chain(self.y.as_slice()).map(String::as_str).collect()
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        if let (Some(from), Some(to)) = (self.x_from, self.x_to)
            && from >= to
        {
            let message = format!("`{}.x_to` is not above `x_from`", at.path());
            at.fault("x_to", "too small", message, "exchange the two");
        }
    }

    /// The slope of the line.
    ///
    /// # Errors
    /// When there is no such series, type or cell, or no line through its points.
    pub(super) fn slope(&self, recording: &Recording) -> Result<f64> {
        self.line(recording).map(|line| line.slope)
    }

    /// R² of the line.
    ///
    /// # Errors
    /// As [`Fit::slope`].
    pub(super) fn r_squared(&self, recording: &Recording) -> Result<f64> {
        self.line(recording).map(|line| line.r_squared)
    }

    /// Fits the line to a part of the mean of some curves.
    fn line(&self, recording: &Recording) -> Result<Line> {
        let x = recording.series(&self.x, self.cells.as_deref(), Over::Mean)?;
        let mut mean = vec![0.0; x.len()];
        for name in self.y.as_slice() {
            let y = recording.series(name, self.cells.as_deref(), Over::Mean)?;
            mean.iter_mut().zip(y).for_each(|(mean, y)| *mean += y / self.y.as_slice().len() as f64);
        }
        let curve = Curve::new(&x, &mean);
        let (x, y): (Vec<f64>, Vec<f64>) = curve.between(self.x_from, self.x_to).map(|[x, y]| (x, y)).unzip();
        statistics::fit_line(&x, &y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::measures::MeasureKind;
    use crate::analysis::measures::test_recordings::{evaluate, pulled};

    #[test]
    fn lines_are_fitted_to_the_stretch_asked_for() {
        let slope = |x_to| {
            let (x, y, cells) = ("load.pull".into(), "size_x".into(), Some("white".into()));
            evaluate(&MeasureKind::Slope(Fit { x, y: OneOrMany::One(y), cells, x_from: None, x_to }), &pulled())
                .unwrap()
        };
        // The white cells measure 5, 5.5 and 7 µm.
        assert!((slope(None) - 0.1).abs() < 1e-14);
        assert!((slope(Some(10.0)) - 0.05).abs() < 1e-14);
        let (x, y, cells) = ("load.pull".into(), "size_x".into(), Some("white".into()));
        let r_squared = evaluate(
            &MeasureKind::RSquared(Fit { x, y: OneOrMany::One(y), cells, x_from: None, x_to: None }),
            &pulled(),
        )
        .unwrap();
        // Residuals 1/6, −1/3, 1/6 of values whose squares about the mean sum to 13/6.
        assert!((r_squared - (1.0 - (1.0 / 6.0) / (13.0 / 6.0))).abs() < 1e-14);
    }
}
