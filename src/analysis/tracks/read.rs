//! Reads tracks from CSV files in the columns of TrackMate, or others that are named.

use super::assemble::{MOST_FAULTS, Spot, assemble};
use super::set::Tracks;
use crate::analysis::csv_fields::{Field, fields, lines, location, missing_column, name_faults, number, number_fault};
use crate::error::{Error, Fault, Result, Source};
use crate::units::{Length, Time};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// The columns of tracks: the id of the track, the number of the frame, when, and where.
pub const COLUMNS: [&str; 6] = ["TRACK_ID", "FRAME", "POSITION_T", "POSITION_X", "POSITION_Y", "POSITION_Z"];
/// The column with the type of the cell, which may be there.
pub const TYPE: &str = "TYPE";

/// What the reader of a file is told of it beforehand.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Options {
    /// The names of the columns with id, time, x, y and, in space, z; those of [`COLUMNS`] when absent.
    pub columns: Option<Vec<String>>,
    /// What a 1 means in the column of times, s; as the file says, or 1 s.
    pub time_unit: Option<f64>,
    /// What a 1 means in columns of positions, µm; as the file says, or 1 µm.
    pub length_unit: Option<f64>,
    /// Time between frames, s, for files that only number them.
    pub interval: Option<f64>,
}

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
    let text = std::fs::read_to_string(path).map_err(|error| {
        let fault = Fault::new(format!("the tracks {} cannot be read: {error}", path.display()));
        Error::input(fault.help("give the path of a CSV file with a row for each track and frame"))
    })?;
    parse(&path.display().to_string(), &text, options)
}

/// The columns of a file that count, by their numbers.
struct Columns {
    id: usize,
    frame: Option<usize>,
    time: Option<usize>,
    position: Vec<usize>,
    kind: Option<usize>,
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
    let sign = [',', ';', '\t'].into_iter().find(|sign| text[heading.clone()].contains(*sign)).unwrap_or(',');
    let first = fields(text, heading.clone(), sign);
    let names: Vec<String> = first.iter().map(|field| field.text.clone()).collect();
    let twice = name_faults(&source, &first);
    if !twice.is_empty() {
        return Err(Error::Input(twice));
    }
    let columns = columns_of(&source, &heading, &names, options)?;
    let rows: Vec<(Range<usize>, Vec<Field>)> =
        ranges.map(|range| (range.clone(), fields(text, range, sign))).collect();
    // TrackMate says in up to three lines what its columns are and in which unit; none of them has a number where numbers stand.
    let numeric = |fields: &[Field], column: usize| {
        fields.get(column).is_some_and(|field| !field.text.is_empty() && number(&field.text).is_some())
    };
    let of_numbers: Vec<usize> =
        columns.time.into_iter().chain(columns.frame).chain(columns.position.iter().copied()).collect();
    let begins = rows.iter().take(3).position(|(_, fields)| of_numbers.iter().any(|column| numeric(fields, *column)));
    let described = begins.unwrap_or_else(|| rows.len().min(3));
    // A single line of words is a mistake in a row, which is to be told; TrackMate writes several.
    let described =
        if described > 1 && rows[..described].iter().any(|row| row.1.len() == names.len()) { described } else { 0 };
    let mut notes = Vec::new();
    let unit_in = |column: Option<usize>| {
        let said =
            rows[..described].iter().filter_map(|(_, fields)| fields.get(column?)).map(|field| field.text.as_str());
        said.filter_map(|text| text.strip_prefix('(')?.strip_suffix(')')).next_back().map(str::to_owned)
    };
    let time_unit = match options.time_unit {
        Some(unit) => unit,
        None => unit_of(&source, "time", unit_in(columns.time), "--time-unit", &mut notes, |text| {
            text.parse::<Time>().ok().map(Time::value)
        })?,
    };
    let length_unit = match options.length_unit {
        Some(unit) => unit,
        None => unit_of(
            &source,
            "length",
            unit_in(columns.position.first().copied()),
            "--length-unit",
            &mut notes,
            |text| text.parse::<Length>().ok().map(Length::value),
        )?,
    };
    let (mut spots, mut faults, mut alone, mut lost) = (Vec::new(), Vec::new(), 0, 0);
    for (row, fields) in rows.into_iter().skip(described) {
        if faults.len() >= MOST_FAULTS {
            break;
        }
        if fields.len() != names.len() {
            let found = format!("a row of {} fields under {} column names", fields.len(), names.len());
            let fault = Fault::new(found).at(location(&source, row, "in this row"));
            faults.push(fault.help("give one value for each column; decimal commas must be points"));
            continue;
        }
        let mut value = |column: usize| match number(&fields[column].text) {
            Some(value) => value,
            None => {
                let Field { text, range } = &fields[column];
                faults.push(number_fault(&source, Field { text: text.clone(), range: range.clone() }));
                f64::NAN
            }
        };
        let id = fields[columns.id].text.as_str();
        if id.is_empty() || id == "None" {
            alone += 1;
            continue;
        }
        let frame = columns.frame.map(&mut value);
        let time = match columns.time {
            Some(column) => value(column) * time_unit,
            None => frame.unwrap_or(f64::NAN) * options.interval.unwrap_or(f64::NAN),
        };
        let mut position = [f64::NAN; 3];
        columns.position.iter().zip(&mut position).for_each(|(column, part)| *part = value(*column) * length_unit);
        if faults.is_empty() && (time.is_nan() || frame.is_some_and(f64::is_nan)) {
            let fault = Fault::new(format!("a position of track {id} has no time")).at(location(
                &source,
                row.clone(),
                "in this row",
            ));
            faults.push(fault.help("give each row its frame and time"));
        }
        if position[..columns.position.len()].iter().any(|part| part.is_nan()) {
            lost += 1;
            continue;
        }
        let kind = columns.kind.map_or(String::new(), |column| fields[column].text.clone());
        spots.push(Spot { track: id.to_owned(), kind, frame, time, position, row });
    }
    if !faults.is_empty() {
        return Err(Error::Input(faults));
    }
    for (number, what) in [(alone, "belong to no track"), (lost, "have no position")] {
        if number > 0 {
            notes.push(format!("{number} rows {what} and are passed over"));
        }
    }
    Ok(Read { tracks: assemble(&spots, &source)?, notes })
}

