//! Reads a result file: finished, interrupted, or left behind by a run that was killed.

use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use hdf5::{Dataset, File};

use super::catalogue::{CAME_LATER, FORCE, List, Run, TRACTION};
use super::census::Census;
use super::contacts;
use super::container::{self, Access, damaged};
use super::header::{Header, Measure};
use super::layout_io::{read_header, read_layout};
use super::renewal::settle;
use super::systems::SystemScope;
use super::texts::text;
use super::whole::whole_frames;
use super::{Cell, FibreRow, Layout, PseudopodEvent, Tractions};
use crate::error::{Error, Fault, Result};
use crate::recorded::{CONTACTS, NAMED, cell_label, cell_series, cell_unit, derived};

/// A result file opened for reading. Arrays are read when they are asked for.
pub struct ResultFile {
    path: PathBuf,
    file: File,
    header: Header,
    layout: Layout,
    ending: Ending,
    frames: usize,
    /// The series of contacts once they were asked for, by their order.
    pub(super) of_contacts: OnceLock<Vec<Vec<f64>>>,
    census: Census,
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
    /// Whether the run goes on and writes to the file.
    pub running: bool,
}

impl ResultFile {
    /// Opens a result file. Of a run that was killed it first takes in the frames that wait beside the file; of one that goes
    /// on it shows the last version.
    ///
    /// # Errors
    /// [`Error::Input`] for a file that is missing, not HDF5, not ours, truncated or damaged, or without a single
    /// frame.
    pub fn open(path: &Path) -> Result<Self> {
        container::check_signature(path)?;
        let running = settle(path);
        let file = container::open(path, Access::Read)?;
        let read = || -> hdf5::Result<_> {
            let group = file.group("provenance")?;
            let wall_time: f64 = group.attr("wall_time")?.read_scalar()?;
            let ending = Ending {
                finished: group.attr("finished")?.read_scalar::<i64>()? == 1,
                wall_time: wall_time.is_finite().then_some(wall_time),
                resumed: group.attr("resumed")?.read_scalar()?,
                running,
            };
            let layout = read_layout(&file)?;
            let frames = whole_frames(&file, &layout)?;
            let census = Census::read(&file, &layout, frames)?;
            Ok((read_header(&file)?, layout, ending, frames, census))
        };
        let (header, layout, ending, frames, census) = read().map_err(|error| damaged(path, &error.to_string()))?;
        if frames == 0 {
            return Err(Error::input(
                Fault::new(format!("{} holds no frame: its run ended before the first one", path.display()))
                    .help("run the experiment again with --force"),
            ));
        }
        let (path, of_contacts) = (path.to_path_buf(), OnceLock::new());
        Ok(Self { path, file, header, layout, ending, frames, of_contacts, census })
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

    /// Whether each frame lies within a step, between the states at its ends. Of files that do not say so, made before frames did, none does.
    ///
    /// # Errors
    /// A damaged file.
    pub fn interpolated(&self) -> Result<Vec<bool>> {
        if !self.file.link_exists("/interpolated") {
            return Ok(vec![false; self.frames]);
        }
        self.read("/interpolated", |dataset| {
            Ok(dataset.read_slice_1d::<i64, _>(0..self.frames)?.iter().map(|within| *within != 0).collect())
        })
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

    /// What all atoms did to what is around them, in the mean over the step that led to a frame; `None` if the run did not record it.
    ///
    /// # Errors
    /// A damaged file.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn tractions(&self, frame: usize) -> Result<Option<Tractions>> {
        if !self.layout.tractions {
            return Ok(None);
        }
        let of = |number: usize| self.atom_vectors(TRACTION[number].path, frame);
        let (traction, of_cells, drag) = (of(0)?, of(1)?, of(2)?);
        let held = if self.has(CAME_LATER[1]) { of(5)? } else { vec![[0.0; 3]; traction.len()] };
        Ok(Some(Tractions { traction, of_cells, drag, outer: of(3)?, inertia: of(4)?, held }))
    }

    /// Density of a substance on membranes, `SYSTEM.VARIABLE`, at all atoms in a frame: NaN on cells without the system; `None` if the
    /// run recorded no such substance.
    ///
    /// # Errors
    /// A damaged file.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn membrane(&self, name: &str, frame: usize) -> Result<Option<Vec<f64>>> {
        assert!(frame < self.frames, "frame {frame} of {}", self.frames);
        let Some(membrane) = self.layout.membranes.iter().find(|membrane| membrane.name == name) else {
            return Ok(None);
        };
        let rows = self.census.atoms(frame);
        if rows.is_empty() {
            return Ok(Some(Vec::new()));
        }
        Ok(Some(self.read(&membrane.path(), |dataset| dataset.read_slice_1d::<f64, _>(rows))?.to_vec()))
    }

    fn atom_vectors(&self, path: &str, frame: usize) -> Result<Vec<[f64; 3]>> {
        assert!(frame < self.frames, "frame {frame} of {}", self.frames);
        let rows = self.census.atoms(frame);
        if rows.is_empty() {
            return Ok(Vec::new());
        }
        let values = self.read(path, |dataset| dataset.read_slice_2d::<f64, _>((rows, 0..3)))?;
        let (values, _) = values.into_raw_vec_and_offset();
        Ok(values.as_chunks::<3>().0.to_vec())
    }

