//! A small Parquet file whose pages are compressed by one compressor for all of its columns.
//!
//! The writer of the crate `parquet` makes a compressor and a decompressor for each column of each row group, and each
//! of them asks the processor three times what it can do. On a virtual machine the host answers that: for pieces of a
//! hundred rows it took ten times as long as compressing them. So its columns are written without one, and their pages
//! are compressed as they lie in a store of our own.

use std::cell::RefCell;
use std::io;
use std::sync::{Arc, Mutex, PoisonError};

use ::parquet::arrow::ArrowSchemaConverter;
use ::parquet::arrow::arrow_writer::{
    ArrowColumnChunk, ArrowRowGroupWriterFactory, PageKey, PageStore, PageStoreArgs, PageStoreFactory, compute_leaves,
};
use ::parquet::basic::{Compression, ZstdLevel};
use ::parquet::column::writer::ColumnCloseResult;
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::ColumnChunkMetaData;
use ::parquet::file::properties::{WriterProperties, WriterPropertiesPtr};
use ::parquet::file::writer::SerializedFileWriter;
use ::parquet::schema::types::TypePtr;
use arrow_array::RecordBatch;
use arrow_schema::SchemaRef;
use bytes::Bytes;
use zstd::bulk::Compressor;

use super::table::{RUN, io_error};

/// What most programs take Zstandard at: the next percent would cost more than it is worth.
const LEVEL: i32 = 3;
/// Of plans, which a search writes by the thousand in a second: without codes for single bytes, which cost more than
/// half of the time and save a fortieth. (Of what was executed, most of a campaign, they save a fourteenth.)
const QUICK: i32 = -1;

