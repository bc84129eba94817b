//! A table of what a study measured, as comma-separated text and as Parquet.

#[cfg(feature = "parquet")]
mod parquet_file;

#[cfg(feature = "parquet")]
pub use parquet_file::parquet_bytes;

/// A column of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct TableColumn {
    /// Its title, with the unit in brackets.
    pub title: String,
    /// Its cells.
    pub cells: Cells,
}

/// The cells of a column; what is not known is empty.
#[derive(Debug, Clone, PartialEq)]
pub enum Cells {
    /// Whole numbers.
    Whole(Vec<Option<i64>>),
    /// Numbers.
    Numbers(Vec<Option<f64>>),
    /// Words.
    Words(Vec<Option<String>>),
}

impl Cells {
    /// A cell as text.
    fn text(&self, row: usize) -> String {
        match self {
            Self::Whole(cells) => cells[row].map(|number| number.to_string()),
            Self::Numbers(cells) => cells[row].map(|number| number.to_string()),
            Self::Words(cells) => cells[row].clone(),
        }
        .unwrap_or_default()
    }

    fn len(&self) -> usize {
        match self {
            Self::Whole(cells) => cells.len(),
            Self::Numbers(cells) => cells.len(),
            Self::Words(cells) => cells.len(),
        }
    }
}

/// A table as comma-separated text, a line of titles first. Numbers keep every digit.
pub fn csv_text(columns: &[TableColumn]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Writing to memory cannot fail, and all columns are as long.
    let _ = writer.write_record(columns.iter().map(|column| &column.title));
    for row in 0..columns.first().map_or(0, |column| column.cells.len()) {
        let _ = writer.write_record(columns.iter().map(|column| column.cells.text(row)));
    }
    String::from_utf8_lossy(&writer.into_inner().unwrap_or_default()).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_that_are_not_known_are_empty() {
        let column = |title: &str, cells| TableColumn { title: title.into(), cells };
        let columns = [
            column("run", Cells::Whole(vec![Some(1), Some(2)])),
            column("gap (um)", Cells::Numbers(vec![Some(0.1 + 0.2), None])),
            column("status, told", Cells::Words(vec![Some("complete".into()), None])),
        ];
        let text = "run,gap (um),\"status, told\"\n1,0.30000000000000004,complete\n2,,\n";
        assert_eq!(csv_text(&columns), text);
    }
}
