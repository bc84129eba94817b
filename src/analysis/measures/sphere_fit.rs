//! The shear modulus of a spherical membrane that is pulled at its poles.

use super::fit::Fit;
use crate::analysis::recording::Recording;
use crate::error::Result;
use crate::units::LineStiffness;
use crate::values::OneOrMany;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A part of a curve of a sphere's equatorial diameter against the force at its poles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct SphereFit {
    /// The force.
    #[schemars(extend("x-text" = "series"))]
    pub x: String,
    /// The diameter; of several the mean is taken.
    #[schemars(extend("x-text" = "series"))]
    pub y: OneOrMany<String>,
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// Only forces up to here, pN.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_to: Option<f64>,
    /// The area modulus K of the membrane.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub area: LineStiffness,
}

impl SphereFit {
    pub(super) fn series(&self) -> Vec<&str> {
        std::iter::once(&self.x).chain(self.y.as_slice()).map(String::as_str).collect()
    }

    /// The shear modulus µ, pN/µm.
    ///
    /// # Errors
    /// When there is no such series, type or cell, or no line through its points.
    pub(super) fn evaluate(&self, recording: &Recording) -> Result<f64> {
        let (x, y, cells) = (self.x.clone(), self.y.clone(), self.cells.clone());
        let slope = Fit { x, y, cells, x_from: None, x_to: self.x_to }.slope(recording)?;
        Ok(shear(slope, self.area.value()))
    }
}

/// The shear modulus µ of a spherical membrane of area modulus K whose equatorial diameter changes with the force at
/// its poles by `slope` (µm/pN), from eq. (membrane.5) for forces at points.
fn shear(slope: f64, area: f64) -> f64 {
    1.0 / (-std::f64::consts::TAU * slope - 0.5 / area)
}
