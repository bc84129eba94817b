//! How large an experiment is, from the numbers of its documents alone: told before anything is made that no memory holds.

use std::f64::consts::PI;

use super::super::{CellType, Document, Mesh};
use super::schedule::schedule;
use crate::error::{Error, Fault, Result};
use crate::field::FieldSystem;

/// Bytes of memory an atom of a cell: 120 measured where cells pass through each other, and 440 to 1 020 where they are packed and touch
/// (`docs/benchmarks.md`), the step, what it begins from, and a frame that is recorded together.
const AN_ATOM: f64 = 120.0;
const AN_ATOM_IN_CONTACT: f64 = 700.0;

/// Bytes of memory a cell besides.
const A_CELL: f64 = 500.0;

/// Bytes of memory an atom of the mesh that all cells of a type share: positions, neighbours and forces; and, times the root of the
/// number of atoms, two factors of its stiffness, of which a row reaches over some five rings of atoms.
const AN_ATOM_OF_A_MESH: f64 = 3000.0;
const A_ROW_OF_A_MESH: f64 = 2.0 * 8.0 * 5.0;

/// Bytes of memory a number of a system of equations in a cell or at an atom: stages and what is recorded.
const A_NUMBER: f64 = 100.0;

/// Bytes of memory a value of a field in a box, as many as the numbers that moving fields needs.
const A_VALUE: f64 = 8.0 * crate::field::ARRAYS as f64;

/// Bytes of a mesh file for each atom, at least: binary PLY has 12 for an atom and 13 for each of two facets.
const FILE_BYTES: f64 = 38.0;

/// Bytes of the result for a frame of an atom, a cell and a value of a field, before they are packed.
const ATOM_RECORDED: f64 = 24.0;
const FORCE_RECORDED: f64 = 24.0;
const TRACTIONS_RECORDED: f64 = 96.0;
const CELL_RECORDED: f64 = 400.0;
const VALUE_RECORDED: f64 = 8.0;

/// Cells and atoms are numbered in 32 bits.
const MOST_NUMBERED: f64 = u32::MAX as f64;

/// How large an experiment is. Numbers are whole up to 2⁵³, and no more than roughly right beyond.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Size {
    /// Cells that there are at most.
    pub cells: f64,
    /// Their atoms.
    pub atoms: f64,
    /// Their facets.
    pub facets: f64,
    /// Atoms of the finest mesh.
    pub finest: f64,
    /// Boxes of all fields, times their species.
    pub values: f64,
    /// Frames of the result.
    pub frames: f64,
    /// Bytes of memory that a run takes, by an estimate that is right within a factor of two or so.
    pub memory: f64,
    /// Bytes of the result before it is packed: what is written is less.
    pub result: f64,
}

/// What takes memory, and the key that says how much.
struct Part {
    key: String,
    words: String,
    memory: f64,
}

impl Size {
    /// The size of an experiment's cells. Reads nothing but the lengths of mesh files.
    pub fn of_cells(document: &Document) -> Self {
        let mut size = Self { frames: frames(document), ..Self::default() };
        let experiment = &document.experiment;
        let recorded = ATOM_RECORDED
            + if experiment.output.forces { FORCE_RECORDED } else { 0.0 }
            + if experiment.keeps_tractions() { TRACTIONS_RECORDED } else { 0.0 };
        for cell in experiment.cells.values() {
            let ([atoms, facets], cells) = (of_mesh(document, &cell.mesh), most(cell));
            size.cells += cells;
            size.atoms += cells * atoms;
            size.facets += cells * facets;
            size.finest = size.finest.max(atoms);
            size.memory += memory(document, cells, atoms);
            size.result += size.frames * cells * (CELL_RECORDED + atoms * recorded);
        }
        size
    }

    /// With values of a field.
    fn with_field(mut self, values: f64, each: f64) -> Self {
        self.values += values;
        self.memory += values * each;
        self.result += self.frames * values * VALUE_RECORDED;
        self
    }

