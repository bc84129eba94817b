//! `pseudopod export`: a frame of a result as a mesh file.

use super::render::refuse_existing;
use crate::Vec3;
use crate::error::Result;
use crate::geometry::{Surface, export_surface};
use crate::output::ResultFile;
use std::path::PathBuf;

/// Writes the cells of a frame as OBJ, PLY or STL, µm.
#[derive(Debug, Clone, clap::Args)]
pub struct ExportArgs {
    /// The result file.
    pub result: PathBuf,
    /// The mesh file; its ending (.obj, .ply, .stl) says how it is written.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// The number of the frame, from 0; the last when absent.
    #[arg(long)]
    pub frame: Option<usize>,
    /// Replaces a file that is there.
    #[arg(long)]
    pub force: bool,
}

/// Runs the command.
///
/// # Errors
/// A result that cannot be read, a file that exists or cannot be written.
pub fn run(args: &ExportArgs) -> Result<()> {
    let result = ResultFile::open(&args.result)?;
    refuse_existing(&args.output, args.force)?;
    let last = result.frames().saturating_sub(1);
    let positions = result.positions(args.frame.unwrap_or(last).min(last))?.into_iter().map(Vec3::from).collect();
    export_surface(&Surface { positions, facets: result.layout().facets.clone() }, &args.output)
}
