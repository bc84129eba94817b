//! Reads a result file: finished, interrupted, or left behind by a run that was killed.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use hdf5::{Dataset, File};
use ndarray::{Array2, s};

use super::Layout;
use super::catalogue::{CATALOGUE, CONTACT, FORCE, Filled, List, Run, cell_series_names};
use super::contacts;
use super::container::{self, Access, damaged, text};
use super::header::{Header, Measure};
use super::layout_io::{read_header, read_layout};
use super::mark::FlushMark;
use super::systems::SystemScope;
use crate::error::{Error, Fault, Result};

/// A result file opened for reading. Arrays are read when they are asked for.
pub struct ResultFile {
    path: PathBuf,
    file: File,
    header: Header,
    layout: Layout,
    ending: Ending,
    frames: usize,
    /// The series of contacts once they were asked for, by their order.
    of_contacts: OnceLock<Vec<Vec<f64>>>,
}

/// How the run of a file ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ending {
    /// Whether the run came to its end; otherwise it goes on, was interrupted or killed.
    pub finished: bool,
    /// Wall time of the run, s; unknown for a run that has not finished.
    pub wall_time: Option<f64>,
    /// How often the run was resumed.
    pub resumed: i64,
}

impl ResultFile {
    /// Opens a result file.
    ///
    /// # Errors
    /// [`Error::Input`] for a file that is missing, not HDF5, not ours, truncated or damaged, still being written, or
    /// without a single frame.
    pub fn open(path: &Path) -> Result<Self> {
        let file = container::open(path, Access::Read)?;
        let read = || -> hdf5::Result<_> {
            let group = file.group("provenance")?;
            let wall_time: f64 = group.attr("wall_time")?.read_scalar()?;
            let ending = Ending {
                finished: group.attr("finished")?.read_scalar::<i64>()? == 1,
                wall_time: wall_time.is_finite().then_some(wall_time),
                resumed: group.attr("resumed")?.read_scalar()?,
            };
            Ok((read_header(&file)?, read_layout(&file)?, ending, whole_frames(&file)?))
        };
        let (header, layout, ending, frames) = read().map_err(|error| damaged(path, &error.to_string()))?;
        if frames == 0 {
            return Err(Error::input(
                Fault::new(format!("{} holds no frame: its run ended before the first one", path.display()))
                    .help("run the experiment again with --force"),
            ));
        }
        Ok(Self { path: path.to_path_buf(), file, header, layout, ending, frames, of_contacts: OnceLock::new() })
    }

    /// The path it was opened by.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Who made the file from what.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// How the arrays of a frame are to be read.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// How the run ended.
    pub fn ending(&self) -> Ending {
        self.ending
    }

    /// Number of frames that are whole.
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Simulated time of every frame, s.
    ///
    /// # Errors
    /// A damaged file; so for all other arrays.
    pub fn times(&self) -> Result<Vec<f64>> {
        self.numbers("/time")
    }

    /// Steps made up to every frame.
    ///
    /// # Errors
    /// A damaged file.
    pub fn steps(&self) -> Result<Vec<u64>> {
        let steps = self.read("/step", |dataset| Ok(dataset.read_slice_1d::<i64, _>(0..self.frames)?.to_vec()))?;
        Ok(steps.into_iter().map(|step| u64::try_from(step).unwrap_or(0)).collect())
    }