    /// With numbers of a system in all cells, or at all atoms.
    fn with_numbers(mut self, numbers: f64) -> Self {
        self.memory += numbers * A_NUMBER;
        self.result += self.frames * numbers * VALUE_RECORDED;
        self
    }
}

/// The size of an experiment's cells where they fit.
///
/// # Errors
/// [`Error::Input`] at the key that makes the most of it: more cells or atoms than can be numbered, or more memory than the document
/// [may take](Document::memory).
pub fn of_cells(document: &Document) -> Result<Size> {
    let size = Size::of_cells(document);
    let largest = document.experiment.cells.iter().map(|(name, cell)| part_of(document, name, cell));
    let Some(largest) = largest.max_by(|one, other| one.memory.total_cmp(&other.memory)) else { return Ok(size) };
    for (number, words) in [(size.cells, "cells"), (size.atoms, "atoms")] {
        if number > MOST_NUMBERED {
            let message =
                format!("the experiment has {} {words}; {MOST_NUMBERED} at most can be numbered", count(number));
            let fault = Fault::new(message).help("let there be fewer cells or coarser meshes");
            return Err(refused(document, &largest, fault));
        }
    }
    within(document, size, &largest)?;
    Ok(size)
}

/// Adds a field of a document of equations to the size of an experiment, before the field is made.
///
/// # Errors
/// As [`of_cells`].
pub fn with_field(document: &Document, name: &str, size: Size, system: &FieldSystem) -> Result<Size> {
    let (boxes, species) = (system.grid().len(), system.species().len());
    let carrying = if system.transport().is_some() { 8.0 * crate::field::CARRYING as f64 } else { 0.0 };
    let each = A_VALUE + carrying;
    let values = boxes as f64 * species as f64;
    let words = format!("{} boxes of the field `{name}` with {species} species each", count(boxes as f64));
    let key = format!("chemistry.{name}.document");
    let size = size.with_field(values, each);
    within(document, size, &Part { key, words, memory: values * each })?;
    Ok(size)
}

/// Adds a system of so many numbers, which so many cells or atoms have, to the size of an experiment.
///
/// # Errors
/// As [`of_cells`].
pub fn with_system(document: &Document, name: &str, size: Size, [numbers, copies]: [f64; 2]) -> Result<Size> {
    let words = format!("{} copies of the system `{name}` with {numbers} numbers each", count(copies));
    let key = format!("chemistry.{name}.document");
    let size = size.with_numbers(numbers * copies);
    within(document, size, &Part { key, words, memory: numbers * copies * A_NUMBER })?;
    Ok(size)
}

/// Refuses what takes more memory than it may.
fn within(document: &Document, size: Size, largest: &Part) -> Result<()> {
    let Some(most) = document.memory.filter(|most| size.memory > *most as f64) else { return Ok(()) };
    let message = format!(
        "the experiment takes about {} of memory, and {} may be taken: {} take {}",
        bytes(size.memory),
        bytes(most as f64),
        largest.words,
        bytes(largest.memory)
    );
    let help = "let there be fewer of them, or name a larger limit where the machine has more: --memory \"64 GB\"";
    Err(refused(document, largest, Fault::new(message).help(help)))
}

fn refused(document: &Document, part: &Part, fault: Fault) -> Error {
    Error::input(document.location(&part.key, "most of it comes from here").into_iter().fold(fault, Fault::at))
}

/// What a type of cells takes.
fn part_of(document: &Document, name: &str, cell: &CellType) -> Part {
    let ([atoms, _], cells) = (of_mesh(document, &cell.mesh), most(cell));
    let key = match () {
        () if cells <= 1.0 || memory(document, 0.0, atoms) > memory(document, cells, 0.0) + cells * atoms * AN_ATOM => {
            "mesh"
        }
        () if cell.number.is_some_and(|number| 2.0 * f64::from(number) > cells) => "number",
        () if 2.0 * cell.count() as f64 > cells => "placement",
        () => "added",
    };
    let plural = if cells == 1.0 { "cell" } else { "cells" };
    let words = format!("{} {plural} of type `{name}` with {} atoms each", count(cells), count(atoms));
    Part { key: format!("cells.{name}.{key}"), words, memory: memory(document, cells, atoms) }
}

