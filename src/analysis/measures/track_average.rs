//! A number that each track has, over the cells.

use super::declared::Declared;
use super::statistic::Statistic;
use crate::analysis::recording::{POSITION, Recording};
use crate::analysis::tracks::Tracks;
use crate::analysis::tracks::motion::Quantity;
use crate::cell::motility::Space;
use crate::error::{Error, Fault, Result};
use crate::units::Time;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A number that each track has, over the cells.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct TrackAverage {
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
    /// Whether cells move in the plane x, y or in space.
    #[serde(default)]
    pub space: Space,
    /// Which number of the values of all cells.
    #[serde(default)]
    pub statistic: Statistic,
}

impl TrackAverage {
    pub(super) fn series(&self) -> Vec<&str> {
        POSITION.to_vec()
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        at.stretch(self.from, self.to);
    }

    /// The number over all tracks that have it, eqs. (analysis.20), (analysis.21), (analysis.23).
    ///
    /// # Errors
    /// When there is no such type, fewer than two frames lie between the times, or no track has it.
    pub(super) fn evaluate(&self, recording: &Recording, quantity: Quantity) -> Result<f64> {
        let tracks = Tracks::of(recording, self.cells.as_deref())?
            .along(self.space.axes())
            .between(self.from.map(Time::value), self.to.map(Time::value))?;
        over_tracks(quantity.of(&tracks), self.statistic, quantity.undefined())
    }
}

/// One number of the values of tracks, without those that are not defined.
///
/// # Errors
/// When none is, with why.
pub(super) fn over_tracks(mut values: Vec<f64>, statistic: Statistic, undefined: &str) -> Result<f64> {
    let all = values.len();
    values.retain(|value| !value.is_nan());
    if values.is_empty() {
        let fault = Fault::new(format!("it is not defined for {all} tracks: {undefined}"));
        return Err(Error::input(fault.help("give the cells motility or a pull, and frames enough")));
    }
    statistic.of(&values)
}

#[cfg(test)]
mod tests {
    use crate::analysis::measures::test_recordings::{PERSISTENCE, evaluate, walkers};
    use crate::analysis::measures::test_results::all_are;
    use crate::analysis::measures::{Measure, MeasureKind};

    fn kind(text: &str) -> MeasureKind {
        toml::from_str::<Measure>(&text.replace("; ", "\n")).unwrap_or_else(|error| panic!("{text}: {error}")).kind
    }

    #[test]
    fn straight_cells_and_zigzags_have_their_directness_speed_and_turns() {
        // Amoebae: three straight, three in zigzags of 0.06 µm nearer on each step of 0.1 µm.
        all_are(&[
            ("kind = 'directness'; cells = 'amoeba'; from = '10 s'; to = '60 s'", 0.8, 1e-12),
            ("kind = 'mean_speed'; cells = 'amoeba'; statistic = 'standard_deviation'", 0.0, 1e-12),
        ]);
    }

    #[test]
    fn walkers_of_speed_one_have_the_measures_of_their_walk() {
        let recording = walkers(2_000);
        let value = |text: &str| evaluate(&kind(text), &recording).unwrap();
        // Between frames a quarter of a persistence apart a chord is shorter than its path: Fürth's law for the root mean square, less for the mean.
        let speed = value("kind = 'mean_speed'");
        assert!(0.9 < speed && speed < 0.962, "{speed}");
        // Runs of constant speed have ⟨v(0)·v(t)⟩ = exp(−t/p); of means over intervals h, (cosh(h/p) − 1)/(h/p − 1 + exp(−h/p)) exp(−t/p).
        let h: f64 = 0.25;
        let blur = (h.cosh() - 1.0) / (h - 1.0 + (-h).exp());
        for (lag, expected) in
            [("5 s", blur * (-h).exp()), ("20 s", blur * (-1.0_f64).exp()), ("60 s", blur * (-3.0_f64).exp())]
        {
            let found = value(&format!("kind = 'velocity_correlation'; lag = '{lag}'"));
            println!("{lag}: {found} {expected}");
            // 2 000 walks of some twenty independent stretches: an error of 1/√40 000 = 0.005; three of them.
            assert!((found - expected).abs() < 0.015, "{lag}: {found} {expected}");
        }
        let persistence = value("kind = 'persistence'");
        assert!((persistence / PERSISTENCE - 1.0).abs() < 0.05, "{persistence}");
        let [low, high] =
            ["low", "high"].map(|end| value(&format!("kind = 'persistence'; statistic = 'persistence_{end}'")));
        assert!(low < PERSISTENCE && PERSISTENCE < high && high / low < 1.2, "{low} to {high}");
        assert!((value("kind = 'persistence'; statistic = 'speed'") - 1.0).abs() < 0.03);
        // Directions without preference.
        assert!(value("kind = 'rayleigh'") > 0.01);
        assert!(value("kind = 'rayleigh'; statistic = 'resultant_length'") < 0.06);
        let forward = value("kind = 'forward_index'; direction = [1, 0, 0]");
        let error = value("kind = 'forward_index'; direction = [1, 0, 0]; statistic = 'standard_error'");
        assert!(forward.abs() < 3.0 * error, "{forward} ± {error}");
        // Straight at lags far below the persistence, diffusive far above: the local slope of Fürth's law in between.
        let exponent = value("kind = 'msd_exponent'; lag_from = '100 s'; lag_to = '200 s'");
        assert!(1.0 < exponent && exponent < 1.25, "{exponent}");
    }
}
