//! Whether faster cells go straighter: a line through the types of cells.

use super::declared::Declared;
use super::finished::Finished;
use crate::analysis::furth::Localisation;
use crate::analysis::recording::POSITION;
use crate::analysis::speed_persistence::{FEWEST, Point, relation};
use crate::analysis::tracks::Tracks;
use crate::cell::motility::Space;
use crate::error::Result;
use crate::values::OneOrMany;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which number of the line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum SpeedPersistenceStatistic {
    /// The coefficient of correlation of the logarithm of the persistence and the speed, from −1 to 1.
    #[default]
    Correlation,
    /// How much the logarithm of the persistence grows with the speed, s/µm.
    Slope,
    /// The decades between the smallest persistence and the largest.
    Decades,
}

/// Whether faster types of cells go straighter: the line through the logarithms of their persistence against their mean speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct SpeedPersistence {
    /// The types of cells, three or more; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<OneOrMany<String>>,
    /// Whether cells move in the plane x, y or in space.
    #[serde(default)]
    pub space: Space,
    /// Whether positions have an error that is fitted, too: `exact` or `noisy`.
    #[serde(default)]
    pub localisation: Localisation,
    /// Which number of the line.
    #[serde(default)]
    pub statistic: SpeedPersistenceStatistic,
}

impl SpeedPersistence {
    pub(super) fn series(&self) -> Vec<&str> {
        POSITION.to_vec()
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        let mut types: Vec<&str> = match &self.cells {
            Some(types) => types.as_slice().iter().map(String::as_str).collect(),
            None => at.types(),
        };
        types.sort_unstable();
        types.dedup();
        if types.len() < FEWEST {
            let (key, path) = match &self.cells {
                Some(_) => ("cells", format!("{}.cells", at.path())),
                None => ("", at.path().to_owned()),
            };
            let message = format!("`{path}`: a line needs three types of cells, and there are {}", types.len());
            at.fault(key, "too few types", message, "name three types of cells or more");
        }
    }

    /// The number that is asked for, eq. (analysis.36).
    ///
    /// # Errors
    /// When there is no such type, or the persistence of one cannot be told.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let kinds: Vec<&str> = match &self.cells {
            Some(kinds) => kinds.as_slice().iter().map(String::as_str).collect(),
            None => run.recording.types.iter().map(String::as_str).collect(),
        };
        let seed = run.file.map_or(0, |file| file.header().seed);
        let point = |kind: &&str| {
            let tracks = Tracks::of(run.recording, Some(kind))?.along(self.space.axes());
            Point::of(&tracks, self.localisation, seed)
        };
        let found = relation(&kinds.iter().map(point).collect::<Result<Vec<_>>>()?)?;
        Ok(match self.statistic {
            SpeedPersistenceStatistic::Correlation => found.correlation,
            SpeedPersistenceStatistic::Slope => found.line.slope,
            SpeedPersistenceStatistic::Decades => found.decades,
        })
    }
}
