//! A row group whose pages are compressed by one compressor for all of its columns.
//!
//! The writer of the crate `parquet` makes a compressor and a decompressor for each column of each row group, and each
//! of them asks the processor three times what it can do. On a virtual machine the host answers that: for pieces of a
//! hundred rows it took ten times as long as compressing them. So its columns are written without one, and their pages
//! are compressed as they lie in a store of our own.

use std::cell::RefCell;
use std::io::{self, Write};
use std::sync::{Arc, Mutex, PoisonError};

use ::parquet::arrow::ArrowSchemaConverter;
use ::parquet::arrow::arrow_writer::{
    ArrowColumnChunk, ArrowRowGroupWriterFactory, PageKey, PageStore, PageStoreArgs, PageStoreFactory, compute_leaves,
};
use ::parquet::basic::{Compression, ZstdLevel};
use ::parquet::column::writer::ColumnCloseResult;
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaDataReader};
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::SerializedFileWriter;
use ::parquet::schema::types::TypePtr;
use arrow_array::cast::AsArray;
use arrow_array::types::{ArrowPrimitiveType, Float32Type, Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef, RecordBatch};
use arrow_schema::{FieldRef, Schema, SchemaRef};
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
    columns: Vec<Column>,
    pages: Pages,
    level: i32,
}

/// A column of a layout.
#[derive(Debug)]
struct Column {
    writers: ArrowRowGroupWriterFactory,
    /// Numbers that were packed last, and what they became.
    last: Option<(ArrayRef, Chunk)>,
}

/// A column of a row group, compressed: its pages one after the other, and what is to be known of them.
type Chunk = (Bytes, ColumnChunkMetaData);

/// A row group that waits to be written, wherever that will be.
#[derive(Debug, Clone)]
pub(super) struct Packed {
    root: TypePtr,
    chunks: Vec<Chunk>,
    rows: usize,
}

impl Layout {
    /// Of tables with the columns of `schema`, which `encoding` says how to encode; it must ask for no compression, and
    /// for no index.
    pub(super) fn of(schema: SchemaRef, encoding: WriterProperties) -> io::Result<Self> {
        let (pages, encoding) = (Pages::default(), Arc::new(encoding));
        let column = |field: &FieldRef| {
            let alone: SchemaRef = Arc::new(Schema::new(vec![Arc::clone(field)]));
            let writer = SerializedFileWriter::new(Vec::new(), root_of(&alone)?, Arc::clone(&encoding))?;
            let writers = ArrowRowGroupWriterFactory::new(&writer, alone);
            Ok(Column { writers: writers.with_page_store_factory(Arc::new(pages.clone())), last: None })
        };
        let columns = schema.fields().iter().map(column).collect::<Result<_, ParquetError>>().map_err(io_error)?;
        let level = if schema.column_with_name(RUN).is_some() { LEVEL } else { QUICK };
        Ok(Self { root: root_of(&schema).map_err(io_error)?, schema, columns, pages, level })
    }

    /// What it is the layout of.
    pub(super) fn schema(&self) -> &SchemaRef {
        &self.schema
    }

    /// The rows as one row group: the bytes of its pages are those that the writer itself makes of them.
    pub(super) fn packed(&mut self, batch: &RecordBatch) -> io::Result<Packed> {
        // A piece that failed may have left some.
        drop(self.pages.taken());
        let chunks = if batch.num_rows() > 0 { self.chunks_of(batch).map_err(io_error)? } else { Vec::new() };
        Ok(Packed { root: Arc::clone(&self.root), chunks, rows: batch.num_rows() })
    }

