//! The result file: one HDF5 file per run that ParaView, PyVista and h5py open directly.
//!
//! [`catalogue`] lists what is in it. [`ResultWriter`] writes it frame by frame, [`ResultFile`] reads it, and
//! [`save_checkpoint`] keeps the state to resume from. Fields and systems of chemistry stand beside the cells. This
//! module is the only one that knows HDF5.

pub mod catalogue;
mod changes;
mod checkpoint;
mod column;
mod columns;
mod contacts;
mod container;
mod field_column;
mod field_export;
mod fields;
mod fields_reader;
mod header;
mod info;
mod instant;
mod layout_io;
mod mark;
mod mend;
mod packing;
mod reader;
mod room;
mod systems;
mod tables;
mod writer;

pub use changes::{Change, Event, changes};
pub use checkpoint::{Checkpoint, CheckpointMeta, checkpoint_path, load_checkpoint, save_checkpoint};
pub use contacts::{Alike, Touching, clusters, count_alike, segregation, touching_cells};
pub use field_export::{write_field_image, write_field_table};
pub use fields::{Along, FieldLayout, field_view_path};
pub use header::{Header, Measure};
pub use info::{describe, to_json};
pub use instant::{SeriesInfo, SeriesScope};
pub use reader::{Ending, ResultFile};
pub use systems::{SystemLayout, SystemScope};
pub use tables::{Table, table_text, write_table, write_text};
pub use writer::{Overwrite, ResultWriter};

/// What does not change during a run and says how the arrays of a frame are to be read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// Names of the cell types.
    pub types: Vec<String>,
    /// One entry per cell, in the order of all per-cell arrays.
    pub cells: Vec<CellLayout>,
    /// Facets of all cells with global atom numbers, cell after cell.
    pub facets: Vec<[u32; 3]>,
    /// Internal links of all cells (global atom numbers), drawn as lines.
    pub links: Vec<[u32; 2]>,
    /// Names of the scene series (one number per frame), e.g. `load.pull`, with their units.
    pub scene_series: Vec<(String, String)>,
    /// Rigid planes: name, a point (µm), the unit normal that points to the free side.
    pub planes: Vec<(String, [f64; 3], [f64; 3])>,
    /// The grids of fields.
    pub fields: Vec<FieldLayout>,
    /// The systems of chemistry inside cells, and those of the scene.
    pub systems: Vec<SystemLayout>,
    /// Whether the cells can touch, so that who touches whom is recorded.
    pub contacts: bool,
}

impl Layout {
    /// Number of atoms of all cells.
    pub fn atoms(&self) -> usize {
        self.cells.iter().map(|cell| (cell.first_atom + cell.atoms) as usize).max().unwrap_or(0)
    }
}

/// Where one cell's atoms and facets stand in the arrays of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct CellLayout {
    /// Index into [`Layout::types`].
    pub kind: u32,
    /// First atom (global number) and number of atoms.
    pub first_atom: u32,
    /// Number of atoms.
    pub atoms: u32,
    /// First facet in [`Layout::facets`].
    pub first_facet: u32,
    /// Number of facets.
    pub facets: u32,
}

/// What is recorded at one instant. All vectors of per-cell values have one entry per cell of the [`Layout`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Frame {
    /// Simulated time, s.
    pub time: f64,
    /// Number of steps made so far.
    pub step: u64,
    /// Positions of all atoms, µm, in the order of the layout.
    pub positions: Vec<[f64; 3]>,
    /// Elastic and applied force on every atom, pN.
    pub forces: Vec<[f64; 3]>,
    /// Per-cell values.
    pub cells: Vec<CellRecord>,
    /// One value per [`Layout::scene_series`].
    pub scene: Vec<f64>,
    /// Motility runs that ended since the frame before: (cell, end time s, duration s).
    pub runs: Vec<(u32, f64, f64)>,
    /// Pairs of cells that touch, the smaller number first, in ascending order.
    pub pairs: Vec<Touching>,
    /// Cells that touch planes, in ascending order of cell, then plane.
    pub on_planes: Vec<Touching>,
    /// Values of the fields: for each field of the layout, for each species, one value for each box, x fastest.
    pub fields: Vec<Vec<Vec<f64>>>,
    /// Values of the systems: for each system of the layout, for each quantity, one value for each of its cells (one
    /// in all for a system of the scene).
    pub systems: Vec<Vec<Vec<f64>>>,
}

/// What is recorded of one cell at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CellRecord {
    /// Centre of volume (mean of the atoms for an open surface), µm.
    pub position: [f64; 3],
    /// Mean velocity of the atoms over the last step, µm/s.
    pub velocity: [f64; 3],
    /// Enclosed volume, µm³ (0 for an open surface).
    pub volume: f64,
    /// (V − target)/target.
    pub volume_error: f64,
    /// Surface area, µm².
    pub area: f64,
    /// Elastic energy, pN·µm.
    pub energy: f64,
    /// Extents of the axis-aligned bounding box, µm.
    pub size: [f64; 3],
    /// Extents along the principal axes of the atoms, longest first, µm.
    pub principal: [f64; 3],
    /// Smallest area of a facet over its area at rest.
    pub smallest_facet: f64,
    /// Smallest cosine between the normal of a facet and the direction from the cell's centre; 0 for an open surface.
    pub smallest_cosine: f64,
    /// Share of the atoms that are near another cell; 0 without contacts.
    pub contact_share: f64,
    /// Number of the aggregate: of its smallest cell; the cell's own where it touches no other.
    pub aggregate: f64,
}
