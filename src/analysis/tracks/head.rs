//! What a file with tracks says at its head: which columns it has, and what they are.

use crate::analysis::csv_fields::{Field, fields, missing_column, name_faults, number};
use crate::error::{Error, Result, Source};
use std::ops::Range;
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

/// A line of a file, parted into fields.
pub struct Row {
    /// Its bytes.
    pub range: Range<usize>,
    /// Its fields.
    pub fields: Vec<Field>,
}

impl Row {
    /// Parts a line.
    pub fn of(text: &str, range: Range<usize>, sign: char) -> Self {
        Self { fields: fields(text, range.clone(), sign), range }
    }

    /// Whether a field holds a number.
    fn has_number(&self, column: usize) -> bool {
        self.fields.get(column).is_some_and(|field| !field.text.is_empty() && number(&field.text).is_some())
    }
}

/// The line of column names, understood.
pub struct Head {
    /// What parts the fields.
    pub sign: char,
    /// Number of columns.
    pub width: usize,
    /// Those that count.
    pub columns: Columns,
}

/// The columns of a file that count, by their numbers.
pub struct Columns {
    /// The id of the track.
    pub id: usize,
    /// The number of the frame.
    pub frame: Option<usize>,
    /// The time.
    pub time: Option<usize>,
    /// x, y and, in space, z.
    pub position: Vec<usize>,
    /// The type of the cell.
    pub kind: Option<usize>,
}

impl Head {
    /// Finds the columns in the line of their names.
    ///
    /// # Errors
    /// Names that are empty or there twice, or columns that are not there.
    pub fn of(source: &Arc<Source>, heading: Range<usize>, options: &Options) -> Result<Self> {
        let text = &source.text[heading.clone()];
        let sign = [',', ';', '\t'].into_iter().find(|sign| text.contains(*sign)).unwrap_or(',');
        let first = fields(&source.text, heading.clone(), sign);
        let twice = name_faults(source, &first);
        if !twice.is_empty() {
            return Err(Error::Input(twice));
        }
        let names: Vec<String> = first.into_iter().map(|field| field.text).collect();
        Ok(Self { sign, width: names.len(), columns: columns_of(source, &heading, &names, options)? })
    }

    /// The number of rows below the names that describe the columns: TrackMate says in up to three lines what its columns are and in which unit, and none of them has a
    /// number where numbers stand. A single line of words is a mistake in a row, which is to be told.
    pub fn described(&self, rows: &[Row]) -> usize {
        let Columns { frame, time, position, .. } = &self.columns;
        let has_numbers = |row: &Row| time.iter().chain(frame).chain(position).any(|column| row.has_number(*column));
        let first = &rows[..rows.len().min(3)];
        let lines = first.iter().position(has_numbers).unwrap_or(first.len());
        if lines > 1 && first[..lines].iter().any(|row| row.fields.len() == self.width) { lines } else { 0 }
    }
}

/// The sign of a unit that tools write as a word; other words as they are.
pub fn unit_sign(said: &str) -> &str {
    match said.to_ascii_lowercase().as_str() {
        "sec" | "secs" | "second" | "seconds" => "s",
        "mins" | "minute" | "minutes" => "min",
        "hr" | "hrs" | "hour" | "hours" => "h",
        "micron" | "microns" | "micrometer" | "micrometers" | "micrometre" | "micrometres" => "um",
        "millimeter" | "millimeters" | "millimetre" | "millimetres" => "mm",
        _ => said,
    }
}

/// The unit in brackets that rows below the names say of a column.
pub fn unit_in(described: &[Row], column: usize) -> Option<&str> {
    let said = described.iter().filter_map(|row| row.fields.get(column)).map(|field| field.text.as_str());
    said.filter_map(|text| text.strip_prefix('(')?.strip_suffix(')')).next_back()
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
