//! A table as an Apache Parquet file, which pandas, R, Julia, DuckDB and others read with the types of its columns.

use super::{Cells, TableColumn};
use crate::error::{Error, Result};
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{Type, TypePtr};
use std::sync::Arc;

/// The bytes of a table as a Parquet file: whole numbers and numbers of 64 bits, words in UTF-8, null where nothing is known. The same for the same
/// table.
///
/// # Errors
/// [`Error::Machine`] if the format refuses a table.
pub fn parquet_bytes(columns: &[TableColumn]) -> Result<Vec<u8>> {
    written(columns).map_err(|error| Error::Machine {
        message: format!("the table could not be written as Parquet: {error}"),
        help: "use the same table as comma-separated text".into(),
    })
}

fn written(columns: &[TableColumn]) -> std::result::Result<Vec<u8>, ParquetError> {
    let fields = columns.iter().map(field).collect::<std::result::Result<Vec<_>, _>>()?;
    let schema = Arc::new(Type::group_type_builder("study").with_fields(fields).build()?);
    let created = format!("pseudopod version {}", env!("CARGO_PKG_VERSION"));
    let properties = Arc::new(WriterProperties::builder().set_created_by(created).build());
    let mut bytes = Vec::new();
    let mut file = SerializedFileWriter::new(&mut bytes, schema, properties)?;
    let mut rows = file.next_row_group()?;
    for column in columns {
        let Some(mut writer) = rows.next_column()? else { break };
        write_cells(&mut writer, &column.cells)?;
        writer.close()?;
    }
    rows.close()?;
    file.close()?;
    Ok(bytes)
}

fn field(column: &TableColumn) -> std::result::Result<TypePtr, ParquetError> {
    let (physical, logical) = match &column.cells {
        Cells::Whole(_) => (Physical::INT64, None),
        Cells::Numbers(_) => (Physical::DOUBLE, None),
        Cells::Words(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let field = Type::primitive_type_builder(&column.title, physical).with_repetition(Repetition::OPTIONAL);
    Ok(Arc::new(field.with_logical_type(logical).build()?))
}

/// Writes cells: those that are there, and for all of them whether they are.
fn write_cells(writer: &mut SerializedColumnWriter, cells: &Cells) -> std::result::Result<(), ParquetError> {
    fn levels<T>(cells: &[Option<T>]) -> Vec<i16> {
        cells.iter().map(|cell| i16::from(cell.is_some())).collect()
    }
    match cells {
        Cells::Whole(cells) => {
            let values: Vec<i64> = cells.iter().flatten().copied().collect();
            writer.typed::<Int64Type>().write_batch(&values, Some(&levels(cells)), None)
        }
        Cells::Numbers(cells) => {
            let values: Vec<f64> = cells.iter().flatten().copied().collect();
            writer.typed::<DoubleType>().write_batch(&values, Some(&levels(cells)), None)
        }
        Cells::Words(cells) => {
            let values: Vec<ByteArray> = cells.iter().flatten().map(|text| ByteArray::from(text.as_str())).collect();
            writer.typed::<ByteArrayType>().write_batch(&values, Some(&levels(cells)), None)
        }
    }
    .map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;

    #[test]
    fn a_table_is_read_back_and_is_the_same_bytes_again() {
        let column = |title: &str, cells| TableColumn { title: title.into(), cells };
        let columns = [
            column("run", Cells::Whole(vec![Some(1), Some(2), Some(3)])),
            column("gap (um)", Cells::Numbers(vec![Some(0.1), None, Some(-2.5)])),
            column("status", Cells::Words(vec![Some("complete".into()), None, Some("µ".into())])),
        ];
        let bytes = parquet_bytes(&columns).unwrap();
        assert_eq!(bytes, parquet_bytes(&columns).unwrap());
        let reader = SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap();
        let rows: Vec<Vec<(String, Field)>> =
            reader.get_row_iter(None).unwrap().map(|row| row.unwrap().into_columns()).collect();
        assert_eq!(rows.len(), 3);
        assert_eq!(rows[0][1], ("gap (um)".to_owned(), Field::Double(0.1)));
        assert_eq!(rows[1][1].1, Field::Null);
        assert_eq!(rows[2][0].1, Field::Long(3));
        assert_eq!(rows[2][2].1, Field::Str("µ".into()));
    }
}
