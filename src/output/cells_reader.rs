//! Reads the quantities of cells.

use std::ops::Range;

use ndarray::Array2;

use super::catalogue::CAME_LATER;
use super::{Cell, Known, ResultFile, SystemScope};
use crate::error::Result;
use crate::recorded::{cell_quantities, derived};

impl ResultFile {
    /// All cells that were ever recorded, by ascending id: the columns of [`cell_series`](Self::cell_series).
    pub fn known_cells(&self) -> &[Known] {
        &self.census().known
    }

    /// The column of each cell of a frame in [`cell_series`](Self::cell_series), in the order of the frame.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn columns(&self, frame: usize) -> &[u32] {
        self.census().columns(frame)
    }

    /// The cells of a frame, in the order of its arrays.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn cells(&self, frame: usize) -> Vec<Cell> {
        self.columns(frame).iter().map(|column| self.known_cells()[*column as usize].cell).collect()
    }

    /// The column of the cell with an id.
    pub fn column_of(&self, id: u64) -> Option<u32> {
        self.known_cells().binary_search_by_key(&id, |known| known.cell.id).ok().map(|column| column as u32)
    }

    /// Whether all frames have the same cells.
    pub fn has_one_population(&self) -> bool {
        self.census().populations() < 2
    }

    /// A series of cells, `[frame, cell]`, in the unit of [`units`](Self::units), for all cells of
    /// [`known_cells`](Self::known_cells); NaN where a cell is not there. Vectors go by component: `position_x`,
    /// `velocity_z`, `size_y`, `principal_1` (the longest); `speed` is the length of the velocity. `SYSTEM.QUANTITY` is
    /// a quantity of a system inside cells, NaN for cells without the system.
    ///
    /// # Errors
    /// An unknown name, or a damaged file.
    pub fn cell_series(&self, name: &str) -> Result<Array2<f64>> {
        let mut all = Array2::from_elem((self.frames(), self.known_cells().len()), f64::NAN);
        let values = self.rows_of_cells(name, 0..self.frames())?;
        let start = self.census().rows(0).start;
        for frame in 0..self.frames() {
            let first = self.census().rows(frame).start - start;
            for (column, value) in self.columns(frame).iter().zip(&values[first..]) {
                all[[frame, *column as usize]] = *value;
            }
        }
        Ok(all)
    }

    /// The values of a series of cells in a frame, for [`cells`](Self::cells).
    ///
    /// # Errors
    /// As [`cell_series`](Self::cell_series).
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn cell_values(&self, name: &str, frame: usize) -> Result<Vec<f64>> {
        self.rows_of_cells(name, frame..frame + 1)
    }

    /// The rows that some frames have in the dataset of a series, with what may lie between them.
    fn rows_of_cells(&self, name: &str, frames: Range<usize>) -> Result<Vec<f64>> {
        if let Some(derived) = derived(name) {
            let [x, y, z] = derived.components.map(|component| self.rows_of_cells(component, frames.clone()));
            let vectors = x?.into_iter().zip(y?).zip(z?);
            return Ok(vectors.map(|((x, y), z)| (derived.by)([x, y, z])).collect());
        }
        let (path, component) = self.find_series(name).ok_or_else(|| self.unknown(name))?;
        let rows = self.census().rows(frames.start).start..self.census().rows(frames.end - 1).end;
        if rows.is_empty() {
            return Ok(Vec::new());
        }
        if CAME_LATER.contains(&path.as_str()) && !self.has(&path) {
            return Ok(vec![0.0; rows.len()]);
        }
        self.read(&path, |dataset| match component {
            None => Ok(dataset.read_slice_1d::<f64, _>(rows)?.to_vec()),
            Some(i) => Ok(dataset.read_slice_1d::<f64, _>((rows, i))?.to_vec()),
        })
    }

    /// The dataset of a series of cells, and which component of a vector it is.
    fn find_series(&self, name: &str) -> Option<(String, Option<usize>)> {
        if let Some((system, (quantity, _))) = self.quantity_of(name)
            && system.scope == SystemScope::Cells
        {
            return Some((system.path(quantity), None));
        }
        let all = cell_quantities(self.layout().on_demand());
        all.into_iter().find_map(|quantity| Some((quantity.dataset.to_owned(), quantity.component(name)?.0)))
    }
}
