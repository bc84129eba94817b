//! The time in which a series, or the column of a measured table, comes to rest.

use super::declared::Declared;
use super::finished::Finished;
use crate::analysis::over::Over;
use crate::analysis::relaxation::{self, Law};
use crate::analysis::table::Table;
use crate::error::{Error, Fault, Result};
use crate::units::Time;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The time in which a series of a run, or a column of a measured table, comes to rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct RecoveryTime {
    /// The series; give it or `table`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "series"))]
    pub series: Option<String>,
    /// The type of cells of the series; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// A measured table, relative to the document; give it or `series`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "file"))]
    pub table: Option<PathBuf>,
    /// Its column of times, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_column: Option<String>,
    /// Its column of what comes to rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y_column: Option<String>,
    /// How it comes to rest.
    #[serde(default)]
    pub law: Law,
    /// Only from this time on; from the first on when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Time>,
    /// Only up to this time; up to the last when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Time>,
    /// Which number of the fit.
    #[serde(default)]
    pub statistic: RecoveryStatistic,
}

/// Which number of the fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum RecoveryStatistic {
    /// The time.
    #[default]
    Time,
    /// Where it comes to rest.
    End,
    /// Root mean square of what the fitted curve is off.
    Off,
}

impl RecoveryTime {
    pub(super) fn series(&self) -> Vec<&str> {
        self.series.as_deref().into_iter().collect()
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        match (&self.series, &self.table) {
            (Some(_), Some(_)) => at.two_keys("table", "series", "measure one of them"),
            (None, None) => {
                let message = format!("`{}` lacks what comes to rest", at.path());
                let help = "add `series = \"NAME\"`, or a `table` with `x_column` and `y_column`";
                at.fault("", "`series` or `table` is missing here", message, help);
            }
            (None, Some(_)) if self.x_column.is_none() || self.y_column.is_none() => {
                let message = format!("`{}` lacks the columns of its table", at.path());
                at.fault("", "columns are missing here", message, "add `x_column` and `y_column`");
            }
            (None, Some(_)) if self.cells.is_some() => {
                at.two_keys("cells", "table", "leave `cells` out: a table has none");
            }
            // The times of a table are its own.
            (None, Some(_)) => {}
            (Some(_), None) => at.stretch(self.from, self.to),
        }
    }

    /// The number of the fit, eq. (analysis.40).
    ///
    /// # Errors
    /// When there is no such series, type, cell, table or column, or nothing that comes to rest.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let (times, values) = match (&self.series, &self.table, &self.x_column, &self.y_column) {
            (Some(series), ..) => {
                let values = run.recording.series(series, self.cells.as_deref(), Over::Mean)?;
                (run.recording.times.clone(), values)
            }
            (None, Some(table), Some(x), Some(y)) => {
                let table = Table::read(&(run.resolve)(table))?;
                (table.column(x)?.to_vec(), table.column(y)?.to_vec())
            }
            _ => {
                let fault = Fault::new("nothing has no time in which it comes to rest");
                return Err(Error::input(fault.help("give a `series`, or a `table` and its columns")));
            }
        };
        let (from, to) = (self.from.map_or(f64::NEG_INFINITY, Time::value), self.to.map_or(f64::INFINITY, Time::value));
        // Frames are where they were asked for but for round-off.
        let slack = 1e-9 * times.iter().fold(0.0, |most: f64, time| most.max(time.abs()));
        let within = |(time, value): &(f64, f64)| (from - slack..=to + slack).contains(time) && value.is_finite();
        let (times, values): (Vec<f64>, Vec<f64>) = times.into_iter().zip(values).filter(within).unzip();
        let found = relaxation::fit(self.law, &times, &values).ok_or_else(|| {
            let found = format!("no time can be told in which this comes to rest from {} points", times.len());
            let help = "four are needed, and some of them where it is nearly at rest; look at it with plot, and set `from` and `to`";
            Error::input(Fault::new(found).help(help))
        })?;
        Ok(match self.statistic {
            RecoveryStatistic::Time => found.time,
            RecoveryStatistic::End => found.end,
            RecoveryStatistic::Off => found.off,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::measures::MeasureKind;
    use crate::analysis::measures::test_recordings::evaluate;
    use crate::analysis::recording::Recording;
    use std::collections::BTreeMap;
    use std::io::Write;

    const NOTHING: RecoveryTime = RecoveryTime {
        series: None,
        cells: None,
        table: None,
        x_column: None,
        y_column: None,
        law: Law::Exponential,
        from: None,
        to: None,
        statistic: RecoveryStatistic::Time,
    };

    #[test]
    fn series_and_tables_come_to_rest_in_the_stretch_asked_for() {
        let times: Vec<f64> = (0..40).map(|i| 0.1 * f64::from(i)).collect();
        let size: Vec<f64> =
            times.iter().map(|t| if *t < 1.0 { 9.0 } else { 2.0 + (-(t - 1.0) / 0.7).exp() }).collect();
        let mut file = tempfile::NamedTempFile::new().unwrap();
        writeln!(file, "t,y").unwrap();
        times.iter().zip(&size).for_each(|(t, y)| writeln!(file, "{t},{y}").unwrap());
        let recording = Recording { times, scene: BTreeMap::from([("size".to_owned(), size)]), ..Recording::default() };
        let from = Some(Time::new(1.0));
        let of_series = RecoveryTime { series: Some("size".into()), from, ..NOTHING };
        let of_table = RecoveryTime {
            table: Some(file.path().to_owned()),
            x_column: Some("t".into()),
            y_column: Some("y".into()),
            from,
            ..NOTHING
        };
        for of in [of_series, of_table] {
            let number =
                |statistic| evaluate(&MeasureKind::RecoveryTime(RecoveryTime { statistic, ..of.clone() }), &recording);
            assert!((number(RecoveryStatistic::Time).unwrap() - 0.7).abs() < 1e-6);
            assert!((number(RecoveryStatistic::End).unwrap() - 2.0).abs() < 1e-6);
            assert!(number(RecoveryStatistic::Off).unwrap() < 1e-6);
            let few = RecoveryTime { to: Some(Time::new(1.2)), ..of };
            let message = evaluate(&MeasureKind::RecoveryTime(few), &recording).unwrap_err().to_string();
            assert!(message.contains("from 3 points"), "{message}");
        }
    }
}
