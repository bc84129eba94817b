//! Every dataset of the result file: where it stands, its unit and shape, what it means and where its numbers come
//! from. A new quantity is one row here; writer, reader and `info` follow.
//!
//! Shapes are in words: `frame` counts recorded instants, `atom`, `cell`, `facet` and `link` the parts of the
//! [`Layout`](super::Layout). All numbers here take eight bytes: floating point or signed integers. Fields and systems
//! of chemistry, which differ from run to run, are made by `fields` and `systems`.

use super::{CellRecord, Frame};

/// One motility run that ended: cell, end (s), duration (s).
pub type Run = (u32, f64, f64);

/// One row of the catalogue.
pub struct Entry {
    /// Path in the file.
    pub path: &'static str,
    /// Unit; `1` for pure numbers and counts.
    pub unit: &'static str,
    /// Shape in words.
    pub shape: &'static str,
    /// What the numbers mean, in a sentence.
    pub description: &'static str,
    /// Where the numbers come from, which also fixes their type.
    pub filled: Filled,
}

/// Where the numbers of a dataset come from.
pub enum Filled {
    /// Written when the file is made, from the layout: integers.
    OnceIntegers,
    /// Written when the file is made, from the layout: floating-point numbers.
    OnceFloats,
    /// Written when the file is made: texts.
    OnceTexts,
    /// One floating-point number per frame.
    Frame(fn(&Frame) -> f64),
    /// The same integer, this many times, per frame.
    Counter(usize, fn(&Instant) -> i64),
    /// A second name of another dataset.
    Link(&'static str),
    /// One vector per atom and frame, all frames one after the other.
    Atoms(fn(&Frame) -> &[[f64; 3]]),
    /// One number per frame and cell.
    Cell(fn(&CellRecord) -> f64),
    /// Three numbers per frame and cell; the endings name the components.
    CellVector(fn(&CellRecord) -> [f64; 3], [&'static str; 3]),
    /// An integer per row of a list.
    RowInteger(List, fn(&Frame, usize) -> i64),
    /// A floating-point number per row of a list.
    RowFloat(List, fn(&Frame, usize) -> f64),
    /// One number per frame and name of the scene; `<name>` in the path.
    Scene,
    /// One number per measure, written when the run ends; `<name>` in the path.
    Measure,
    /// A number that says whether a flush is under way.
    Mark,
    /// Bytes written when the run ends.
    Bytes,
}

/// What a counter is read from.
pub struct Instant<'a> {
    /// The frame being written.
    pub frame: &'a Frame,
    /// Its number.
    pub index: usize,
    /// Atoms of all cells.
    pub atoms: usize,
    /// Rows of each list up to this frame, its own included.
    pub rows: [usize; List::ALL.len()],
}

/// What has any number of rows in a frame. All frames stand one after the other; a counter says where each ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum List {
    /// Motility runs that ended.
    Runs,
    /// Pairs of cells that touch.
    Pairs,
    /// Cells that touch a plane.
    OnPlanes,
}

impl List {
    /// All lists, each at its number.
    pub const ALL: [Self; 3] = [Self::Runs, Self::Pairs, Self::OnPlanes];

    /// Rows of a frame.
    pub fn rows(self, frame: &Frame) -> usize {
        match self {
            Self::Runs => frame.runs.len(),
            Self::Pairs => frame.pairs.len(),
            Self::OnPlanes => frame.on_planes.len(),
        }
    }

    /// The dataset that counts its rows up to each frame.
    pub fn counter(self) -> &'static str {
        match self {
            Self::Runs => "/events/run_count",
            Self::Pairs => "/contacts/pair_count",
            Self::OnPlanes => "/contacts/plane_count",
        }
    }

    /// A dataset with its rows.
    pub fn column(self) -> &'static str {
        match self {
            Self::Runs => "/events/runs/cell",
            Self::Pairs => "/contacts/pairs/area",
            Self::OnPlanes => "/contacts/planes/area",
        }
    }
}

const XYZ: [&str; 3] = ["x", "y", "z"];
const LONGEST_FIRST: [&str; 3] = ["1", "2", "3"];

const fn row(
    path: &'static str,
    unit: &'static str,
    shape: &'static str,
    filled: Filled,
    description: &'static str,
) -> Entry {
    Entry { path, unit, shape, description, filled }
}

use Filled::{
    Atoms, Bytes, Cell, CellVector, Counter, Frame as PerFrame, Link, OnceFloats, OnceIntegers, OnceTexts, RowFloat,
    RowInteger,
};

