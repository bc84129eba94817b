//! The values of fields at the end of a course, as a table or as an HDF5 file that a document can start from.

use crate::equations::eml::Document;
use crate::error::{Error, Fault, Result};
use crate::field::{FieldSystem, Fields};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// A file for the last values.
pub(super) struct Last {
    path: PathBuf,
    as_table: bool,
}

impl Last {
    /// A file of the kind that its name says.
    ///
    /// # Errors
    /// Another ending than .csv, .h5 or .hdf5.
    pub(super) fn new(path: &Path) -> std::result::Result<Self, Fault> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
        match ending.as_str() {
            "csv" => Ok(Self { path: path.to_owned(), as_table: true }),
            "h5" | "hdf5" => Ok(Self { path: path.to_owned(), as_table: false }),
            _ => {
                let fault = Fault::new(format!("cannot tell from its name what kind of file {} is", path.display()));
                Err(fault.help("let the name end in .csv for a table or .h5 for datasets"))
            }
        }
    }

    /// Writes the values.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(super) fn save(self, document: &Document, system: &FieldSystem, fields: &Fields) -> Result<PathBuf> {
        let failed = |error: String| Error::Machine {
            message: format!("{} cannot be written: {error}", self.path.display()),
            help: "free some space, or name a file in a folder that you may write to with --last".into(),
        };
        if self.as_table {
            std::fs::write(&self.path, table(document, fields)).map_err(|error| failed(error.to_string()))?;
        } else {
            datasets(&self.path, system, fields).map_err(|error| failed(error.to_string()))?;
        }
        Ok(self.path)
    }
}

/// A row for each box: its centre in the document's unit of length, and the value of each field.
fn table(document: &Document, fields: &Fields) -> String {
    let (grid, axes) = (fields.grid(), fields.grid().dimension());
    let length = document.grid.as_ref().map_or(1.0, |grid| grid.micrometres);
    let ids = fields.species().iter().map(|species| species.name.as_str());
    let mut text = ["x", "y", "z"].into_iter().take(axes).chain(ids).collect::<Vec<_>>().join(",") + "\n";
    for at in 0..grid.len() {
        let centre = grid.centre(at);
        let numbers = (0..axes).map(|axis| centre[axis] / length);
        let values = (0..fields.species().len()).map(|s| fields.values(s)[at]);
        for (number, value) in numbers.chain(values).enumerate() {
            // Writing to a text cannot fail.
            let _ = write!(text, "{}{value:?}", if number == 0 { "" } else { "," });
        }
        text.push('\n');
    }
    text
}

/// One dataset for each field, `[y][x]` or `[z][y][x]`, as `dataset="FILE:/FIELD"` of a document takes them, with its unit beside it.
fn datasets(path: &Path, system: &FieldSystem, fields: &Fields) -> hdf5::Result<()> {
    let file = hdf5::File::create(path)?;
    let [nx, ny, nz] = fields.grid().cells;
    let shape = if fields.grid().is_flat() { vec![ny, nx] } else { vec![nz, ny, nx] };
    for (s, (species, unit)) in fields.species().iter().zip(system.units()).enumerate() {
        let builder = file.new_dataset::<f64>().obj_track_times(false).shape(shape.clone());
        let dataset = builder.create(species.name.as_str())?;
        dataset.write_raw(fields.values(s))?;
        if let Ok(unit) = unit.parse::<hdf5::types::VarLenUnicode>() {
            dataset.new_attr::<hdf5::types::VarLenUnicode>().create("unit")?.write_scalar(&unit)?;
        }
    }
    Ok(())
}