    /// Positions of all atoms in a frame, µm.
    ///
    /// # Errors
    /// A damaged file.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn positions(&self, frame: usize) -> Result<Vec<[f64; 3]>> {
        self.atom_vectors("/VTKHDF/Points", frame)
    }

    /// Elastic and applied force on all atoms in a frame, pN; `None` if the run recorded none.
    ///
    /// # Errors
    /// A damaged file.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn forces(&self, frame: usize) -> Result<Option<Vec<[f64; 3]>>> {
        let path = FORCE[0].path;
        if self.file.dataset(path).is_err() {
            return Ok(None);
        }
        self.atom_vectors(path, frame).map(Some)
    }

    fn atom_vectors(&self, path: &str, frame: usize) -> Result<Vec<[f64; 3]>> {
        assert!(frame < self.frames, "frame {frame} of {}", self.frames);
        let atoms = self.layout.atoms();
        if atoms == 0 {
            return Ok(Vec::new());
        }
        let first = frame * atoms;
        let values = self.read(path, |dataset| dataset.read_slice_2d::<f64, _>((first..first + atoms, 0..3)))?;
        let (values, _) = values.into_raw_vec_and_offset();
        Ok(values.as_chunks::<3>().0.to_vec())
    }

    /// Names that [`cell_series`](Self::cell_series) knows.
    pub fn series_names(&self) -> Vec<String> {
        let mut names = cell_series_names();
        names.extend(self.cell_quantities());
        names
    }

    /// Names that [`scene_series`](Self::scene_series) knows.
    pub fn scene_names(&self) -> Vec<String> {
        let mut names: Vec<String> = self.layout.scene_series.iter().map(|(name, _)| name.clone()).collect();
        names.extend(contacts::series(&self.layout).into_iter().map(|(name, _)| name));
        names.extend(self.scene_quantities());
        names
    }

    /// A per-cell series, `[frame, cell]`, in the unit of [`units`](Self::units). Vectors go by component:
    /// `position_x`, `velocity_z`, `size_y`, `principal_1` (the longest); `speed` is the length of the velocity.
    /// `SYSTEM.QUANTITY` is a quantity of a system inside cells, NaN for cells without the system.
    ///
    /// # Errors
    /// An unknown name, or a damaged file.
    pub fn cell_series(&self, name: &str) -> Result<Array2<f64>> {
        if name == "speed" {
            let component = |ending: &str| self.cell_series(&format!("velocity_{ending}"));
            let (x, y, z) = (component("x")?, component("y")?, component("z")?);
            return Ok((&x * &x + &y * &y + &z * &z).sqrt());
        }
        if let Some((system, (quantity, _))) = self.quantity_of(name)
            && let SystemScope::Cells(cells) = &system.scope
        {
            let values = self.quantity_series(&system.name, quantity)?;
            let mut all = Array2::from_elem((self.frames, self.layout.cells.len()), f64::NAN);
            for (column, cell) in values.columns().into_iter().zip(cells) {
                if (*cell as usize) < self.layout.cells.len() {
                    all.column_mut(*cell as usize).assign(&column);
                }
            }
            return Ok(all);
        }
        let (path, component) = find_series(name).ok_or_else(|| self.unknown(name))?;
        let (frames, cells) = (self.frames, self.layout.cells.len());
        if cells == 0 {
            return Ok(Array2::zeros((frames, 0)));
        }
        self.read(path, |dataset| match component {
            None => dataset.read_slice_2d::<f64, _>((0..frames, 0..cells)),
            Some(i) => dataset.read_slice_2d::<f64, _>((0..frames, 0..cells, i)),
        })
    }

    /// A series of the scene as a whole: one number per frame. `SYSTEM.QUANTITY` is a quantity of a system of the
    /// scene; `contact.area.TYPE.TYPE` and its like are found from who touches whom.
    ///
    /// # Errors
    /// An unknown name, or a damaged file.
    pub fn scene_series(&self, name: &str) -> Result<Vec<f64>> {
        if let Some(number) = contacts::series(&self.layout).iter().position(|(known, _)| known == name) {
            return Ok(self.contact_series()?[number].clone());
        }
        match self.layout.scene_series.iter().any(|(known, _)| known == name) {
            true => self.numbers(&format!("/scene/{name}")),
            false => match self.quantity_of(name) {
                Some((system, (quantity, _))) if system.scope == SystemScope::Scene => {
                    Ok(self.quantity_series(&system.name, quantity)?.into_iter().collect())
                }
                _ => Err(self.unknown(name)),
            },
        }
    }

    /// The unit of `time`, of a per-cell series or of a series of the scene; `1` for pure numbers.
    ///
    /// # Errors
    /// An unknown name.
    pub fn units(&self, name: &str) -> Result<String> {
        if let Some((_, unit)) = self.layout.scene_series.iter().find(|(known, _)| known == name) {
            return Ok(unit.clone());
        }
        if let Some((_, unit)) = contacts::series(&self.layout).into_iter().find(|(known, _)| known == name) {
            return Ok(unit.to_owned());
        }
        if let Some((_, (_, unit))) = self.quantity_of(name) {
            return Ok(unit.clone());
        }
        let known = match name {
            "time" => Some(("/time", None)),
            "speed" => find_series("velocity_x"),
            _ => find_series(name),
        };
        let (path, _) = known.ok_or_else(|| self.unknown(name))?;
        Ok(super::catalogue::entry(path).unit.to_string())
    }

    /// Motility runs that ended up to the last frame.
    ///
    /// # Errors
    /// A damaged file.
    pub fn runs(&self) -> Result<Vec<Run>> {
        let count = self.rows_of(List::Runs, 0..self.frames)?.end;
        let cells = self.read("/events/runs/cell", |dataset| dataset.read_slice_1d::<i64, _>(0..count))?;
        let ends = self.read("/events/runs/end_time", |dataset| dataset.read_slice_1d::<f64, _>(0..count))?;
        let durations = self.read("/events/runs/duration", |dataset| dataset.read_slice_1d::<f64, _>(0..count))?;
        Ok((0..count).map(|i| (u32::try_from(cells[i]).unwrap_or(u32::MAX), ends[i], durations[i])).collect())
    }

    /// The rows that a list has in some frames.
    pub(super) fn rows_of(&self, list: List, frames: Range<usize>) -> Result<Range<usize>> {
        let up_to = |frames: usize| {
            let count = |dataset: &Dataset| dataset.read_slice_1d::<i64, _>(frames.max(1) - 1..frames);
            let count = self.read(list.counter(), count)?;
            Ok::<_, Error>(count.last().map_or(0, |count| usize::try_from(*count).unwrap_or(0)))
        };
        Ok(up_to(frames.start)?..up_to(frames.end)?)
    }

    /// All series of contacts, found when they are asked for the first time.
    fn contact_series(&self) -> Result<&Vec<Vec<f64>>> {
        if let Some(known) = self.of_contacts.get() {
            return Ok(known);
        }
        let found = contacts::all_series(self)?;
        Ok(self.of_contacts.get_or_init(|| found))
    }

    /// The measures of the experiment, by name; none before the run has finished.
    ///
    /// # Errors
    /// A damaged file.
    pub fn summary(&self) -> Result<Vec<Measure>> {
        let Ok(group) = self.file.group("summary") else { return Ok(Vec::new()) };
        let read = |name: &str| -> hdf5::Result<Measure> {
            let dataset = group.dataset(name)?;
            Ok(Measure {
                name: name.to_string(),
                value: dataset.read_scalar()?,
                unit: text(&dataset, "unit")?,
                description: text(&dataset, "description")?,
            })
        };
        let names = group.member_names();
        let measures = names.and_then(|names| names.iter().map(|name| read(name)).collect());
        measures.map_err(|error| damaged(&self.path, &error.to_string()))
    }

    /// The HDF5 file itself, for what only `info` needs.
    pub(super) fn file(&self) -> &File {
        &self.file
    }

    fn numbers(&self, path: &str) -> Result<Vec<f64>> {
        self.read(path, |dataset| Ok(dataset.read_slice_1d::<f64, _>(0..self.frames)?.to_vec()))
    }

    pub(super) fn read<T>(&self, path: &str, take: impl FnOnce(&Dataset) -> hdf5::Result<T>) -> Result<T> {
        let taken = self.file.dataset(path).and_then(|dataset| take(&dataset));
        taken.map_err(|error| damaged(&self.path, &format!("{path}: {error}")))
    }

    pub(super) fn unknown(&self, name: &str) -> Error {
        let mut known = self.series_names();
        known.extend(self.scene_names());
        let help = listed(name, &known, std::iter::empty());
        Error::input(Fault::new(format!("{} has no series `{name}`", self.path.display())).help(help))
    }
}