/// Bytes of memory of a type of so many cells with so many atoms each.
fn memory(document: &Document, cells: f64, atoms: f64) -> f64 {
    let an_atom = if document.experiment.contact.is_some() { AN_ATOM_IN_CONTACT } else { AN_ATOM };
    cells * (A_CELL + atoms * an_atom) + atoms * (AN_ATOM_OF_A_MESH + atoms.sqrt() * A_ROW_OF_A_MESH)
}

/// The most cells of a type. As [`CellType::most`], of which the sum may not fit its number.
fn most(cell: &CellType) -> f64 {
    cell.count() as f64 + cell.added.iter().map(|added| added.count() as f64).sum::<f64>()
}

/// Atoms and facets of a mesh; those of a file by its length.
fn of_mesh(document: &Document, mesh: &Mesh) -> [f64; 2] {
    match mesh {
        Mesh::RedCell { level, .. } | Mesh::Icosphere { level, .. } => {
            let facets = 20.0 * 4.0_f64.powi(i32::from(*level));
            [0.5 * facets + 2.0, facets]
        }
        Mesh::Octasphere { divisions, .. } => {
            let facets = 8.0 * f64::from(*divisions).powi(2);
            [0.5 * facets + 2.0, facets]
        }
        Mesh::Box { divisions, .. } => {
            let [x, y, z] = divisions.map(f64::from);
            let facets = 4.0 * (x * y + y * z + z * x);
            [0.5 * facets + 2.0, facets]
        }
        Mesh::Sheet { divisions, .. } => {
            let [x, y] = divisions.map(f64::from);
            [(x + 1.0) * (y + 1.0), 2.0 * x * y]
        }
        Mesh::Triangle { .. } => [3.0, 1.0],
        // As if all rings were as wide as the widest.
        Mesh::Lathe { profile, rounding, around } => {
            let corners: Vec<[f64; 2]> = profile.iter().map(|corner| corner.map(|length| length.value())).collect();
            let widest = corners.iter().map(|corner| corner[0]).fold(0.0, f64::max);
            let sides = corners.iter().zip(corners.iter().cycle().skip(1));
            let outline: f64 = sides.map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).sum();
            let around = f64::from(*around);
            let of_a_corner = if rounding.value() == 0.0 { 1.0 } else { 6.0 };
            let rings = of_a_corner * corners.len() as f64
                + if widest > 0.0 { outline * around / (2.0 * PI * widest) } else { 0.0 };
            [rings * around, 2.0 * rings * around]
        }
        Mesh::Block { divisions, .. } => {
            let [x, y, z] = divisions.map(f64::from);
            [(x + 1.0) * (y + 1.0) * (z + 1.0), 4.0 * (x * y + y * z + z * x)]
        }
        Mesh::Rod { rings, layers, .. } => {
            let (rings, layers) = (f64::from(*rings), f64::from(*layers));
            [(1.0 + 3.0 * rings * (rings + 1.0)) * (layers + 1.0), 12.0 * rings * (rings + layers)]
        }
        Mesh::File { path, .. } => {
            let length = std::fs::metadata(document.resolve(path)).map_or(0.0, |file| file.len() as f64);
            [length / FILE_BYTES, 2.0 * length / FILE_BYTES]
        }
    }
}

/// Frames that the run records.
fn frames(document: &Document) -> f64 {
    schedule(document).frames(document.experiment.run.until.value())
}

/// A number of things, as messages show it.
fn count(number: f64) -> String {
    if number < 1e15 { format!("{number:.0}") } else { format!("{number:.1e}") }
}

