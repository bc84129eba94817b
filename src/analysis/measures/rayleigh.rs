//! Whether cells go anywhere more than elsewhere.

use super::declared::Declared;
use crate::analysis::circular;
use crate::analysis::recording::{POSITION, Recording};
use crate::analysis::tracks::{Tracks, summary};
use crate::error::{Error, Fault, Result};
use crate::units::Time;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which number describes directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum RayleighStatistic {
    /// The probability, by Rayleigh's test, that directions without preference agree so much.
    #[default]
    PValue,
    /// The length of the mean of the directions, from 0 to 1.
    ResultantLength,
    /// Where that mean points, degrees from the x axis towards the y axis.
    MeanDirection,
}

/// Whether the net displacements of cells in the plane x, y point anywhere more than elsewhere.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Rayleigh {
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// When tracks begin; with the first frame when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Time>,
    /// When tracks end; with the last frame when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Time>,
    /// Which number describes the directions.
    #[serde(default)]
    pub statistic: RayleighStatistic,
}

impl Rayleigh {
    pub(super) fn series(&self) -> Vec<&str> {
        POSITION.to_vec()
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        at.stretch(self.from, self.to);
    }

    /// The number, eqs. (analysis.27), (analysis.28).
    ///
    /// # Errors
    /// When there is no such type, fewer than two frames lie between the times, or no cell ends elsewhere than it began.
    pub(super) fn evaluate(&self, recording: &Recording) -> Result<f64> {
        let tracks = Tracks::of(recording, self.cells.as_deref())?
            .between(self.from.map(Time::value), self.to.map(Time::value))?;
        let found = circular::describe(summary::directions(&tracks));
        if found.number == 0 {
            let fault = Fault::new("no cell ends elsewhere in the plane than it began");
            return Err(Error::input(fault.help("give the cells motility or a pull, and frames enough")));
        }
        Ok(match self.statistic {
            RayleighStatistic::PValue => found.p_value,
            RayleighStatistic::ResultantLength => found.resultant,
            RayleighStatistic::MeanDirection => found.mean.to_degrees(),
        })
    }
}