/// What there is, and what may have been meant, one of `known` or `also`.
pub(super) fn listed<'a>(name: &str, known: &'a [String], also: impl Iterator<Item = &'a String>) -> String {
    let near = known.iter().chain(also).map(|other| (strsim::damerau_levenshtein(name, other), other)).min();
    let help = format!("there are: {}", known.join(", "));
    match near {
        Some((distance, other)) if distance <= 3 => format!("did you mean `{other}`? {help}"),
        _ => help,
    }
}

/// The dataset of a per-cell series, and which component of a vector it is.
fn find_series(name: &str) -> Option<(&'static str, Option<usize>)> {
    CATALOGUE.iter().find_map(|entry| {
        let stem = entry.path.strip_prefix("/cells/")?;
        match &entry.filled {
            Filled::Cell(_) if stem == name => Some((entry.path, None)),
            Filled::CellVector(_, endings) => {
                let ending = name.strip_prefix(stem)?.strip_prefix('_')?;
                Some((entry.path, Some(endings.iter().position(|known| *known == ending)?)))
            }
            _ => None,
        }
    })
}

/// Frames that every growing dataset holds. A kill may leave the datasets a frame apart, or a dataset with room for
/// a frame whose numbers never came; such frames are left out.
pub(super) fn whole_frames(file: &File) -> hdf5::Result<usize> {
    let atoms = file.dataset("/VTKHDF/NumberOfPoints")?.read_raw::<i64>()?;
    let atoms = atoms.first().map_or(0, |atoms| usize::try_from(*atoms).unwrap_or(0));
    let mut frames = usize::MAX;
    for entry in CATALOGUE.iter().chain(CONTACT).chain(FORCE) {
        let rows_per_frame = match entry.filled {
            Filled::Frame(_) | Filled::Counter(..) | Filled::Cell(_) | Filled::CellVector(..) => 1,
            Filled::Atoms(_) if atoms > 0 => atoms,
            _ => continue,
        };
        match file.dataset(entry.path) {
            Ok(dataset) => frames = frames.min(dataset.get_shape()?[0] / rows_per_frame),
            Err(_) if CONTACT.iter().chain(FORCE).any(|optional| optional.path == entry.path) => {}
            Err(error) => return Err(error),
        }
    }
    if let Ok(group) = file.group("scene") {
        for series in group.datasets()? {
            frames = frames.min(series.get_shape()?[0]);
        }
    }
    let mut fields = Vec::new();
    if let Ok(group) = file.group("fields") {
        for field in group.groups()? {
            for species in field.group("CellData")?.datasets()? {
                frames = frames.min(species.get_shape()?[0]);
                fields.push(species);
            }
        }
    }
    if let Ok(group) = file.group("chemistry") {
        for system in group.groups()? {
            for quantity in system.datasets()? {
                frames = frames.min(quantity.get_shape()?[0]);
            }
        }
    }
    let (times, points) = (file.dataset("/time")?, file.dataset("/VTKHDF/Points")?);
    let written = |frame: usize| -> hdf5::Result<bool> {
        let time = times.read_slice_1d::<f64, _>(frame..frame + 1)?;
        let mut ends = Vec::new();
        if atoms > 0 {
            ends.extend(points.read_slice_1d::<f64, _>(s![frame * atoms, ..])?);
            ends.extend(points.read_slice_1d::<f64, _>(s![(frame + 1) * atoms - 1, ..])?);
        }
        for field in &fields {
            // The last box of all lies in the last piece of the frame.
            let last: Vec<usize> = field.get_shape()?[1..].iter().map(|n| n.saturating_sub(1)).collect();
            let [z, y, x] = last[..] else { return Ok(false) };
            if field.read_slice_1d::<f32, _>(s![frame, z, y, x..x + 1])?.iter().any(|value| value.is_nan()) {
                return Ok(false);
            }
        }
        let counted = rows_up_to(file, frame + 1)?;
        for list in List::ALL {
            if counted[list as usize] > 0 && file.dataset(list.column())?.get_shape()?[0] < counted[list as usize] {
                return Ok(false);
            }
        }
        Ok(time.iter().chain(&ends).all(|value| !value.is_nan()))
    };
    if FlushMark::is_set(file) {
        // Torn trees may miss frames anywhere.
        return Ok((0..frames).take_while(|frame| written(*frame).unwrap_or(false)).count());
    }
    while frames > 0 && !written(frames - 1).unwrap_or(false) {
        frames -= 1;
    }
    Ok(frames)
}

/// Rows that each list has up to a frame, none where there is no such list.
pub(super) fn rows_up_to(file: &File, frames: usize) -> hdf5::Result<[usize; List::ALL.len()]> {
    let mut rows = [0; List::ALL.len()];
    for list in List::ALL {
        if frames > 0
            && let Ok(counter) = file.dataset(list.counter())
        {
            let count = counter.read_slice_1d::<i64, _>(frames - 1..frames)?;
            rows[list as usize] = count.first().map_or(0, |count| usize::try_from(*count).unwrap_or(0));
        }
    }
    Ok(rows)
}
