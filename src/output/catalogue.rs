//! Every dataset of the result file: where it stands, its unit and shape, what it means and where its numbers come
//! from. A new quantity is one row here, or, if it is one of cells, in [`recorded`](crate::recorded); writer, reader and
//! `info` follow.
//!
//! Shapes are in words: `frame` counts recorded instants, `type` the types of cells, `population` the lists of cells that
//! differ from the one of the frame before. `atom`, `facet` and `link` count the parts of all cells of a population, and
//! `cell` the cells of all frames, one frame after the other. All numbers here take eight bytes: floating point or
//! signed integers. Fields and systems of chemistry, which differ from run to run, are made by `fields` and `systems`.

use super::population::{OfShared, Part, Population, Shared};
use super::{Cell, Frame};
use crate::recorded::{OnDemand, Values, cell_quantities};

/// One motility run that ended: id of the cell, end (s), duration (s).
pub type Run = (u64, f64, f64);

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
    /// One integer per frame.
    Counter(fn(&Instant) -> i64),
    /// Four integers per frame: of vertices, lines, polygons and strips.
    Counters(fn(&Instant) -> [i64; 4]),
    /// A second name of another dataset.
    Link(&'static str),
    /// One integer per population.
    Population(fn(&Population) -> i64),
    /// A block of integers per population; each begins where a piece of the file does.
    Shared(Shared),
    /// One vector per atom and frame, one frame after the other; each begins where a piece of the file does.
    Atoms(fn(&Frame) -> &[[f64; 3]]),
    /// One integer per cell and frame.
    CellInteger(fn(&Cell) -> i64),
    /// What is recorded of each cell of a frame.
    Cell(Values),
    /// An integer per row of a list.
    RowInteger(List, fn(&Frame, usize) -> i64),
    /// A floating-point number per row of a list.
    RowFloat(List, fn(&Frame, usize) -> f64),
    /// One number per frame and name of the scene; `<name>` in the path.
    Scene,
    /// One number per measure, written when the run ends; `<name>` in the path.
    Measure,
    /// Bytes written when the run ends.
    Bytes,
}

/// What a counter is read from.
pub struct Instant<'a> {
    /// The frame being written.
    pub frame: &'a Frame,
    /// Rows of each list up to this frame, its own included.
    pub rows: [usize; List::ALL.len()],
    /// First row of the frame among the atoms of all frames.
    pub first_atom: usize,
    /// First row of the frame among the cells of all frames.
    pub first_cell: usize,
    /// Number of its population.
    pub population: usize,
    /// Where the blocks of its population begin.
    pub blocks: OfShared,
}

impl Instant<'_> {
    fn block(&self, shared: Shared) -> i64 {
        self.blocks[shared as usize] as i64
    }

    /// Where VTK is to look for the offsets of a population: it goes one further for every population before.
    fn offsets(&self, shared: Shared) -> i64 {
        self.block(shared) - self.population as i64
    }
}

/// What has any number of rows in a frame. All frames stand one after the other; a counter says where each ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum List {
    /// Motility runs that ended.
    Runs,
    /// Pseudopods whose protrusion ended.
    Pseudopods,
    /// Pairs of cells that touch.
    Pairs,
    /// Cells that touch a plane.
    OnPlanes,
    /// Fibres that were made at run time and are there.
    Fibres,
    /// Pairs of cells that dynamic links join.
    Links,
}

impl List {
    /// All lists, each at its number.
    pub const ALL: [Self; 6] = [Self::Runs, Self::Pseudopods, Self::Pairs, Self::OnPlanes, Self::Fibres, Self::Links];

    /// Rows of a frame.
    pub fn rows(self, frame: &Frame) -> usize {
        match self {
            Self::Runs => frame.runs.len(),
            Self::Pseudopods => frame.pseudopods.len(),
            Self::Pairs => frame.pairs.len(),
            Self::OnPlanes => frame.on_planes.len(),
            Self::Fibres => frame.fibres.len(),
            Self::Links => frame.links.len(),
        }
    }

