//! How far cells go on as they went some time ago.

use super::declared::Declared;
use crate::analysis::recording::{POSITION, Recording};
use crate::analysis::tracks::Tracks;
use crate::analysis::tracks::velocity::{Correlated, products};
use crate::cell::motility::Space;
use crate::error::{Error, Fault, Result};
use crate::units::Time;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How far cells go on as they went some time ago: the autocorrelation of their velocities.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct VelocityCorrelation {
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// The lag; the nearest number of intervals between frames is taken.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub lag: Time,
    /// Whether velocities or directions are correlated.
    #[serde(default)]
    pub of: Correlated,
    /// Whether cells move in the plane x, y or in space.
    #[serde(default)]
    pub space: Space,
}

impl VelocityCorrelation {
    pub(super) fn series(&self) -> Vec<&str> {
        POSITION.to_vec()
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        at.instant("lag", self.lag);
    }

    /// The autocorrelation at the lag, eq. (analysis.24).
    ///
    /// # Errors
    /// When there is no such type, the frames do not reach over the lag, or no cell moved.
    pub(super) fn evaluate(&self, recording: &Recording) -> Result<f64> {
        let tracks = Tracks::of(recording, self.cells.as_deref())?.along(self.space.axes());
        let lag = (self.lag.value() / tracks.interval()).round().max(0.0) as usize;
        let found = products(&tracks, self.of, &[0, lag]).of_all()[1];
        if found.is_nan() {
            let (lag, frames) = (self.lag, tracks.times.len());
            let fault =
                Fault::new(format!("velocities {lag} apart are not known from {frames} frames, or no cell moved"));
            return Err(Error::input(fault.help("give a shorter lag and cells that move")));
        }
        Ok(found)
    }
}
