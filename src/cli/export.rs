//! `pseudopod export`: a frame of a result as a mesh, or its numbers as a table.

use super::frames::FrameArgs;
use super::render::{Named, refuse_existing};
use super::report::Report;
use crate::Vec3;
use crate::error::{Error, Fault, Result};
use crate::experiment::When;
use crate::geometry::{Surface, export_surface};
use crate::output::{ResultFile, Table, write_table};
use std::path::PathBuf;

/// Writes the cells of a frame as OBJ, PLY or STL, in um, or series, tracks and measures as CSV.
#[derive(Debug, Clone, clap::Args)]
pub struct ExportArgs {
    /// The result file.
    pub result: PathBuf,
    /// The file; its ending says what is written: .obj, .ply, .stl a mesh, .csv a table.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Which frame a mesh shows; the last when absent.
    #[command(flatten)]
    pub frame: FrameArgs,
    /// One cell by its number, from 0, in a mesh; all when absent.
    #[arg(long, value_name = "NUMBER")]
    pub cell: Option<usize>,
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
    /// A row per frame and cell with the position of its centre.
    Tracks,
    /// A row per motility run that ended.
    Runs,
    /// A row per measure of the experiment.
    Summary,
}

/// Runs the command.
///
/// # Errors
/// A result, frame, cell or series that is not there; a file that exists, has an unknown ending or cannot be written.
pub fn run(args: &ExportArgs) -> Result<Report> {
    let ending = args.output.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    let as_table = match ending.as_deref() {
        Some("csv") => true,
        Some("obj" | "ply" | "stl") => false,
        _ => {
            let fault = Fault::new(format!("cannot tell from its name what to write to {}", args.output.display()));
            return Err(Error::input(
                fault.help("let the name end in .obj, .ply or .stl for a mesh, .csv for a table"),
            ));
        }
    };
    refuse_unused(args, as_table)?;
    let result = ResultFile::open(&args.result)?;
    refuse_existing(&args.output, args.force, Named::ByUser)?;
    if as_table {
        write_table(&result, &table_of(args), &args.output)?;
    } else {
        let frame = args.frame.of(&result, When::Last)?;
        export_surface(&surface_of(&result, frame, args.cell)?, &args.output)?;
    }
    Ok(Report::of_files(&args.result, std::slice::from_ref(&args.output)))
}

/// Options that say nothing about what is written are a mistake that the user wants to know of.
fn refuse_unused(args: &ExportArgs, as_table: bool) -> Result<()> {
    let unused = match as_table {
        true if args.frame.frame.is_some() => "--frame",
        true if args.frame.time.is_some() => "--time",
        true if args.cell.is_some() => "--cell",
        false if args.table.is_some() => "--table",
        false if !args.series.is_empty() => "--series",
        true if !args.series.is_empty() && args.table.is_some_and(|kind| kind != TableKind::Series) => "--series",
        _ => return Ok(()),
    };
    let fault = Fault::new(format!("{unused} has no meaning for {}", args.output.display()))
        .help("--frame, --time and --cell belong to a mesh (.obj, .ply, .stl), --table and --series to a table (.csv)");
    Err(Error::input(fault))
}

fn table_of(args: &ExportArgs) -> Table {
    match args.table.unwrap_or(TableKind::Series) {
        TableKind::Series => Table::Series(args.series.clone()),
        TableKind::Tracks => Table::Tracks,
        TableKind::Runs => Table::Runs,
        TableKind::Summary => Table::Summary,
    }
}

/// The surface of one cell or of all cells in a frame.
fn surface_of(result: &ResultFile, frame: usize, cell: Option<usize>) -> Result<Surface> {
    let layout = result.layout();
    let mut positions: Vec<Vec3> = result.positions(frame)?.into_iter().map(Vec3::from).collect();
    let Some(number) = cell else { return Ok(Surface { positions, facets: layout.facets.clone() }) };
    let Some(cell) = layout.cells.get(number) else {
        let fault = Fault::new(format!("{} has no cell {number}", result.path().display()))
            .help(format!("its cells are 0 to {}", layout.cells.len().saturating_sub(1)));
        return Err(Error::input(fault));
    };
    let part = |first: u32, count: u32| first as usize..(first + count) as usize;
    let facets = layout.facets[part(cell.first_facet, cell.facets)].iter();
    let facets = facets.map(|facet| facet.map(|atom| atom - cell.first_atom)).collect();
    positions = positions[part(cell.first_atom, cell.atoms)].to_vec();
    Ok(Surface { positions, facets })
}