    /// Plans of one campaign often share their times, and flights the attitude that they do not have: what was packed
    /// last is not packed again.
    fn chunks_of(&mut self, batch: &RecordBatch) -> Result<Vec<Chunk>, ParquetError> {
        let (pages, level) = (&self.pages, self.level);
        let mut chunks = Vec::with_capacity(self.columns.len());
        for ((field, array), column) in self.schema.fields().iter().zip(batch.columns()).zip(&mut self.columns) {
            let numbers = bytes_of(array);
            if let (Some(numbers), Some((last, chunk))) = (numbers, &column.last)
                && bytes_of(last) == Some(numbers)
            {
                chunks.push(chunk.clone());
                continue;
            }
            for (leaf, mut writer) in compute_leaves(field, array)?.iter().zip(column.writers.create_column_writers(0)?)
            {
                writer.write(leaf)?;
                chunks.push(pages.compressed(&writer.close()?, level)?);
            }
            column.last = numbers.map(|_| Arc::clone(array)).zip(chunks.last().cloned());
        }
        Ok(chunks)
    }
}

impl Packed {
    /// The one row group of a Parquet file in memory, of our own.
    pub(super) fn read(bytes: &Bytes) -> io::Result<Self> {
        let metadata = ParquetMetaDataReader::new().parse_and_finish(bytes).map_err(io_error)?;
        let root = metadata.file_metadata().schema_descr().root_schema_ptr();
        let groups = metadata.row_groups();
        let chunk = |column: &ColumnChunkMetaData| {
            let (from, length) = column.byte_range();
            let pages = bytes.slice(from as usize..(from + length) as usize);
            Ok((pages, moved(column.clone(), from as i64)?))
        };
        let chunks = groups.iter().flat_map(|group| group.columns()).map(chunk);
        let chunks = chunks.collect::<Result<_, ParquetError>>().map_err(io_error)?;
        Ok(Self { root, chunks, rows: groups.iter().map(|group| group.num_rows() as usize).sum() })
    }

    /// A Parquet file with it alone.
    pub(super) fn to_file(&self) -> io::Result<Bytes> {
        let properties = Arc::new(WriterProperties::builder().set_created_by("hairpin".into()).build());
        let mut writer = SerializedFileWriter::new(Vec::new(), self.root.clone(), properties).map_err(io_error)?;
        self.append_to(&mut writer)?;
        Ok(writer.into_inner().map_err(io_error)?.into())
    }

    /// Writes it behind what `writer` has; nothing where it has no rows.
    pub(super) fn append_to<W: Write + Send>(&self, writer: &mut SerializedFileWriter<W>) -> io::Result<()> {
        if self.rows == 0 {
            return Ok(());
        }
        let mut group = writer.next_row_group().map_err(io_error)?;
        for (bytes, metadata) in &self.chunks {
            group.append_column(bytes, closed(metadata.clone(), self.rows)).map_err(io_error)?;
        }
        group.close().map(drop).map_err(io_error)
    }

    /// Its columns.
    pub(super) fn root(&self) -> &TypePtr {
        &self.root
    }

    /// Bytes that it takes in memory.
    pub(super) fn size(&self) -> usize {
        self.chunks.iter().map(|(bytes, _)| bytes.len() + size_of::<Chunk>()).sum()
    }
}

fn root_of(schema: &Schema) -> Result<TypePtr, ParquetError> {
    Ok(ArrowSchemaConverter::new().convert(schema)?.root_schema_ptr())
}

/// The bytes of numbers without gaps.
fn bytes_of(array: &dyn Array) -> Option<&[u8]> {
    fn of<T: ArrowPrimitiveType>(array: &dyn Array) -> Option<&[u8]> {
        Some(array.as_primitive_opt::<T>()?.values().inner().as_slice())
    }
    let bytes = of::<Float64Type>(array).or_else(|| of::<Float32Type>(array)).or_else(|| of::<Int64Type>(array));
    bytes.filter(|_| array.null_count() == 0)
}

/// Pages of the one column that is being written: the header of each, and what it is of.
#[derive(Debug, Clone, Default)]
struct Pages(Arc<Mutex<Vec<Bytes>>>);

