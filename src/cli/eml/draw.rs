//! The curves of a solution as a chart.

use super::columns::Column;
use crate::equations::eml::Document;
use crate::error::{Fault, Result};
use crate::picture::chart::{svg_to_png, to_svg};
use crate::picture::image::write_file;
use crate::picture::{Axis, Chart, Series};
use std::path::{Path, PathBuf};

/// More points than this are not seen in a curve.
const MOST_POINTS: usize = 4000;

/// A chart that grows row by row.
pub(super) struct Drawing<'a> {
    path: PathBuf,
    columns: Vec<&'a Column>,
    curves: Vec<Vec<[f64; 2]>>,
    /// Every how many rows a point is drawn.
    stride: usize,
    rows: usize,
}

impl<'a> Drawing<'a> {
    /// An empty chart of some columns for a file.
    ///
    /// # Errors
    /// An ending that is no picture's; nothing to draw.
    pub(super) fn new(path: &Path, columns: &'a [Column], points: usize) -> std::result::Result<Self, Fault> {
        if !is_svg(path) && !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
            let fault = Fault::new(format!("cannot tell from its name what kind of picture {} is", path.display()));
            return Err(fault.help("let the name end in .svg or .png"));
        }
        let columns: Vec<&Column> = columns.iter().filter(|column| column.quantity.is_some()).collect();
        if columns.is_empty() {
            let help = "name a quantity with --columns, such as --columns time,x";
            return Err(Fault::new("there is no curve to draw").help(help));
        }
        let curves = vec![Vec::new(); columns.len()];
        Ok(Self { path: path.to_owned(), columns, curves, stride: points.div_ceil(MOST_POINTS).max(1), rows: 0 })
    }

    /// Takes a row.
    pub(super) fn row(&mut self, time: f64, values: &[f64]) {
        if self.rows.is_multiple_of(self.stride) {
            for (curve, column) in self.curves.iter_mut().zip(&self.columns) {
                curve.push([time, column.value(time, values)]);
            }
        }
        self.rows += 1;
    }

    /// Writes the picture.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(super) fn save(self, document: &Document) -> Result<PathBuf> {
        let shared = self.columns[0].unit.as_str();
        let same = self.columns.iter().all(|column| column.unit == shared) && !["", "1"].contains(&shared);
        let label = if let [only] = self.columns[..] { only.title.clone() } else { String::new() };
        let label = if same { format!("{label} ({shared})").trim().to_owned() } else { label };
        let curves = self.columns.iter().zip(self.curves);
        let chart = Chart {
            title: document.name.clone(),
            x: Axis::linear(format!("time ({})", document.time_unit)),
            y: Axis::linear(label),
            series: curves.map(|(column, points)| Series::line(&column.title, points)).collect(),
            ..Chart::default()
        };
        let svg = to_svg(&chart, 720.0, 480.0);
        let bytes = if is_svg(&self.path) { svg.into_bytes() } else { svg_to_png(&svg, 2.0)? };
        write_file(&self.path, &bytes).map(|()| self.path)
    }
}

fn is_svg(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"))
}
