//! All datasets that grow with the run, made and filled as the catalogue says.

use std::borrow::Cow;

use hdf5::File;

use super::catalogue::{CATALOGUE, CONTACT, Entry, FORCE, Filled, Instant, List};
use super::column::{Column, Number, PackedColumn, Plan, push_frames};
use super::container::set_number;
use super::fields::FieldColumns;
use super::systems::{SystemColumns, SystemLayout};
use super::{CellRecord, Frame, Layout};

/// From this many cells on, a frame of a per-cell series is a compressed piece of its own.
pub(super) const MANY_CELLS: usize = 1024;

/// Frames after which HDF5 is made to forget where the pieces lie, a few MB.
const REMEMBERED_FRAMES: usize = 5000;

type FrameNumber = fn(&Frame) -> f64;
type Counted = fn(&Instant) -> i64;
type AtomVectors = fn(&Frame) -> &[[f64; 3]];

/// Where a per-cell series comes from.
enum CellSource {
    Number(fn(&CellRecord) -> f64),
    Vector(fn(&CellRecord) -> [f64; 3]),
}

impl CellSource {
    fn values(&self, cells: &[CellRecord]) -> Vec<f64> {
        match self {
            Self::Number(value) => cells.iter().map(value).collect(),
            Self::Vector(value) => cells.iter().flat_map(value).collect(),
        }
    }
}

/// Where a number per row of a list comes from.
enum RowSource {
    Integer(fn(&Frame, usize) -> i64),
    Float(fn(&Frame, usize) -> f64),
}

/// Rows of each list so far.
pub(super) type Rows = [usize; List::ALL.len()];

/// The datasets by what fills them.
#[derive(Default)]
pub(super) struct Columns {
    atoms: usize,
    cells: usize,
    frames: usize,
    rows: Rows,
    atom_vectors: Vec<(AtomVectors, PackedColumn)>,
    many_cells: Vec<(CellSource, PackedColumn)>,
    few_cells: Vec<(CellSource, Column)>,
    counters: Vec<(usize, Counted, Column)>,
    frame_numbers: Vec<(FrameNumber, Column)>,
    row_numbers: Vec<(List, RowSource, Column)>,
    scene: Vec<Column>,
    forces: bool,
    fields: FieldColumns,
    systems: SystemColumns,
    /// How many there are of each system.
    members: Vec<usize>,
    /// Frames at the last [`Columns::forget_history`].
    forgotten: usize,
}

/// Whether datasets are made or opened and cut.
#[derive(Clone, Copy)]
enum Start {
    New,
    Cut { frames: usize, rows: Rows },
}

impl Columns {
    /// Makes all datasets, those of the forces if they are wanted: in a new run they come with the first frame that
    /// has some.
    pub fn create(file: &File, layout: &Layout, forces: bool) -> hdf5::Result<Self> {
        let mut columns = Self::start(file, layout, Start::New)?;
        if forces {
            columns.add_forces(file, Start::New)?;
        }
        Ok(columns)
    }

    /// Opens all datasets and cuts them to their first frames and rows.
    pub fn reopen(file: &File, layout: &Layout, frames: usize, rows: Rows) -> hdf5::Result<Self> {
        Self::start(file, layout, Start::Cut { frames, rows })
    }

    fn start(file: &File, layout: &Layout, start: Start) -> hdf5::Result<Self> {
        let mut columns = Self { atoms: layout.atoms(), cells: layout.cells.len(), ..Self::default() };
        if let Start::Cut { frames, rows } = start {
            (columns.frames, columns.rows) = (frames, rows);
        }
        let contacts = if layout.contacts { CONTACT } else { &[] };
        for entry in CATALOGUE.iter().chain(contacts) {
            columns.add(file, entry, start)?;
        }
        for (order, (name, unit)) in (0_i64..).zip(&layout.scene_series) {
            columns.add_scene(file, name, unit, order, start)?;
        }
        columns.members = layout.systems.iter().map(SystemLayout::members).collect();
        (columns.fields, columns.systems) = match start {
            Start::New => (FieldColumns::create(file, layout)?, SystemColumns::create(file, layout)?),
            Start::Cut { frames, .. } => {
                (FieldColumns::reopen(file, layout, frames)?, SystemColumns::reopen(file, layout, frames)?)
            }
        };
        if let Start::Cut { .. } = start
            && file.dataset(FORCE[0].path).is_ok()
        {
            columns.add_forces(file, start)?;
        }
        Ok(columns)
    }