/// All datasets, in the order in which they are made, except those of [`CONTACT`] and [`FORCE`].
#[rustfmt::skip]
pub const CATALOGUE: &[Entry] = &[
    // The animated surface, in the layout that VTK calls VTKHDF PolyData 2.0.
    row("/VTKHDF/NumberOfPoints", "1", "1", OnceIntegers, "Atoms of all cells."),
    row("/VTKHDF/Points", "um", "frame*atom, 3", Atoms(|f| &f.positions), "Positions of the atoms, one frame after the other."),
    row("/VTKHDF/PointData/cell", "1", "atom", OnceIntegers, "Cell that an atom belongs to."),
    row("/VTKHDF/PointData/type", "1", "atom", OnceIntegers, "Type of the cell that an atom belongs to, an index into /cells/type_names."),
    row("/VTKHDF/CellData/cell", "1", "link + facet", OnceIntegers, "Cell that a link or a facet belongs to (first atom of a link)."),
    row("/VTKHDF/CellData/type", "1", "link + facet", OnceIntegers, "Type of the cell that a link or a facet belongs to."),
    row("/VTKHDF/Steps/Values", "s", "frame", PerFrame(|f| f.time), "Simulated time of a frame."),
    row("/VTKHDF/Steps/NumberOfParts", "1", "frame", Counter(1, |_| 1), "Pieces of the surface (VTKHDF); always one."),
    row("/VTKHDF/Steps/PartOffsets", "1", "frame", Counter(1, |_| 0), "First piece of a frame (VTKHDF); the mesh never changes."),
    row("/VTKHDF/Steps/PointOffsets", "1", "frame", Counter(1, |i| (i.index * i.atoms) as i64), "First row of a frame in /VTKHDF/Points."),
    row("/VTKHDF/Steps/CellOffsets", "1", "frame, 4", Counter(4, |_| 0), "First vertex, line, polygon and strip of a frame (VTKHDF)."),
    row("/VTKHDF/Steps/ConnectivityIdOffsets", "1", "frame, 4", Link("/VTKHDF/Steps/CellOffsets"), "The same for the connectivity (VTKHDF)."),
    row("/VTKHDF/Steps/PointDataOffsets/cell", "1", "frame", Link("/VTKHDF/Steps/PartOffsets"), "First row of a frame in PointData/cell."),
    row("/VTKHDF/Steps/PointDataOffsets/type", "1", "frame", Link("/VTKHDF/Steps/PartOffsets"), "First row of a frame in PointData/type."),
    row("/VTKHDF/Steps/CellDataOffsets/cell", "1", "frame", Link("/VTKHDF/Steps/PartOffsets"), "First row of a frame in CellData/cell."),
    row("/VTKHDF/Steps/CellDataOffsets/type", "1", "frame", Link("/VTKHDF/Steps/PartOffsets"), "First row of a frame in CellData/type."),
    // Topology, once for each kind that VTK knows; only lines and polygons are used.
    row("/VTKHDF/Vertices/NumberOfConnectivityIds", "1", "1", OnceIntegers, "Unused."),
    row("/VTKHDF/Vertices/NumberOfCells", "1", "1", OnceIntegers, "Unused."),
    row("/VTKHDF/Vertices/Offsets", "1", "1", OnceIntegers, "Unused."),
    row("/VTKHDF/Vertices/Connectivity", "1", "0", OnceIntegers, "Unused."),
    row("/VTKHDF/Lines/NumberOfConnectivityIds", "1", "1", OnceIntegers, "Twice the number of internal links."),
    row("/VTKHDF/Lines/NumberOfCells", "1", "1", OnceIntegers, "Internal links."),
    row("/VTKHDF/Lines/Offsets", "1", "link + 1", OnceIntegers, "Where a link begins in Connectivity."),
    row("/VTKHDF/Lines/Connectivity", "1", "2*link", OnceIntegers, "The two atoms of every internal link."),
    row("/VTKHDF/Polygons/NumberOfConnectivityIds", "1", "1", OnceIntegers, "Three times the number of facets."),
    row("/VTKHDF/Polygons/NumberOfCells", "1", "1", OnceIntegers, "Facets."),
    row("/VTKHDF/Polygons/Offsets", "1", "facet + 1", OnceIntegers, "Where a facet begins in Connectivity."),
    row("/VTKHDF/Polygons/Connectivity", "1", "3*facet", OnceIntegers, "The three atoms of every facet, outward."),
    row("/VTKHDF/Strips/NumberOfConnectivityIds", "1", "1", OnceIntegers, "Unused."),
    row("/VTKHDF/Strips/NumberOfCells", "1", "1", OnceIntegers, "Unused."),
    row("/VTKHDF/Strips/Offsets", "1", "1", OnceIntegers, "Unused."),
    row("/VTKHDF/Strips/Connectivity", "1", "0", OnceIntegers, "Unused."),
    // Time.
    row("/time", "s", "frame", Link("/VTKHDF/Steps/Values"), "Simulated time of a frame."),
    row("/step", "1", "frame", Counter(1, |i| i.frame.step as i64), "Steps made up to a frame."),
    // Cells.
    row("/cells/type_names", "1", "type", OnceTexts, "Names of the cell types."),
    row("/cells/type", "1", "cell", OnceIntegers, "Type of a cell, an index into type_names."),
    row("/cells/first_atom", "1", "cell", OnceIntegers, "First atom of a cell."),
    row("/cells/atoms", "1", "cell", OnceIntegers, "Atoms of a cell."),
    row("/cells/first_facet", "1", "cell", OnceIntegers, "First facet of a cell."),
    row("/cells/facets", "1", "cell", OnceIntegers, "Facets of a cell."),
    row("/cells/position", "um", "frame, cell, 3", CellVector(|c| c.position, XYZ), "Centre of volume; mean of the atoms for an open surface."),
    row("/cells/velocity", "um/s", "frame, cell, 3", CellVector(|c| c.velocity, XYZ), "Mean velocity of the atoms over the last step."),
    row("/cells/volume", "um^3", "frame, cell", Cell(|c| c.volume), "Enclosed volume; 0 for an open surface."),
    row("/cells/volume_error", "1", "frame, cell", Cell(|c| c.volume_error), "(volume - target) / target."),
    row("/cells/area", "um^2", "frame, cell", Cell(|c| c.area), "Area of the surface."),
    row("/cells/energy", "pN um", "frame, cell", Cell(|c| c.energy), "Elastic energy."),
    row("/cells/size", "um", "frame, cell, 3", CellVector(|c| c.size, XYZ), "Extents of the box along the axes."),
    row("/cells/principal", "um", "frame, cell, 3", CellVector(|c| c.principal, LONGEST_FIRST), "Extents along the principal axes of the atoms, longest first."),
    row("/cells/smallest_facet", "1", "frame, cell", Cell(|c| c.smallest_facet), "Smallest area of a facet over its area at rest."),
    row("/cells/smallest_cosine", "1", "frame, cell", Cell(|c| c.smallest_cosine), "Smallest cosine between the normal of a facet and the direction from the centre; below 0 where a facet has folded over, 0 for an open surface."),
    row("/cells/contact_share", "1", "frame, cell", Cell(|c| c.contact_share), "Share of the atoms that are near another cell; 0 without contacts."),
    row("/cells/aggregate", "1", "frame, cell", Cell(|c| c.aggregate), "Aggregate of a cell: the number of the smallest cell of those that it touches, and that these touch; its own where it is alone."),
    // Rigid planes, for pictures.
    row("/planes/names", "1", "plane", OnceTexts, "Names of the rigid planes."),
    row("/planes/point", "um", "plane, 3", OnceFloats, "A point of a plane."),
    row("/planes/normal", "1", "plane, 3", OnceFloats, "Unit normal, towards the free side."),
    // What happened, and what the experiment as a whole records.
    row("/events/run_count", "1", "frame", Counter(1, |i| i.rows[List::Runs as usize] as i64), "Motility runs that ended up to a frame."),
    row("/events/runs/cell", "1", "run", RowInteger(List::Runs, |f, i| i64::from(f.runs[i].0)), "Cell whose motility run ended."),
    row("/events/runs/end_time", "s", "run", RowFloat(List::Runs, |f, i| f.runs[i].1), "When the motility run ended."),
    row("/events/runs/duration", "s", "run", RowFloat(List::Runs, |f, i| f.runs[i].2), "How long the motility run lasted."),
    row("/scene/<name>", "of the series", "frame", Filled::Scene, "A series of the scene as a whole."),
    row("/provenance/experiment", "1", "1", OnceTexts, "The experiment document, verbatim."),
    row("/provenance/equation_files", "1", "document", OnceTexts, "Documents of equations, as the experiment names them."),
    row("/provenance/equations", "1", "document", OnceTexts, "The texts of these documents, verbatim."),
    row("/provenance/sets", "1", "setting", OnceTexts, "Settings of the command line."),
    row("/provenance/flushing", "1", "scalar", Filled::Mark, "1 while the file is brought up to date: a run that was killed meanwhile, and its file mended when it is resumed."),
    row("/summary/<name>", "of the measure", "scalar", Filled::Measure, "A measure that the experiment declares."),
    row("/checkpoint", "1", "byte", Bytes, "The state at the end of the run, to resume from."),
];

