//! Measured tables: CSV files with named columns, read with errors that point at the faulty cell.

use super::csv_fields::{fields, lines, location, missing_column, name_faults, number, number_fault};
use crate::error::{Error, Fault, Result, Source};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// A table of numbers with a name for each column.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    source: Arc<Source>,
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
    /// The bytes of the line of names, to point at.
    heading: Range<usize>,
}

impl Table {
    /// Reads a table from a file, see [`Table::parse`]. Faults name the file as `path` is written.
    ///
    /// # Errors
    /// When the file cannot be read, and as [`Table::parse`].
    pub fn read(path: &Path) -> Result<Self> {
        let text = crate::files::read_text(path).map_err(|error| {
            let found = format!("the table {} cannot be read: {error}", path.display());
            Error::input(Fault::new(found).help("give the path of a CSV file with a line of column names"))
        })?;
        Self::parse(&path.display().to_string(), &text)
    }

    /// Reads a table from text: a line of column names, then a line of numbers for each row.
    ///
    /// Fields are parted by commas. Empty lines and lines that start with `#` are passed over; an empty field is a
    /// value that was not measured and becomes NaN.
    ///
    /// # Errors
    /// With all faults found: no names, a name used twice, too few or too many fields, a field that is no number.
    pub fn parse(name: &str, text: &str) -> Result<Self> {
        let source = Arc::new(Source { name: name.to_owned(), text: text.to_owned() });
        let mut lines = lines(text).map(|range| (range.clone(), fields(text, range, ',')));
        let Some((heading, first)) = lines.next() else {
            let fault = Fault::new(format!("the table {name} is empty"));
            return Err(Error::input(fault.help("start it with a line of column names, parted by commas")));
        };
        let mut faults = name_faults(&source, &first);
        let names: Vec<String> = first.into_iter().map(|field| field.text).collect();
        let mut columns = vec![Vec::new(); names.len()];
        for (line, fields) in lines {
            if fields.len() != names.len() {
                let found = format!("a row of {} fields under {} column names", fields.len(), names.len());
                let fault = Fault::new(found).at(location(&source, line, "in this row"));
                faults.push(fault.help("give one number for each column; leave a missing one empty"));
                continue;
            }
            for (column, field) in columns.iter_mut().zip(fields) {
                match number(&field.text) {
                    Some(value) => column.push(value),
                    None => faults.push(number_fault(&source, field)),
                }
            }
        }
        if faults.is_empty() { Ok(Self { source, names, columns, heading }) } else { Err(Error::Input(faults)) }
    }

    /// The names of the columns, in the order of the file.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// Adds a number to all of a column.
    ///
    /// # Errors
    /// When there is no such column.
    pub fn shift(&mut self, name: &str, by: f64) -> Result<()> {
        self.column(name)?;
        let columns = self.names.iter().zip(&mut self.columns).filter(|(known, _)| *known == name);
        columns.flat_map(|(_, column)| column).for_each(|value| *value += by);
        Ok(())
    }

    /// A column by its name; NaN where nothing was measured.
    ///
    /// # Errors
    /// When there is no such column.
    pub fn column(&self, name: &str) -> Result<&[f64]> {
        if let Some(index) = self.names.iter().position(|known| known == name) {
            return Ok(&self.columns[index]);
        }
        Err(Error::input(missing_column(&self.source, &self.heading, &self.names, name)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults(text: &str) -> Vec<Fault> {
        let Err(Error::Input(faults)) = Table::parse("pull.csv", text) else { panic!("no faults in {text:?}") };
        faults
    }

    fn marked(fault: &Fault) -> &str {
        let location = fault.location.as_ref().unwrap();
        &location.source.text[location.start..location.start + location.length]
    }

    #[test]
    fn columns_are_found_by_name() {
        let text = "\u{feff}# Mills et al. 2004\nF_pN, A_um ,\"low, um\"\r\n0,7.738,7.16\n\n16,9.155,\n";
        let table = Table::parse("pull.csv", text).unwrap();
        assert_eq!(table.names(), ["F_pN", "A_um", "low, um"]);
        assert_eq!(table.rows(), 2);
        assert_eq!(table.column("A_um").unwrap(), [7.738, 9.155]);
        assert!(table.column("low, um").unwrap()[1].is_nan());
    }

    #[test]
    fn all_faulty_cells_are_pointed_at() {
        let faults = faults("a,b\n1,two\n3\n inf ,5\n");
        assert_eq!(faults.iter().map(marked).collect::<Vec<_>>(), ["two", "3", "inf"]);
        assert_eq!(faults[1].message, "a row of 1 fields under 2 column names");
    }

    #[test]
    fn names_must_be_there_and_differ() {
        assert!(faults("# nothing\n")[0].message.contains("empty"));
        let faults = faults("a,,a\n");
        assert_eq!(faults[0].message, "column 2 has no name");
        assert_eq!(marked(&faults[1]), "a");
    }

    #[test]
    fn a_misspelt_column_is_guessed() {
        let table = Table::parse("pull.csv", "F_pN,A_um\n1,2\n").unwrap();
        let Err(Error::Input(faults)) = table.column("F_pn") else { panic!("found a column that is not there") };
        assert_eq!(faults[0].help.as_deref(), Some("its columns are F_pN, A_um; did you mean \"F_pN\"?"));
        assert_eq!(marked(&faults[0]), "F_pN,A_um");
        assert!(Table::read(Path::new("no/such.csv")).unwrap_err().to_string().contains("no/such.csv"));
    }
}
