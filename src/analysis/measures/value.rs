//! A series at one instant, or its mean or extremes in time.

use super::declared::Declared;
use super::reduction::Reduction;
use crate::analysis::over::Over;
use crate::analysis::recording::Recording;
use crate::error::{Error, Fault, Result};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A series at one instant, or its mean or extremes in time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Value {
    /// The series.
    #[schemars(extend("x-text" = "series"))]
    pub series: String,
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// How the values of several cells become one.
    #[serde(default)]
    pub over: Over,
    /// The instant, or how the values at several instants become one.
    #[serde(default)]
    pub time: Reduction,
}

impl Value {
    pub(super) fn series(&self) -> Vec<&str> {
        vec![&self.series]
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        self.time.check(at);
    }

    /// The value of the series.
    ///
    /// # Errors
    /// When there is no such series, type, cell or time, or no value.
    pub(super) fn evaluate(&self, recording: &Recording) -> Result<f64> {
        let (series, cells) = (self.series.as_str(), self.cells.as_deref());
        let value = self.time.reduce(&recording.times, &recording.series(series, cells, self.over)?)?;
        match value.is_nan() && series.starts_with("contact.") {
            true => Err(nobody_touches(series)),
            false if value.is_nan() && !recording.lives.is_empty() => Err(nobody_there(series, cells)),
            false => Ok(value),
        }
    }
}

/// That a series of contacts has no value where it is asked for.
fn nobody_touches(series: &str) -> Error {
    let fault = Fault::new(format!("\"{series}\" has no value where no two cells touch, or none of different types"));
    Error::input(fault.help("give a time at which such cells touch"))
}

/// That there is no cell to measure where a series is asked for.
fn nobody_there(series: &str, kind: Option<&str>) -> Error {
    let which = kind.map_or("no cell".to_owned(), |kind| format!("no cell of the type \"{kind}\""));
    let fault = Fault::new(format!("\"{series}\" has no value: {which} is there at a time at which it is asked for"));
    Error::input(fault.help("give a time at which there are such cells, or take `min` or `max`"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::measures::MeasureKind;
    use crate::analysis::measures::test_recordings::{evaluate, pulled};
    use crate::analysis::measures::test_results::{all_are, inside};
    use crate::units::Time;

    fn value(cells: Option<&str>, over: Over, time: Reduction) -> MeasureKind {
        MeasureKind::Value(Value { series: "size_x".to_owned(), cells: cells.map(str::to_owned), over, time })
    }

    #[test]
    fn values_are_reduced_over_cells_and_time() {
        let recording = pulled();
        let found = |cells, over, time| evaluate(&value(cells, over, time), &recording).unwrap();
        assert_eq!(found(Some("white"), Over::Mean, Reduction::Last), 7.0);
        assert_eq!(found(None, Over::Min, Reduction::First), 4.0);
        assert_eq!(found(None, Over::Max, Reduction::Mean), 9.0);
        assert_eq!(found(Some("white"), Over::Sum, Reduction::Max), 14.0);
        assert_eq!(found(Some("white"), Over::First, Reduction::Min), 4.0);
        assert_eq!(found(Some("red"), Over::Mean, Reduction::Range), 2.0);
        assert_eq!(found(Some("red"), Over::Mean, Reduction::At(Time::new(2.0))), 9.5);
    }

    #[test]
    fn a_time_meant_to_be_the_last_is_the_last() {
        let mut recording = pulled();
        recording.times[2] = 3.0 - 1e-12;
        let at = |time| evaluate(&value(Some("red"), Over::Mean, Reduction::At(Time::new(time))), &recording);
        assert_eq!(at(3.0).unwrap(), 10.0);
        assert!(at(3.001).is_err());
    }

    #[test]
    fn what_is_not_there_is_named() {
        let recording = pulled();
        let message = |measure: MeasureKind| evaluate(&measure, &recording).unwrap_err().to_string();
        let missing = value(Some("blue"), Over::Mean, Reduction::Last);
        assert_eq!(message(missing), "there is no cell type \"blue\" in this run");
        assert_eq!(message(value(None, Over::Mean, Reduction::At(Time::new(4.0)))), "nothing was recorded at 4 s");
        let measure =
            MeasureKind::Value(Value { series: "volume".into(), cells: None, over: Over::Mean, time: Reduction::Last });
        assert_eq!(measure.series(), ["volume"]);
        assert_eq!(message(measure), "there is no series \"volume\" in this run");
    }

    #[test]
    fn series_of_chemistry_are_reduced_like_others_over_the_cells_that_have_them() {
        let mean = (0..6).map(|cell| inside(cell, 20.0)).sum::<f64>() / 6.0;
        let swing = "kind = 'value'; series = 'chemistry.oscillator.cAMP'; time = '20 s'";
        all_are(&[
            (swing, mean, 1e-12),
            (&format!("{swing}; cells = 'amoeba'; over = 'first'"), inside(0, 20.0), 1e-12),
            ("kind = 'value'; series = 'oscillator.cAMP'; time = '20 s'", mean, 1e-12),
            ("kind = 'value'; series = 'chemistry.clock.tick'; time = '25 s'", 0.0, 1e-12),
            ("kind = 'slope'; x = 'chemistry.clock.tick'; y = 'chemistry.clock.tick'", 1.0, 1e-12),
        ]);
    }
}
