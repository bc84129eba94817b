//! The options of `export`.

use crate::cli::frames::FrameArgs;
use crate::units::Length;
use std::path::PathBuf;

/// Writes the cells of a frame as OBJ, PLY, STL, VTU or PML, in um, or of all frames as PVD, a field as VTI, PVD, OME-TIFF or
/// CSV, or series, tracks and measures as CSV.
#[derive(Debug, Clone, clap::Args)]
pub struct ExportArgs {
    /// The result file.
    pub result: PathBuf,
    /// The file; its ending says what is written: .obj, .ply, .stl, .vtu, .pml a mesh, .pvd all frames of it, .vti, .ome.tiff a field, .csv
    /// a table. A folder for --table biotracks.
    #[arg(short, long, value_name = "FILE", required_unless_present_any = ["html", "pml", "lml"])]
    pub output: Option<PathBuf>,
    /// Writes a page with everything in it, to mail and to open in a browser from the disk.
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
    /// Quantities that cells can be coloured by in the page, by commas, besides that of the document and, where they take little, all of the cells.
    #[arg(long, value_delimiter = ',', value_name = "QUANTITY", requires = "html")]
    pub colours: Vec<String>,
    /// The most that the page may take, as in "20 MB", which is what it may when absent: frames are left out, evenly, where it takes more.
    #[arg(long, value_name = "SIZE", requires = "html")]
    pub size: Option<String>,
    /// Writes the cells of a frame as a physical model, in um: their atoms, neighbourhoods and facets.
    #[arg(long, value_name = "FILE")]
    pub pml: Option<PathBuf>,
    /// Writes the loads of the experiment and the atoms that are held, by the atoms of that model.
    #[arg(long, value_name = "FILE")]
    pub lml: Option<PathBuf>,
    /// Which frame a mesh or a field shows; the last when absent, all in an .ome.tiff.
    #[command(flatten)]
    pub frame: FrameArgs,
    /// Each so many frames only, from the first on, in a .pvd or .ome.tiff.
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..), conflicts_with_all = ["frame", "time"])]
    pub every: Option<u32>,
    /// One cell by its number, from 0, in a mesh; all when absent.
    #[arg(long, value_name = "NUMBER")]
    pub cell: Option<u64>,
    /// A field, FIELD.SPECIES for one of its species only; the first field in a .vti or .ome.tiff when absent.
    #[arg(long, value_name = "FIELD")]
    pub field: Option<String>,
    /// How far the upper face of the one body of a type has moved since the first frame, such as a gel under cells: a regular grid for programs of traction
    /// force microscopy, in um and with tractions in a .csv, in pixels in a .txt.
    #[arg(long, value_name = "TYPE", conflicts_with_all = ["table", "field"])]
    pub displacements: Option<String>,
    /// Between the points of that grid, as in "1 um"; a sixty-fourth of the face when absent.
    #[arg(long, value_name = "LENGTH", requires = "displacements")]
    pub spacing: Option<Length>,
    /// What a pixel of a .txt is, as in "0.1 um"; a sixteenth of the spacing when absent.
    #[arg(long, value_name = "LENGTH", requires = "displacements")]
    pub pixel: Option<Length>,
    /// What a table holds; series when absent.
    #[arg(long, value_enum)]
    pub table: Option<TableKind>,
    /// The series of a table, by commas; all when absent.
    #[arg(long, value_delimiter = ',', value_name = "SERIES")]
    pub series: Vec<String>,
    /// Replaces a file that is there.
    #[arg(long)]
    pub force: bool,
    /// Prints what was made as JSON.
    #[arg(long)]
    pub json: bool,
}

/// What a table holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum TableKind {
    /// A row per frame and cell with the series of the cells and the scene.
    Series,
    /// A row per cell and frame with the position of its centre, in the columns of TrackMate.
    Tracks,
    /// A folder with the tracks in the layout of biotracks (CMSO): dp.json, objects.csv, links.csv, tracks.csv.
    Biotracks,
    /// A row per motility run that ended.
    Runs,
    /// A row per pseudopod whose protrusion ended: how long it was pushed, where it pointed, and how far that was from the one before.
    Pseudopods,
    /// A row per measure of the experiment.
    Summary,
    /// A row per frame and pair of cells that touch, or cell that touches a plane, with the area.
    Contacts,
    /// A row per birth, merge, split and death of aggregates between frames.
    Aggregates,
}
