//! `pseudopod export`: frames of a result as meshes or as the values of a field, or its numbers as a table.

mod args;
mod html;
mod model;
mod what;

pub use args::{ExportArgs, TableKind};

use super::files::{Named, refuse_existing, refuse_existing_folder, refuse_same};
use super::report::Report;
use crate::Vec3;
use crate::analysis::aggregates::table_of_changes;
use crate::analysis::displacement_map::DisplacementMap;
use crate::error::words::all_of;
use crate::error::{Error, Fault, Result, short};
use crate::experiment::When;
use crate::geometry::{Surface, export_surface};
use crate::output::biotracks::write_biotracks;
use crate::output::{
    Cell, FieldLayout, ResultFile, Table, series_file, series_folder, write_field_image, write_field_series,
    write_field_table, write_field_tiff, write_mesh, write_mesh_series, write_table, write_text,
};
use model::{write_loads, write_model};
use std::ops::Range;
use std::path::{Path, PathBuf};
use what::{What, is_in_pixels};

/// Pixels between the points of a map when it is not said what a pixel is.
const PIXELS: f64 = 16.0;

/// Numbers of pixels that are as near to whole ones as this are whole.
const ROUND_OFF: f64 = 1e-6;

/// Runs the command.
///
/// # Errors
/// A result, frame, cell or series that is not there; a file that exists, has an unknown ending or cannot be written.
pub fn run(args: &ExportArgs) -> Result<Report> {
    let what = args.output.as_deref().map(|output| What::of(args, output)).transpose()?;
    if let (None, Some(path)) = (&args.output, args.pml.as_ref().or(args.lml.as_ref())) {
        What::Model.refuse_unused(args, path)?;
    }
    if let (None, None, None, Some(page)) = (&args.output, &args.pml, &args.lml, &args.html) {
        What::refuse_for_page(args, page)?;
    }
    let result = ResultFile::open(&args.result)?;
    let named = [&args.output, &args.html, &args.pml, &args.lml].map(Option::as_deref);
    let named: Vec<&Path> = named.into_iter().flatten().collect();
    refuse_same(&[&[args.result.as_path()], named.as_slice()].concat())?;
    named.iter().try_for_each(|path| refuse_existing(path, args.force, Named::ByUser))?;
    let mut files: Vec<PathBuf> = [&args.html, &args.pml, &args.lml].into_iter().flatten().cloned().collect();
    if let Some(path) = &args.pml {
        let frame = args.frame.of(&result, When::Last)?;
        write_model(&result, frame, shown(&result, frame, args.cell)?, path)?;
    }
    let page = args.html.as_deref().map(|path| html::write_page(args, path)).transpose()?;
    let untold = match &args.lml {
        Some(path) => {
            let frame = args.frame.of(&result, When::Last)?;
            write_loads(&result, frame, shown(&result, frame, args.cell)?, path)?
        }
        None => Vec::new(),
    };
    if let (Some(what), Some(output)) = (what, &args.output) {
        files.extend(write(args, &result, what, output)?);
    }
    let mut report = Report::of_files(&args.result, &files);
    report.words += &page.unwrap_or_default();
    if !untold.is_empty() {
        report.words += &format!("LML has no words for {}: they were left out\n", all_of(untold));
    }
    Ok(report)
}

