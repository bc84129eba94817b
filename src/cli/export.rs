//! `pseudopod export`: a frame of a result as a mesh or as the values of a field, or its numbers as a table.

use super::files::{Named, refuse_existing, refuse_same};
use super::frames::FrameArgs;
use super::report::Report;
use crate::Vec3;
use crate::analysis::aggregates::table_of_changes;
use crate::error::{Error, Fault, Result};
use crate::experiment::When;
use crate::geometry::{Surface, export_surface};
use crate::output::biotracks::write_biotracks;
use crate::output::{ResultFile, Table, write_field_image, write_field_table, write_table, write_text};
use std::path::PathBuf;

/// Writes the cells of a frame as OBJ, PLY or STL, in um, a field of a frame as VTI or CSV, or series, tracks and
/// measures as CSV.
#[derive(Debug, Clone, clap::Args)]
pub struct ExportArgs {
    /// The result file.
    pub result: PathBuf,
    /// The file; its ending says what is written: .obj, .ply, .stl a mesh, .vti a field, .csv a table. A folder for --table biotracks.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Which frame a mesh or a field shows; the last when absent.
    #[command(flatten)]
    pub frame: FrameArgs,
    /// One cell by its number, from 0, in a mesh; all when absent.
    #[arg(long, value_name = "NUMBER")]
    pub cell: Option<usize>,
    /// A field, FIELD.SPECIES for one of its species only; the first field in a .vti when absent.
    #[arg(long, value_name = "FIELD")]
    pub field: Option<String>,
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

/// Runs the command.
///
/// # Errors
/// A result, frame, cell or series that is not there; a file that exists, has an unknown ending or cannot be written.
pub fn run(args: &ExportArgs) -> Result<Report> {
    let ending = args.output.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    let what = match ending.as_deref() {
        _ if args.table == Some(TableKind::Biotracks) => What::Package,
        Some("csv") if args.field.is_some() => What::FieldTable,
        Some("csv") => What::Table,
        Some("vti") => What::FieldImage,
        Some("obj" | "ply" | "stl") => What::Mesh,
        _ => {
            let fault = Fault::new(format!("cannot tell from its name what to write to {}", args.output.display()));
            return Err(Error::input(
                fault.help("let the name end in .obj, .ply or .stl for a mesh, .vti for a field, .csv for a table"),
            ));
        }
    };
    refuse_unused(args, what)?;
    let result = ResultFile::open(&args.result)?;
    refuse_same(&[&args.result, &args.output])?;
    refuse_existing(&args.output, args.force, Named::ByUser)?;
    match what {
        What::Table => match table_of(args) {
            Some(table) => write_table(&result, &table, &args.output)?,
            None => write_text(&table_of_changes(&result)?, &args.output)?,
        },
        What::Package => return Ok(Report::of_files(&args.result, &write_biotracks(&result, &args.output)?)),
        What::Mesh => {
            let frame = args.frame.of(&result, When::Last)?;
            export_surface(&surface_of(&result, frame, args.cell)?, &args.output)?;
        }
        What::FieldTable | What::FieldImage => write_field(args, &result, what)?,
    }
    Ok(Report::of_files(&args.result, std::slice::from_ref(&args.output)))
}

/// What is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum What {
    Mesh,
    Table,
    Package,
    FieldTable,
    FieldImage,
}

/// Writes the species of a field, or the one that is named.
fn write_field(args: &ExportArgs, result: &ResultFile, what: What) -> Result<()> {
    let frame = args.frame.of(result, When::Last)?;
    let first = result.layout().fields.first().map(|field| field.name.as_str());
    // Without any field the name does not matter: the message says that there is none.
    let name = args.field.as_deref().or(first).unwrap_or_default();
    let (field, species) = result.field_species(name)?;
    let species = if field.name == name { (0..field.species.len()).collect() } else { vec![species] };
    match what {
        What::FieldImage => write_field_image(result, field, &species, frame, &args.output),
        _ => write_field_table(result, field, &species, frame, &args.output),
    }
}

/// Options that say nothing about what is written are a mistake that the user wants to know of.
fn refuse_unused(args: &ExportArgs, what: What) -> Result<()> {
    let (table, field) =
        (matches!(what, What::Table | What::Package), matches!(what, What::FieldTable | What::FieldImage));
    let unused = match () {
        () if table && args.frame.frame.is_some() => "--frame",
        () if table && args.frame.time.is_some() => "--time",
        () if what != What::Mesh && args.cell.is_some() => "--cell",
        () if !table && args.table.is_some() => "--table",
        () if !table && !args.series.is_empty() => "--series",
        () if !args.series.is_empty() && args.table.is_some_and(|kind| kind != TableKind::Series) => "--series",
        () if !field && args.field.is_some() => "--field",
        () => return Ok(()),
    };
    let fault = Fault::new(format!("{unused} has no meaning for {}", args.output.display())).help(
        "--frame and --time belong to a mesh (.obj, .ply, .stl) or a field (.vti, or .csv with --field), --cell to a \
         mesh, --field to a field, --table and --series to a table (.csv)",
    );
    Err(Error::input(fault))
}

/// The table of the result; none for what is found from it.
fn table_of(args: &ExportArgs) -> Option<Table> {
    Some(match args.table.unwrap_or(TableKind::Series) {
        TableKind::Series => Table::Series(args.series.clone()),
        TableKind::Tracks => Table::Tracks,
        TableKind::Runs => Table::Runs,
        TableKind::Pseudopods => Table::Pseudopods,
        TableKind::Summary => Table::Summary,
        TableKind::Contacts => Table::Contacts,
        TableKind::Aggregates | TableKind::Biotracks => return None,
    })
}

/// The surface of one cell, by its id, or of all cells in a frame.
fn surface_of(result: &ResultFile, frame: usize, cell: Option<usize>) -> Result<Surface> {
    let (layout, cells) = (result.layout(), result.cells(frame));
    let positions: Vec<Vec3> = result.positions(frame)?.into_iter().map(Vec3::from).collect();
    let Some(id) = cell else { return Ok(Surface { positions, facets: layout.facets_of(&cells).collect() }) };
    let found = cells.iter().zip(layout.atoms_of(&cells)).find(|(cell, _)| cell.id == id as u64);
    let Some((cell, atoms)) = found else {
        let ids = || cells.iter().map(|cell| cell.id);
        let (first, last) = (ids().min().unwrap_or(0), ids().max().unwrap_or(0));
        let name = result.path().display();
        let fault = match result.has_one_population() {
            true => Fault::new(format!("{name} has no cell {id}")).help(format!("its cells are {first} to {last}")),
            false => Fault::new(format!("{name} has no cell {id} in frame {frame}"))
                .help(format!("{} cells from {first} to {last} are there then", cells.len())),
        };
        return Err(Error::input(fault));
    };
    Ok(Surface { positions: positions[atoms].to_vec(), facets: layout.types[cell.kind as usize].facets.clone() })
}