    fn add(&mut self, file: &File, entry: &Entry, start: Start) -> hdf5::Result<()> {
        let integer = |row: &[usize], rows| small(file, &entry.plan(Number::Integer), row, start, rows);
        let float = |row: &[usize], rows| small(file, &entry.plan(Number::Float), row, start, rows);
        let (frames, rows) = (self.frames, self.rows);
        match entry.filled {
            Filled::Frame(value) => self.frame_numbers.push((value, float(&[], frames)?)),
            Filled::Counter(1, value) => self.counters.push((1, value, integer(&[], frames)?)),
            Filled::Counter(width, value) => self.counters.push((width, value, integer(&[width], frames)?)),
            Filled::Atoms(value) => self.atom_vectors.push((value, large(file, entry, self.atoms, &[3], start)?)),
            Filled::Cell(value) => self.add_cells(file, entry, &[], CellSource::Number(value), start)?,
            Filled::CellVector(value, _) => self.add_cells(file, entry, &[3], CellSource::Vector(value), start)?,
            Filled::RowInteger(list, value) => {
                let column = integer(&[], rows[list as usize])?;
                self.row_numbers.push((list, RowSource::Integer(value), column));
            }
            Filled::RowFloat(list, value) => {
                let column = float(&[], rows[list as usize])?;
                self.row_numbers.push((list, RowSource::Float(value), column));
            }
            Filled::Link(target) => link(file, target, entry.path)?,
            Filled::OnceIntegers | Filled::OnceFloats | Filled::OnceTexts => {}
            Filled::Scene | Filled::Measure | Filled::Mark | Filled::Bytes => {}
        }
        Ok(())
    }

    fn add_cells(
        &mut self,
        file: &File,
        entry: &Entry,
        vector: &[usize],
        source: CellSource,
        start: Start,
    ) -> hdf5::Result<()> {
        let row = [&[self.cells], vector].concat();
        if self.cells >= MANY_CELLS {
            self.many_cells.push((source, large(file, entry, 1, &row, start)?));
        } else {
            self.few_cells.push((source, small(file, &entry.plan(Number::Float), &row, start, self.frames)?));
        }
        Ok(())
    }

    fn add_scene(&mut self, file: &File, name: &str, unit: &str, order: i64, start: Start) -> hdf5::Result<()> {
        let path = format!("/scene/{name}");
        let description = "A series of the scene as a whole.";
        let plan = Plan { path: &path, number: Number::Float, unit, description };
        self.scene.push(small(file, &plan, &[], start, self.frames)?);
        let dataset = file.dataset(&path)?;
        set_number(&dataset, "order", order)
    }

    fn add_forces(&mut self, file: &File, start: Start) -> hdf5::Result<()> {
        self.forces = true;
        FORCE.iter().try_for_each(|entry| self.add(file, entry, start))
    }

    /// Frames so far.
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Appends a frame.
    pub fn append(&mut self, file: &File, frame: &Frame) -> hdf5::Result<()> {
        if self.frames == 0 && !self.forces && !frame.forces.is_empty() {
            self.add_forces(file, Start::New)?;
        }
        self.check_sizes(frame);
        self.append_large(frame)?;
        self.fields.append(&frame.fields)?;
        self.systems.append(&self.members, &frame.systems)?;
        let rows = List::ALL.map(|list| self.rows[list as usize] + list.rows(frame));
        let instant = Instant { frame, index: self.frames, atoms: self.atoms, rows };
        for (value, column) in &mut self.frame_numbers {
            column.push([value(frame).to_bits()])?;
        }
        for (width, value, column) in &mut self.counters {
            column.push(std::iter::repeat_n(value(&instant).cast_unsigned(), *width))?;
        }
        for (source, column) in &mut self.few_cells {
            column.push(source.values(&frame.cells).into_iter().map(f64::to_bits))?;
        }
        for (column, value) in self.scene.iter_mut().zip(&frame.scene) {
            column.push([value.to_bits()])?;
        }
        for (list, source, column) in &mut self.row_numbers {
            for row in 0..list.rows(frame) {
                column.push([match source {
                    RowSource::Integer(value) => value(frame, row).cast_unsigned(),
                    RowSource::Float(value) => value(frame, row).to_bits(),
                }])?;
            }
        }
        self.frames += 1;
        self.rows = rows;
        Ok(())
    }