fn columns_of(source: &Arc<Source>, heading: &Range<usize>, names: &[String], options: &Options) -> Result<Columns> {
    let find = |name: &str| names.iter().position(|known| known.eq_ignore_ascii_case(name));
    let need = |name: &str| {
        find(name).ok_or_else(|| {
            let mut fault = missing_column(source, heading, names, name);
            if options.columns.is_none() {
                let help = fault.help.take().unwrap_or_default();
                fault.help = Some(format!("{help}; --columns names other columns, as in --columns id,t,x,y"));
            }
            Error::input(fault)
        })
    };
    let kind = find(TYPE);
    if let Some(own) = &options.columns {
        let numbers = own.iter().map(|name| need(name)).collect::<Result<Vec<_>>>()?;
        return Ok(Columns {
            id: numbers[0],
            frame: None,
            time: Some(numbers[1]),
            position: numbers[2..].to_vec(),
            kind,
        });
    }
    let [id, frame, time, x, y, z] = COLUMNS;
    let (id, frame) = (need(id)?, find(frame));
    let time = match (find(time), options.interval) {
        (_, Some(_)) if frame.is_some() => None,
        (None, None) if frame.is_some() => {
            let fault = missing_column(source, heading, names, time);
            return Err(Error::input(
                fault.help("frames are numbered, but when were they? add --interval, as in --interval \"30 s\""),
            ));
        }
        _ => Some(need(time)?),
    };
    let position = [need(x)?, need(y)?].into_iter().chain(find(z)).collect();
    Ok(Columns { id, frame, time, position, kind })
}

/// What a 1 means in base units, by what the file says of it; 1 with a note where it says nothing.
fn unit_of(
    source: &Arc<Source>,
    what: &str,
    said: Option<String>,
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
    parse(&format!("1 {said}")).ok_or_else(|| {
        let fault = Fault::new(format!("{} says that its unit of {what} is \"{said}\"", source.name));
        let example = if what == "time" { "30 s" } else { "0.65 um" };
        Error::input(fault.help(format!("say what that is with {option}, as in {option} \"{example}\"")))
    })
}

#[cfg(test)]
#[path = "read_tests.rs"]
mod tests;
