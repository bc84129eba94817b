//! The series of a finished run, as plain arrays, and the curves between them.

use super::curve::Curve;
use super::over::Over;
use crate::error::{Error, Fault, Result};
use crate::output::ResultFile;
use crate::values::When;
use ndarray::{Array2, Array3, ArrayView1};
use std::collections::BTreeMap;
use std::ops::Range;

/// The series that hold where cells are, along x, y and z.
pub const POSITION: [&str; 3] = ["position_x", "position_y", "position_z"];

/// Series of a finished run: those that the measures at hand need, see [`MeasureKind::series`](super::measures::MeasureKind::series).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recording {
    /// Time of each frame, s; the series `time`.
    pub times: Vec<f64>,
    /// Names of the cell types.
    pub types: Vec<String>,
    /// Ids of all cells that were ever there, ascending: a cell's number in this recording is its position here.
    pub ids: Vec<u64>,
    /// For each cell the index of its type.
    pub cell_types: Vec<u32>,
    /// For each cell from its first frame to the one after its last; empty if all cells are there in all frames.
    pub lives: Vec<Range<usize>>,
    /// Per-cell series by name, [frame, cell], in base units; NaN where a cell is not there.
    pub cells: BTreeMap<String, Array2<f64>>,
    /// Series of the whole scene by name, [frame], in base units.
    pub scene: BTreeMap<String, Vec<f64>>,
    /// Motility runs that ended: number of the cell, time of the end (s), duration (s).
    pub runs: Vec<(usize, f64, f64)>,
    /// Names of all series that the run has, those of chemistry as `SYSTEM.QUANTITY`.
    pub known: Vec<String>,
}

/// What a series of chemistry may begin with, so that a reader of the document knows where it comes from.
const CHEMISTRY: &str = "chemistry.";

impl Recording {
    /// Reads the series that are asked for, and the rest, from a result file. Quantities of chemistry are called
    /// `chemistry.SYSTEM.QUANTITY` or `SYSTEM.QUANTITY`. Names that the file has no series of are passed over;
    /// [`Recording::series`] says so when they are used.
    ///
    /// # Errors
    /// A damaged file.
    pub fn read(file: &ResultFile, names: &[&str]) -> Result<Self> {
        let known = file.known_cells();
        let lives = known.iter().map(|known| known.frames.clone());
        // A cell that came and went between two frames is of no known type.
        let number = |(id, end, duration)| Some((file.column_of(id)? as usize, end, duration));
        let mut recording = Self {
            times: file.times()?,
            types: file.layout().type_names(),
            ids: known.iter().map(|known| known.cell.id).collect(),
            cell_types: known.iter().map(|known| known.cell.kind).collect(),
            lives: if file.has_one_population() { Vec::new() } else { lives.collect() },
            runs: file.runs()?.into_iter().filter_map(number).collect(),
            ..Self::default()
        };
        let (of_cells, of_scene) = (file.series_names(), file.scene_names());
        for &name in names {
            let in_file = |name: &str| of_scene.iter().chain(&of_cells).any(|known| known == name);
            let stored = name.strip_prefix(CHEMISTRY).filter(|_| !in_file(name)).unwrap_or(name);
            if of_scene.iter().any(|known| known == stored) {
                recording.scene.insert(name.to_owned(), file.scene_series(stored)?);
            } else if of_cells.iter().any(|known| known == stored) {
                recording.cells.insert(name.to_owned(), file.cell_series(stored)?);
            }
        }
        recording.known = ["time".to_owned()].into_iter().chain(of_scene).chain(of_cells).collect();
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
        let cells = self.cells_with(name, kind)?;
        let series = self.cell_series(name)?;
        // A system of chemistry may live in some of the cells only: the others have no value in any frame.
        let having: Vec<usize> =
            cells.iter().copied().filter(|cell| series.column(*cell).iter().any(|value| !value.is_nan())).collect();
        let cells = if having.is_empty() { cells } else { having };
        let of_frame = |(frame, row): (usize, ArrayView1<f64>)| {
            let there = cells.iter().filter(|cell| self.is_there(frame, **cell));
            over.reduce(&there.map(|&cell| row[cell]).collect::<Vec<_>>())
        };
        Ok(series.rows().into_iter().enumerate().map(of_frame).collect())
    }