/// Bytes as people say them: "1.2 GB".
pub fn bytes(number: f64) -> String {
    const NAMES: [&str; 7] = ["bytes", "kB", "MB", "GB", "TB", "PB", "EB"];
    let power =
        (0..NAMES.len() - 1).find(|power| number < 999.5 * 1000_f64.powi(*power as i32)).unwrap_or(NAMES.len() - 1);
    let scaled = number / 1000_f64.powi(power as i32);
    let digits = if scaled < 9.95 && power > 0 { 1 } else { 0 };
    format!("{scaled:.digits$} {}", NAMES[power])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Profile, Surface, box_surface, icosphere, lathe, octasphere, sheet};
    use std::path::Path;

    fn document(cells: &str) -> Document {
        let text = format!(
            "title = \"x\"\nrun = {{ until = \"1 s\" }}\n[cells.a]\n{cells}\nmechanics = {{ drag = \"20 pN s/um\" }}"
        );
        Document::parse("a", &text, Path::new("."), &[]).expect("a good document")
    }

    #[test]
    fn meshes_have_as_many_atoms_and_facets_as_are_told() {
        let told = |mesh: &str| {
            let document = document(&format!("mesh = {{ {mesh} }}\nplacement = {{ at = [[0, 0, 0]] }}"));
            of_mesh(&document, &document.experiment.cells["a"].mesh)
        };
        let made = |surface: Surface| [surface.positions.len() as f64, surface.facets.len() as f64];
        assert_eq!(told("shape = \"icosphere\", radius = \"1 um\", level = 3"), made(icosphere(1.0, 3)));
        assert_eq!(told("shape = \"octasphere\", radius = \"1 um\", divisions = 5"), made(octasphere(1.0, 5)));
        let [box_told, sheet_told] = [
            "shape = \"box\", size = [\"1 um\", \"2 um\", \"3 um\"], divisions = [2, 3, 5]",
            "shape = \"sheet\", size = [\"1 um\", \"2 um\"], divisions = [2, 3]",
        ]
        .map(told);
        assert_eq!(box_told, made(box_surface([1.0, 2.0, 3.0], [2, 3, 5])));
        assert_eq!(sheet_told, made(sheet(1.0, 2.0, 2, 3)));
        let told = told(
            "shape = \"lathe\", profile = [[\"2 um\", 0], [\"3 um\", 0], [\"3 um\", \"9 um\"], [\"2 um\", \"9 um\"]], rounding = \"0.5 um\", around = 32",
        );
        let corners = &[[2.0, 0.0], [3.0, 0.0], [3.0, 9.0], [2.0, 9.0]];
        let made = made(lathe(Profile { corners, rounding: 0.5, around: 32 }).expect("a surface"));
        assert!((0..2).all(|i| (1.0..2.0).contains(&(told[i] / made[i]))), "no fewer: {told:?} {made:?}");
    }

    /// What is said of so many cells on a machine of 24 GB, and what is marked.
    fn refusal(number: &str) -> (String, String) {
        let mesh = "mesh = { shape = \"icosphere\", radius = \"5 um\", level = 0 }";
        let mut document = document(&format!("number = {number}\n{mesh}"));
        document.memory = Some(24_000_000_000);
        let Err(Error::Input(faults)) = of_cells(&document) else { panic!("{number} cells fit") };
        let location = faults[0].location.clone().expect("a location");
        let marked = location.source.text[location.start..location.start + location.length].to_owned();
        (faults[0].message.clone(), marked)
    }

    #[test]
    fn cells_that_no_memory_holds_are_refused_where_their_number_stands() {
        let (message, marked) = refusal("300000000");
        assert!(message.contains("582 GB of memory, and 24 GB may be taken: 300000000 cells of type `a`"), "{message}");
        assert_eq!(marked, "300000000");
        let (message, _) = refusal("1000000000");
        assert!(message.contains("12000000000 atoms"), "{message}");
    }

    #[test]
    fn bytes_are_said_shortly() {
        let said = [0.0, 999.0, 999.6, 4.2e9, 23.4e9, 1e30].map(bytes);
        assert_eq!(said, ["0 bytes", "999 bytes", "1.0 kB", "4.2 GB", "23 GB", "1000000000000 EB"]);
    }
}
