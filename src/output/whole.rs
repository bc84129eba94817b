//! How much of a file is whole: frames that can be read, and the rows that they take.

use hdf5::{Dataset, File};
use ndarray::s;

use super::catalogue::{CAME_LATER, CATALOGUE, CONTACT, FIBRE, FORCE, Filled, LINK, List, TRACTION, cell_entries};
use super::pieces::has_frames;
use super::population::{OfShared, Part, Population, Shared};
use super::{Cell, Layout};

/// The number in a row of integers.
pub(super) fn integer(file: &File, path: &str, row: usize) -> hdf5::Result<usize> {
    let number = file.dataset(path)?.read_slice_1d::<i64, _>(row..row + 1)?;
    let number = number.first().copied().unwrap_or(-1);
    usize::try_from(number).map_err(|_| format!("{path} holds {number}").as_str().into())
}

/// The cells of a frame.
pub(super) fn cells_of(file: &File, layout: &Layout, frame: usize) -> hdf5::Result<Vec<Cell>> {
    let (first, count) = (integer(file, "/cells/first", frame)?, integer(file, "/cells/count", frame)?);
    if count == 0 {
        return Ok(Vec::new());
    }
    let rows = |path: &str| file.dataset(path)?.read_slice_1d::<i64, _>(first..first + count);
    let (ids, kinds, parents) = (rows("/cells/id")?, rows("/cells/type")?, rows("/cells/parent")?);
    let cells = ids.iter().zip(&kinds).zip(&parents).map(|((id, kind), parent)| {
        let known = |kind: &u32| (*kind as usize) < layout.types.len();
        match (u64::try_from(*id), u32::try_from(*kind).ok().filter(known)) {
            (Ok(id), Some(kind)) => Ok(Cell { id, kind, parent: u64::try_from(*parent).ok() }),
            _ => Err(format!("/cells names the cell {id} of the type {kind}").as_str().into()),
        }
    });
    cells.collect()
}

/// Rows that some frames take in the datasets whose frames differ in size.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ends {
    pub frames: usize,
    /// Rows of each list.
    pub rows: [usize; List::ALL.len()],
    /// Rows of the atoms of all frames.
    pub atoms: usize,
    /// Rows of the cells of all frames.
    pub cells: usize,
    pub populations: usize,
    /// Rows of the blocks of all populations.
    pub blocks: OfShared,
    /// Where the blocks of the last population begin.
    pub blocks_at: OfShared,
    /// The population of the last frame.
    pub population: Option<Population>,
}

impl Ends {
    /// Those of the first frames.
    pub fn of(file: &File, layout: &Layout, frames: usize) -> hdf5::Result<Self> {
        let mut ends = Self {
            frames,
            rows: rows_up_to(file, frames)?,
            atoms: 0,
            cells: 0,
            populations: 0,
            blocks: [0; Shared::ALL.len()],
            blocks_at: [0; Shared::ALL.len()],
            population: None,
        };
        let Some(last) = frames.checked_sub(1) else { return Ok(ends) };
        let population = Population::of(layout, &cells_of(file, layout, last)?);
        let number = |path: &str| integer(file, path, last);
        ends.populations = number("/VTKHDF/Steps/PartOffsets")? + 1;
        ends.atoms = number("/VTKHDF/Steps/PointOffsets")? + population.count(Part::Atoms);
        ends.cells = number("/cells/first")? + population.cells();
        ends.blocks_at = blocks_at(file, last)?;
        for shared in Shared::ALL {
            ends.blocks[shared as usize] = ends.blocks_at[shared as usize] + shared.length(&population);
        }
        ends.population = Some(population);
        Ok(ends)
    }
}

