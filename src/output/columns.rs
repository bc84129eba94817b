//! All datasets that grow with the run, made and filled as the catalogue says.

use std::borrow::Cow;

use hdf5::File;

use super::catalogue::{CATALOGUE, CONTACT, Entry, FIBRE, FORCE, Filled, Instant, LINK, List, TRACTION, cell_entries};
use super::cell_column::{CellColumn, CellSource};
use super::column::{Column, Number, Numbers, PackedColumn, Plan, SMALL_ROWS, push_frames};
use super::container::set_number;
use super::fields::FieldColumns;
use super::membranes::ORDER;
use super::pieces::{Pieces, has_frames};
use super::population::{Population, Shared};
use super::systems::{SystemScope, create_groups};
use super::whole::Ends;
use super::{Frame, Layout};

/// Populations in a piece: most runs have one.
const POPULATION_ROWS: usize = 16;

type FrameNumber = fn(&Frame) -> f64;
type AtomVectors = fn(&Frame) -> &[[f64; 3]];

/// Integers of a frame.
enum Counted {
    One(fn(&Instant) -> i64),
    Four(fn(&Instant) -> [i64; 4]),
}

/// Where a number per row of a list comes from.
enum RowSource {
    Integer(fn(&Frame, usize) -> i64),
    Float(fn(&Frame, usize) -> f64),
}

/// Rows of each list so far.
pub(super) type Rows = [usize; List::ALL.len()];

/// A number of a population that a column holds.
type PopulationNumber = fn(&Population) -> i64;

/// The datasets by what fills them. Until the first frame has come there are none but those of fields and the scene.
#[derive(Default)]
pub(super) struct Columns {
    layout: Layout,
    frames: usize,
    rows: Rows,
    /// The cells of the last frame.
    population: Option<Population>,
    populations: usize,
    atom_vectors: Vec<(AtomVectors, PackedColumn)>,
    /// Substances on membranes, in the order of the layout.
    membranes: Vec<PackedColumn>,
    cells: Vec<(CellSource, CellColumn)>,
    blocks: Vec<(Shared, PackedColumn)>,
    /// Where the blocks of the last population begin.
    blocks_at: [usize; Shared::ALL.len()],
    population_numbers: Vec<(PopulationNumber, Column)>,
    counters: Vec<(Counted, Column)>,
    frame_numbers: Vec<(FrameNumber, Column)>,
    row_numbers: Vec<(List, RowSource, Column)>,
    scene: Vec<Column>,
    /// Quantities of systems of the scene: number of the system and of the quantity.
    scene_systems: Vec<(usize, usize, Column)>,
    are_made: bool,
    forces: bool,
    fields: FieldColumns,
}

