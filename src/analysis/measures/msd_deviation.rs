//! How far the mean squared displacement of cells is from Fürth's formula.

use super::declared::Declared;
use crate::analysis::furth::furth;
use crate::analysis::msd;
use crate::analysis::recording::{POSITION, Recording};
use crate::error::{Error, Fault, Result};
use crate::units::{Speed, Time};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Number of lags at which displacements are held against Fürth's law. Neighbouring lags share most of their steps, so
/// more of them would tell little more.
const LAGS: usize = 12;

/// How far the mean squared displacement of cells is from Fürth's formula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct MsdDeviation {
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// Speed in the formula.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub speed: Speed,
    /// Persistence in the formula.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub persistence: Time,
    /// The shortest lag.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub lag_from: Time,
    /// The longest lag.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub lag_to: Time,
}

impl MsdDeviation {
    pub(super) fn series(&self) -> Vec<&str> {
        POSITION.to_vec()
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        if self.lag_from >= self.lag_to {
            let message = format!("`{}.lag_to` is not above `lag_from`", at.path());
            at.fault("lag_to", "too small", message, "exchange the two");
        }
        at.instant("lag_to", self.lag_to);
    }

    /// Largest distance, in standard errors, of the mean squared displacement from Fürth's law, eq. (analysis.8): at
    /// [`LAGS`] lags, or the frames nearest to them, from the shortest to the longest in equal ratios.
    ///
    /// # Errors
    /// When there is no such type, fewer than two cells, or the frames do not reach over the lags.
    pub(super) fn evaluate(&self, recording: &Recording) -> Result<f64> {
        let (speed, persistence) = (self.speed.value(), self.persistence.value());
        let (lag_from, lag_to) = (self.lag_from.value(), self.lag_to.value());
        let cells = recording.cells_of(self.cells.as_deref())?;
        let times = &recording.times;
        // A millionth forgives the round-off of frames that are due at the very ends.
        let within = |lag: f64| lag > 0.0 && lag_from * (1.0 - 1e-6) <= lag && lag <= lag_to * (1.0 + 1e-6);
        let usable: Vec<usize> = (0..times.len()).filter(|&frame| within(times[frame] - times[0])).collect();
        let reaches = times.last().is_some_and(|last| last - times[0] >= lag_to * (1.0 - 1e-6));
        if cells.len() < 2 || usable.is_empty() || !reaches {
            let recorded = times.last().map_or(0.0, |last| last - times[0]);
            let found = format!(
                "displacements of {} cells over {lag_from} s to {lag_to} s cannot be measured from {} frames of {recorded} s",
                cells.len(),
                times.len()
            );
            return Err(Error::input(
                Fault::new(found).help("give two cells or more, and lags within the recorded time"),
            ));
        }
        let wanted = |index: usize| lag_from * (lag_to / lag_from).powf(index as f64 / (LAGS - 1) as f64);
        let distance = |frame: usize, lag: f64| (times[frame] - times[0] - lag).abs();
        let nearest = |lag: f64| usable.iter().copied().min_by(|&a, &b| distance(a, lag).total_cmp(&distance(b, lag)));
        let mut frames: Vec<usize> = (0..LAGS).filter_map(|index| nearest(wanted(index))).collect();
        frames.dedup();
        let measured = msd::from_the_start(recording.positions(&cells)?.view(), times, &frames);
        let deviation = |one: &msd::Displacement| (one.msd - furth(one.lag, speed, persistence)).abs() / one.error;
        // A maximum that NaN passes through: cells that stand still all alike agree with no law.
        Ok(measured.iter().map(deviation).fold(0.0, |most: f64, next| if next <= most { most } else { next }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::measures::MeasureKind;
    use crate::analysis::measures::test_recordings::{FRAMES, PERSISTENCE, evaluate, walkers};

    fn msd_deviation(speed: f64, persistence: f64, lag_from: f64, lag_to: f64) -> MeasureKind {
        let [persistence, lag_from, lag_to] = [persistence, lag_from, lag_to].map(Time::new);
        let speed = Speed::new(speed);
        MeasureKind::MsdDeviation(MsdDeviation { cells: None, speed, persistence, lag_from, lag_to })
    }

    #[test]
    fn walkers_agree_with_fuerths_law_and_with_no_other() {
        let recording = walkers(2_000);
        let deviation = |speed: f64, persistence: f64| {
            let (lag_from, lag_to) = (PERSISTENCE / 4.0, 10.0 * PERSISTENCE);
            evaluate(&msd_deviation(speed, persistence, lag_from, lag_to), &recording).unwrap()
        };
        // Three standard errors, and far more where speed or persistence are a fifth off.
        assert!(deviation(1.0, PERSISTENCE) < 3.0);
        assert!(deviation(1.2, PERSISTENCE) > 8.0);
        assert!(deviation(1.0, 1.2 * PERSISTENCE) > 5.0);
    }

    #[test]
    fn displacements_need_two_cells_and_time_enough() {
        let measure = |lag_to| msd_deviation(1.0, 20.0, 5.0, lag_to);
        let recording = walkers(3);
        assert!(evaluate(&measure(400.0), &recording).is_ok());
        assert!(evaluate(&measure(401.0), &recording).unwrap_err().to_string().contains("81 frames of 400 s"));
        assert!(evaluate(&measure(400.0), &walkers(1)).unwrap_err().to_string().contains("of 1 cells"));
    }

    #[test]
    fn displacements_go_by_the_times_of_frames() {
        // Frames as an adaptive step leaves them: every third only, then all but a few.
        let mut recording = walkers(2_000);
        let kept: Vec<usize> = (0..FRAMES).filter(|frame| frame % 3 == 0 || (*frame > 40 && frame % 5 != 0)).collect();
        recording.times = kept.iter().map(|&frame| recording.times[frame]).collect();
        for series in recording.cells.values_mut() {
            *series = series.select(ndarray::Axis(0), &kept);
        }
        let measure = |lag_to| msd_deviation(1.0, 20.0, 5.0, lag_to);
        assert!(evaluate(&measure(200.0), &recording).unwrap() < 3.0);
    }
}