    /// The dataset that counts its rows up to each frame.
    pub fn counter(self) -> &'static str {
        match self {
            Self::Runs => "/events/run_count",
            Self::Pseudopods => "/events/pseudopod_count",
            Self::Pairs => "/contacts/pair_count",
            Self::OnPlanes => "/contacts/plane_count",
            Self::Fibres => "/fibres/count",
            Self::Links => "/links/pair_count",
        }
    }

    /// A dataset with its rows.
    pub fn column(self) -> &'static str {
        match self {
            Self::Runs => "/events/runs/cell",
            Self::Pseudopods => "/events/pseudopods/cell",
            Self::Pairs => "/contacts/pairs/area",
            Self::OnPlanes => "/contacts/planes/area",
            Self::Fibres => "/fibres/tension",
            Self::Links => "/links/number",
        }
    }
}

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
    Atoms, Bytes, CellInteger, Counter, Counters, Frame as PerFrame, Link, OnceFloats, OnceIntegers, OnceTexts,
    Population as PerPopulation, RowFloat, RowInteger, Shared as Block,
};

/// All datasets, in the order in which they are made, except those of [`cell_entries`], [`CONTACT`], [`FORCE`], [`TRACTION`], [`FIBRE`] and [`LINK`].
#[rustfmt::skip]
pub const CATALOGUE: &[Entry] = &[
    // The animated surface, in the layout that VTK calls VTKHDF PolyData 2.0.
    row("/VTKHDF/NumberOfPoints", "1", "population", PerPopulation(|p| p.count(Part::Atoms) as i64), "Atoms of all cells."),
    row("/VTKHDF/Points", "um", "atom of all frames, 3", Atoms(|f| &f.positions), "Positions of the atoms, one frame after the other, cell after cell; NaN between frames."),
    row("/VTKHDF/PointData/cell", "1", "atom", Block(Shared::PointCell), "Id of the cell that an atom belongs to."),
    row("/VTKHDF/PointData/type", "1", "atom", Block(Shared::PointType), "Type of the cell that an atom belongs to, an index into /cells/type_names."),
    row("/VTKHDF/CellData/cell", "1", "link + facet", Block(Shared::DrawnCell), "Id of the cell that a link or a facet belongs to."),
    row("/VTKHDF/CellData/type", "1", "link + facet", Block(Shared::DrawnType), "Type of the cell that a link or a facet belongs to."),
    row("/VTKHDF/Steps/Values", "s", "frame", PerFrame(|f| f.time), "Simulated time of a frame."),
    row("/VTKHDF/Steps/NumberOfParts", "1", "frame", Counter(|_| 1), "Pieces of the surface (VTKHDF); always one."),
    row("/VTKHDF/Steps/PartOffsets", "1", "frame", Counter(|i| i.population as i64), "Population of a frame (VTKHDF): frames with the same cells have the same."),
    row("/VTKHDF/Steps/PointOffsets", "1", "frame", Counter(|i| i.first_atom as i64), "First row of a frame in /VTKHDF/Points."),
    row("/VTKHDF/Steps/CellOffsets", "1", "frame, 4", Counters(|i| [0, i.offsets(Shared::LinkOffsets), i.offsets(Shared::FacetOffsets), 0]), "First vertex, line, polygon and strip of a frame (VTKHDF): its Offsets begin as many rows later as PartOffsets says."),
    row("/VTKHDF/Steps/ConnectivityIdOffsets", "1", "frame, 4", Counters(|i| [0, i.block(Shared::LinkAtoms), i.block(Shared::FacetAtoms), 0]), "First row of a frame in the connectivity of vertices, lines, polygons and strips."),
    row("/VTKHDF/Steps/PointDataOffsets/cell", "1", "frame", Counter(|i| i.block(Shared::PointCell)), "First row of a frame in PointData/cell."),
    row("/VTKHDF/Steps/PointDataOffsets/type", "1", "frame", Link("/VTKHDF/Steps/PointDataOffsets/cell"), "First row of a frame in PointData/type."),
    row("/VTKHDF/Steps/CellDataOffsets/cell", "1", "frame", Counter(|i| i.block(Shared::DrawnCell)), "First row of a frame in CellData/cell."),
    row("/VTKHDF/Steps/CellDataOffsets/type", "1", "frame", Link("/VTKHDF/Steps/CellDataOffsets/cell"), "First row of a frame in CellData/type."),
    // Topology, once for each kind that VTK knows; only lines and polygons are used.
    row("/VTKHDF/Vertices/NumberOfConnectivityIds", "1", "population", PerPopulation(|_| 0), "Unused."),
    row("/VTKHDF/Vertices/NumberOfCells", "1", "population", Link("/VTKHDF/Vertices/NumberOfConnectivityIds"), "Unused."),
    row("/VTKHDF/Vertices/Offsets", "1", "population", Link("/VTKHDF/Vertices/NumberOfConnectivityIds"), "Unused."),
    row("/VTKHDF/Vertices/Connectivity", "1", "0", OnceIntegers, "Unused."),
    row("/VTKHDF/Lines/NumberOfConnectivityIds", "1", "population", PerPopulation(|p| 2 * p.count(Part::Links) as i64), "Twice the number of internal links."),
    row("/VTKHDF/Lines/NumberOfCells", "1", "population", PerPopulation(|p| p.count(Part::Links) as i64), "Internal links."),
    row("/VTKHDF/Lines/Offsets", "1", "link + 1", Block(Shared::LinkOffsets), "Where a link begins in Connectivity."),
    row("/VTKHDF/Lines/Connectivity", "1", "2*link", Block(Shared::LinkAtoms), "The two atoms of every internal link."),
    row("/VTKHDF/Polygons/NumberOfConnectivityIds", "1", "population", PerPopulation(|p| 3 * p.count(Part::Facets) as i64), "Three times the number of facets."),
    row("/VTKHDF/Polygons/NumberOfCells", "1", "population", PerPopulation(|p| p.count(Part::Facets) as i64), "Facets."),
    row("/VTKHDF/Polygons/Offsets", "1", "facet + 1", Block(Shared::FacetOffsets), "Where a facet begins in Connectivity."),
    row("/VTKHDF/Polygons/Connectivity", "1", "3*facet", Block(Shared::FacetAtoms), "The three atoms of every facet, outward."),
    row("/VTKHDF/Strips/NumberOfConnectivityIds", "1", "population", Link("/VTKHDF/Vertices/NumberOfConnectivityIds"), "Unused."),
    row("/VTKHDF/Strips/NumberOfCells", "1", "population", Link("/VTKHDF/Vertices/NumberOfConnectivityIds"), "Unused."),
    row("/VTKHDF/Strips/Offsets", "1", "population", Link("/VTKHDF/Vertices/NumberOfConnectivityIds"), "Unused."),
    row("/VTKHDF/Strips/Connectivity", "1", "0", OnceIntegers, "Unused."),
    // Time.
    row("/time", "s", "frame", Link("/VTKHDF/Steps/Values"), "Simulated time of a frame."),
    row("/step", "1", "frame", Counter(|i| i.frame.step as i64), "Steps made up to a frame, the one included within which it lies."),
    row("/interpolated", "1", "frame", Counter(|i| i64::from(i.frame.interpolated)), "1 where a frame lies within a step, between the states at its ends; 0 where a step ended there."),
    // Types of cells, and the cells of every frame.
    row("/cells/type_names", "1", "type", OnceTexts, "Names of the cell types."),
    row("/types/atoms", "1", "type", OnceIntegers, "Atoms of a cell of a type."),
    row("/types/facets", "1", "type", OnceIntegers, "Facets of a cell of a type."),
    row("/types/facet_atoms", "1", "3*facet of all types", OnceIntegers, "The three atoms of every facet of a cell, by their numbers in it, type after type."),
    row("/types/links", "1", "type", OnceIntegers, "Internal links of a cell of a type."),
    row("/types/link_atoms", "1", "2*link of all types", OnceIntegers, "The two atoms of every link of a cell, by their numbers in it, type after type."),
    row("/cells/count", "1", "frame", Counter(|i| i.frame.cells.len() as i64), "Cells of a frame."),
    row("/cells/first", "1", "frame", Counter(|i| i.first_cell as i64), "First row of a frame in the other datasets of cells; it has as many rows as count says."),
    row("/cells/id", "1", "cell", CellInteger(|c| c.id.cast_signed()), "Id of a cell: no other cell of the run ever has it. -1 between frames."),
    row("/cells/type", "1", "cell", CellInteger(|c| i64::from(c.kind)), "Type of a cell, an index into type_names."),
    row("/cells/parent", "1", "cell", CellInteger(|c| c.parent.map_or(-1, u64::cast_signed)), "Id of the cell that a cell was born from; -1 for none."),
    // Rigid planes and tools, for pictures.
    row("/planes/names", "1", "plane", OnceTexts, "Names of the rigid planes and, after them, of the tools."),
    row("/planes/point", "um", "plane, 3", OnceFloats, "A point of a plane; the point of the axis of a tool from which heights are told, where it begins."),
    row("/planes/normal", "1", "plane, 3", OnceFloats, "Unit normal of a plane, towards the free side, or direction of the axis of a tool."),
    row("/planes/direction", "1", "plane, 3", OnceFloats, "Unit direction in which a tool goes, along which tool_displacement.NAME is; 0 of what stands."),
    row("/planes/profile", "um", "point of all tools, 3", OnceFloats, "Profiles of tools, which turn about their axes: distance from the axis, height, and the tool, an index into /planes/names."),
    // What happened, and what the experiment as a whole records.
    row("/events/run_count", "1", "frame", Counter(|i| i.rows[List::Runs as usize] as i64), "Motility runs that ended up to a frame."),
    row("/events/runs/cell", "1", "run", RowInteger(List::Runs, |f, i| f.runs[i].0.cast_signed()), "Id of the cell whose motility run ended."),
    row("/events/runs/end_time", "s", "run", RowFloat(List::Runs, |f, i| f.runs[i].1), "When the motility run ended."),
    row("/events/runs/duration", "s", "run", RowFloat(List::Runs, |f, i| f.runs[i].2), "How long the motility run lasted."),
    row("/events/pseudopod_count", "1", "frame", Counter(|i| i.rows[List::Pseudopods as usize] as i64), "Pseudopods whose protrusion ended up to a frame."),
    row("/events/pseudopods/cell", "1", "pseudopod", RowInteger(List::Pseudopods, |f, i| f.pseudopods[i].cell.cast_signed()), "Id of the cell whose pseudopod's protrusion ended."),
    row("/events/pseudopods/end_time", "s", "pseudopod", RowFloat(List::Pseudopods, |f, i| f.pseudopods[i].end), "When the protrusion ended."),
    row("/events/pseudopods/lifetime", "s", "pseudopod", RowFloat(List::Pseudopods, |f, i| f.pseudopods[i].lifetime), "How long it lasted."),
    row("/events/pseudopods/direction_x", "1", "pseudopod", RowFloat(List::Pseudopods, |f, i| f.pseudopods[i].direction[0]), "Where the pseudopod pointed: x of a unit vector."),
    row("/events/pseudopods/direction_y", "1", "pseudopod", RowFloat(List::Pseudopods, |f, i| f.pseudopods[i].direction[1]), "y of it."),
    row("/events/pseudopods/direction_z", "1", "pseudopod", RowFloat(List::Pseudopods, |f, i| f.pseudopods[i].direction[2]), "z of it."),
    row("/events/pseudopods/turn", "deg", "pseudopod", RowFloat(List::Pseudopods, |f, i| f.pseudopods[i].turn), "Angle from the pseudopod before; NaN of the first of a cell."),
    row("/events/pseudopods/side", "1", "pseudopod", RowInteger(List::Pseudopods, |f, i| i64::from(f.pseudopods[i].side)), "Side to which it split off from the one before: 1 left, -1 right; 0 where it started anew."),
    row("/events/pseudopods/alone", "1", "pseudopod", RowInteger(List::Pseudopods, |f, i| i64::from(f.pseudopods[i].alone)), "1 where the cell had no other pseudopod when it began, 0 where it had."),
    row("/events/pseudopods/abandoned", "1", "pseudopod", RowInteger(List::Pseudopods, |f, i| i64::from(f.pseudopods[i].abandoned)), "1 where it was given up when its protrusion ended, 0 where it was kept."),
    row("/scene/<name>", "of the series", "frame", Filled::Scene, "A series of the scene as a whole."),
    row("/provenance/experiment", "1", "1", OnceTexts, "The experiment document, verbatim."),
    row("/provenance/equation_files", "1", "document", OnceTexts, "Documents of equations, as the experiment names them, and the documents and tables that these name."),
    row("/provenance/equations", "1", "document", OnceTexts, "The texts of these documents, verbatim."),
    row("/provenance/sets", "1", "setting", OnceTexts, "Settings of the command line."),
    row("/summary/<name>", "of the measure", "scalar", Filled::Measure, "A measure that the experiment declares."),
    row("/checkpoint", "1", "byte", Bytes, "The state at the end of the run, to resume from."),
];

