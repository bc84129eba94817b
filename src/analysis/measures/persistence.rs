//! How long cells go straight on, as the mean squared displacement tells.

use super::declared::Declared;
use super::finished::Finished;
use super::msd_exponent::{check_lags, lags_of};
use crate::analysis::furth::{self, Localisation};
use crate::analysis::msd;
use crate::analysis::recording::POSITION;
use crate::analysis::tracks::Tracks;
use crate::cell::motility::Space;
use crate::error::Result;
use crate::units::Time;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which number of the fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum PersistenceStatistic {
    /// The persistence time, s.
    #[default]
    Persistence,
    /// The lower end of its interval of 95 %.
    PersistenceLow,
    /// The upper end of its interval of 95 %.
    PersistenceHigh,
    /// The speed, root mean square, µm/s.
    Speed,
    /// The lower end of its interval of 95 %.
    SpeedLow,
    /// The upper end of its interval of 95 %.
    SpeedHigh,
    /// The standard deviation of the error of localisation along an axis, µm.
    LocalisationError,
}

/// How long cells go straight on: the fit of Fürth's formula to the mean squared displacement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Persistence {
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// The shortest lag; an interval between frames when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub lag_from: Option<Time>,
    /// The longest lag; a quarter of the frames when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub lag_to: Option<Time>,
    /// Whether cells move in the plane x, y or in space.
    #[serde(default)]
    pub space: Space,
    /// Whether positions have an error that is fitted, too: `exact` or `noisy`.
    #[serde(default)]
    pub localisation: Localisation,
    /// Which number of the fit.
    #[serde(default)]
    pub statistic: PersistenceStatistic,
}

impl Persistence {
    pub(super) fn series(&self) -> Vec<&str> {
        POSITION.to_vec()
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        check_lags(self.lag_from, self.lag_to, at);
    }

    /// The number, eq. (analysis.6), with (analysis.19) for the ends of intervals. Draws are of the experiment's seed.
    ///
    /// # Errors
    /// When there is no such type, the frames do not reach over the lags, or the fit does not settle.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let tracks = Tracks::of(run.recording, self.cells.as_deref())?.along(self.space.axes());
        let of = msd::of_cells(tracks.positions.view(), &tracks.times, &lags_of(&tracks, self.lag_from, self.lag_to)?);
        let seed = run.file.map_or(0, |file| file.header().seed);
        let walk = furth::estimate(&of, tracks.axes(), self.localisation, seed)?;
        Ok(match self.statistic {
            PersistenceStatistic::Persistence => walk.persistence.value,
            PersistenceStatistic::PersistenceLow => walk.persistence.low,
            PersistenceStatistic::PersistenceHigh => walk.persistence.high,
            PersistenceStatistic::Speed => walk.speed.value,
            PersistenceStatistic::SpeedLow => walk.speed.low,
            PersistenceStatistic::SpeedHigh => walk.speed.high,
            PersistenceStatistic::LocalisationError => walk.noise.value,
        })
    }
}