/// Whether datasets are made or opened and cut.
#[derive(Clone, Copy)]
enum Start<'a> {
    New(&'a Pieces),
    Cut(&'a Ends),
}

impl Columns {
    /// Makes the datasets of the fields; all others come with the first frame, which tells their sizes.
    pub fn create(file: &File, layout: &Layout) -> hdf5::Result<Self> {
        let fields = FieldColumns::create(file, layout)?;
        Ok(Self { layout: layout.clone(), fields, ..Self::default() })
    }

    /// Opens all datasets and cuts them to their first frames.
    pub fn reopen(file: &File, layout: &Layout, frames: usize) -> hdf5::Result<Self> {
        let mut columns = Self { layout: layout.clone(), frames, ..Self::default() };
        columns.fields = FieldColumns::reopen(file, layout, frames)?;
        if !has_frames(file) {
            return Ok(columns);
        }
        let ends = Ends::of(file, layout, frames)?;
        columns.start(file, Start::Cut(&ends))?;
        if file.dataset(FORCE[0].path).is_ok() {
            columns.add_forces(file, Start::Cut(&ends))?;
        }
        (columns.rows, columns.populations, columns.blocks_at) = (ends.rows, ends.populations, ends.blocks_at);
        columns.population = ends.population;
        Ok(columns)
    }

    fn start(&mut self, file: &File, start: Start) -> hdf5::Result<()> {
        let contacts = if self.layout.contacts { CONTACT } else { &[] };
        let tractions = if self.layout.tractions { TRACTION } else { &[] };
        let fibres = if self.layout.fibres { FIBRE } else { &[] };
        let links = if self.layout.linked { LINK } else { &[] };
        for entry in CATALOGUE.iter().chain(contacts).chain(tractions).chain(fibres).chain(links) {
            self.add(file, entry, start)?;
        }
        cell_entries(self.layout.on_demand()).try_for_each(|entry| self.add(file, &entry, start))?;
        for (order, (name, unit)) in (0_i64..).zip(&self.layout.scene_series) {
            let path = format!("/scene/{name}");
            let description = "A series of the scene as a whole.";
            let plan = Plan { path: &path, number: Number::Float, unit, description };
            self.scene.push(per_frame(file, &plan, &[], start)?);
            let dataset = file.dataset(&path)?;
            set_number(&dataset, "order", order)?;
        }
        self.add_systems(file, start)?;
        self.add_membranes(file, start)?;
        self.are_made = true;
        Ok(())
    }

    fn add(&mut self, file: &File, entry: &Entry, start: Start) -> hdf5::Result<()> {
        let (integer, float) = (entry.plan(Number::Integer), entry.plan(Number::Float));
        match entry.filled {
            Filled::Frame(value) => self.frame_numbers.push((value, per_frame(file, &float, &[], start)?)),
            Filled::Counter(value) => {
                self.counters.push((Counted::One(value), per_frame(file, &integer, &[], start)?));
            }
            Filled::Counters(value) => {
                let column = match start {
                    Start::New(_) => Column::create(file, &integer, &[4], SMALL_ROWS / 4)?,
                    Start::Cut(ends) => Column::reopen(file, entry.path, Number::Integer, &[4], ends.frames)?,
                };
                self.counters.push((Counted::Four(value), column));
            }
            Filled::Population(value) => {
                let column = match start {
                    Start::New(_) => Column::create(file, &integer, &[], POPULATION_ROWS)?,
                    Start::Cut(ends) => Column::reopen(file, entry.path, Number::Integer, &[], ends.populations)?,
                };
                self.population_numbers.push((value, column));
            }
            Filled::Shared(shared) => {
                let column = match start {
                    Start::New(pieces) => PackedColumn::create(file, &integer, &[], pieces.blocks[shared as usize])?,
                    Start::Cut(ends) => {
                        PackedColumn::reopen(file, entry.path, Number::Integer, &[], ends.blocks[shared as usize])?
                    }
                };
                self.blocks.push((shared, column));
            }
            Filled::Atoms(value) => {
                let column = match start {
                    Start::New(pieces) => PackedColumn::create(file, &float, &[3], pieces.atoms)?,
                    Start::Cut(ends) => PackedColumn::reopen(file, entry.path, Number::Float, &[3], ends.atoms)?,
                };
                self.atom_vectors.push((value, column));
            }
            Filled::CellInteger(value) => self.add_cells(file, &integer, CellSource::Integer(value), start)?,
            Filled::Cell(values) => self.add_cells(file, &float, CellSource::Recorded(values), start)?,
            Filled::RowInteger(list, value) => {
                let column = of_list(file, &integer, list, start)?;
                self.row_numbers.push((list, RowSource::Integer(value), column));
            }
            Filled::RowFloat(list, value) => {
                let column = of_list(file, &float, list, start)?;
                self.row_numbers.push((list, RowSource::Float(value), column));
            }
            Filled::Link(target) => link(file, target, entry.path)?,
            Filled::OnceIntegers | Filled::OnceFloats | Filled::OnceTexts => {}
            Filled::Scene | Filled::Measure | Filled::Bytes => {}
        }
        Ok(())
    }

    fn add_cells(&mut self, file: &File, plan: &Plan, source: CellSource, start: Start) -> hdf5::Result<()> {
        let column = match start {
            Start::New(pieces) => CellColumn::create(file, plan, source.row(), pieces.cells)?,
            Start::Cut(ends) => CellColumn::reopen(file, plan, source.row(), ends.cells)?,
        };
        self.cells.push((source, column));
        Ok(())
    }

    /// The datasets of the systems of chemistry: those inside cells are like other quantities of cells.
    fn add_systems(&mut self, file: &File, start: Start) -> hdf5::Result<()> {
        if let Start::New(_) = start {
            create_groups(file, &self.layout.systems)?;
        }
        for (number, system) in self.layout.systems.clone().iter().enumerate() {
            for (order, (name, unit)) in system.quantities.iter().enumerate() {
                let path = system.path(name);
                let description = format!("{name} of the system {}.", system.name);
                let plan = Plan { path: &path, number: Number::Float, unit, description: &description };
                match system.scope {
                    SystemScope::Scene => {
                        self.scene_systems.push((number, order, per_frame(file, &plan, &[], start)?));
                    }
                    SystemScope::Cells => self.add_cells(file, &plan, CellSource::System(number, order), start)?,
                }
                let dataset = file.dataset(&path)?;
                set_number(&dataset, "order", order as i64)?;
            }
        }
        Ok(())
    }

    /// The datasets of substances on membranes; a frame begins where its positions do.
    fn add_membranes(&mut self, file: &File, start: Start) -> hdf5::Result<()> {
        for (order, membrane) in self.layout.membranes.iter().enumerate() {
            let (path, description) = (membrane.path(), format!("Density of {} at the atoms.", membrane.name));
            let plan = Plan { path: &path, number: Number::Float, unit: &membrane.unit, description: &description };
            let column = match start {
                Start::New(pieces) => PackedColumn::create(file, &plan, &[], pieces.atoms)?,
                Start::Cut(ends) => PackedColumn::reopen(file, &path, Number::Float, &[], ends.atoms)?,
            };
            if let Start::New(_) = start {
                let dataset = file.dataset(&path)?;
                set_number(&dataset, ORDER, order as i64)?;
            }
            self.membranes.push(column);
            link(file, "/VTKHDF/Steps/PointOffsets", &membrane.offsets())?;
        }
        Ok(())
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
        let new = !self.population.as_ref().is_some_and(|known| known.is(&frame.cells));
        let population = new.then(|| Population::of(&self.layout, &frame.cells));
        if let Some(population) = &population {
            let pieces = Pieces::of(population);
            if !self.are_made {
                self.start(file, Start::New(&pieces))?;
            }
            let no_atoms_yet = self.atom_vectors.iter().all(|(_, column)| column.rows() == 0);
            if no_atoms_yet && !self.forces && !frame.forces.is_empty() {
                let pieces = Pieces::found(file)?.unwrap_or(pieces);
                self.add_forces(file, Start::New(&pieces))?;
            }
        }
        if let Some(population) = population {
            self.begin_population(population)?;
        }
        let rows = List::ALL.map(|list| self.rows[list as usize] + list.rows(frame));
        let instant = Instant {
            frame,
            rows,
            first_atom: self.atom_vectors.first().map_or(0, |(_, column)| column.rows()),
            first_cell: self.cells.first().map_or(0, |(_, column)| column.rows()),
            population: self.populations - 1,
            blocks: self.blocks_at,
        };
        for (value, column) in &mut self.counters {
            match value {
                Counted::One(value) => column.push([value(&instant).cast_unsigned()])?,
                Counted::Four(value) => column.push(value(&instant).map(i64::cast_unsigned))?,
            }
        }
        self.append_large(frame)?;
        self.append_small(frame)?;
        self.fields.append(&frame.fields)?;
        self.frames += 1;
        self.rows = rows;
        Ok(())
    }

    /// Writes what the frames of a population share.
    fn begin_population(&mut self, population: Population) -> hdf5::Result<()> {
        for (shared, column) in &mut self.blocks {
            self.blocks_at[*shared as usize] = column.rows();
            let fill = |first: usize, numbers: &mut [i64]| shared.fill(&self.layout, &population, first, numbers);
            column.push_integers(shared.length(&population), fill)?;
        }
        for (value, column) in &mut self.population_numbers {
            column.push([value(&population).cast_unsigned()])?;
        }
        self.populations += 1;
        self.population = Some(population);
        Ok(())
    }

    fn append_large(&mut self, frame: &Frame) -> hdf5::Result<()> {
        let atoms = self.atom_vectors.iter_mut();
        let mut large: Vec<(&mut PackedColumn, Numbers)> =
            atoms.map(|(value, column)| (column, Numbers::Floats(Cow::from(value(frame).as_flattened())))).collect();
        for (values, column) in frame.membranes.iter().zip(&mut self.membranes) {
            large.push((column, Numbers::Floats(Cow::from(values))));
        }
        for (source, column) in &mut self.cells {
            if let CellColumn::Many(column) = column {
                large.push((column, source.values(frame)));
            }
        }
        push_frames(&mut large)
    }

    fn append_small(&mut self, frame: &Frame) -> hdf5::Result<()> {
        for (value, column) in &mut self.frame_numbers {
            column.push([value(frame).to_bits()])?;
        }
        for (source, column) in &mut self.cells {
            if let CellColumn::Few(column) = column {
                let (values, width) = (source.values(frame), source.row().iter().product::<usize>());
                for cell in 0..frame.cells.len() {
                    column.push((cell * width..(cell + 1) * width).map(|index| values.bits(index)))?;
                }
            }
        }
        for (column, value) in self.scene.iter_mut().zip(&frame.scene) {
            column.push([value.to_bits()])?;
        }
        for (system, quantity, column) in &mut self.scene_systems {
            column.push(frame.systems[*system][*quantity].iter().map(|value| value.to_bits()))?;
        }
        for (list, source, column) in &mut self.row_numbers {
            for row in 0..list.rows(frame) {
                column.push([match source {
                    RowSource::Integer(value) => value(frame, row).cast_unsigned(),
                    RowSource::Float(value) => value(frame, row).to_bits(),
                }])?;
            }
        }
        Ok(())
    }

    /// Hands all rows that are still in memory to the file.
    pub fn write(&mut self) -> hdf5::Result<()> {
        let frames = self.counters.iter_mut().map(|(_, column)| column);
        let frames = frames.chain(self.frame_numbers.iter_mut().map(|(_, column)| column)).chain(&mut self.scene);
        let frames = frames.chain(self.scene_systems.iter_mut().map(|(.., column)| column));
        let all = frames.chain(self.population_numbers.iter_mut().map(|(_, column)| column));
        let mut all = all.chain(self.row_numbers.iter_mut().map(|(_, _, column)| column));
        all.try_for_each(Column::write)?;
        for (_, column) in &mut self.cells {
            if let CellColumn::Few(column) = column {
                column.write()?;
            }
        }
        self.fields.write_counts(self.frames)
    }
}

fn per_frame(file: &File, plan: &Plan, row: &[usize], start: Start) -> hdf5::Result<Column> {
    match start {
        Start::New(_) => Column::create(file, plan, row, SMALL_ROWS),
        Start::Cut(ends) => Column::reopen(file, plan.path, plan.number, row, ends.frames),
    }
}

fn of_list(file: &File, plan: &Plan, list: List, start: Start) -> hdf5::Result<Column> {
    match start {
        Start::New(_) => Column::create(file, plan, &[], SMALL_ROWS),
        Start::Cut(ends) => Column::reopen(file, plan.path, plan.number, &[], ends.rows[list as usize]),
    }
}

/// Gives a dataset a second name, making the groups that it needs.
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