/// The datasets of contacts, which exist in a run with contacts.
#[rustfmt::skip]
pub const CONTACT: &[Entry] = &[
    row("/contacts/pair_count", "1", "frame", Counter(|i| i.rows[List::Pairs as usize] as i64), "Rows of /contacts/pairs up to the end of a frame."),
    row("/contacts/pairs/first", "1", "pair", RowInteger(List::Pairs, |f, i| f.pairs[i].cell.cast_signed()), "Of two cells that touch the smaller id."),
    row("/contacts/pairs/second", "1", "pair", RowInteger(List::Pairs, |f, i| f.pairs[i].other.cast_signed()), "The other."),
    row("/contacts/pairs/area", "um^2", "pair", RowFloat(List::Pairs, |f, i| f.pairs[i].area), "Area of contact: of the atoms of both sides that touch the other, at rest, half of it. 0 where only edges touch."),
    row("/contacts/plane_count", "1", "frame", Counter(|i| i.rows[List::OnPlanes as usize] as i64), "Rows of /contacts/planes up to the end of a frame."),
    row("/contacts/planes/cell", "1", "cell on plane", RowInteger(List::OnPlanes, |f, i| f.on_planes[i].cell.cast_signed()), "Id of a cell that touches a plane."),
    row("/contacts/planes/plane", "1", "cell on plane", RowInteger(List::OnPlanes, |f, i| f.on_planes[i].other.cast_signed()), "The plane, an index into /planes/names."),
    row("/contacts/planes/area", "um^2", "cell on plane", RowFloat(List::OnPlanes, |f, i| f.on_planes[i].area), "Area of contact: of the atoms that touch the plane, at rest."),
];