/// The datasets of contacts, which exist in a run with contacts.
#[rustfmt::skip]
pub const CONTACT: &[Entry] = &[
    row("/contacts/pair_count", "1", "frame", Counter(1, |i| i.rows[List::Pairs as usize] as i64), "Rows of /contacts/pairs up to the end of a frame."),
    row("/contacts/pairs/first", "1", "pair", RowInteger(List::Pairs, |f, i| i64::from(f.pairs[i].cell)), "Of two cells that touch the one with the smaller number."),
    row("/contacts/pairs/second", "1", "pair", RowInteger(List::Pairs, |f, i| i64::from(f.pairs[i].other)), "The other."),
    row("/contacts/pairs/area", "um^2", "pair", RowFloat(List::Pairs, |f, i| f.pairs[i].area), "Area of contact: of the atoms of both sides that touch the other, at rest, half of it. 0 where only edges touch."),
    row("/contacts/plane_count", "1", "frame", Counter(1, |i| i.rows[List::OnPlanes as usize] as i64), "Rows of /contacts/planes up to the end of a frame."),
    row("/contacts/planes/cell", "1", "cell on plane", RowInteger(List::OnPlanes, |f, i| i64::from(f.on_planes[i].cell)), "A cell that touches a plane."),
    row("/contacts/planes/plane", "1", "cell on plane", RowInteger(List::OnPlanes, |f, i| i64::from(f.on_planes[i].other)), "The plane, an index into /planes/names."),
    row("/contacts/planes/area", "um^2", "cell on plane", RowFloat(List::OnPlanes, |f, i| f.on_planes[i].area), "Area of contact: of the atoms that touch the plane, at rest."),
];

