//! How well cells go along a cue.

use super::declared::Declared;
use super::statistic::Statistic;
use super::track_average::over_tracks;
use crate::analysis::recording::{POSITION, Recording};
use crate::analysis::tracks::Tracks;
use crate::analysis::tracks::motion::Cue;
use crate::analysis::tracks::summary::forward_indices;
use crate::cell::motility::Space;
use crate::error::Result;
use crate::units::{Length, Time};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Along the cue or across it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum ForwardPart {
    /// Along the cue.
    #[default]
    Parallel,
    /// Across the cue: to the left of it in the plane, by size in space.
    Perpendicular,
}

/// How well cells go along a cue: the net displacement along it over the length of the path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct ForwardIndex {
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// The direction of the cue; in place of `towards`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// The point from which the cue comes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub towards: Option<[Length; 3]>,
    /// Along the cue or across it.
    #[serde(default)]
    pub part: ForwardPart,
    /// When tracks begin; with the first frame when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Time>,
    /// When tracks end; with the last frame when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Time>,
    /// Whether cells move in the plane x, y or in space.
    #[serde(default)]
    pub space: Space,
    /// Which number of the values of all cells.
    #[serde(default)]
    pub statistic: Statistic,
}

impl ForwardIndex {
    pub(super) fn series(&self) -> Vec<&str> {
        POSITION.to_vec()
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        match (self.direction, self.towards) {
            (Some(direction), None) => at.direction("direction", direction),
            (Some(_), Some(_)) => {
                at.two_keys("direction", "towards", "keep the one that says where the cue comes from")
            }
            (None, None) => {
                let message = format!("`{}` has no cue", at.path());
                at.fault(
                    "",
                    "no cue",
                    message,
                    "add `direction`, such as [1, 0, 0], or a point `towards` which cells go",
                );
            }
            (None, Some(_)) => {}
        }
        at.stretch(self.from, self.to);
    }

    /// The index over all cells that moved, eq. (analysis.22).
    ///
    /// # Errors
    /// When there is no such type, fewer than two frames lie between the times, or no cell moved.
    pub(super) fn evaluate(&self, recording: &Recording) -> Result<f64> {
        let tracks = Tracks::of(recording, self.cells.as_deref())?
            .along(self.space.axes())
            .between(self.from.map(Time::value), self.to.map(Time::value))?;
        let cue = match (self.direction, self.towards) {
            (Some(direction), _) => Cue::Direction(direction),
            (None, point) => Cue::Point(point.unwrap_or_default().map(Length::value)),
        };
        let [parallel, perpendicular] = forward_indices(&tracks, cue);
        let values = if self.part == ForwardPart::Parallel { parallel } else { perpendicular };
        over_tracks(values, self.statistic, "no cell moved, or all start at the point of the cue")
    }
}