/// Writes one file, and what goes with it.
fn write(args: &ExportArgs, result: &ResultFile, what: What, output: &Path) -> Result<Vec<PathBuf>> {
    match what {
        What::Table => match table_of(args) {
            Some(table) => write_table(result, &table, output)?,
            None => write_text(&table_of_changes(result)?, output)?,
        },
        What::Map => write_text(&map_of(args, result, output)?, output)?,
        What::Package => return write_biotracks(result, output),
        What::Surface => {
            let frame = args.frame.of(result, When::Last)?;
            let (surface, [cell, kind]) = surface_of(result, frame, args.cell)?;
            export_surface(&surface, &[("cell", cell), ("type", kind)], output)?;
        }
        What::Model => {
            let frame = args.frame.of(result, When::Last)?;
            write_model(result, frame, shown(result, frame, args.cell)?, output)?;
        }
        What::Mesh => {
            let frame = args.frame.of(result, When::Last)?;
            if let Some(id) = args.cell {
                index_of(result, frame, id)?;
            }
            write_mesh(result, frame, args.cell, output)?;
        }
        What::MeshSeries => {
            let frames = frames_with(result, every(result, args), args.cell)?;
            let folder = refuse_series(args, output, &frames, "vtu")?;
            write_mesh_series(result, &frames, args.cell, output)?;
            return Ok(vec![output.to_path_buf(), folder]);
        }
        What::FieldSeries => {
            let (field, species) = field_of(args, result)?;
            let frames = every(result, args);
            let folder = refuse_series(args, output, &frames, "vti")?;
            write_field_series(result, field, &species, &frames, output)?;
            return Ok(vec![output.to_path_buf(), folder]);
        }
        What::FieldStack => {
            let (field, species) = field_of(args, result)?;
            let one = args.frame.frame.is_some() || args.frame.time.is_some();
            let frames = if one { vec![args.frame.of(result, When::Last)?] } else { every(result, args) };
            write_field_tiff(result, field, &species, &frames, output)?;
        }
        What::FieldTable | What::FieldImage => {
            let (field, species) = field_of(args, result)?;
            let frame = args.frame.of(result, When::Last)?;
            let write = if what == What::FieldImage { write_field_image } else { write_field_table };
            write(result, field, &species, frame, output)?;
        }
    }
    Ok(vec![output.to_path_buf()])
}

/// How the face of a gel has moved, for a file of this name.
fn map_of(args: &ExportArgs, result: &ResultFile, output: &Path) -> Result<String> {
    let name = args.displacements.as_deref().unwrap_or_default();
    let frame = args.frame.of(result, When::Last)?;
    for (option, length) in [("--spacing", args.spacing), ("--pixel", args.pixel)] {
        if let Some(length) = length.filter(|length| length.value() <= 0.0) {
            let fault = Fault::new(format!("{option} is {length}")).help("give a length above 0, as in \"1 um\"");
            return Err(Error::input(fault));
        }
    }
    let map = DisplacementMap::of(result, name, frame, args.spacing.map(|spacing| spacing.value()))?;
    if !is_in_pixels(output) {
        return Ok(map.as_csv());
    }
    let pixel = args.pixel.map_or(map.spacing / PIXELS, |pixel| pixel.value());
    let pixels = map.spacing / pixel;
    if pixels < 1.0 - ROUND_OFF || (pixels - pixels.round()).abs() > ROUND_OFF * pixels {
        let (spacing, whole) = (short(map.spacing), pixels.round().max(1.0) * pixel);
        let message = format!("a spacing of {spacing} um is {} pixels of {} um", short(pixels), short(pixel));
        let help = format!("give a spacing of a whole number of pixels, such as --spacing \"{} um\"", short(whole));
        return Err(Error::input(Fault::new(message).help(help)));
    }
    Ok(map.in_pixels(pixel))
}

/// The field that is asked for, and which of its species.
fn field_of<'a>(args: &ExportArgs, result: &'a ResultFile) -> Result<(&'a FieldLayout, Vec<usize>)> {
    let first = result.layout().fields.first().map(|field| field.name.as_str());
    // Without any field the name does not matter: the message says that there is none.
    let name = args.field.as_deref().or(first).unwrap_or_default();
    let (field, species) = result.field_species(name)?;
    Ok((field, if field.name == name { (0..field.species.len()).collect() } else { vec![species] }))
}

/// The frames of a series.
fn every(result: &ResultFile, args: &ExportArgs) -> Vec<usize> {
    (0..result.frames()).step_by(args.every.unwrap_or(1) as usize).collect()
}

