//! A table in memory, written to one Parquet file and read back from whatever a Parquet writer made of it.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ::parquet::arrow::arrow_reader::{ArrowReaderMetadata, ParquetRecordBatchReader};
use ::parquet::arrow::{ArrowWriter, ProjectionMask, parquet_to_arrow_field_levels};
use ::parquet::basic::{Compression, Encoding};
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::{EnabledStatistics, WriterProperties, WriterPropertiesBuilder};
use ::parquet::schema::types::ColumnPath;
use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use arrow_array::{Array, ArrayRef, Float64Array, RecordBatch};
use arrow_schema::{Field, Schema};
use arrow_select::concat::concat_batches;
use bytes::Bytes;
use thiserror::Error;

use super::groups::Groups;
use super::guard::{check_sizes, most_decoded, read_footer};
use crate::atomic::{self, WriteError};
use crate::bounds::{self, MOST_RASTER_BYTES};
use crate::foreign;

/// Version of our schemas, in the metadata of every file.
pub const SCHEMA_VERSION: &str = "1";
const SCHEMA_KEY: &str = "hairpin.schema";
const VERSION_KEY: &str = "hairpin.schema_version";
/// Note: the time between samples of which only some rows are there, s.
pub(super) const PERIOD: &str = "hairpin.sample_s";
/// Note: how many rows were written.
const ROWS: &str = "hairpin.rows";
/// Column: what the rows are of.
pub(super) const CASE: &str = "case";
/// Column: the number of the run that they are of.
pub(super) const RUN: &str = "run";
/// Rows between two looks at how much memory they take.
const ROWS_AT_ONCE: usize = 1024;

/// Why a Parquet file is not the table it should be.
#[derive(Debug, Error)]
pub enum TableError {
    /// The file cannot be opened.
    #[error("cannot read {}: {cause}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's answer.
        cause: io::Error,
    },
    /// The file is there and is no sound Parquet file.
    #[error("{} is not a Parquet file that can be read: {cause}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// What the decoder says.
        cause: String,
    },
    /// A column is missing or has a type that cannot be converted.
    #[error("{}: column `{column}`: {found}, must be {expected}", path.display())]
    Column {
        /// The file.
        path: PathBuf,
        /// Its column.
        column: String,
        /// What is there.
        found: String,
        /// What must be there.
        expected: String,
    },
    /// Rows that were written are not there any more.
    #[error("{}: {found} rows, must be {written}, as many as were written: remove it, and hairpin execute --resume makes it anew", path.display())]
    Rows {
        /// The file.
        path: PathBuf,
        /// Rows that are there.
        found: usize,
        /// Rows that were.
        written: usize,
    },
    /// A value is out of its bounds.
    #[error("{}: column `{column}`, row {row}: {value}, must be {bound}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Its column.
        column: String,
        /// Row, counted from 0.
        row: usize,
        /// The value found.
        value: String,
        /// What it must be.
        bound: String,
    },
}

/// Columns of equal length on their way into a file.
#[derive(Debug, Default)]
pub(crate) struct Columns {
    fields: Vec<Field>,
    arrays: Vec<ArrayRef>,
}

impl Columns {
    /// Appends a column; all columns of one table have the same number of rows.
    pub(crate) fn push(&mut self, name: impl Into<String>, array: ArrayRef) {
        self.fields.push(Field::new(name, array.data_type().clone(), true));
        self.arrays.push(array);
    }

    /// The same with every column of numbers as `map` has it.
    pub(super) fn map_numbers(mut self, map: impl Fn(&str, &Float64Array) -> ArrayRef) -> Self {
        for (field, array) in self.fields.iter_mut().zip(&mut self.arrays) {
            if let Some(values) = array.as_primitive_opt::<Float64Type>() {
                let mapped = map(field.name(), values);
                *field = Field::new(field.name(), mapped.data_type().clone(), true);
                *array = mapped;
            }
        }
        self
    }

    /// The rows, to be written as one group of a part.
    pub(super) fn into_batch(self) -> RecordBatch {
        let schema = Arc::new(Schema::new(self.fields));
        RecordBatch::try_new(schema, self.arrays).expect("columns of one table have equal lengths")
    }

    /// Writes the table: snappy, schema name and version in the metadata, the same bytes for the same columns.
    pub(crate) fn write(self, path: &Path, schema_name: &str) -> Result<(), WriteError> {
        self.write_noting(path, schema_name, &[])
    }

