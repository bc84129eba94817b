//! The period of a series that goes up and down.

use super::declared::Declared;
use super::statistic::Statistic;
use crate::analysis::recording::Recording;
use crate::analysis::waves;
use crate::error::{Error, Fault, Result};
use crate::units::Time;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The period of a series that goes up and down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Period {
    /// The series.
    #[schemars(extend("x-text" = "series"))]
    pub series: String,
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// One cell instead, by its number from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cell: Option<u32>,
    /// Only from this time on; from the first frame when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Time>,
    /// Which number of the periods of all cells.
    #[serde(default)]
    pub statistic: Statistic,
}

impl Period {
    pub(super) fn series(&self) -> Vec<&str> {
        vec![&self.series]
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        at.stretch(self.from, None);
        let number = at.cells();
        if let Some(cell) = self.cell.filter(|cell| *cell as usize >= number) {
            let message = format!("`{}.cell` is {cell}, but there are {number} cells", at.path());
            let help = format!("give a number from 0 to {}", number.saturating_sub(1));
            at.fault("cell", "no such cell", message, &help);
        }
        if self.cells.is_some() && self.cell.is_some() {
            at.two_keys("cell", "cells", "name a type of cells or number one cell");
        }
    }

    /// The mean period of the series, eq. (analysis.12), over cells.
    ///
    /// # Errors
    /// When there is no such series or cell, or one does not rise three times.
    pub(super) fn evaluate(&self, recording: &Recording) -> Result<f64> {
        let first = waves::first_frame(&recording.times, self.from.map(Time::value));
        let times = &recording.times[first..];
        let few = |whose: String, rises: usize| {
            let found =
                format!("{whose} rises through its middle {rises} times, which makes no period; three are needed");
            Error::input(Fault::new(found).help("let the run last longer, record more frames, or begin earlier (from)"))
        };
        if let Some(values) = recording.scene.get(&self.series) {
            let found = waves::period(times, &values[first..]);
            let periods = [found.map_err(|rises| few(format!("\"{}\"", self.series), rises))?];
            return self.statistic.of(&periods);
        }
        let mut cells = recording.cells_with(&self.series, self.cells.as_deref())?;
        if let Some(cell) = self.cell {
            let number = cells.len();
            cells.retain(|known| recording.number_of(u64::from(cell)) == Some(*known));
            if cells.is_empty() {
                let found =
                    format!("cell {cell} is not among the {number} cells that have values of \"{}\"", self.series);
                return Err(Error::input(Fault::new(found).help("cells are counted from 0 over all types")));
            }
        }
        let series = recording.cell_series(&self.series)?;
        let mut periods = Vec::new();
        for cell in cells {
            let values: Vec<f64> = series.column(cell).iter().skip(first).copied().collect();
            match waves::period(times, &values) {
                Ok(period) => periods.push(period),
                // One that came later or left earlier had no time for more.
                Err(_) if !(first..recording.times.len()).all(|frame| recording.is_there(frame, cell)) => {}
                Err(rises) => return Err(few(format!("\"{}\" of cell {}", self.series, recording.ids[cell]), rises)),
            }
        }
        if periods.is_empty() {
            return Err(few(format!("\"{}\" of any cell", self.series), 0));
        }
        self.statistic.of(&periods)
    }
}

#[cfg(test)]
mod tests {
    use crate::analysis::measures::test_results::all_are;

    #[test]
    fn periods_are_found_in_cells_and_in_the_scene() {
        let period = |rest: &str| format!("kind = 'period'; series = 'chemistry.{rest}");
        all_are(&[
            (&period("oscillator.cAMP'"), 30.0, 1e-2),
            (&period("oscillator.cAMP'; cell = 3"), 30.0, 1e-2),
            (&period("oscillator.cAMP'; cells = 'amoeba'; statistic = 'standard_error'"), 0.0, 1e-2),
            // A growing swing has its middle elsewhere than its zeros, which all periods share but the first.
            (&period("clock.tick'; from = '30 s'"), 12.5, 0.3),
        ]);
    }
}
