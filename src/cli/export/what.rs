//! What `export` writes, by the ending of the file and the options, and which options then mean something.

use super::args::{ExportArgs, TableKind};
use crate::error::{Error, Fault, Result};
use std::path::Path;

/// What is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum What {
    /// The surface of cells in a frame.
    Surface,
    /// The same as a physical model.
    Model,
    /// The same for VTK, with quantities of atoms and cells.
    Mesh,
    /// All frames of it.
    MeshSeries,
    /// Numbers of the result.
    Table,
    /// How far the face of a gel has moved, on a grid.
    Map,
    /// A folder of tables.
    Package,
    /// A frame of a field as a table.
    FieldTable,
    /// A frame of a field for VTK.
    FieldImage,
    /// All frames of it.
    FieldSeries,
    /// All frames of a field, or one, as pictures.
    FieldStack,
}

impl What {
    /// What the arguments ask for in a file.
    ///
    /// # Errors
    /// [`Error::Input`] for a name that does not tell it, and for options that say nothing about it.
    pub fn of(args: &ExportArgs, output: &Path) -> Result<Self> {
        let ending = output.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        let what = match ending.as_deref() {
            _ if args.table == Some(TableKind::Biotracks) => Self::Package,
            Some("csv" | "txt") if args.displacements.is_some() => Self::Map,
            Some("csv") if args.field.is_some() => Self::FieldTable,
            Some("csv") => Self::Table,
            Some("vti") => Self::FieldImage,
            Some("vtu") => Self::Mesh,
            Some("pvd") if args.field.is_some() => Self::FieldSeries,
            Some("pvd") => Self::MeshSeries,
            Some("tif" | "tiff") if has_ome(output) => Self::FieldStack,
            Some("obj" | "ply" | "stl") => Self::Surface,
            Some("pml") => Self::Model,
            _ => {
                let name = output.display();
                let fault = Fault::new(format!("cannot tell from its name what to write to {name}"));
                return Err(Error::input(fault.help(
                    "let the name end in .obj, .ply, .stl, .vtu or .pml for a mesh, .pvd for all frames of it, .vti or .ome.tiff \
                     for a field, .csv for a table, .txt for a map of --displacements",
                )));
            }
        };
        what.refuse_unused(args, output)?;
        Ok(what)
    }

    /// A page has all frames, cells and fields: options that choose some say nothing about it.
    ///
    /// # Errors
    /// [`Error::Input`] for such an option.
    pub fn refuse_for_page(args: &ExportArgs, page: &Path) -> Result<()> {
        let unused = match () {
            () if args.frame.frame.is_some() => "--frame",
            () if args.frame.time.is_some() => "--time",
            () if args.every.is_some() => "--every",
            () if args.cell.is_some() => "--cell",
            () if args.table.is_some() => "--table",
            () if !args.series.is_empty() => "--series",
            () if args.field.is_some() => "--field",
            () if args.displacements.is_some() => "--displacements",
            () => return Ok(()),
        };
        let fault = Fault::new(format!("{unused} has no meaning for {}", page.display()));
        Err(Error::input(
            fault.help(
                "a page has all cells and fields, and as many frames as --size lets it have: leave the option out",
            ),
        ))
    }

    /// Options that say nothing about what is written are a mistake that the user wants to know of.
    ///
    /// # Errors
    /// [`Error::Input`] for such an option.
    pub fn refuse_unused(self, args: &ExportArgs, output: &Path) -> Result<()> {
        use What::*;
        let table = matches!(self, Table | Package);
        let field = matches!(self, FieldTable | FieldImage | FieldSeries | FieldStack);
        let one_frame = !table && !matches!(self, MeshSeries | FieldSeries);
        let unused = match () {
            () if !one_frame && args.frame.frame.is_some() => "--frame",
            () if !one_frame && args.frame.time.is_some() => "--time",
            () if args.every.is_some() && !matches!(self, MeshSeries | FieldSeries | FieldStack) => "--every",
            () if args.cell.is_some() && !matches!(self, Surface | Model | Mesh | MeshSeries) => "--cell",
            () if !table && args.table.is_some() => "--table",
            () if !table && !args.series.is_empty() => "--series",
            () if !args.series.is_empty() && args.table.is_some_and(|kind| kind != TableKind::Series) => "--series",
            () if !field && args.field.is_some() => "--field",
            () if self != Map && args.displacements.is_some() => "--displacements",
            () if args.pixel.is_some() && !is_in_pixels(output) => "--pixel",
            () => return Ok(()),
        };
        let fault = Fault::new(format!("{unused} has no meaning for {}", output.display())).help(
            "--frame and --time belong to one frame of a mesh (.obj, .ply, .stl, .vtu, .pml) or of a field (.vti, .ome.tiff, or \
             .csv with --field), --every to all frames (.pvd, .ome.tiff), --cell to a mesh, --field to a field, --table and \
             --series to a table (.csv), --displacements to a map (.csv, .txt), --pixel to one in pixels (.txt)",
        );
        Err(Error::input(fault))
    }
}

/// Whether a map is written in pixels.
pub fn is_in_pixels(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("txt"))
}

/// Whether `.ome` stands before the ending of a file.
fn has_ome(path: &Path) -> bool {
    path.file_stem().is_some_and(|stem| Path::new(stem).extension().is_some_and(|end| end.eq_ignore_ascii_case("ome")))
}