    /// The same with the number of rows in the metadata, of a table that nothing else says the length of.
    pub(super) fn write_counted(self, path: &Path, schema_name: &str) -> Result<(), WriteError> {
        let rows = self.arrays.first().map_or(0, |column| column.len());
        self.write_noting(path, schema_name, &[(ROWS.to_owned(), rows.to_string())])
    }

    fn write_noting(self, path: &Path, schema_name: &str, more: &[(String, String)]) -> Result<(), WriteError> {
        let batch = self.into_batch();
        let schema = batch.schema();
        let properties = properties(&schema)
            .set_statistics_enabled(EnabledStatistics::Chunk)
            .set_key_value_metadata(Some(notes(schema_name, more)))
            .build();
        atomic::write_with(path, |file| {
            let mut writer = ArrowWriter::try_new(file, schema.clone(), Some(properties)).map_err(io_error)?;
            writer.write(&batch).map_err(io_error)?;
            writer.close().map_err(io_error)?;
            Ok(())
        })
    }
}

/// What stands in the metadata of a file: its schema, and `more`.
pub(super) fn notes(schema_name: &str, more: &[(String, String)]) -> Vec<KeyValue> {
    let own = [(SCHEMA_KEY, schema_name), (VERSION_KEY, SCHEMA_VERSION)];
    let more = more.iter().map(|(key, value)| (key.as_str(), value.as_str()));
    own.into_iter().chain(more).map(|(key, value)| KeyValue::new(key.into(), value.to_string())).collect()
}

/// How columns are packed.
pub(super) fn properties(schema: &Schema) -> WriterPropertiesBuilder {
    let mut builder = WriterProperties::builder().set_compression(Compression::SNAPPY).set_created_by("hairpin".into());
    for field in schema.fields() {
        // Measured numbers hardly repeat: their bytes side by side compress better than a dictionary.
        if field.data_type().is_floating() {
            let column = ColumnPath::new(vec![field.name().clone()]);
            builder = builder
                .set_column_dictionary_enabled(column.clone(), false)
                .set_column_encoding(column, Encoding::BYTE_STREAM_SPLIT);
        }
    }
    builder
}

pub(super) fn io_error(error: ::parquet::errors::ParquetError) -> io::Error {
    match error {
        ::parquet::errors::ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(cause) => *cause,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}

/// A table as read.
#[derive(Debug)]
pub(crate) struct Table {
    pub(super) path: PathBuf,
    pub(super) batch: RecordBatch,
    metadata: Vec<(String, String)>,
}

impl Table {
    /// Rows that were read by themselves.
    pub(super) fn of(path: &Path, batch: RecordBatch) -> Self {
        Self { path: path.into(), batch, metadata: Vec::new() }
    }

    /// Reads the whole file, however its rows are grouped and compressed.
    pub(crate) fn read(path: &Path) -> Result<Self, TableError> {
        let unreadable = |cause| TableError::Unreadable { path: path.into(), cause };
        let broken = |cause: String| TableError::Broken { path: path.into(), cause };
        let file = bounds::open(path, MOST_RASTER_BYTES).map_err(unreadable)?;
        let decoded = foreign::call(|| decode(file));
        let (batch, metadata) =
            decoded.unwrap_or_else(|_| Err("its bytes contradict each other".into())).map_err(broken)?;
        Ok(Self { path: path.into(), batch, metadata })
    }

    /// Whether there is such a column.
    pub(crate) fn has(&self, column: &str) -> bool {
        self.batch.column_by_name(column).is_some()
    }

    /// The rows in those columns that are not empty throughout.
    pub(super) fn without_empty_columns(&self) -> RecordBatch {
        let columns = self.batch.columns().iter().enumerate();
        let full = columns.filter(|(_, column)| column.null_count() < column.len() || column.is_empty());
        let places: Vec<usize> = full.map(|(place, _)| place).collect();
        self.batch.project(&places).expect("columns are chosen among those that are there")
    }

    /// Number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.batch.num_rows()
    }

    /// # Errors
    /// Fewer or more rows than were written, where the file says how many that were.
    pub(super) fn check_rows(&self) -> Result<(), TableError> {
        let written = self.note(ROWS).and_then(|rows| rows.parse::<usize>().ok());
        match written.filter(|written| *written != self.rows()) {
            Some(written) => Err(TableError::Rows { path: self.path.clone(), found: self.rows(), written }),
            None => Ok(()),
        }
    }

    /// Names of the columns in the file's order.
    pub(crate) fn names(&self) -> Vec<String> {
        self.batch.schema().fields().iter().map(|field| field.name().clone()).collect()
    }

    /// A note from the file's metadata, if the last writer kept it.
    pub(crate) fn note(&self, key: &str) -> Option<&str> {
        self.metadata.iter().find(|(k, _)| k == key).map(|(_, value)| value.as_str())
    }

    /// The error for a value of this table.
    pub(crate) fn refuse(
        &self,
        column: &str,
        row: usize,
        value: impl ToString,
        bound: impl Into<String>,
    ) -> TableError {
        TableError::Value {
            path: self.path.clone(),
            column: column.into(),
            row,
            value: value.to_string(),
            bound: bound.into(),
        }
    }
}

