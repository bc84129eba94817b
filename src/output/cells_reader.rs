//! Reads which cells there are, and the quantities of cells.

use std::collections::BTreeMap;
use std::ops::Range;

use hdf5::File;
use ndarray::Array2;

use super::whole::cells_of;
use super::{Cell, Known, Layout, ResultFile, SystemScope};
use crate::error::Result;
use crate::recorded::{CELL, SPEED};

/// The cells of all frames, and where their numbers are.
pub(super) struct Census {
    /// All cells that were ever recorded, by ascending id.
    known: Vec<Known>,
    /// For each population its cells, by their numbers in `known`.
    populations: Vec<Vec<u32>>,
    /// For each population the number of its atoms.
    atoms: Vec<usize>,
    frames: Vec<OfFrame>,
}

/// What is to be known of a frame.
#[derive(Clone, Copy)]
struct OfFrame {
    population: usize,
    /// Its first row among the cells and among the atoms of all frames.
    first_cell: usize,
    first_atom: usize,
}

impl Census {
    /// Reads the cells of the first frames: once for each population.
    pub fn read(file: &File, layout: &Layout, frames: usize) -> hdf5::Result<Self> {
        let column = |path: &str| -> hdf5::Result<Vec<usize>> {
            if frames == 0 {
                return Ok(Vec::new());
            }
            let numbers = file.dataset(path)?.read_slice_1d::<i64, _>(0..frames)?;
            numbers
                .iter()
                .map(|n| usize::try_from(*n).map_err(|_| format!("{path} holds {n}").as_str().into()))
                .collect()
        };
        let (parts, first_cells) = (column("/VTKHDF/Steps/PartOffsets")?, column("/cells/first")?);
        let first_atoms = column("/VTKHDF/Steps/PointOffsets")?;
        let of_frame = |frame: usize| OfFrame {
            population: parts[frame],
            first_cell: first_cells[frame],
            first_atom: first_atoms[frame],
        };
        let mut cells: Vec<Vec<Cell>> = Vec::new();
        let mut known: BTreeMap<u64, Known> = BTreeMap::new();
        let mut first = 0;
        for alike in parts.chunk_by(|one, other| one == other) {
            // Populations are numbered as they come.
            if alike[0] >= cells.len() {
                if alike[0] > cells.len() {
                    return Err(format!("population {} of a frame is not there", alike[0]).as_str().into());
                }
                cells.push(cells_of(file, layout, first)?);
            }
            let end = first + alike.len();
            for cell in &cells[alike[0]] {
                let seen = known.entry(cell.id).or_insert(Known { cell: *cell, frames: first..end });
                seen.frames.end = end;
            }
            first = end;
        }
        let ids: Vec<u64> = known.keys().copied().collect();
        let number = |cell: &Cell| ids.binary_search(&cell.id).map_or(u32::MAX, |number| number as u32);
        Ok(Self {
            known: known.into_values().collect(),
            atoms: cells.iter().map(|cells| layout.atoms(cells)).collect(),
            populations: cells.iter().map(|cells| cells.iter().map(number).collect()).collect(),
            frames: (0..frames).map(of_frame).collect(),
        })
    }

    /// The rows of the atoms of a frame.
    pub fn atoms(&self, frame: usize) -> Range<usize> {
        let known = self.frames[frame];
        known.first_atom..known.first_atom + self.atoms[known.population]
    }

    /// The rows of the cells of a frame.
    fn rows(&self, frame: usize) -> Range<usize> {
        let known = self.frames[frame];
        known.first_cell..known.first_cell + self.populations[known.population].len()
    }
}

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
        &self.census().populations[self.census().frames[frame].population]
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
        self.census().populations.len() < 2
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
        let start = self.census().frames.first().map_or(0, |known| known.first_cell);
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
        if name == SPEED {
            let component = |ending: &str| self.rows_of_cells(&format!("velocity_{ending}"), frames.clone());
            let (x, y, z) = (component("x")?, component("y")?, component("z")?);
            return Ok(x.iter().zip(&y).zip(&z).map(|((x, y), z)| (x * x + y * y + z * z).sqrt()).collect());
        }
        let (path, component) = self.find_series(name).ok_or_else(|| self.unknown(name))?;
        let rows = self.census().rows(frames.start).start..self.census().rows(frames.end - 1).end;
        if rows.is_empty() {
            return Ok(Vec::new());
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
        CELL.iter().find_map(|quantity| Some((quantity.dataset.to_owned(), quantity.component(name)?.0)))
    }
}
