//! Cells of a frame as a physical model, and the loads on them.

use crate::Vec3;
use crate::error::{Error, Result};
use crate::experiment::{loads_as_lml, prepare};
use crate::geometry::Surface;
use crate::output::{Cell, ResultFile};
use crate::physical_model::pml::model_of_surfaces;
use crate::run::document_of;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::ops::Range;
use std::path::Path;

/// Writes some of the cells of a frame as PML in µm.
///
/// # Errors
/// A file that cannot be written, or a result that cannot be read.
pub fn write_model(result: &ResultFile, frame: usize, shown: Range<usize>, path: &Path) -> Result<()> {
    let (layout, cells) = (result.layout(), result.cells(frame));
    let positions: Vec<Vec3> = result.positions(frame)?.into_iter().map(Vec3::from).collect();
    let own = |(cell, atoms): (&Cell, Range<usize>)| {
        let kind = &layout.types[cell.kind as usize];
        (
            format!("{} {}", kind.name, cell.id),
            Surface { positions: positions[atoms].to_vec(), facets: kind.facets.to_vec() },
        )
    };
    let surfaces: Vec<(String, Surface)> =
        cells.iter().zip(layout.atoms_of(&cells)).skip(shown.start).take(shown.len()).map(own).collect();
    let title = result.path().file_stem().unwrap_or_default().to_string_lossy().into_owned();
    save(path, |out| model_of_surfaces(&title, "um", &surfaces).write(out))
}

/// Writes the loads of the experiment on the same cells as LML; tells what LML has no words for.
///
/// # Errors
/// As [`write_model`], and those of the experiment where it can no longer be compiled.
pub fn write_loads(result: &ResultFile, frame: usize, shown: Range<usize>, path: &Path) -> Result<Vec<&'static str>> {
    let (layout, cells) = (result.layout(), result.cells(frame));
    let model = prepare(&document_of(result.header(), result.path())?)?.model;
    let cells = &cells[shown];
    let first = layout.atoms_of(cells).map(|atoms| atoms.start as u32);
    let listed: Vec<(usize, u32)> = cells.iter().map(|cell| cell.kind as usize).zip(first).collect();
    let (loads, untold) = loads_as_lml(&model, &listed);
    save(path, |out| loads.write(out))?;
    Ok(untold)
}

fn save(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> Result<()> {
    let outcome = File::create(path).and_then(|file| {
        let mut out = BufWriter::new(file);
        write(&mut out)?;
        out.flush()
    });
    outcome.map_err(|failure| Error::Machine {
        message: format!("{} cannot be written: {failure}", path.display()),
        help: "write to a folder that exists, that is yours and that has room".into(),
    })
}