/// Where the blocks of the population of a frame begin.
fn blocks_at(file: &File, frame: usize) -> hdf5::Result<OfShared> {
    let population = integer(file, "/VTKHDF/Steps/PartOffsets", frame)?;
    let four = |name: &str| -> hdf5::Result<[usize; 4]> {
        let numbers = file.dataset(&format!("/VTKHDF/Steps/{name}"))?.read_slice_1d::<i64, _>(s![frame, ..])?;
        Ok(std::array::from_fn(|i| numbers.get(i).map_or(0, |number| usize::try_from(*number).unwrap_or(0))))
    };
    let (offsets, atoms) = (four("CellOffsets")?, four("ConnectivityIdOffsets")?);
    let data = |name: &str| integer(file, &format!("/VTKHDF/Steps/{name}"), frame);
    let mut found = [0; Shared::ALL.len()];
    for shared in Shared::ALL {
        found[shared as usize] = match shared {
            Shared::PointCell => data("PointDataOffsets/cell")?,
            Shared::PointType => data("PointDataOffsets/type")?,
            Shared::DrawnCell => data("CellDataOffsets/cell")?,
            Shared::DrawnType => data("CellDataOffsets/type")?,
            // See `Instant::offsets`.
            Shared::LinkOffsets => offsets[1] + population,
            Shared::FacetOffsets => offsets[2] + population,
            Shared::LinkAtoms => atoms[1],
            Shared::FacetAtoms => atoms[2],
        };
    }
    Ok(found)
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

/// Frames that every growing dataset holds. Damage may leave the datasets a frame apart, or a dataset with space for a frame
/// whose numbers are missing; such frames at the end are left out.
pub(super) fn whole_frames(file: &File, layout: &Layout) -> hdf5::Result<usize> {
    if !has_frames(file) {
        return Ok(0);
    }
    let (mut frames, mut fields) = (usize::MAX, Vec::new());
    for entry in CATALOGUE.iter().chain(CONTACT).chain(FIBRE).chain(LINK) {
        if !matches!(entry.filled, Filled::Frame(_) | Filled::Counter(_) | Filled::Counters(_)) {
            continue;
        }
        match file.dataset(entry.path) {
            Ok(dataset) => frames = frames.min(dataset.get_shape()?[0]),
            Err(_) if CONTACT.iter().chain(FIBRE).chain(LINK).any(|optional| optional.path == entry.path) => {}
            Err(error) => return Err(error),
        }
    }
    if let Ok(group) = file.group("scene") {
        for series in group.datasets()? {
            frames = frames.min(series.get_shape()?[0]);
        }
    }
    if let Ok(group) = file.group("fields") {
        for field in group.groups()? {
            for species in field.group("CellData")?.datasets()? {
                frames = frames.min(species.get_shape()?[0]);
                fields.push(species);
            }
        }
    }
    let datasets = Datasets::of(file, layout, fields)?;
    for dataset in &datasets.scene_systems {
        frames = frames.min(dataset.get_shape()?[0]);
    }
    let is_whole = |frame: usize| datasets.hold(file, layout, frame).unwrap_or(false);
    while frames > 0 && !is_whole(frames - 1) {
        frames -= 1;
    }
    Ok(frames)
}

/// The datasets that say whether a frame is whole.
struct Datasets {
    /// With a row for each atom, and each cell, of each frame.
    atoms: Vec<Dataset>,
    cells: Vec<Dataset>,
    /// With a block for each population.
    blocks: Vec<(Shared, Dataset)>,
    populations: Vec<Dataset>,
    fields: Vec<Dataset>,
    scene_systems: Vec<Dataset>,
}

impl Datasets {
    fn of(file: &File, layout: &Layout, fields: Vec<Dataset>) -> hdf5::Result<Self> {
        let (atoms, cells, scene_systems) = (Vec::new(), Vec::new(), Vec::new());
        let mut found = Self { atoms, cells, blocks: Vec::new(), populations: Vec::new(), fields, scene_systems };
        let of_cells = cell_entries(layout.on_demand()).map(|entry| (entry.path, entry.filled));
        let all = CATALOGUE.iter().chain(FORCE).map(|entry| (entry.path, &entry.filled));
        for (path, filled) in all {
            let dataset = || file.dataset(path);
            match filled {
                Filled::Atoms(_) if path == FORCE[0].path => found.atoms.extend(dataset().ok()),
                Filled::Atoms(_) => found.atoms.push(dataset()?),
                Filled::CellInteger(_) => found.cells.push(dataset()?),
                Filled::Shared(shared) => found.blocks.push((*shared, dataset()?)),
                Filled::Population(_) => found.populations.push(dataset()?),
                _ => {}
            }
        }
        // Results of earlier versions do not have all of them.
        let is_told = |path: &str| !CAME_LATER.contains(&path) || file.dataset(path).is_ok();
        let of_atoms = TRACTION.iter().filter(|entry| layout.tractions && matches!(entry.filled, Filled::Atoms(_)));
        for entry in of_atoms.filter(|entry| is_told(entry.path)) {
            found.atoms.push(file.dataset(entry.path)?);
        }
        for (path, _) in of_cells.filter(|(path, _)| is_told(path)) {
            found.cells.push(file.dataset(path)?);
        }
        for membrane in &layout.membranes {
            found.atoms.push(file.dataset(&membrane.path())?);
        }
        for system in &layout.systems {
            for (quantity, _) in &system.quantities {
                let dataset = file.dataset(&system.path(quantity))?;
                match system.scope {
                    super::SystemScope::Scene => found.scene_systems.push(dataset),
                    super::SystemScope::Cells => found.cells.push(dataset),
                }
            }
        }
        Ok(found)
    }

    /// Whether they hold all of a frame.
    fn hold(&self, file: &File, layout: &Layout, frame: usize) -> hdf5::Result<bool> {
        let time = file.dataset("/time")?.read_slice_1d::<f64, _>(frame..frame + 1)?;
        let ends = Ends::of(file, layout, frame + 1)?;
        let long_enough = |datasets: &[Dataset], rows: usize| datasets.iter().all(|data| data.shape()[0] >= rows);
        let blocks = self.blocks.iter().all(|(shared, data)| data.shape()[0] >= ends.blocks[*shared as usize]);
        if !(long_enough(&self.atoms, ends.atoms)
            && long_enough(&self.cells, ends.cells)
            && long_enough(&self.populations, ends.populations)
            && blocks)
        {
            return Ok(false);
        }
        let first = integer(file, "/VTKHDF/Steps/PointOffsets", frame)?;
        let mut numbers = time.to_vec();
        if ends.atoms > first {
            for row in [first, ends.atoms - 1] {
                numbers.extend(self.atoms[0].read_slice_1d::<f64, _>(s![row, ..])?);
            }
        }
        for (shared, data) in &self.blocks {
            let (first, end) = (ends.blocks_at[*shared as usize], ends.blocks[*shared as usize]);
            if end > first && data.read_slice_1d::<i64, _>(end - 1..end)?[0] < 0 {
                return Ok(false);
            }
        }
        for field in &self.fields {
            // The last box of all lies in the last piece of the frame.
            let last: Vec<usize> = field.get_shape()?[1..].iter().map(|n| n.saturating_sub(1)).collect();
            let [z, y, x] = last[..] else { return Ok(false) };
            let last = field.read_slice_1d::<f32, _>(s![frame, z, y, x..x + 1])?;
            numbers.extend(last.iter().map(|value| f64::from(*value)));
        }
        for list in List::ALL {
            let rows = ends.rows[list as usize];
            if rows > 0 && file.dataset(list.column())?.get_shape()?[0] < rows {
                return Ok(false);
            }
        }
        Ok(numbers.iter().all(|value| !value.is_nan()))
    }
}