type Decoded = (RecordBatch, Vec<(String, String)>);

fn decode(mut file: File) -> Result<Decoded, String> {
    let most = most_decoded(file.metadata().map_err(|error| error.to_string())?.len());
    let metadata = read_footer(&mut file)?;
    let groups: Vec<usize> = (0..metadata.metadata().num_row_groups()).collect();
    let batch = decode_groups(&file, &metadata, &groups, most)?;
    Ok((batch, notes_of(&metadata)))
}

/// The notes in a file's metadata.
pub(super) fn notes_of(metadata: &ArrowReaderMetadata) -> Vec<(String, String)> {
    metadata.metadata().file_metadata().key_value_metadata().map_or_else(Vec::new, |pairs| {
        pairs.iter().map(|pair| (pair.key.clone(), pair.value.clone().unwrap_or_default())).collect()
    })
}

/// The rows of a file of our own in memory.
pub(super) fn decode_groups_of(bytes: &Bytes, metadata: &ArrowReaderMetadata) -> Result<RecordBatch, String> {
    rows_of(&Groups::of(bytes, metadata.metadata()), metadata, u64::MAX)
}

/// The rows of `groups`, which may come to `most` bytes.
pub(super) fn decode_groups(
    file: &File,
    metadata: &ArrowReaderMetadata,
    groups: &[usize],
    most: u64,
) -> Result<RecordBatch, String> {
    let groups = Groups::read(file, metadata.metadata(), groups, most).map_err(|error| error.to_string())?;
    check_sizes(&groups, metadata.schema(), most)?;
    rows_of(&groups, metadata, most)
}

fn rows_of(groups: &Groups<'_>, metadata: &ArrowReaderMetadata, most: u64) -> Result<RecordBatch, String> {
    let schema = metadata.schema();
    let all = ProjectionMask::all();
    let reader = parquet_to_arrow_field_levels(metadata.parquet_schema(), all, Some(schema.fields()))
        .and_then(|levels| ParquetRecordBatchReader::try_new_with_row_groups(&levels, groups, ROWS_AT_ONCE, None));
    let (mut batches, mut taken) = (Vec::new(), 0_u64);
    for batch in reader.map_err(|error| error.to_string())? {
        let batch = batch.map_err(|error| error.to_string())?;
        taken += batch.get_array_memory_size() as u64;
        // Short batches have room to spare.
        if taken > most.saturating_mul(2) {
            return Err(format!("more than {most} bytes of rows are in it"));
        }
        batches.push(batch);
    }
    concat_batches(schema, &batches).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tools that cut rows off leave the file's notes as they are.
    #[test]
    fn rows_that_were_cut_off_are_missed() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("baseline.parquet");
        let columns = |rows: usize| {
            let mut columns = Columns::default();
            columns.push("x", Arc::new(Float64Array::from(vec![1.0; rows])));
            columns
        };
        columns(3).write_counted(&path, "results").unwrap();
        assert!(Table::read(&path).unwrap().check_rows().is_ok());
        columns(2).write_noting(&path, "results", &[(ROWS.to_owned(), "3".to_owned())]).unwrap();
        let told = Table::read(&path).unwrap().check_rows().unwrap_err().to_string();
        assert!(told.contains("baseline.parquet: 2 rows, must be 3"), "{told}");
        // Of an earlier version, which says nothing of it.
        columns(2).write(&path, "results").unwrap();
        assert!(Table::read(&path).unwrap().check_rows().is_ok());
    }
}
