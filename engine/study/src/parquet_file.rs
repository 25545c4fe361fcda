//! Rows as Parquet: the same rows and notes give the same bytes.

use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::record::Field;
use parquet::schema::parser::parse_message_type;

use crate::error::{Result, StudyError};
use crate::row::{Kind, StudyRow, Value};

/// Rows of a group: what is held in memory at a time.
pub(crate) const GROUP: usize = 16_384;

/// What stands in a file besides its rows: names and values.
pub type Notes = Vec<(String, String)>;

/// Writes rows in groups of [`GROUP`].
pub(crate) struct RowWriter<W: Write + Send> {
    writer: SerializedFileWriter<W>,
    waiting: Vec<StudyRow>,
}

impl<W: Write + Send> RowWriter<W> {
    /// A file with these notes.
    pub fn new(to: W, notes: &Notes) -> std::result::Result<Self, ParquetError> {
        let columns: String = StudyRow::COLUMNS
            .iter()
            .map(|(name, kind)| match kind {
                Kind::Whole => format!("required int64 {name}; "),
                Kind::Number => format!("optional double {name}; "),
                Kind::Text => format!("optional binary {name} (UTF8); "),
                Kind::Flag => format!("required boolean {name}; "),
            })
            .collect();
        let schema = Arc::new(parse_message_type(&format!("message try_on {{ {columns} }}"))?);
        let notes = notes.iter().map(|(key, value)| KeyValue::new(key.clone(), value.clone())).collect();
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_created_by(format!("toile {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata(Some(notes))
            .build();
        Ok(Self { writer: SerializedFileWriter::new(to, schema, Arc::new(properties))?, waiting: Vec::new() })
    }

    /// Adds a row.
    pub fn push(&mut self, row: StudyRow) -> std::result::Result<(), ParquetError> {
        self.waiting.push(row);
        if self.waiting.len() == GROUP { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> std::result::Result<(), ParquetError> {
        let rows = std::mem::take(&mut self.waiting);
        if rows.is_empty() {
            return Ok(());
        }
        let mut columns: Vec<Vec<Value>> = StudyRow::COLUMNS.iter().map(|_| Vec::with_capacity(rows.len())).collect();
        for row in rows {
            columns.iter_mut().zip(row.values()).for_each(|(column, value)| column.push(value));
        }
        let mut group = self.writer.next_row_group()?;
        for ((_, kind), column) in StudyRow::COLUMNS.iter().zip(columns) {
            write_column(&mut group, *kind, column)?;
        }
        group.close()?;
        Ok(())
    }

    /// Writes what is left.
    pub fn finish(mut self) -> std::result::Result<W, ParquetError> {
        self.flush()?;
        self.writer.into_inner()
    }
}

fn write_column<W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    kind: Kind,
    values: Vec<Value>,
) -> std::result::Result<(), ParquetError> {
    let Some(mut column) = group.next_column()? else {
        return Err(ParquetError::General("a column is missing".to_owned()));
    };
    let (mut whole, mut numbers, mut texts, mut flags, mut there) = (vec![], vec![], vec![], vec![], vec![]);
    for value in values {
        match value {
            Value::Whole(value) => whole.push(value),
            Value::Flag(value) => flags.push(value),
            Value::Number(value) => {
                there.push(i16::from(value.is_some()));
                numbers.extend(value);
            }
            Value::Text(value) => {
                there.push(i16::from(value.is_some()));
                texts.extend(value.map(|text| ByteArray::from(text.into_bytes())));
            }
        }
    }
    match kind {
        Kind::Whole => column.typed::<Int64Type>().write_batch(&whole, None, None)?,
        Kind::Flag => column.typed::<BoolType>().write_batch(&flags, None, None)?,
        Kind::Text => column.typed::<ByteArrayType>().write_batch(&texts, Some(&there), None)?,
        Kind::Number => column.typed::<DoubleType>().write_batch(&numbers, Some(&there), None)?,
    };
    column.close()
}

/// A whole file of rows.
///
/// # Errors
/// None that a sound build has.
pub fn bytes_of(rows: impl IntoIterator<Item = StudyRow>, notes: &Notes) -> Result<Vec<u8>> {
    let mut writer = RowWriter::new(Vec::new(), notes).map_err(StudyError::internal)?;
    rows.into_iter().try_for_each(|row| writer.push(row)).map_err(StudyError::internal)?;
    writer.finish().map_err(StudyError::internal)
}

/// That a file holds no rows of a study.
fn no_rows(path: &Path, why: &dyn std::fmt::Display) -> StudyError {
    StudyError::Input(format!(
        "{}: it is no file of rows of a study ({why}); make it again by `toile study`",
        path.display()
    ))
}

fn opened(path: &Path) -> Result<SerializedFileReader<File>> {
    let file = File::open(path).map_err(|e| no_rows(path, &e))?;
    SerializedFileReader::new(file).map_err(|e| no_rows(path, &e))
}

/// The notes of a file.
///
/// # Errors
/// A file that is none of ours.
pub fn notes(path: &Path) -> Result<Notes> {
    Ok(opened(path)?.metadata().file_metadata().key_value_metadata().map_or_else(Vec::new, |all| {
        all.iter().map(|note| (note.key.clone(), note.value.clone().unwrap_or_default())).collect()
    }))
}

/// Reads each row of a file to `each`.
///
/// # Errors
/// A file that is none of ours; those of `each`.
pub fn read(path: &Path, mut each: impl FnMut(StudyRow) -> Result<()>) -> Result<()> {
    let refused = |why: &dyn std::fmt::Display| no_rows(path, why);
    let reader = opened(path)?;
    for found in reader.get_row_iter(None).map_err(|e| refused(&e))? {
        let found = found.map_err(|e| refused(&e))?;
        let mut row = StudyRow::default();
        for ((name, field), (_, kind)) in found.get_column_iter().zip(StudyRow::COLUMNS) {
            let value = match (kind, field) {
                (Kind::Whole, Field::Long(value)) => Value::Whole(*value),
                (Kind::Flag, Field::Bool(value)) => Value::Flag(*value),
                (Kind::Number, Field::Double(value)) => Value::Number(Some(*value)),
                (Kind::Number, Field::Null) => Value::Number(None),
                (Kind::Text, Field::Str(text)) => Value::Text(Some(text.clone())),
                (Kind::Text, Field::Null) => Value::Text(None),
                _ => return Err(refused(&format!("the column {name} holds something else"))),
            };
            row.set(name, value).ok_or_else(|| refused(&format!("the column {name} is not known")))?;
        }
        each(row)?;
    }
    Ok(())
}
