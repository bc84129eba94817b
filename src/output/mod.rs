//! The result file: one HDF5 file per run that ParaView, PyVista and h5py open directly.
//!
//! [`catalogue`] lists what is in it. [`ResultWriter`] writes it: frames go into a log beside it, from which they are taken
//! into the next version of the file, which takes the place of the one before as a whole. [`ResultFile`] reads it, and
//! [`save_checkpoint`] keeps the state to resume from. Fields and systems of chemistry stand beside the cells. This
//! module is the only one that knows HDF5.

pub mod biotracks;
pub mod catalogue;
mod cell_column;
mod cells;
mod cells_reader;
mod census;
mod changes;
mod checkpoint;
mod claim;
mod column;
mod columns;
mod contacts;
mod contacts_reader;
mod container;
#[cfg(test)]
#[path = "../../tests/result_file/example.rs"]
#[allow(dead_code)]
mod example;
mod field_column;
mod field_export;
mod field_layout;
mod fields;
mod fields_reader;
mod fits;
mod frame_log;
mod frame_series;
mod header;
mod info;
mod instant;
mod layout_io;
mod membranes;
mod mesh_export;
mod ome_tiff;
mod packing;
mod pieces;
mod population;
mod reader;
mod renewal;
mod reopening;
mod replacement;
mod systems;
mod tables;
mod texts;
mod versions;
mod vetting;
mod vtk_xml;
mod whole;
mod writer;

use serde::{Deserialize, Serialize};

pub use crate::recorded::{CellRecord, OnDemand};
pub use cells::{Cell, CellType, Known};
pub use changes::{Change, Event, changes};
pub use checkpoint::{Checkpoint, CheckpointMeta, checkpoint_path, load_checkpoint, save_checkpoint};
pub use claim::Overwrite;
pub use contacts::{Alike, Touching, clusters, count_alike, segregation, touching_cells};
pub use field_export::{write_field_image, write_field_table};
pub use field_layout::{Along, FieldLayout};
pub use fields::field_view_path;
pub use frame_log::frames_path;
pub use frame_series::{series_file, series_folder, write_field_series, write_mesh_series};
pub use header::{Header, Measure};
pub use info::{describe, to_json};
pub use instant::{SeriesInfo, SeriesScope};
pub use membranes::MembraneLayout;
pub use mesh_export::write_mesh;
pub use ome_tiff::write_field_tiff;
pub use population::{Part, Population, Shared};
pub use reader::{Ending, ResultFile};
pub use reopening::Kept;
pub use systems::{SystemLayout, SystemScope};
pub use tables::{Table, table_text, write_table, write_text};
pub use writer::ResultWriter;

/// What does not change during a run and says how the arrays of a frame are to be read.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Layout {
    /// The types of cells; a frame says which cells there are.
    pub types: Vec<CellType>,
    /// Names of the scene series (one number per frame), e.g. `load.pull`, with their units.
    pub scene_series: Vec<(String, String)>,
    /// What cells cannot pass: planes, then tools.
    pub obstacles: Vec<Obstacle>,
    /// The grids of fields.
    pub fields: Vec<FieldLayout>,
    /// The systems of chemistry inside cells, and those of the scene.
    pub systems: Vec<SystemLayout>,
    /// Substances on the membranes of cells.
    pub membranes: Vec<MembraneLayout>,
    /// Whether the cells can touch, so that who touches whom is recorded.
    pub contacts: bool,
    /// Whether what cells do to what is around them is recorded.
    pub tractions: bool,
    /// Whether fibres may be made at run time, so that those that are there are recorded.
    pub fibres: bool,
    /// Whether dynamic links may join cells, so that those that they join are recorded.
    pub linked: bool,
    /// Whether some cells are viscous, so that what that takes is recorded.
    pub viscosity: bool,
}

impl Layout {
    /// What is recorded of cells that not all runs have.
    pub fn on_demand(&self) -> OnDemand {
        OnDemand { tractions: self.tractions, fibres: self.fibres, viscosity: self.viscosity }
    }
}

/// A rigid plane or tool.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Obstacle {
    /// Its name.
    pub name: String,
    /// A point of the plane, µm; of a tool that of its axis from which heights are told, where it begins.
    pub point: [f64; 3],
    /// The unit normal of the plane, which points to the free side, or the direction of the axis of the tool.
    pub normal: [f64; 3],
    /// The unit direction in which the tool goes, along which the series `tool_displacement.NAME` is; 0 of what stands.
    pub direction: [f64; 3],
    /// The profile that makes the tool as it is turned about its axis, each point a distance from the axis and a height, µm; none of a plane.
    pub profile: Vec<[f64; 2]>,
}

