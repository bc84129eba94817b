//! Reads tracks from CSV files in the columns of TrackMate, or others that are named.

use super::assemble::{MOST_FAULTS, Spot, assemble};
pub use super::head::{COLUMNS, Options, TYPE};
use super::head::{Head, Row, unit_in, unit_sign};
use super::set::Tracks;
use crate::analysis::csv_fields::{Field, lines, location, number, number_fault};
use crate::error::{Error, Fault, Result, Source};
use crate::units::{Length, Time};
use std::path::Path;
use std::sync::Arc;

/// What was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Read {
    /// The tracks.
    pub tracks: Tracks,
    /// What was assumed of the file, or passed over.
    pub notes: Vec<String>,
}

/// Reads a file; see [`parse`].
///
/// # Errors
/// When the file cannot be read, and as [`parse`].
pub fn read(path: &Path, options: &Options) -> Result<Read> {
    let text = crate::files::read_text(path).map_err(|error| {
        let fault = Fault::new(format!("the tracks {} cannot be read: {error}", path.display()));
        Error::input(fault.help("give the path of a CSV file with a row for each track and frame"))
    })?;
    parse(&path.display().to_string(), &text, options)
}

/// Reads tracks from text: a line of column names, then a row for each track and frame, in any order, parted by commas, semicolons or tabs.
///
/// The lines in which TrackMate describes its columns are passed over, as are rows without a track; the units of time and length that they say count. A row with an empty position is a frame in which the cell was not found.
///
/// # Errors
/// With the faults found, ten at most: columns that are not there, fields that are no numbers, units that are none, and as [`assemble`].
pub fn parse(name: &str, text: &str, options: &Options) -> Result<Read> {
    let source = Arc::new(Source { name: name.to_owned(), text: text.to_owned() });
    let mut ranges = lines(text);
    let Some(heading) = ranges.next() else {
        let fault = Fault::new(format!("{name} is empty"));
        return Err(Error::input(fault.help(format!("start it with a line of column names, {}", COLUMNS.join(",")))));
    };
    let head = Head::of(&source, heading, options)?;
    let rows: Vec<Row> = ranges.map(|range| Row::of(text, range, head.sign)).collect();
    let (described, rows) = rows.split_at(head.described(&rows));
    let mut notes = Vec::new();
    let time = |text: &str| text.parse::<Time>().ok().map(Time::value);
    let length = |text: &str| text.parse::<Length>().ok().map(Length::value);
    let said = |column: usize| unit_in(described, column);
    let interval = options.interval.unwrap_or(f64::NAN);
    let time_unit = match (head.columns.time, options.time_unit) {
        (None, _) => interval,
        (_, Some(unit)) => unit,
        (Some(column), None) => unit_of(&source, "time", said(column), "--time-unit", &mut notes, time)?,
    };
    let length_unit = match options.length_unit {
        Some(unit) => unit,
        None => unit_of(&source, "length", said(head.columns.position[0]), "--length-unit", &mut notes, length)?,
    };
    let found = spots(&source, &head, rows, [time_unit, length_unit])?;
    for (number, what) in [(found.alone, "without a track"), (found.lost, "without a position")] {
        if number > 0 {
            notes.push(format!("{number} row{} {what}, passed over", if number == 1 { "" } else { "s" }));
        }
    }
    Ok(Read { tracks: assemble(&found.spots, &source)?, notes })
}

/// What rows hold.
#[derive(Default)]
struct Found {
    spots: Vec<Spot>,
    /// Number of rows without a track.
    alone: usize,
    /// Number of rows without a position.
    lost: usize,
}

/// The spots of rows; times and positions times their units.
fn spots(source: &Arc<Source>, head: &Head, rows: &[Row], units: [f64; 2]) -> Result<Found> {
    let (mut found, mut faults) = (Found::default(), Vec::new());
    for row in rows {
        if faults.len() >= MOST_FAULTS {
            break;
        }
        if row.fields.len() != head.width {
            let message = format!("a row of {} fields under {} column names", row.fields.len(), head.width);
            let fault = Fault::new(message).at(location(source, row.range.clone(), "in this row"));
            faults.push(fault.help("give one value for each column; decimal commas must be points"));
            continue;
        }
        let id = row.fields[head.columns.id].text.as_str();
        if id.is_empty() || id == "None" {
            found.alone += 1;
            continue;
        }
        match spot(source, head, row, units) {
            Ok(Some(spot)) => found.spots.push(spot),
            Ok(None) => found.lost += 1,
            Err(mut of_row) => faults.append(&mut of_row),
        }
    }
    if faults.is_empty() { Ok(found) } else { Err(Error::Input(faults)) }
}

/// The spot of a row; none without a position.
fn spot(
    source: &Arc<Source>,
    head: &Head,
    row: &Row,
    [time_unit, length_unit]: [f64; 2],
) -> std::result::Result<Option<Spot>, Vec<Fault>> {
    let columns = &head.columns;
    let mut faults = Vec::new();
    let mut value = |column: usize| {
        let Field { text, range } = &row.fields[column];
        number(text).unwrap_or_else(|| {
            faults.push(number_fault(source, Field { text: text.clone(), range: range.clone() }));
            f64::NAN
        })
    };
    let frame = columns.frame.map(&mut value);
    // Without a column of times the unit of time is that between frames.
    let time = columns.time.map(&mut value).or(frame).unwrap_or(f64::NAN) * time_unit;
    let mut position = [f64::NAN; 3];
    columns.position.iter().zip(&mut position).for_each(|(column, part)| *part = value(*column) * length_unit);
    let track = row.fields[columns.id].text.clone();
    if faults.is_empty() && (time.is_nan() || frame.is_some_and(f64::is_nan)) {
        let fault = Fault::new(format!("a position of track {track} has no time"));
        let fault = fault.at(location(source, row.range.clone(), "in this row"));
        faults.push(fault.help("give each row its frame and time"));
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let kind = columns.kind.map_or(String::new(), |column| row.fields[column].text.clone());
    let is_known = position[..columns.position.len()].iter().all(|part| !part.is_nan());
    Ok(is_known.then(|| Spot { track, kind, frame, time, position, row: row.range.clone() }))
}

/// What a 1 means in base units, by what the file says of it; 1 with a note where it says nothing.
fn unit_of(
    source: &Arc<Source>,
    what: &str,
    said: Option<&str>,
    option: &str,
    notes: &mut Vec<String>,
    parse: impl Fn(&str) -> Option<f64>,
) -> Result<f64> {
    let Some(said) = said else {
        let (unit, base) = if what == "time" { ("seconds", "min") } else { ("micrometres", "0.65 um") };
        notes.push(format!(
            "{what}s are taken to be in {unit}; if they are not, add {option} \"{base}\" or whatever a 1 means"
        ));
        return Ok(1.0);
    };
    parse(&format!("1 {}", unit_sign(said))).ok_or_else(|| {
        let fault = Fault::new(format!("{} says that its unit of {what} is \"{said}\"", source.name));
        let example = if what == "time" { "30 s" } else { "0.65 um" };
        Error::input(fault.help(format!("say what that is with {option}, as in {option} \"{example}\"")))
    })
}

#[cfg(test)]
#[path = "read_tests.rs"]
mod tests;
