//! The cells of a frame for VTK (`.vtu`): their facets, with what was recorded of atoms and of cells.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::ops::Range;
use std::path::Path;

use super::container::machine_error;
use super::vtk_xml::{Numbers, opening, time_value, write_array};
use super::{Cell, ResultFile, catalogue};
use crate::error::Result;
use crate::recorded::{DERIVED, Values, cell_quantities};

/// VTK's number for a triangle.
const TRIANGLE: u8 = 5;

/// Writes the cells of a frame, or the one with an id, as an unstructured grid of VTK (`.vtu`): triangles with every quantity of
/// their cell, points with every quantity of their atom, the time of the frame, s. Of a cell that is not in the frame there are none
/// of either. An existing file is replaced.
///
/// # Errors
/// A damaged result, or a file that cannot be written.
///
/// # Panics
/// If there is no such frame.
pub fn write_mesh(result: &ResultFile, frame: usize, cell: Option<u64>, path: &Path) -> Result<()> {
    let mesh = Mesh::read(result, frame, cell)?;
    let written = File::create(path).and_then(|file| {
        let mut out = BufWriter::new(file);
        mesh.write(&mut out)?;
        out.flush()
    });
    written.map_err(|error| machine_error(path, "cannot be written", &error.to_string()))
}

/// A quantity of atoms or of cells: so many numbers for each.
struct Quantity {
    name: String,
    unit: String,
    components: usize,
    values: Vec<f64>,
}

impl Quantity {
    fn vector(name: &str, unit: &str, values: &[[f64; 3]]) -> Self {
        Self { name: name.to_owned(), unit: unit.to_owned(), components: 3, values: values.as_flattened().to_vec() }
    }

    fn number(name: String, unit: String, values: Vec<f64>) -> Self {
        Self { name, unit, components: 1, values }
    }

    /// Those of some of its items.
    fn of(&self, items: Range<usize>) -> &[f64] {
        &self.values[self.components * items.start..self.components * items.end]
    }
}

/// What is written of a frame.
struct Mesh<'a> {
    result: &'a ResultFile,
    time: f64,
    /// All cells of the frame, and those that are shown with their atoms.
    cells: Vec<Cell>,
    shown: Range<usize>,
    atoms: Range<usize>,
    positions: Vec<[f64; 3]>,
    of_atoms: Vec<Quantity>,
    of_cells: Vec<Quantity>,
}

impl<'a> Mesh<'a> {
    fn read(result: &'a ResultFile, frame: usize, cell: Option<u64>) -> Result<Self> {
        let cells = result.cells(frame);
        let shown = match cell {
            None => 0..cells.len(),
            Some(id) => cells.iter().position(|cell| cell.id == id).map_or(0..0, |at| at..at + 1),
        };
        let layout = result.layout();
        let first = layout.atoms(&cells[..shown.start]);
        let atoms = first..first + layout.atoms(&cells[shown.clone()]);
        let (of_atoms, of_cells) = (quantities_of_atoms(result, frame)?, quantities_of_cells(result, frame)?);
        let (time, positions) = (result.times()?[frame], result.positions(frame)?);
        Ok(Self { result, time, cells, shown, atoms, positions, of_atoms, of_cells })
    }

