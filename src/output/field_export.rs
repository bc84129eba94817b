//! A frame of a field for other programs: a table of positions and values, or an image for VTK.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use super::container::machine_error;
use super::field_layout::{Along, FieldLayout};
use super::vtk_xml::{Numbers, opening, time_value, write_array};
use super::{ResultFile, write_text};
use crate::error::Result;

/// Writes a frame of a field as a table: a row for each box with its centre (µm; no z for a field of the substrate)
/// and the values of these species, by their numbers. An existing file is replaced.
///
/// # Errors
/// A damaged result, or a file that cannot be written.
///
/// # Panics
/// If there is no such frame or species.
pub fn write_field_table(
    result: &ResultFile,
    field: &FieldLayout,
    species: &[usize],
    frame: usize,
    path: &Path,
) -> Result<()> {
    write_text(&table(field, &values_of(result, field, species, frame)?), path)
}

/// Writes a frame of a field as an image of VTK (`.vti`) with one array for each of these species. An existing file is
/// replaced.
///
/// # Errors
/// As [`write_field_table`].
///
/// # Panics
/// As [`write_field_table`].
pub fn write_field_image(
    result: &ResultFile,
    field: &FieldLayout,
    species: &[usize],
    frame: usize,
    path: &Path,
) -> Result<()> {
    let (time, values) = (result.times()?[frame], values_of(result, field, species, frame)?);
    let written = File::create(path).and_then(|file| {
        let mut out = BufWriter::new(file);
        write_image(&mut out, field, &values, time)?;
        out.flush()
    });
    written.map_err(|error| machine_error(path, "cannot be written", &error.to_string()))
}

/// A species with its name and unit, and its values.
type Values<'a> = (&'a (String, String), Vec<f64>);

fn values_of<'a>(
    result: &ResultFile,
    field: &'a FieldLayout,
    species: &[usize],
    frame: usize,
) -> Result<Vec<Values<'a>>> {
    let value = |number: &usize| {
        let named = &field.species[*number];
        Ok((named, result.field_frame(&field.name, &named.0, frame)?))
    };
    species.iter().map(value).collect()
}

fn table(field: &FieldLayout, species: &[Values]) -> String {
    let axes = if field.is_flat() { &[Along::X, Along::Y][..] } else { &[Along::X, Along::Y, Along::Z] };
    let coordinates = axes.iter().map(|axis| format!("{} (um)", axis.letter()));
    let values = species.iter().map(|((name, unit), _)| match unit.as_str() {
        "" | "1" => super::tables::field(name),
        unit => super::tables::field(&format!("{name} ({unit})")),
    });
    let mut text = coordinates.chain(values).collect::<Vec<_>>().join(",");
    text.push('\n');
    let [nx, ny, _] = field.cells;
    for at in 0..field.len() {
        let index = [at % nx, at / nx % ny, at / (nx * ny)];
        let coordinates = axes.iter().map(|axis| rounded(field.centre(*axis, index[axis.number()])).to_string());
        // As many digits as were stored.
        let values = species.iter().map(|(_, values)| (values[at] as f32).to_string());
        text.push_str(&coordinates.chain(values).collect::<Vec<_>>().join(","));
        text.push('\n');
    }
    text
}

/// A coordinate without the noise of its last digits.
fn rounded(coordinate: f64) -> f64 {
    (coordinate * 1e9).round() / 1e9
}

fn write_image(out: &mut impl Write, field: &FieldLayout, species: &[Values], time: f64) -> io::Result<()> {
    let list = |numbers: &[f64; 3]| numbers.map(|number| number.to_string()).join(" ");
    let [nx, ny, nz] = field.cells;
    let (extent, origin, spacing) = (format!("0 {nx} 0 {ny} 0 {nz}"), list(&field.origin), list(&field.spacing));
    writeln!(
        out,
        "{}<ImageData WholeExtent=\"{extent}\" Origin=\"{origin}\" Spacing=\"{spacing}\">\n{}<Piece Extent=\"{extent}\">\n<CellData>",
        opening("ImageData"),
        time_value(time)
    )?;
    for ((name, unit), values) in species {
        // As many digits as were stored.
        let values: Vec<f32> = values.iter().map(|value| *value as f32).collect();
        write_array(out, name, 1, unit, &Numbers::Singles(&values))?;
    }
    writeln!(out, "</CellData>\n</Piece>\n</ImageData>\n</VTKFile>")
}
