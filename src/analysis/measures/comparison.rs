//! A simulated curve beside a measured table: their distance, their ratio, and how many error bars it meets.

use super::declared::Declared;
use super::finished::Finished;
use crate::analysis::curve::Curve;
use crate::analysis::table::Table;
use crate::error::{Error, Fault, Result};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A simulated curve beside a measured table (CSV with a line of column names).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Comparison {
    /// The table, relative to the document.
    #[schemars(extend("x-text" = "file"))]
    pub table: PathBuf,
    /// Its column along x.
    pub x_column: String,
    /// What is added to its column along x, as where it counts from an instant within the run.
    #[serde(default, skip_serializing_if = "crate::elementary::is_zero")]
    pub x_shift: f64,
    /// Its column along y.
    pub y_column: String,
    /// Its column with the lower ends of the bars.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low_column: Option<String>,
    /// Its column with the upper ends of the bars.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub high_column: Option<String>,
    /// The series along x.
    #[schemars(extend("x-text" = "series"))]
    pub x: String,
    /// The series along y.
    #[schemars(extend("x-text" = "series"))]
    pub y: String,
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
}

impl Comparison {
    pub(super) fn series(&self) -> Vec<&str> {
        vec![&self.x, &self.y]
    }

    /// What must hold where error bars are counted.
    pub(super) fn check_bars(&self, at: &mut dyn Declared) {
        if self.low_column.is_none() || self.high_column.is_none() {
            let message = format!("`{}` lacks the columns of the bars", at.path());
            at.fault("", "columns are missing here", message, "add `low_column` and `high_column`");
        }
    }

    /// Root mean square of the relative distance between the table and the curve.
    ///
    /// # Errors
    /// When there is no such table, column, series, type or cell, or the curve does not reach a row.
    pub(super) fn rms(&self, run: &Finished) -> Result<f64> {
        let (table, curve) = self.open(run)?;
        curve.relative_rms(table.column(&self.x_column)?, table.column(&self.y_column)?)
    }

    /// The mean ratio of the curve to the table.
    ///
    /// # Errors
    /// As [`Comparison::rms`].
    pub(super) fn ratio(&self, run: &Finished) -> Result<f64> {
        let (table, curve) = self.open(run)?;
        curve.mean_ratio(table.column(&self.x_column)?, table.column(&self.y_column)?)
    }

    /// The number of rows whose bars hold the curve.
    ///
    /// # Errors
    /// As [`Comparison::rms`], and when the columns of the bars are not named.
    pub(super) fn bars(&self, run: &Finished) -> Result<f64> {
        let (Some(low), Some(high)) = (&self.low_column, &self.high_column) else {
            let fault = Fault::new("error bars cannot be counted without the columns of their ends");
            return Err(Error::input(fault.help("give low_column and high_column")));
        };
        let (table, curve) = self.open(run)?;
        let rows = curve.rows_within(table.column(&self.x_column)?, table.column(low)?, table.column(high)?)?;
        Ok(rows as f64)
    }

    fn open(&self, run: &Finished) -> Result<(Table, Curve)> {
        let curve = run.recording.curve(&self.x, &self.y, self.cells.as_deref())?;
        let mut table = Table::read(&(run.resolve)(&self.table))?;
        table.shift(&self.x_column, self.x_shift)?;
        Ok((table, curve))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::measures::MeasureKind;
    use crate::analysis::measures::test_recordings::{evaluate, pulled};
    use crate::analysis::recording::Recording;
    use ndarray::Array2;
    use std::collections::BTreeMap;
    use std::io::Write;
    use std::path::Path;

    #[test]
    fn tables_are_compared_with_the_curve() {
        let mut file = tempfile::NamedTempFile::new().unwrap();
        write!(file, "F,A,low,high\n0,8,7,9\n15,10,9.6,11\n").unwrap();
        let comparison = Comparison {
            table: file.path().to_owned(),
            x_column: "F".into(),
            x_shift: 0.0,
            y_column: "A".into(),
            low_column: Some("low".into()),
            high_column: Some("high".into()),
            x: "load.pull".into(),
            y: "size_x".into(),
            cells: Some("red".into()),
        };
        let recording = pulled();
        // The red cell measures 8 and 9.5 µm at the two loads.
        let rms = evaluate(&MeasureKind::TableRms(comparison.clone()), &recording).unwrap();
        assert!((rms - 0.05 / 2.0_f64.sqrt()).abs() < 1e-14);
        let ratio = evaluate(&MeasureKind::TableRatio(comparison.clone()), &recording).unwrap();
        assert!((ratio - 0.975).abs() < 1e-14);
        assert_eq!(evaluate(&MeasureKind::TableBars(comparison.clone()), &recording).unwrap(), 1.0);
        let without = Comparison { low_column: None, ..comparison };
        assert!(
            evaluate(&MeasureKind::TableBars(without), &recording)
                .unwrap_err()
                .to_string()
                .contains("without the columns")
        );
    }

    #[test]
    fn a_curve_through_the_cells_of_mills_meets_all_their_bars() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/optical_tweezers/data/mills2004_b.csv");
        let table = Table::read(&file).unwrap();
        let (force, axial) = (table.column("F_pN").unwrap(), table.column("A_um").unwrap());
        // A staircase: each load is held for two frames, and the cell has settled in the second.
        let twice = |values: &[f64], first: f64| values.iter().flat_map(|y| [first * y, *y]).collect::<Vec<f64>>();
        let recording = |stretch: f64| {
            let load = twice(force, 1.0);
            let sizes = twice(axial, 0.9).into_iter().map(|size| stretch * size).collect();
            Recording {
                times: (0..load.len()).map(|frame| frame as f64).collect(),
                types: vec!["red".to_owned()],
                cell_types: vec![0],
                cells: BTreeMap::from([("size_x".to_owned(), Array2::from_shape_vec((load.len(), 1), sizes).unwrap())]),
                scene: BTreeMap::from([("load.pull".to_owned(), load)]),
                ..Recording::default()
            }
        };
        let comparison = Comparison {
            table: file.clone(),
            x_column: "F_pN".into(),
            x_shift: 0.0,
            y_column: "A_um".into(),
            low_column: Some("Amin".into()),
            high_column: Some("Amax".into()),
            x: "load.pull".into(),
            y: "size_x".into(),
            cells: None,
        };
        let [rms, ratio, bars] = [MeasureKind::TableRms, MeasureKind::TableRatio, MeasureKind::TableBars]
            .map(|kind| move |recording: &Recording, of: &Comparison| evaluate(&kind(of.clone()), recording).unwrap());
        // Interpolation at the points themselves is exact; a twentieth more is a twentieth off in each row.
        assert_eq!(rms(&recording(1.0), &comparison), 0.0);
        assert_eq!(bars(&recording(1.0), &comparison), table.rows() as f64);
        assert!((rms(&recording(1.05), &comparison) - 0.05).abs() < 1e-14);
        assert!((ratio(&recording(1.05), &comparison) - 1.05).abs() < 1e-14);
        // No bar reaches a quarter beyond its mean.
        assert_eq!(bars(&recording(1.25), &comparison), 0.0);
    }
}
