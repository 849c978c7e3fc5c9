//! A piece: the rows of one case or run, packed as they will stand in a part of a table, a row group of its own.

use std::cell::RefCell;
use std::io;
use std::sync::Arc;

use ::parquet::arrow::arrow_reader::{ArrowReaderMetadata, ArrowReaderOptions};
use ::parquet::basic::Compression;
use ::parquet::file::metadata::ParquetMetaDataReader;
use ::parquet::file::properties::{EnabledStatistics, WriterProperties};
use ::parquet::schema::types::ColumnPath;
use arrow_array::{RecordBatch, new_null_array};
use arrow_cast::cast;
use arrow_schema::{DataType, Field, Schema};

use super::compressed::{Layout, Packed};
use super::table::{CASE, Columns, RUN, decode_groups_of, io_error, properties};
use crate::channels::LEG;

thread_local! {
    static LAYOUT: RefCell<Option<Layout>> = const { RefCell::new(None) };
}

/// The rows of one case or run, packed.
#[derive(Debug, Clone)]
pub struct Piece {
    pub(super) packed: Packed,
    /// Its columns.
    pub(super) fields: Arc<[Field]>,
    /// Time between the samples of which only some rows are there, s.
    pub(super) period: Option<f64>,
}

impl Piece {
    pub(super) fn of(columns: Columns) -> io::Result<Self> {
        Self::of_batch(&columns.into_batch(), None)
    }

    /// The rows of a motion, sampled every `period` s, of which only some are there.
    pub(super) fn thinned(columns: Columns, period: Option<f64>) -> io::Result<Self> {
        Self::of_batch(&columns.into_batch(), period)
    }

    pub(super) fn of_batch(batch: &RecordBatch, period: Option<f64>) -> io::Result<Self> {
        let schema = batch.schema();
        let packed = LAYOUT.with_borrow_mut(|known| {
            // Pieces of one table hardly ever differ in their columns.
            let layout = match known.take().filter(|known| *known.schema() == schema) {
                Some(layout) => layout,
                None => Layout::of(schema.clone(), encoding(&schema))?,
            };
            known.insert(layout).packed(batch)
        })?;
        let fields = schema.fields().iter().map(|field| field.as_ref().clone()).collect();
        Ok(Self { packed, fields, period })
    }

    /// The same with the columns `fields`: numbers in other widths, and columns that it has not empty.
    pub(super) fn with_fields(&self, fields: &Arc<[Field]>) -> io::Result<Self> {
        if self.fields == *fields {
            return Ok(self.clone());
        }
        let bytes = self.packed.to_file()?;
        let metadata = ParquetMetaDataReader::new().parse_and_finish(&bytes);
        let metadata = metadata.and_then(|all| ArrowReaderMetadata::try_new(Arc::new(all), ArrowReaderOptions::new()));
        let batch = decode_groups_of(&bytes, &metadata.map_err(io_error)?).map_err(io::Error::other)?;
        let column = |field: &Field| match batch.column_by_name(field.name()) {
            Some(column) => cast(column, field.data_type()).map_err(io::Error::other),
            None => Ok(new_null_array(field.data_type(), batch.num_rows())),
        };
        let columns = fields.iter().map(column).collect::<io::Result<Vec<_>>>()?;
        let schema = Arc::new(Schema::new(fields.to_vec()));
        let batch = RecordBatch::try_new(schema, columns).map_err(io::Error::other)?;
        Self::of_batch(&batch, self.period)
    }
}

/// How the columns of a piece are encoded.
fn encoding(schema: &Schema) -> WriterProperties {
    // Of a hundred rows a dictionary is a page more, and longer than what it saves but where few values take turns.
    let mut builder = properties(schema)
        .set_dictionary_enabled(false)
        .set_column_dictionary_enabled(ColumnPath::new(vec![LEG.into()]), true)
        .set_statistics_enabled(EnabledStatistics::None)
        .set_compression(Compression::UNCOMPRESSED);
    for key in [CASE, RUN] {
        // What tells one piece from another without reading it.
        builder = builder.set_column_statistics_enabled(ColumnPath::new(vec![key.into()]), EnabledStatistics::Chunk);
    }
    builder.set_offset_index_disabled(true).build()
}

/// The columns of all that `pieces` have, by first appearance; where their types differ, floating-point numbers.
pub(super) fn union<'a>(pieces: impl Iterator<Item = &'a Arc<[Field]>>) -> Arc<[Field]> {
    let mut all: Option<Vec<Field>> = None;
    let mut before: Option<&Arc<[Field]>> = None;
    for fields in pieces {
        if before.is_some_and(|before| Arc::ptr_eq(before, fields) || before == fields) {
            continue;
        }
        before = Some(fields);
        let Some(all) = &mut all else {
            all = Some(fields.to_vec());
            continue;
        };
        for field in fields.iter() {
            match all.iter_mut().find(|known| known.name() == field.name()) {
                None => all.push(field.clone()),
                Some(known) if known.data_type() != field.data_type() && known.data_type().is_numeric() => {
                    *known = Field::new(known.name(), DataType::Float64, true);
                }
                Some(_) => {}
            }
        }
    }
    all.unwrap_or_default().into()
}
