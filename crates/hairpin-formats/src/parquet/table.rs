//! A table in memory, written to one Parquet file and read back from whatever a Parquet writer made of it.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ::parquet::arrow::ArrowWriter;
use ::parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use ::parquet::basic::{Compression, Encoding};
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::{EnabledStatistics, WriterProperties};
use ::parquet::schema::types::ColumnPath;
use arrow_array::{ArrayRef, RecordBatch};
use arrow_schema::{DataType, Field, Schema};
use arrow_select::concat::concat_batches;
use thiserror::Error;

use super::guard::{check_footer, check_sizes, most_decoded};
use crate::atomic::{self, WriteError};
use crate::bounds::{self, MOST_RASTER_BYTES};
use crate::foreign;

/// Version of our schemas, in the metadata of every file.
pub const SCHEMA_VERSION: &str = "1";
const SCHEMA_KEY: &str = "hairpin.schema";
const VERSION_KEY: &str = "hairpin.schema_version";

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
    metadata: Vec<(String, String)>,
}

impl Columns {
    /// Appends a column; all columns of one table have the same number of rows.
    pub(crate) fn push(&mut self, name: impl Into<String>, array: ArrayRef) {
        self.fields.push(Field::new(name, array.data_type().clone(), true));
        self.arrays.push(array);
    }

    /// Adds a note to the file's metadata. Other writers drop it, so nothing may depend on it alone.
    pub(crate) fn note(&mut self, key: &str, value: String) {
        self.metadata.push((key.into(), value));
    }

    /// Writes the table: snappy, schema name and version in the metadata, the same bytes for the same columns.
    pub(crate) fn write(self, path: &Path, schema_name: &str) -> Result<(), WriteError> {
        let schema = Arc::new(Schema::new(self.fields));
        let batch = RecordBatch::try_new(schema.clone(), self.arrays).expect("columns of one table have equal lengths");
        let properties = properties(&schema, schema_name, self.metadata);
        atomic::write_with(path, |file| {
            let mut writer = ArrowWriter::try_new(file, schema.clone(), Some(properties)).map_err(io_error)?;
            writer.write(&batch).map_err(io_error)?;
            writer.close().map_err(io_error)?;
            Ok(())
        })
    }
}

fn properties(schema: &Schema, schema_name: &str, notes: Vec<(String, String)>) -> WriterProperties {
    let mut metadata = vec![
        KeyValue::new(SCHEMA_KEY.into(), schema_name.to_string()),
        KeyValue::new(VERSION_KEY.into(), SCHEMA_VERSION.to_string()),
    ];
    metadata.extend(notes.into_iter().map(|(key, value)| KeyValue::new(key, value)));
    let mut builder = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by("hairpin".into())
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_key_value_metadata(Some(metadata));
    for field in schema.fields() {
        // Measured numbers hardly repeat: their bytes side by side compress better than a dictionary.
        if field.data_type() == &DataType::Float64 {
            let column = ColumnPath::new(vec![field.name().clone()]);
            builder = builder
                .set_column_dictionary_enabled(column.clone(), false)
                .set_column_encoding(column, Encoding::BYTE_STREAM_SPLIT);
        }
    }
    builder.build()
}

fn io_error(error: ::parquet::errors::ParquetError) -> io::Error {
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

    /// Number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.batch.num_rows()
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
    check_footer(&mut file)?;
    let mut other = file.try_clone().map_err(|error| error.to_string())?;
    let builder = ParquetRecordBatchReaderBuilder::try_new(file).map_err(|error| error.to_string())?;
    let metadata = builder.metadata().file_metadata().key_value_metadata().map_or_else(Vec::new, |pairs| {
        pairs.iter().map(|pair| (pair.key.clone(), pair.value.clone().unwrap_or_default())).collect()
    });
    let schema = builder.schema().clone();
    check_sizes(&mut other, builder.metadata(), &schema, most)?;
    let reader = builder.build().map_err(|error| error.to_string())?;
    let (mut batches, mut taken) = (Vec::new(), 0);
    for batch in reader {
        let batch = batch.map_err(|error| error.to_string())?;
        taken += batch.get_array_memory_size() as u64;
        // Short batches have room to spare.
        if taken > 2 * most {
            return Err(format!("more than {most} bytes of rows are in it"));
        }
        batches.push(batch);
    }
    let batch = concat_batches(&schema, &batches).map_err(|error| error.to_string())?;
    Ok((batch, metadata))
}