/// The datasets of the forces, which exist when the first frame carries forces.
#[rustfmt::skip]
pub const FORCE: &[Entry] = &[
    row("/VTKHDF/PointData/force", "pN", "frame*atom, 3", Atoms(|f| &f.forces), "Elastic and applied force on the atoms."),
    row("/VTKHDF/Steps/PointDataOffsets/force", "1", "frame", Link("/VTKHDF/Steps/PointOffsets"), "First row of a frame in PointData/force."),
];

/// The row of a path.
///
/// # Panics
/// If the catalogue has no such row: a mistake in this module.
pub fn entry(path: &str) -> &'static Entry {
    let found = CATALOGUE.iter().chain(CONTACT).chain(FORCE).find(|entry| entry.path == path);
    found.unwrap_or_else(|| panic!("{path} is missing from the catalogue of the result file"))
}

/// Names of the per-cell series, vectors by their components (`position_x`), in the order of the catalogue, and
/// `speed`.
pub fn cell_series_names() -> Vec<String> {
    let mut names = Vec::new();
    for entry in CATALOGUE {
        let Some(name) = entry.path.strip_prefix("/cells/") else { continue };
        match &entry.filled {
            Cell(_) => names.push(name.to_string()),
            CellVector(_, endings) => names.extend(endings.iter().map(|ending| format!("{name}_{ending}"))),
            _ => {}
        }
    }
    names.push("speed".into());
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_path_is_listed_once_and_links_lead_somewhere() {
        let all: Vec<&Entry> = CATALOGUE.iter().chain(CONTACT).chain(FORCE).collect();
        for (number, entry) in all.iter().enumerate() {
            assert!(!all[..number].iter().any(|other| other.path == entry.path), "{} is listed twice", entry.path);
            if let Link(target) = entry.filled {
                assert!(all.iter().any(|other| other.path == target), "{} leads to {target}", entry.path);
            }
        }
    }

    #[test]
    fn vector_series_are_named_by_component() {
        let names = cell_series_names();
        for name in ["position_x", "size_z", "principal_1", "velocity_y", "volume", "speed"] {
            assert!(names.iter().any(|known| known == name), "{name} is missing from {names:?}");
        }
    }
}