/// The datasets of fibres, which exist in a run in which some may be made.
#[rustfmt::skip]
pub const FIBRE: &[Entry] = &[
    row("/fibres/count", "1", "frame", Counter(|i| i.rows[List::Fibres as usize] as i64), "Rows of the other datasets of fibres up to the end of a frame."),
    row("/fibres/cell", "1", "fibre", RowInteger(List::Fibres, |f, i| f.fibres[i].cell.cast_signed()), "Id of the cell that a fibre belongs to."),
    row("/fibres/number", "1", "fibre", RowInteger(List::Fibres, |f, i| f.fibres[i].number.cast_signed()), "Number of the fibre among those that its cell has made: the same in all frames, and no other's."),
    row("/fibres/from", "1", "fibre", RowInteger(List::Fibres, |f, i| i64::from(f.fibres[i].atoms[0])), "Atom at its first end, by its number in the cell; of a pseudopod's fibre the one in front."),
    row("/fibres/to", "1", "fibre", RowInteger(List::Fibres, |f, i| i64::from(f.fibres[i].atoms[1])), "Atom at its other end."),
    row("/fibres/length", "um", "fibre", RowFloat(List::Fibres, |f, i| f.fibres[i].length), "Distance of these atoms."),
    row("/fibres/tension", "pN", "fibre", RowFloat(List::Fibres, |f, i| f.fibres[i].tension), "What the fibre pulls with: stiffness times activation in the last step times length."),
];