    fn shown_cells(&self) -> &[Cell] {
        &self.cells[self.shown.clone()]
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let layout = self.result.layout();
        let facets: usize = self.shown_cells().iter().map(|cell| layout.types[cell.kind as usize].facets.len()).sum();
        write!(out, "{}<UnstructuredGrid>\n{}", opening("UnstructuredGrid"), time_value(self.time))?;
        writeln!(out, "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{facets}\">", self.atoms.len())?;
        writeln!(out, "<PointData>")?;
        let atoms_of = |cell: &Cell| layout.types[cell.kind as usize].atoms as usize;
        self.write_owners(out, atoms_of)?;
        for quantity in &self.of_atoms {
            let numbers = Numbers::Floats(quantity.of(self.atoms.clone()));
            write_array(out, &quantity.name, quantity.components, &quantity.unit, &numbers)?;
        }
        writeln!(out, "</PointData>\n<CellData>")?;
        let facets_of = |cell: &Cell| layout.types[cell.kind as usize].facets.len();
        self.write_owners(out, facets_of)?;
        for quantity in &self.of_cells {
            let of = |at: usize| quantity.of(at..at + 1).repeat(facets_of(&self.cells[at]));
            let values: Vec<f64> = self.shown.clone().flat_map(of).collect();
            write_array(out, &quantity.name, quantity.components, &quantity.unit, &Numbers::Floats(&values))?;
        }
        writeln!(out, "</CellData>\n<Points>")?;
        let positions = self.positions[self.atoms.clone()].as_flattened();
        write_array(out, "Points", 3, "um", &Numbers::Floats(positions))?;
        writeln!(out, "</Points>\n<Cells>")?;
        let corners = layout.facets_of(self.shown_cells()).flatten().map(i64::from);
        write_array(out, "connectivity", 1, "1", &Numbers::Integers(&corners.collect::<Vec<_>>()))?;
        let ends: Vec<i64> = (1..=facets as i64).map(|facet| 3 * facet).collect();
        write_array(out, "offsets", 1, "1", &Numbers::Integers(&ends))?;
        write_array(out, "types", 1, "1", &Numbers::Bytes(&vec![TRIANGLE; facets]))?;
        writeln!(out, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
    }

    /// Whose each atom or facet is, by the names that the result file has for this too, where a cell has so many of them.
    fn write_owners(&self, out: &mut impl Write, parts: impl Fn(&Cell) -> usize) -> io::Result<()> {
        let mut write = |name: &str, of: fn(&Cell) -> i64| {
            let numbers = self.shown_cells().iter().flat_map(|cell| std::iter::repeat_n(of(cell), parts(cell)));
            write_array(out, name, 1, "1", &Numbers::Integers(&numbers.collect::<Vec<_>>()))
        };
        write("cell", |cell| cell.id.cast_signed())?;
        write("type", |cell| i64::from(cell.kind))?;
        write("parent", |cell| cell.parent.map_or(-1, u64::cast_signed))
    }
}

/// What was recorded of the atoms of a frame besides their positions.
fn quantities_of_atoms(result: &ResultFile, frame: usize) -> Result<Vec<Quantity>> {
    let mut all = Vec::new();
    if let Some(forces) = result.forces(frame)? {
        all.push(Quantity::vector("force", "pN", &forces));
    }
    if let Some(found) = result.tractions(frame)? {
        let values = [found.traction, found.of_cells, found.drag, found.outer, found.inertia, found.held];
        // The names are those of the datasets, whose order that of the values is.
        for (entry, values) in catalogue::TRACTION.iter().zip(&values) {
            all.push(Quantity::vector(entry.path.rsplit('/').next().unwrap_or_default(), entry.unit, values));
        }
    }
    for membrane in &result.layout().membranes {
        let values = result.membrane(&membrane.name, frame)?.unwrap_or_default();
        all.push(Quantity::number(membrane.name.clone(), membrane.unit.clone(), values));
    }
    Ok(all)
}

/// What was recorded of the cells of a frame, and what chemistry is in them.
fn quantities_of_cells(result: &ResultFile, frame: usize) -> Result<Vec<Quantity>> {
    let mut all = Vec::new();
    for quantity in cell_quantities(result.layout().on_demand()) {
        let (name, unit) = (quantity.name().to_owned(), quantity.unit.to_owned());
        let series = |ending: &str| result.cell_values(&format!("{name}_{ending}"), frame);
        all.push(match &quantity.values {
            Values::Number(..) => {
                let values = result.cell_values(&name, frame)?;
                Quantity::number(name, unit, values)
            }
            Values::Vector(_, [(one, _), (two, _), (three, _)]) => {
                let (one, two, three) = (series(one)?, series(two)?, series(three)?);
                let values: Vec<[f64; 3]> = (0..one.len()).map(|at| [one[at], two[at], three[at]]).collect();
                Quantity::vector(&name, &unit, &values)
            }
        });
    }
    for derived in &DERIVED {
        let values = result.cell_values(derived.name, frame)?;
        all.push(Quantity::number(derived.name.to_owned(), derived.unit.to_owned(), values));
    }
    for name in result.cell_quantities() {
        let (unit, values) = (result.units(&name)?, result.cell_values(&name, frame)?);
        all.push(Quantity::number(name, unit, values));
    }
    Ok(all)
}