thread_local! {
    static COMPRESSOR: RefCell<Option<(i32, Compressor<'static>)>> = const { RefCell::new(None) };
}

/// How the rows of tables with the same columns are packed.
#[derive(Debug)]
pub(super) struct Layout {
    schema: SchemaRef,
    root: TypePtr,
    columns: ArrowRowGroupWriterFactory,
    pages: Pages,
    level: i32,
    properties: WriterPropertiesPtr,
}

impl Layout {
    /// Of tables with the columns of `schema`, which `encoding` says how to encode; it must ask for no compression, and
    /// for no index.
    pub(super) fn of(schema: SchemaRef, encoding: WriterProperties) -> io::Result<Self> {
        let root = ArrowSchemaConverter::new().convert(&schema).map_err(io_error)?.root_schema_ptr();
        let writer = SerializedFileWriter::new(Vec::new(), root.clone(), Arc::new(encoding)).map_err(io_error)?;
        let pages = Pages::default();
        let columns = ArrowRowGroupWriterFactory::new(&writer, schema.clone());
        let columns = columns.with_page_store_factory(Arc::new(pages.clone()));
        let properties = Arc::new(WriterProperties::builder().set_created_by("hairpin".into()).build());
        let level = if schema.column_with_name(RUN).is_some() { LEVEL } else { QUICK };
        Ok(Self { schema, root, columns, pages, level, properties })
    }

    /// What it is the layout of.
    pub(super) fn schema(&self) -> &SchemaRef {
        &self.schema
    }

    /// The rows as one row group: the bytes of its pages are those that the writer itself makes of them.
    pub(super) fn packed(&self, batch: &RecordBatch) -> io::Result<Bytes> {
        // Many of them wait in memory: without room to spare.
        self.file_of(batch).map(|bytes| bytes.into_boxed_slice().into()).map_err(io_error)
    }

    fn file_of(&self, batch: &RecordBatch) -> Result<Vec<u8>, ParquetError> {
        // A piece that failed may have left some.
        drop(self.pages.taken());
        let mut writer = SerializedFileWriter::new(Vec::new(), self.root.clone(), self.properties.clone())?;
        if batch.num_rows() > 0 {
            let mut group = writer.next_row_group()?;
            let mut columns = self.columns.create_column_writers(0)?.into_iter();
            for (field, array) in self.schema.fields().iter().zip(batch.columns()) {
                for (leaf, mut column) in compute_leaves(field, array)?.iter().zip(columns.by_ref()) {
                    column.write(leaf)?;
                    let (bytes, close) = self.compressed(&column.close()?, batch.num_rows())?;
                    group.append_column(&bytes, close)?;
                }
            }
            group.close()?;
        }
        writer.into_inner()
    }

    /// The column whose pages wait in the store.
    fn compressed(&self, plain: &ArrowColumnChunk, rows: usize) -> Result<(Bytes, ColumnCloseResult), ParquetError> {
        let metadata = plain.close().metadata.clone();
        let stored = self.pages.taken();
        let (mut pages, has_dictionary) =
            (stored.as_chunks::<2>().0.to_vec(), metadata.dictionary_page_offset().is_some());
        if has_dictionary {
            // It is the last that is known, and the first that is read.
            pages.rotate_right(1);
        }
        let (mut bytes, mut unpacked, mut first) = (Vec::new(), 0, 0);
        for (number, [header, page]) in pages.iter().enumerate() {
            let packed = packed(page, self.level)?;
            let header = with_packed_size(header, packed.len());
            let header = header.ok_or_else(|| ParquetError::General("a page without a header".into()))?;
            if number == usize::from(has_dictionary) {
                first = bytes.len() as i64;
            }
            unpacked += (header.len() + page.len()) as i64;
            bytes.extend_from_slice(&header);
            bytes.extend_from_slice(&packed);
        }
        let metadata = metadata
            .into_builder()
            .set_compression(Compression::ZSTD(ZstdLevel::try_new(LEVEL)?))
            .set_total_compressed_size(bytes.len() as i64)
            .set_total_uncompressed_size(unpacked)
            .set_dictionary_page_offset(has_dictionary.then_some(0))
            .set_data_page_offset(first)
            .build()?;
        Ok((bytes.into(), closed(metadata, rows)))
    }
}

/// Pages of the one column that is being written: the header of each, and what it is of.
#[derive(Debug, Clone, Default)]
struct Pages(Arc<Mutex<Vec<Bytes>>>);

impl Pages {
    fn taken(&self) -> Vec<Bytes> {
        std::mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl PageStoreFactory for Pages {
    fn create(&self, _of: &PageStoreArgs<'_>) -> Result<Box<dyn PageStore>, ParquetError> {
        Ok(Box::new(self.clone()))
    }
}

impl PageStore for Pages {
    fn put(&mut self, bytes: Bytes) -> Result<PageKey, ParquetError> {
        let mut stored = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        stored.push(bytes);
        Ok(PageKey::new(stored.len() as u64 - 1))
    }

    /// Whoever wrote a page takes it from here: nobody asks by a key.
    fn take(&mut self, key: PageKey) -> Result<Bytes, ParquetError> {
        Err(ParquetError::General(format!("page {} went another way", key.get())))
    }
}

/// The header of a page that is packed as a whole, in so many bytes; `None`: it is none.
///
/// Thrift's compact protocol: the kind of the page, its size and its packed size come first, a byte for the field and a
/// number whose last byte is below 128 each.
fn with_packed_size(header: &[u8], packed: usize) -> Option<Vec<u8>> {
    let mut ends = header.iter().zip(1..).filter(|(byte, _)| **byte < 0x80).map(|(_, end)| end);
    let (from, to) = (ends.nth(4)?, ends.next()?);
    let mut with = header[..from].to_vec();
    let mut left = packed << 1;
    while left >= 0x80 {
        with.push(left as u8 | 0x80);
        left >>= 7;
    }
    with.push(left as u8);
    with.extend_from_slice(&header[to..]);
    Some(with)
}

/// What a column that is written already, of so many rows, is appended by: it has neither filter nor index.
pub(super) fn closed(metadata: ColumnChunkMetaData, rows: usize) -> ColumnCloseResult {
    ColumnCloseResult {
        bytes_written: metadata.compressed_size() as u64,
        rows_written: rows as u64,
        metadata,
        bloom_filter: None,
        column_index: None,
        offset_index: None,
    }
}

fn packed(bytes: &[u8], level: i32) -> io::Result<Bytes> {
    COMPRESSOR.with_borrow_mut(|known| {
        let compressor = match known.take().filter(|(of, _)| *of == level) {
            Some(compressor) => compressor,
            None => (level, Compressor::new(level)?),
        };
        known.insert(compressor).1.compress(bytes).map(Bytes::from)
    })
}

#[cfg(test)]
mod tests {
    use ::parquet::arrow::ArrowWriter;
    use ::parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
    use ::parquet::arrow::arrow_writer::ArrowWriterOptions;
    use arrow_array::{ArrayRef, Float64Array, Int32Array, RecordBatch, StringArray};

    use super::*;
    use crate::parquet::table::properties as packing;

    /// Numbers, their repetitions, words and what is not there, a hundred rows of each and none.
    fn batch(rows: usize) -> RecordBatch {
        let numbers: Float64Array = (0..rows).map(|k| (k % 7 != 3).then_some((k as f64).sin())).collect();
        let legs: Int32Array = (0..rows).map(|k| Some(k as i32 / 9)).collect();
        let words: StringArray = (0..rows).map(|k| (k % 2 == 0).then(|| format!("word {}", k % 5))).collect();
        let nothing: Float64Array = (0..rows).map(|_| None).collect();
        let run: Int32Array = (0..rows).map(|_| Some(1)).collect();
        let columns: [(&str, ArrayRef); 5] = [
            (RUN, Arc::new(run)),
            ("x_m", Arc::new(numbers)),
            ("leg", Arc::new(legs)),
            ("ended", Arc::new(words)),
            ("z_m", Arc::new(nothing)),
        ];
        RecordBatch::try_from_iter_with_nullable(columns.map(|(name, column)| (name, column, true))).unwrap()
    }

    fn encoding(batch: &RecordBatch, compression: Compression) -> WriterProperties {
        packing(&batch.schema())
            .set_compression(compression)
            .set_offset_index_disabled(true)
            .set_statistics_enabled(::parquet::file::properties::EnabledStatistics::None)
            .build()
    }

    #[test]
    fn the_bytes_are_those_of_the_writer() {
        for rows in [0, 1, 100, 30_000] {
            let batch = batch(rows);
            let properties = encoding(&batch, Compression::ZSTD(ZstdLevel::try_new(LEVEL).unwrap()));
            let options = ArrowWriterOptions::new().with_properties(properties).with_skip_arrow_metadata(true);
            let mut writer = ArrowWriter::try_new_with_options(Vec::new(), batch.schema(), options).unwrap();
            writer.write(&batch).unwrap();
            let by_the_writer = writer.into_inner().unwrap();
            let layout = Layout::of(batch.schema(), encoding(&batch, Compression::UNCOMPRESSED)).unwrap();
            // Twice: nothing is left over of the first.
            assert!((0..2).all(|_| layout.packed(&batch).unwrap() == by_the_writer), "{rows} rows");
        }
    }

    #[test]
    fn a_plan_is_read_as_it_was() {
        for rows in [1, 100, 30_000] {
            let planned = batch(rows).project(&[1, 2, 3, 4]).unwrap();
            let layout = Layout::of(planned.schema(), encoding(&planned, Compression::UNCOMPRESSED)).unwrap();
            let bytes = layout.packed(&planned).unwrap();
            let read = ParquetRecordBatchReaderBuilder::try_new(bytes).unwrap().with_batch_size(rows).build().unwrap();
            assert_eq!(read.map(Result::unwrap).collect::<Vec<_>>(), [planned], "{rows} rows");
        }
    }
}