/// The datasets of dynamic links, which exist in a run whose contacts make some.
#[rustfmt::skip]
pub const LINK: &[Entry] = &[
    row("/links/pair_count", "1", "frame", Counter(|i| i.rows[List::Links as usize] as i64), "Rows of the other datasets of links up to the end of a frame."),
    row("/links/first", "1", "linked pair", RowInteger(List::Links, |f, i| f.links[i].cell.cast_signed()), "Of two cells that are linked the smaller id."),
    row("/links/second", "1", "linked pair", RowInteger(List::Links, |f, i| f.links[i].other.cast_signed()), "The other."),
    row("/links/number", "1", "linked pair", RowInteger(List::Links, |f, i| i64::from(f.links[i].number)), "Links between facets of the two, each of three springs."),
];

/// The datasets of the forces, which exist when the first frame carries forces.
#[rustfmt::skip]
pub const FORCE: &[Entry] = &[
    row("/VTKHDF/PointData/force", "pN", "atom of all frames, 3", Atoms(|f| &f.forces), "Elastic and applied force on the atoms."),
    row("/VTKHDF/Steps/PointDataOffsets/force", "1", "frame", Link("/VTKHDF/Steps/PointOffsets"), "First row of a frame in PointData/force."),
];

/// What results of earlier versions lack, which did not tell what holds atoms: it is nothing there.
pub const CAME_LATER: [&str; 2] = ["/cells/holding_force", "/VTKHDF/PointData/holding_force"];