    /// Names that [`cell_series`](Self::cell_series) knows, those of systems included.
    pub fn series_names(&self) -> Vec<String> {
        let mut names: Vec<String> = cell_series(self.layout.on_demand()).collect();
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
                    self.numbers(&system.path(quantity))
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
        if name == "time" {
            return Ok(super::catalogue::entry("/time").unit.to_string());
        }
        let known = self.series_names().iter().any(|known| known == name) || derived(name).is_some();
        cell_unit(name).filter(|_| known).map(str::to_owned).ok_or_else(|| self.unknown(name))
    }

    /// Whether there is such a dataset.
    pub(super) fn has(&self, path: &str) -> bool {
        self.file.dataset(path).is_ok()
    }

    /// What a chart calls a series, without its unit.
    pub fn label(&self, name: &str) -> String {
        let recorded = || CONTACTS.iter().find(|row| row.name == name).map(|row| row.label.to_owned());
        let known = cell_label(name).map(str::to_owned).or_else(recorded);
        let known = known.or_else(|| contacts::label(&self.layout, name));
        let of_something =
            |(word, of)| NAMED.iter().find(|known| known.0 == word).map(|known| format!("{} {of}", known.1));
        known.or_else(|| name.split_once('.').and_then(of_something)).unwrap_or_else(|| name.to_owned())
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
        Ok((0..count).map(|i| (u64::try_from(cells[i]).unwrap_or(u64::MAX), ends[i], durations[i])).collect())
    }

    /// Pseudopods whose protrusion ended up to the last frame; none in a file of before they were recorded.
    ///
    /// # Errors
    /// A damaged file.
    pub fn pseudopods(&self) -> Result<Vec<PseudopodEvent>> {
        // Files of earlier versions have no such list.
        if self.file.dataset(List::Pseudopods.counter()).is_err() {
            return Ok(Vec::new());
        }
        let count = self.rows_of(List::Pseudopods, 0..self.frames)?.end;
        let integers = |name: &str| {
            self.read(&format!("/events/pseudopods/{name}"), |dataset| dataset.read_slice_1d::<i64, _>(0..count))
        };
        let numbers = |name: &str| {
            self.read(&format!("/events/pseudopods/{name}"), |dataset| dataset.read_slice_1d::<f64, _>(0..count))
        };
        let [cells, sides] = [integers("cell")?, integers("side")?];
        // Of files of earlier versions all were alone, and kept.
        let told = self.file.dataset("/events/pseudopods/alone").is_ok();
        let outcomes = if told { Some([integers("alone")?, integers("abandoned")?]) } else { None };
        let is = |which: usize, row: usize| outcomes.as_ref().map(|outcomes| outcomes[which][row] == 1);
        let [ends, lifetimes, turns] = [numbers("end_time")?, numbers("lifetime")?, numbers("turn")?];
        let directions = [numbers("direction_x")?, numbers("direction_y")?, numbers("direction_z")?];
        let event = |row: usize| PseudopodEvent {
            cell: u64::try_from(cells[row]).unwrap_or(u64::MAX),
            end: ends[row],
            lifetime: lifetimes[row],
            direction: [0, 1, 2].map(|axis| directions[axis][row]),
            turn: turns[row],
            side: sides[row].signum() as i8,
            alone: is(0, row).unwrap_or(true),
            abandoned: is(1, row).unwrap_or(false),
        };
        Ok((0..count).map(event).collect())
    }

    /// The fibres that were made at run time and are there in a frame; none in a run without such fibres. All join atoms that their cells have.
    ///
    /// # Errors
    /// A damaged file.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn fibres(&self, frame: usize) -> Result<Vec<FibreRow>> {
        assert!(frame < self.frames, "frame {frame} of {}", self.frames);
        if !self.layout.fibres {
            return Ok(Vec::new());
        }
        let rows = self.rows_of(List::Fibres, frame..frame + 1)?;
        let integers = |name: &str| {
            let read = |dataset: &Dataset| dataset.read_slice_1d::<i64, _>(rows.clone());
            self.read(&format!("/fibres/{name}"), read)
        };
        let numbers = |name: &str| {
            let read = |dataset: &Dataset| dataset.read_slice_1d::<f64, _>(rows.clone());
            self.read(&format!("/fibres/{name}"), read)
        };
        let [cells, own, from, to] = [integers("cell")?, integers("number")?, integers("from")?, integers("to")?];
        let [lengths, tensions] = [numbers("length")?, numbers("tension")?];
        let unsigned = |number: i64| u64::try_from(number).unwrap_or(u64::MAX);
        let atom = |number: i64| u32::try_from(number).unwrap_or(u32::MAX);
        let row = |row: usize| FibreRow {
            cell: unsigned(cells[row]),
            number: unsigned(own[row]),
            atoms: [atom(from[row]), atom(to[row])],
            length: lengths[row],
            tension: tensions[row],
        };
        let found: Vec<FibreRow> = (0..cells.len()).map(row).collect();
        let atoms_of = |cell: &Cell| (cell.id, self.layout.types[cell.kind as usize].atoms);
        let there: HashMap<u64, u32> = self.cells(frame).iter().map(atoms_of).collect();
        let joins =
            |fibre: &FibreRow| there.get(&fibre.cell).is_some_and(|atoms| fibre.atoms.iter().all(|atom| atom < atoms));
        match found.iter().all(joins) {
            true => Ok(found),
            false => Err(damaged(&self.path, "/fibres joins atoms that are not there")),
        }
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

    /// Which cells there are in every frame.
    pub(super) fn census(&self) -> &Census {
        &self.census
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
