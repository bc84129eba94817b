//! Tables of a result for spreadsheets and scripts: comma-separated text, a line of names with units first.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use super::container::machine_error;
use super::{ResultFile, Touching};
use crate::error::Result;

/// What a table holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Table {
    /// A row per frame and cell that is there, by its id: these series of the cells, or of the scene. All of them if none is named.
    Series(Vec<String>),
    /// A row per cell and frame in which it is there, in the columns of TrackMate: when, s, and where its centre is, µm.
    Tracks,
    /// A row per motility run that ended: cell, end (s), duration (s).
    Runs,
    /// A row per pseudopod whose protrusion ended: cell, end (s), how long it was pushed (s), direction, angle from the one before (degrees), side, whether it began
    /// alone and was given up.
    Pseudopods,
    /// A row per measure of the experiment.
    Summary,
    /// A row per frame and pair of cells that touch, or cell that touches a plane, with the area.
    Contacts,
}

/// Writes a table to a file; an existing file is replaced. See [`table_text`] and [`write_text`].
///
/// # Errors
/// [`crate::error::Error::Input`] for a series that the result does not have, or a damaged result;
/// [`crate::error::Error::Machine`] when the file cannot be written.
pub fn write_table(result: &ResultFile, table: &Table, path: &Path) -> Result<()> {
    write_text(&table_text(result, table)?, path)
}

/// Writes a text to a file; an existing file is replaced.
///
/// # Errors
/// [`crate::error::Error::Machine`] when the file cannot be written.
pub fn write_text(text: &str, path: &Path) -> Result<()> {
    let written = std::fs::File::create(path).and_then(|file| {
        let mut out = BufWriter::new(file);
        out.write_all(text.as_bytes())?;
        out.flush()
    });
    written.map_err(|error: io::Error| machine_error(path, "cannot be written", &error.to_string()))
}

/// A table as text. Numbers keep every digit.
///
/// # Errors
/// A series that the result does not have, or a damaged result.
pub fn table_text(result: &ResultFile, table: &Table) -> Result<String> {
    match table {
        Table::Series(names) if names.is_empty() => {
            series(result, &result.series_names().into_iter().chain(result.scene_names()).collect::<Vec<_>>())
        }
        Table::Series(names) => series(result, names),
        Table::Tracks => tracks(result),
        Table::Runs => runs(result),
        Table::Pseudopods => pseudopods(result),
        Table::Summary => summary(result),
        Table::Contacts => contacts(result),
    }
}

/// Values of a series: one per frame and cell, or one per frame that all cells share.
enum Column {
    Cells(ndarray::Array2<f64>),
    Scene(Vec<f64>),
}

fn series(result: &ResultFile, names: &[String]) -> Result<String> {
    let layout = result.layout();
    let mut text = String::from("frame,time (s),cell,type");
    let mut columns = Vec::new();
    for name in names {
        text.push_str(&format!(",{}", field(&titled(name, &result.units(name)?))));
        let of_scene = result.scene_names().contains(name);
        columns.push(match of_scene {
            true => Column::Scene(result.scene_series(name)?),
            false => Column::Cells(result.cell_series(name)?),
        });
    }
    text.push('\n');
    for (frame, time) in result.times()?.into_iter().enumerate() {
        for (cell, number) in result.cells(frame).iter().zip(result.columns(frame)) {
            text.push_str(&format!("{frame},{time},{},{}", cell.id, field(&layout.types[cell.kind as usize].name)));
            for column in &columns {
                let value = match column {
                    Column::Cells(values) => values[[frame, *number as usize]],
                    Column::Scene(values) => values[frame],
                };
                text.push_str(&format!(",{value}"));
            }
            text.push('\n');
        }
    }
    Ok(text)
}

/// Cell by cell, as programs that read tracks expect it.
fn tracks(result: &ResultFile) -> Result<String> {
    let (layout, times) = (result.layout(), result.times()?);
    let [x, y, z] = ["position_x", "position_y", "position_z"].map(|name| result.cell_series(name));
    let (x, y, z) = (x?, y?, z?);
    let mut text = String::from("TRACK_ID,FRAME,POSITION_T,POSITION_X,POSITION_Y,POSITION_Z,TYPE\n");
    for (column, known) in result.known_cells().iter().enumerate() {
        let kind = field(&layout.types[known.cell.kind as usize].name);
        for frame in known.frames.clone() {
            let (at, time) = ([frame, column], times[frame]);
            text.push_str(&format!("{},{frame},{time},{},{},{},{kind}\n", known.cell.id, x[at], y[at], z[at]));
        }
    }
    Ok(text)
}

fn contacts(result: &ResultFile) -> Result<String> {
    let layout = result.layout();
    let kind = |cell: u64| {
        let known = result.column_of(cell).map(|column| result.known_cells()[column as usize].cell.kind);
        field(known.map_or("", |kind| layout.types[kind as usize].name.as_str()))
    };
    let mut text = String::from("frame,time (s),cell,type,other,type or plane,area (um^2)\n");
    for (frame, time) in result.times()?.into_iter().enumerate() {
        for Touching { cell, other, area } in result.pairs(frame)? {
            text.push_str(&format!("{frame},{time},{cell},{},{other},{},{area}\n", kind(cell), kind(other)));
        }
        for Touching { cell, other, area } in result.on_planes(frame)? {
            let plane = layout.obstacles.get(other as usize).map_or("", |obstacle| obstacle.name.as_str());
            text.push_str(&format!("{frame},{time},{cell},{},,{},{area}\n", kind(cell), field(plane)));
        }
    }
    Ok(text)
}

fn runs(result: &ResultFile) -> Result<String> {
    let mut text = String::from("cell,end time (s),duration (s)\n");
    for (cell, end, duration) in result.runs()? {
        text.push_str(&format!("{cell},{end},{duration}\n"));
    }
    Ok(text)
}

fn pseudopods(result: &ResultFile) -> Result<String> {
    let mut text = String::from(
        "cell,end time (s),lifetime (s),direction x,direction y,direction z,turn (deg),side,alone,abandoned\n",
    );
    for pod in result.pseudopods()? {
        let [x, y, z] = pod.direction;
        let [alone, abandoned] = [pod.alone, pod.abandoned].map(u8::from);
        let (cell, end, lifetime, turn, side) = (pod.cell, pod.end, pod.lifetime, pod.turn, pod.side);
        text.push_str(&format!("{cell},{end},{lifetime},{x},{y},{z},{turn},{side},{alone},{abandoned}\n"));
    }
    Ok(text)
}

fn summary(result: &ResultFile) -> Result<String> {
    let mut text = String::from("measure,value,unit,description\n");
    for measure in result.summary()? {
        let (name, unit) = (field(&measure.name), field(&measure.unit));
        text.push_str(&format!("{name},{},{unit},{}\n", measure.value, field(&measure.description)));
    }
    Ok(text)
}

/// A name with its unit, if it has one.
fn titled(name: &str, unit: &str) -> String {
    if unit == "1" { name.to_owned() } else { format!("{name} ({unit})") }
}

/// A text as one field (RFC 4180): in quotes where it holds a comma, a quote or an end of line.
pub(super) fn field(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::{field, titled};

    #[test]
    fn a_field_with_commas_and_quotes_stays_one_field() {
        assert_eq!(field("plain"), "plain");
        assert_eq!(field("height, \"axial\""), "\"height, \"\"axial\"\"\"");
    }

    #[test]
    fn pure_numbers_have_no_unit_in_their_title() {
        assert_eq!(titled("volume", "um^3"), "volume (um^3)");
        assert_eq!(titled("volume_error", "1"), "volume_error");
    }
}
