//! How the mean squared displacement grows with the lag.

use super::declared::Declared;
use crate::analysis::msd;
use crate::analysis::recording::{POSITION, Recording};
use crate::analysis::tracks::{Tracks, summary};
use crate::cell::motility::Space;
use crate::error::{Error, Fault, Result};
use crate::units::Time;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the mean squared displacement grows with the lag: as which power of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct MsdExponent {
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
}

impl MsdExponent {
    pub(super) fn series(&self) -> Vec<&str> {
        POSITION.to_vec()
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        check_lags(self.lag_from, self.lag_to, at);
    }

    /// The slope of the logarithms over windows that overlap, eq. (analysis.25).
    ///
    /// # Errors
    /// When there is no such type, the frames do not reach over the lags, or fewer than two lags have displacements.
    pub(super) fn evaluate(&self, recording: &Recording) -> Result<f64> {
        let tracks = Tracks::of(recording, self.cells.as_deref())?.along(self.space.axes());
        let of = msd::of_cells(tracks.positions.view(), &tracks.times, &lags_of(&tracks, self.lag_from, self.lag_to)?);
        let all: Vec<usize> = (0..tracks.number()).collect();
        let found = summary::exponent(&of.lags, &of.mean_of(&all));
        if found.is_nan() {
            let fault = Fault::new("fewer than two lags have displacements that are not zero");
            return Err(Error::input(
                fault.help("give cells that move, and lags of two intervals between frames or more"),
            ));
        }
        Ok(found)
    }
}

/// Notes lags in the wrong order, or outside of the run.
pub(super) fn check_lags(from: Option<Time>, to: Option<Time>, at: &mut dyn Declared) {
    if let (Some(from), Some(to)) = (from, to)
        && from >= to
    {
        let message = format!("`{}.lag_to` is not above `lag_from`", at.path());
        at.fault("lag_to", "too small", message, "exchange the two");
    }
    for (key, lag) in [("lag_from", from), ("lag_to", to)] {
        if let Some(lag) = lag {
            at.instant(key, lag);
        }
    }
}

/// The lags between two times, in frames.
///
/// # Errors
/// When no lag lies there.
pub(super) fn lags_of(tracks: &Tracks, from: Option<Time>, to: Option<Time>) -> Result<Vec<usize>> {
    let usual = tracks.usual_lags();
    let interval = tracks.interval();
    // A millionth forgives the round-off of frames that are due at the very ends.
    let first = from.map_or(1, |from| (from.value() / interval - 1e-6).ceil().max(1.0) as usize);
    let last = to.map_or(usual[usual.len() - 1], |to| (to.value() / interval + 1e-6).floor() as usize);
    let last = last.min(tracks.times.len().saturating_sub(1));
    if first > last {
        let fault =
            Fault::new(format!("no lag between the two lies within {} frames of {interval} s", tracks.times.len()));
        return Err(Error::input(fault.help("record frames more often, or give other lags")));
    }
    Ok((first..=last).collect())
}