    /// The curve y(x) of two series; each a mean over the cells of a type, or over all cells.
    ///
    /// # Errors
    /// When there is no such series, type or cell.
    pub fn curve(&self, x: &str, y: &str, cells: Option<&str>) -> Result<Curve> {
        Ok(Curve::new(&self.series(x, cells, Over::Mean)?, &self.series(y, cells, Over::Mean)?))
    }

    /// The frame that a time means.
    pub fn frame_at(&self, time: When) -> usize {
        let last = self.times.len().saturating_sub(1);
        match time {
            When::First => 0,
            When::Last => last,
            When::At(time) => {
                let away = |frame: &usize| (self.times[*frame] - time.value()).abs();
                (0..self.times.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(last)
            }
        }
    }

    /// Whether a cell is there in a frame.
    pub fn is_there(&self, frame: usize, cell: usize) -> bool {
        self.lives.get(cell).is_none_or(|life| life.contains(&frame))
    }

    /// The number of the cell with an id.
    pub fn number_of(&self, id: u64) -> Option<usize> {
        self.ids.binary_search(&id).ok()
    }

    /// Positions of some cells, µm, [frame, cell, axis], NaN where a cell is not there, of the series `position_x`, `position_y`, `position_z`.
    ///
    /// # Errors
    /// When these were not recorded.
    pub fn positions(&self, cells: &[usize]) -> Result<Array3<f64>> {
        let mut axes = Vec::with_capacity(3);
        for name in POSITION {
            axes.push(self.cell_series(name)?);
        }
        let shape = (self.times.len(), cells.len(), 3);
        Ok(Array3::from_shape_fn(shape, |(frame, cell, axis)| axes[axis][[frame, cells[cell]]]))
    }

    /// The numbers of the cells of a type, or of all, that have values of a series: a system of chemistry may live in
    /// some of the cells only, and the others are NaN in every frame.
    ///
    /// # Errors
    /// When there is no such series, type or cell.
    pub fn cells_with(&self, name: &str, kind: Option<&str>) -> Result<Vec<usize>> {
        let series = self.cell_series(name)?;
        let mut cells = self.cells_of(kind)?;
        let lives = |cell: usize| series.is_empty() || series.column(cell).iter().any(|value| !value.is_nan());
        cells.retain(|&cell| lives(cell));
        if cells.is_empty() {
            let which = kind.map_or("no cell".to_owned(), |kind| format!("no cell of the type \"{kind}\""));
            let fault = Fault::new(format!("{which} has values of \"{name}\""));
            return Err(Error::input(fault.help("give a type of cells that the system of the series lives in")));
        }
        Ok(cells)
    }

    /// A series of cells, [frame, cell].
    ///
    /// # Errors
    /// When it was not read.
    pub fn cell_series(&self, name: &str) -> Result<&Array2<f64>> {
        self.cells.get(name).ok_or_else(|| self.missing(name))
    }

    /// That there is no such series, what may have been meant, and what there is.
    fn missing(&self, name: &str) -> Error {
        let read = ["time"].into_iter().chain(self.scene.keys().chain(self.cells.keys()).map(String::as_str));
        let mut there: Vec<&str> = match self.known.as_slice() {
            [] => read.collect(),
            known => known.iter().map(String::as_str).collect(),
        };
        let plain = name.strip_prefix(CHEMISTRY).unwrap_or(name);
        let distance = |other: &str| strsim::damerau_levenshtein(plain, other);
        let near = there.iter().map(|other| (distance(other), *other)).min();
        let prefix = &name[..name.len() - plain.len()];
        if plain.contains('.') {
            // Whoever asks for a quantity of a system wants to know of those.
            there.retain(|known| known.contains('.'));
        }
        let list = match there.is_empty() {
            true => "the run has no series of chemistry".to_owned(),
            false => format!("the series at hand are {}", there.join(", ")),
        };
        let fault = Fault::new(format!("there is no series \"{name}\" in this run"));
        // One slip in three letters, as in documents.
        Error::input(fault.help(match near {
            Some((slips, other)) if slips <= plain.chars().count() / 3 => {
                format!("did you mean \"{}{other}\"? {list}", if other.contains('.') { prefix } else { "" })
            }
            _ => list,
        }))
    }
}
