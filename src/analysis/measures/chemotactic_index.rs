//! How straight cells go towards a point.

use super::declared::Declared;
use super::statistic::Statistic;
use crate::analysis::recording::{POSITION, Recording};
use crate::analysis::tracks::Tracks;
use crate::analysis::tracks::motion::Motion;
use crate::cell::motility::Space;
use crate::error::{Error, Fault, Result};
use crate::units::{Length, Time};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How straight cells go towards a point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct ChemotacticIndex {
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// The point.
    pub towards: [Length; 3],
    /// When the path begins; with the first frame when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Time>,
    /// When the path ends; with the last frame when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Time>,
    /// Whether distances are measured in the plane x, y or in space.
    #[serde(default)]
    pub space: Space,
    /// Which number of the values of all cells.
    #[serde(default)]
    pub statistic: Statistic,
}

impl ChemotacticIndex {
    pub(super) fn series(&self) -> Vec<&str> {
        POSITION.to_vec()
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        at.stretch(self.from, self.to);
    }

    /// How straight cells go towards the point, eq. (analysis.11).
    ///
    /// # Errors
    /// When there is no such type, fewer than two frames lie between the times, or no cell moved.
    pub(super) fn evaluate(&self, recording: &Recording) -> Result<f64> {
        let tracks = Tracks::of(recording, self.cells.as_deref())?
            .along(self.space.axes())
            .between(self.from.map(Time::value), self.to.map(Time::value))?;
        let towards = self.towards.map(Length::value);
        // Of cells that come later or leave earlier the part of the path that they make.
        let index = |track: usize| {
            let motion = Motion::of(&tracks, track)?;
            let away = |position: [f64; 3]| {
                (0..tracks.axes()).map(|axis| (position[axis] - towards[axis]).powi(2)).sum::<f64>().sqrt()
            };
            let nearer = away(motion.start) - away(std::array::from_fn(|axis| motion.start[axis] + motion.net[axis]));
            (motion.path > 0.0).then_some(nearer / motion.path)
        };
        let indices: Vec<f64> = (0..tracks.number()).filter_map(index).collect();
        if indices.is_empty() {
            let fault = Fault::new(format!("none of {} cells moved", tracks.number()));
            return Err(Error::input(fault.help("give the cells motility or a pull")));
        }
        self.statistic.of(&indices)
    }
}

#[cfg(test)]
mod tests {
    use crate::analysis::measures::test_results::all_are;

    #[test]
    fn chemotactic_indices_are_one_for_straight_paths_and_the_cosine_for_zigzags() {
        let index = |rest: &str| format!("kind = 'chemotactic_index'; towards = ['0 um', '0 um', '0 um']; {rest}");
        // Three cells go straight; three come 0.06 µm nearer on each step of 0.1 µm.
        let error = 0.2 * (6.0_f64 / 5.0 / 6.0).sqrt();
        all_are(&[
            (&index("cells = 'amoeba'"), 0.8, 1e-12),
            // Rocks have no path and do not count; an even number of frames leaves no zigzag.
            (&index("from = '10 s'; to = '60 s'"), 0.8, 1e-12),
            (&index("statistic = 'standard_error'"), error, 1e-12),
            (&index("statistic = 'standard_deviation'"), error * 6.0_f64.sqrt(), 1e-12),
            ("kind = 'chemotactic_index'; towards = ['1 km', '0 um', '0 um']; space = 'volume'", -0.8, 1e-6),
        ]);
    }
}