impl Pages {
    /// The column whose pages wait here.
    fn compressed(&self, plain: &ArrowColumnChunk, level: i32) -> Result<Chunk, ParquetError> {
        let metadata = plain.close().metadata.clone();
        let stored = self.taken();
        let (mut pages, has_dictionary) =
            (stored.as_chunks::<2>().0.to_vec(), metadata.dictionary_page_offset().is_some());
        if has_dictionary {
            // It is the last that is known, and the first that is read.
            pages.rotate_right(1);
        }
        let (mut bytes, mut unpacked, mut first) = (Vec::new(), 0, 0);
        for (number, [header, page]) in pages.iter().enumerate() {
            let packed = packed(page, level)?;
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
            // What a page is encoded by stands in its header too.
            .clear_page_encoding_stats()
            .build()?;
        // Many of them wait in memory: without room to spare.
        Ok((bytes.into_boxed_slice().into(), metadata))
    }

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

/// The same column `by` bytes nearer to where what it is in begins.
fn moved(metadata: ColumnChunkMetaData, by: i64) -> Result<ColumnChunkMetaData, ParquetError> {
    let (dictionary, data) = (metadata.dictionary_page_offset(), metadata.data_page_offset());
    let builder = metadata.into_builder().set_dictionary_page_offset(dictionary.map(|at| at - by));
    builder.set_data_page_offset(data - by).build()
}

/// What a column that is written already, of so many rows, is appended by: it has neither filter nor index.
fn closed(metadata: ColumnChunkMetaData, rows: usize) -> ColumnCloseResult {
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
            let by_the_writer = Bytes::from(writer.into_inner().unwrap());
            let by_the_writer = Packed::read(&by_the_writer).unwrap().to_file().unwrap();
            let mut layout = Layout::of(batch.schema(), encoding(&batch, Compression::UNCOMPRESSED)).unwrap();
            // Twice: nothing is left over of the first but what the second has of it.
            let mut whole = || layout.packed(&batch).unwrap().to_file().unwrap();
            assert!((0..2).all(|_| whole() == by_the_writer), "{rows} rows");
        }
    }

    /// −0 is not 0, and what differs in one number is packed anew.
    #[test]
    fn what_was_packed_last_stands_for_the_same_bits_alone() {
        let pair = |a: f64, b: f64| {
            let column: ArrayRef = Arc::new(Float64Array::from(vec![a, b]));
            RecordBatch::try_from_iter_with_nullable([("x_m", column, true)]).unwrap()
        };
        let batches = [pair(0.0, 1.0), pair(0.0, 1.0), pair(-0.0, 1.0), pair(f64::NAN, 1.0), pair(f64::NAN, 1.0)];
        let layout = || Layout::of(batches[0].schema(), encoding(&batches[0], Compression::UNCOMPRESSED)).unwrap();
        let mut one = layout();
        for (i, batch) in batches.iter().enumerate() {
            let [here, alone] = [&mut one, &mut layout()].map(|layout| layout.packed(batch).unwrap());
            assert_eq!(here.to_file().unwrap(), alone.to_file().unwrap(), "{i}");
        }
    }

    #[test]
    fn a_plan_is_read_as_it_was() {
        for rows in [1, 100, 30_000] {
            let planned = batch(rows).project(&[1, 2, 3, 4]).unwrap();
            let mut layout = Layout::of(planned.schema(), encoding(&planned, Compression::UNCOMPRESSED)).unwrap();
            let packed = layout.packed(&planned).unwrap();
            let bytes = packed.to_file().unwrap();
            assert_eq!(Packed::read(&bytes).unwrap().to_file().unwrap(), bytes, "{rows} rows");
            let read = ParquetRecordBatchReaderBuilder::try_new(bytes).unwrap().with_batch_size(rows).build().unwrap();
            assert_eq!(read.map(Result::unwrap).collect::<Vec<_>>(), [planned], "{rows} rows");
        }
    }
}