    fn append_large(&mut self, frame: &Frame) -> hdf5::Result<()> {
        let atoms =
            self.atom_vectors.iter_mut().map(|(value, column)| (column, Cow::from(value(frame).as_flattened())));
        let cells = self.many_cells.iter_mut().map(|(source, column)| (column, Cow::from(source.values(&frame.cells))));
        push_frames(&mut atoms.chain(cells).collect::<Vec<_>>())
    }

    fn check_sizes(&self, frame: &Frame) {
        let expected = (self.atoms, if self.forces { self.atoms } else { 0 }, self.cells, self.scene.len());
        let found = (frame.positions.len(), frame.forces.len(), frame.cells.len(), frame.scene.len());
        assert_eq!(found, expected, "positions, forces, cells and scene values of a frame must fit the layout");
    }

    /// Hands all rows that are still in memory to the file.
    pub fn write(&mut self) -> hdf5::Result<()> {
        let frames = self.counters.iter_mut().map(|(_, _, column)| column);
        let frames = frames.chain(self.frame_numbers.iter_mut().map(|(_, column)| column));
        let frames = frames.chain(self.few_cells.iter_mut().map(|(_, column)| column)).chain(&mut self.scene);
        let mut all = frames.chain(self.row_numbers.iter_mut().map(|(_, _, column)| column));
        all.try_for_each(Column::write)?;
        self.systems.write()?;
        self.fields.write_counts(self.frames)
    }

    /// Lets go of what HDF5 keeps in memory about the frames so far, when it has become much. To be called right
    /// after a flush.
    pub fn forget_history(&mut self, file: &File) -> hdf5::Result<()> {
        if self.frames < self.forgotten + REMEMBERED_FRAMES {
            return Ok(());
        }
        self.forgotten = self.frames;
        for (value, column) in std::mem::take(&mut self.atom_vectors) {
            self.atom_vectors.push((value, column.renewed(file)?));
        }
        for (source, column) in std::mem::take(&mut self.many_cells) {
            self.many_cells.push((source, column.renewed(file)?));
        }
        for (list, source, column) in std::mem::take(&mut self.row_numbers) {
            self.row_numbers.push((list, source, column.renewed(file)?));
        }
        self.fields.renew(file)?;
        self.systems.renew(file)
    }
}

fn small(file: &File, plan: &Plan, row: &[usize], start: Start, rows: usize) -> hdf5::Result<Column> {
    match start {
        Start::New => Column::create(file, plan, row),
        Start::Cut { .. } => Column::reopen(file, plan.path, plan.number, row, rows),
    }
}

fn large(file: &File, entry: &Entry, frame_rows: usize, row: &[usize], start: Start) -> hdf5::Result<PackedColumn> {
    match start {
        Start::New => PackedColumn::create(file, &entry.plan(Number::Float), frame_rows, row),
        Start::Cut { frames, .. } => PackedColumn::reopen(file, entry.path, frame_rows, row, frames),
    }
}

/// Gives a dataset a second name, making the groups on the way.
fn link(file: &File, target: &str, path: &str) -> hdf5::Result<()> {
    if file.dataset(path).is_ok() {
        return Ok(());
    }
    if let Some((group, _)) = path.rsplit_once('/').filter(|(group, _)| !group.is_empty())
        && file.group(group).is_err()
    {
        file.create_group(group)?;
    }
    file.link_hard(target, path)
}