/// The datasets of what atoms do to what is around them, which exist in a run that records tractions.
#[rustfmt::skip]
pub const TRACTION: &[Entry] = &[
    row("/VTKHDF/PointData/traction", "pN", "atom of all frames, 3", Atoms(|f| &f.tractions.traction), "Force of the atoms on planes, in the mean over the last step."),
    row("/VTKHDF/PointData/traction_of_cells", "pN", "atom of all frames, 3", Atoms(|f| &f.tractions.of_cells), "Force of the atoms on other cells."),
    row("/VTKHDF/PointData/drag", "pN", "atom of all frames, 3", Atoms(|f| &f.tractions.drag), "Drag of the medium on the atoms."),
    row("/VTKHDF/PointData/outer_force", "pN", "atom of all frames, 3", Atoms(|f| &f.tractions.outer), "Loads, gravity, attraction and what drives a walk, on the atoms."),
    row("/VTKHDF/PointData/inertia", "pN", "atom of all frames, 3", Atoms(|f| &f.tractions.inertia), "Mass times acceleration of the atoms; 0 in over-damped runs."),
    row("/VTKHDF/PointData/holding_force", "pN", "atom of all frames, 3", Atoms(|f| &f.tractions.held), "What holds the atoms that are fixed, or moves those that go on a course."),
    row("/VTKHDF/Steps/PointDataOffsets/traction", "1", "frame", Link("/VTKHDF/Steps/PointOffsets"), "First row of a frame in PointData/traction."),
    row("/VTKHDF/Steps/PointDataOffsets/traction_of_cells", "1", "frame", Link("/VTKHDF/Steps/PointOffsets"), "First row of a frame in PointData/traction_of_cells."),
    row("/VTKHDF/Steps/PointDataOffsets/drag", "1", "frame", Link("/VTKHDF/Steps/PointOffsets"), "First row of a frame in PointData/drag."),
    row("/VTKHDF/Steps/PointDataOffsets/outer_force", "1", "frame", Link("/VTKHDF/Steps/PointOffsets"), "First row of a frame in PointData/outer_force."),
    row("/VTKHDF/Steps/PointDataOffsets/inertia", "1", "frame", Link("/VTKHDF/Steps/PointOffsets"), "First row of a frame in PointData/inertia."),
    row("/VTKHDF/Steps/PointDataOffsets/holding_force", "1", "frame", Link("/VTKHDF/Steps/PointOffsets"), "First row of a frame in PointData/holding_force."),
];

/// The datasets of the quantities of cells in a run that records these.
pub fn cell_entries(with: OnDemand) -> impl Iterator<Item = Entry> {
    cell_quantities(with).map(|quantity| {
        let shape = if matches!(quantity.values, Values::Vector(..)) { "cell, 3" } else { "cell" };
        row(quantity.dataset, quantity.unit, shape, Filled::Cell(quantity.values), quantity.description)
    })
}

/// The row of a path.
///
/// # Panics
/// If the catalogue has no such row: a mistake in this module.
pub fn entry(path: &str) -> &'static Entry {
    let found = CATALOGUE
        .iter()
        .chain(CONTACT)
        .chain(FORCE)
        .chain(TRACTION)
        .chain(FIBRE)
        .chain(LINK)
        .find(|entry| entry.path == path);
    found.unwrap_or_else(|| panic!("{path} is missing from the catalogue of the result file"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_path_is_listed_once_and_links_lead_somewhere() {
        let cells: Vec<Entry> = cell_entries(OnDemand::ALL).collect();
        let all: Vec<&Entry> = CATALOGUE
            .iter()
            .chain(&cells)
            .chain(CONTACT)
            .chain(FORCE)
            .chain(TRACTION)
            .chain(FIBRE)
            .chain(LINK)
            .collect();
        for (number, entry) in all.iter().enumerate() {
            assert!(!all[..number].iter().any(|other| other.path == entry.path), "{} is listed twice", entry.path);
            if let Link(target) = entry.filled {
                assert!(all.iter().any(|other| other.path == target), "{} leads to {target}", entry.path);
            }
        }
    }
}