/// Those of some frames that have the cell, if one is named.
fn frames_with(result: &ResultFile, frames: Vec<usize>, cell: Option<u64>) -> Result<Vec<usize>> {
    let Some(id) = cell else { return Ok(frames) };
    let there = result.column_of(id).map(|column| result.known_cells()[column as usize].frames.clone());
    let with: Vec<usize> =
        frames.into_iter().filter(|frame| there.as_ref().is_some_and(|there| there.contains(frame))).collect();
    if !with.is_empty() {
        return Ok(with);
    }
    let name = result.path().display();
    Err(Error::input(match there {
        Some(there) => Fault::new(format!("{name} has no cell {id} in the frames that are asked for")).help(format!(
            "it is there from frame {} to {}: use another --every",
            there.start,
            there.end - 1
        )),
        None => {
            let (count, ids) =
                (result.known_cells().len(), ids(result.known_cells().iter().map(|known| known.cell.id)));
            Fault::new(format!("{name} has no cell {id}"))
                .help(format!("{count} cells from {} to {} are in it at some time", ids[0], ids[1]))
        }
    }))
}

/// The folder of a series; refused where it exists, unless it is to be replaced, and where one of its files is the result.
fn refuse_series(args: &ExportArgs, output: &Path, frames: &[usize], ending: &str) -> Result<PathBuf> {
    let folder = series_folder(output);
    refuse_existing_folder(&folder, args.force)?;
    for frame in frames {
        refuse_same(&[&args.result, &series_file(output, *frame, ending)])?;
    }
    Ok(folder)
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

/// The surface of one cell, by its id, or of all cells in a frame; of each atom the id of its cell, and the number of its type.
fn surface_of(result: &ResultFile, frame: usize, cell: Option<u64>) -> Result<(Surface, [Vec<f64>; 2])> {
    let (layout, cells) = (result.layout(), result.cells(frame));
    let shown = shown(result, frame, cell)?;
    let (before, shown) = (&cells[..shown.start], &cells[shown]);
    let positions = result.positions(frame)?.into_iter().map(Vec3::from);
    let positions = positions.skip(layout.atoms(before)).take(layout.atoms(shown)).collect();
    let of_atoms = |number: fn(&Cell) -> f64| -> Vec<f64> {
        let atoms = layout.atoms_of(shown).map(|atoms| atoms.len());
        shown.iter().zip(atoms).flat_map(|(cell, atoms)| std::iter::repeat_n(number(cell), atoms)).collect()
    };
    let owners = [of_atoms(|cell| cell.id as f64), of_atoms(|cell| f64::from(cell.kind))];
    Ok((Surface { positions, facets: layout.facets_of(shown).collect() }, owners))
}

/// Which of the cells of a frame are shown: the one with an id, or all.
fn shown(result: &ResultFile, frame: usize, cell: Option<u64>) -> Result<Range<usize>> {
    match cell {
        None => Ok(0..result.cells(frame).len()),
        Some(id) => index_of(result, frame, id).map(|index| index..index + 1),
    }
}

/// Which of the cells of a frame the one with an id is.
fn index_of(result: &ResultFile, frame: usize, id: u64) -> Result<usize> {
    let cells = result.cells(frame);
    if let Some(index) = cells.iter().position(|cell| cell.id == id) {
        return Ok(index);
    }
    let ids = ids(cells.iter().map(|cell| cell.id));
    let name = result.path().display();
    Err(Error::input(match result.has_one_population() {
        true => Fault::new(format!("{name} has no cell {id}")).help(format!("its cells are {} to {}", ids[0], ids[1])),
        false => Fault::new(format!("{name} has no cell {id} in frame {frame}")).help(format!(
            "{} cells from {} to {} are there then",
            cells.len(),
            ids[0],
            ids[1]
        )),
    }))
}

/// The first and the last of some ids.
fn ids(all: impl Iterator<Item = u64> + Clone) -> [u64; 2] {
    [all.clone().min().unwrap_or(0), all.max().unwrap_or(0)]
}
