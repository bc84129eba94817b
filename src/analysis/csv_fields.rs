//! The lines and fields of CSV files, each with where it stands, so that faults can point at it.

use crate::error::{Fault, Location, Source};
use std::ops::Range;
use std::sync::Arc;

/// One field of a line, without the blanks around it, and where it stands.
pub struct Field {
    /// What it says.
    pub text: String,
    /// Its bytes in the text.
    pub range: Range<usize>,
}

/// The byte ranges of the lines that count.
pub fn lines(text: &str) -> impl Iterator<Item = Range<usize>> {
    // A byte order mark, as spreadsheets write it, belongs to no name.
    let mut start = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    let ranges = text[start..].split_inclusive('\n').map(move |line| {
        // Tabs at the end part empty fields.
        let range = start..start + line.trim_end_matches(['\r', '\n', ' ']).len();
        start += line.len();
        range
    });
    let counts = |content: &str| !content.is_empty() && !content.starts_with('#');
    ranges.filter(move |range| counts(text[range.clone()].trim()))
}

/// Parts a line at its commas, or another sign; the crate csv takes quotes away where there are any.
pub fn fields(text: &str, line: Range<usize>, sign: char) -> Vec<Field> {
    let content = &text[line.clone()];
    if content.contains('"') {
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .delimiter(sign as u8)
            .trim(csv::Trim::All)
            .from_reader(content.as_bytes());
        let record = reader.records().next().and_then(std::result::Result::ok).unwrap_or_default();
        // Quotes may hide commas, so the whole line is what can be pointed at.
        return record.iter().map(|field| Field { text: field.to_owned(), range: line.clone() }).collect();
    }
    let mut start = line.start;
    let part = |field: &str| {
        let blanks = field.len() - field.trim_start().len();
        let text = field.trim().to_owned();
        let range = start + blanks..start + blanks + text.len();
        start += field.len() + sign.len_utf8();
        Field { text, range }
    };
    content.split(sign).map(part).collect()
}

/// The number that a field says; NaN for an empty one, none for anything but a finite number.
pub fn number(field: &str) -> Option<f64> {
    if field.is_empty() {
        return Some(f64::NAN);
    }
    field.parse().ok().filter(|value: &f64| value.is_finite())
}

/// That a field holds no number.
pub fn number_fault(source: &Arc<Source>, field: Field) -> Fault {
    let fault = Fault::new(format!("\"{}\" is not a number", field.text));
    let location = location(source, field.range, "expected a finite number");
    fault
        .at(location)
        .help("write numbers with a point, such as 15.987, and leave a field empty where nothing was measured")
}

/// That there is no such column, which there are, and which may have been meant.
pub fn missing_column(source: &Arc<Source>, heading: &Range<usize>, names: &[String], name: &str) -> Fault {
    let near = names.iter().map(|known| (strsim::jaro_winkler(known, name), known));
    let near = near.filter(|(likeness, _)| *likeness > 0.8).max_by(|a, b| a.0.total_cmp(&b.0));
    let guess = near.map_or(String::new(), |(_, known)| format!("; did you mean \"{known}\"?"));
    let fault = Fault::new(format!("there is no column \"{name}\" in {}", source.name));
    let help = format!("its columns are {}{guess}", names.join(", "));
    fault.at(location(source, heading.clone(), "these are the columns")).help(help)
}

/// Finds column names that are empty or used twice.
pub fn name_faults(source: &Arc<Source>, names: &[Field]) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (index, field) in names.iter().enumerate() {
        let location = location(source, field.range.clone(), "this name");
        if field.text.is_empty() {
            faults.push(
                Fault::new(format!("column {} has no name", index + 1)).at(location).help("give each column a name"),
            );
        } else if names[..index].iter().any(|earlier| earlier.text == field.text) {
            let fault = Fault::new(format!("two columns are called \"{}\"", field.text));
            faults.push(fault.at(location).help("give each column a name of its own"));
        }
    }
    faults
}

/// Bytes of a text, with what is to be said of them.
pub fn location(source: &Arc<Source>, range: Range<usize>, label: &str) -> Location {
    Location { source: source.clone(), start: range.start, length: range.len(), label: label.to_owned() }
}
