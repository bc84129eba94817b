//! The series of a finished run, as plain arrays, and how values of many cells become one.

use crate::error::{Error, Fault, Result};
use crate::experiment::Over;
use crate::output::ResultFile;
use ndarray::{Array2, Array3};
use std::collections::BTreeMap;

/// Series of a finished run: those that the measures at hand need, see [`super::measure::series_of`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recording {
    /// Time of each frame, s; the series `time`.
    pub times: Vec<f64>,
    /// Names of the cell types.
    pub types: Vec<String>,
    /// For each cell the index of its type.
    pub cell_types: Vec<u32>,
    /// Per-cell series by name, [frame, cell], in base units.
    pub cells: BTreeMap<String, Array2<f64>>,
    /// Series of the whole scene by name, [frame], in base units.
    pub scene: BTreeMap<String, Vec<f64>>,
    /// Motility runs that ended: cell, time of the end (s), duration (s).
    pub runs: Vec<(u32, f64, f64)>,
}

/// Makes one of the values of several cells.
fn reduce(over: Over, values: &[f64]) -> f64 {
    match over {
        Over::Mean => super::statistics::mean(values),
        Over::Min => values.iter().copied().fold(f64::INFINITY, f64::min),
        Over::Max => values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        Over::Sum => values.iter().sum(),
        Over::First => values[0],
    }
}

impl Recording {
    /// Reads the series that are asked for, and the rest, from a result file. Names that the file has no series of are
    /// passed over; [`Recording::series`] says so when they are used.
    ///
    /// # Errors
    /// A damaged file.
    pub fn read(file: &ResultFile, names: &[&str]) -> Result<Self> {
        let layout = file.layout();
        let mut recording = Self {
            times: file.times()?,
            types: layout.types.clone(),
            cell_types: layout.cells.iter().map(|cell| cell.kind).collect(),
            runs: file.runs()?,
            ..Self::default()
        };
        let (of_cells, of_scene) = (file.series_names(), file.scene_names());
        for &name in names {
            if of_scene.iter().any(|known| known == name) {
                recording.scene.insert(name.to_owned(), file.scene_series(name)?);
            } else if name == "speed" || of_cells.iter().any(|known| known == name) {
                recording.cells.insert(name.to_owned(), file.cell_series(name)?);
            }
        }
        Ok(recording)
    }

    /// The numbers of the cells of a type, or of all cells.
    ///
    /// # Errors
    /// When there is no such type or no such cell.
    pub fn cells_of(&self, kind: Option<&str>) -> Result<Vec<usize>> {
        let wanted = match kind {
            None => None,
            Some(name) => Some(self.types.iter().position(|known| known == name).ok_or_else(|| {
                let fault = Fault::new(format!("there is no cell type \"{name}\" in this run"));
                Error::input(fault.help(format!("its types are {}", self.types.join(", "))))
            })?),
        };
        let wears = |cell: &usize| wanted.is_none_or(|wanted| self.cell_types[*cell] as usize == wanted);
        let cells: Vec<usize> = (0..self.cell_types.len()).filter(wears).collect();
        if cells.is_empty() {
            let fault = Fault::new("there are no cells to measure");
            return Err(Error::input(fault.help("give a type that the run has cells of")));
        }
        Ok(cells)
    }

    /// A series with one value for each frame: the time, one of the scene, or one of the cells made one by `over`.
    ///
    /// # Errors
    /// When there is no such series, type or cell.
    pub fn series(&self, name: &str, kind: Option<&str>, over: Over) -> Result<Vec<f64>> {
        if name == "time" {
            return Ok(self.times.clone());
        }
        if let Some(values) = self.scene.get(name) {
            return Ok(values.clone());
        }
        let cells = self.cells_of(kind)?;
        let series = self.cell_series(name)?;
        // A system of chemistry may live in some of the cells only: the others have no value in any frame.
        let having: Vec<usize> =
            cells.iter().copied().filter(|cell| series.column(*cell).iter().any(|value| !value.is_nan())).collect();
        let cells = if having.is_empty() { cells } else { having };
        let rows = series.rows().into_iter();
        Ok(rows.map(|row| reduce(over, &cells.iter().map(|&cell| row[cell]).collect::<Vec<_>>())).collect())
    }

    /// Positions of some cells, µm, [frame, cell, axis], of the series `position_x`, `position_y`, `position_z`.
    ///
    /// # Errors
    /// When these were not recorded.
    pub fn positions(&self, cells: &[usize]) -> Result<Array3<f64>> {
        let mut axes = Vec::with_capacity(3);
        for name in ["position_x", "position_y", "position_z"] {
            axes.push(self.cell_series(name)?);
        }
        let shape = (self.times.len(), cells.len(), 3);
        Ok(Array3::from_shape_fn(shape, |(frame, cell, axis)| axes[axis][[frame, cells[cell]]]))
    }

    fn cell_series(&self, name: &str) -> Result<&Array2<f64>> {
        self.cells.get(name).ok_or_else(|| {
            let known = ["time"].into_iter().chain(self.scene.keys().chain(self.cells.keys()).map(String::as_str));
            let fault = Fault::new(format!("there is no series \"{name}\" in this run"));
            Error::input(fault.help(format!("the series at hand are {}", known.collect::<Vec<_>>().join(", "))))
        })
    }
}