/// Forces between atoms and what is around them, in the mean over the last step, pN, atom after atom.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Tractions {
    /// On planes.
    pub traction: Vec<[f64; 3]>,
    /// On other cells.
    pub of_cells: Vec<[f64; 3]>,
    /// Drag of the medium, on the atom.
    pub drag: Vec<[f64; 3]>,
    /// Loads, gravity, attraction and what drives a walk, on the atom.
    pub outer: Vec<[f64; 3]>,
    /// Mass times acceleration; 0 in over-damped runs.
    pub inertia: Vec<[f64; 3]>,
    /// What holds or moves atoms that are fixed or go on a course, on the atom.
    pub held: Vec<[f64; 3]>,
}

/// A fibre of a cell that was made at run time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FibreRow {
    /// Id of the cell.
    pub cell: u64,
    /// Its number among those that the cell has made.
    pub number: u64,
    /// The atoms at its ends, by their numbers in the cell.
    pub atoms: [u32; 2],
    /// Their distance, µm.
    pub length: f64,
    /// What it pulls with, pN.
    pub tension: f64,
}

/// Two cells that dynamic links join.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct LinkedPair {
    /// Id of a cell; of the two the smaller one.
    pub cell: u64,
    /// Id of the other.
    pub other: u64,
    /// Links between facets of the two.
    pub number: u32,
}

/// A pseudopod whose protrusion ended.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PseudopodEvent {
    /// Id of the cell.
    pub cell: u64,
    /// When it ended, s.
    pub end: f64,
    /// How long it was pushed, s.
    pub lifetime: f64,
    /// Unit vector to which it pointed.
    pub direction: [f64; 3],
    /// Angle from the one before, degrees; NaN of the first of a cell.
    pub turn: f64,
    /// The side to which it split off from the one before: 1 left, -1 right, 0 where it started anew.
    pub side: i8,
    /// Whether there was no other when it began.
    pub alone: bool,
    /// Whether it was given up then.
    pub abandoned: bool,
}

/// What is recorded at one instant. Its arrays follow its own list of cells, which may differ from frame to frame.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Frame {
    /// Simulated time, s.
    pub time: f64,
    /// Number of steps made so far, the one included within which the instant lies.
    pub step: u64,
    /// Whether the instant lies within that step, and the frame between the states at its ends.
    pub interpolated: bool,
    /// The cells that there are, each id once.
    pub cells: Vec<Cell>,
    /// Positions of all atoms, µm, cell after cell.
    pub positions: Vec<[f64; 3]>,
    /// Densities of the substances of the layout, one number for each atom, NaN on cells without the system.
    pub membranes: Vec<Vec<f64>>,
    /// Elastic and applied force on every atom, pN.
    pub forces: Vec<[f64; 3]>,
    /// What atoms do to what is around them; empty in a run that does not record it.
    pub tractions: Tractions,
    /// What is recorded of each cell.
    pub records: Vec<CellRecord>,
    /// One value per [`Layout::scene_series`].
    pub scene: Vec<f64>,
    /// Motility runs that ended since the frame before: (id of the cell, end time s, duration s).
    pub runs: Vec<(u64, f64, f64)>,
    /// Pseudopods whose protrusion ended since the frame before.
    pub pseudopods: Vec<PseudopodEvent>,
    /// Fibres that were made at run time and are there, cell after cell.
    pub fibres: Vec<FibreRow>,
    /// Pairs of cells that dynamic links join, the smaller id first, in ascending order.
    pub links: Vec<LinkedPair>,
    /// Pairs of cells that touch, the smaller id first, in ascending order.
    pub pairs: Vec<Touching>,
    /// Cells that touch planes, in ascending order of cell, then plane.
    pub on_planes: Vec<Touching>,
    /// Values of the fields: for each field of the layout, for each species, one value for each box, x fastest.
    pub fields: Vec<Vec<Vec<f64>>>,
    /// Values of the systems: for each system of the layout, for each quantity, one value for each cell, NaN for cells
    /// without the system; one in all for a system of the scene.
    pub systems: Vec<Vec<Vec<f64>>>,
}
