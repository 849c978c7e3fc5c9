//! A small Parquet file with its pages compressed, by one compressor for all of its columns.
//!
//! The writer of the crate `parquet` makes a compressor and a decompressor for each column of each row group, and each
//! of them asks the processor three times what it can do. On a virtual machine the host answers that: for pieces of a
//! hundred rows it took ten times as long as compressing them.

use std::cell::RefCell;
use std::io;
use std::sync::Arc;

use ::parquet::basic::{Compression, ZstdLevel};
use ::parquet::column::page::{CompressedPage, Page, PageWriter};
use ::parquet::column::writer::ColumnCloseResult;
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaData, ParquetMetaDataOptions, ParquetMetaDataReader};
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::serialized_reader::SerializedPageReader;
use ::parquet::file::writer::{SerializedFileWriter, SerializedPageWriter, TrackedWrite};
use bytes::Bytes;
use zstd::bulk::Compressor;

use super::table::io_error;

/// What most programs take Zstandard at: the next percent would cost more than it is worth.
const LEVEL: i32 = 3;

thread_local! {
    static COMPRESSOR: RefCell<Option<Compressor<'static>>> = const { RefCell::new(None) };
}

/// `plain`, of which no page is compressed, with all pages compressed by Zstandard: the bytes that the writer itself
/// makes of them.
pub(super) fn compressed(plain: &Bytes) -> io::Result<Bytes> {
    with_pages_compressed(plain).map(Bytes::from).map_err(io_error)
}

fn with_pages_compressed(plain: &Bytes) -> Result<Vec<u8>, ParquetError> {
    // What pages are encoded as goes with them.
    let options = ParquetMetaDataOptions::new().with_encoding_stats_as_mask(false);
    let metadata = ParquetMetaDataReader::new().with_metadata_options(Some(options)).parse_and_finish(plain)?;
    let schema = metadata.file_metadata().schema_descr().root_schema_ptr();
    let mut writer = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties(&metadata)))?;
    for group in metadata.row_groups() {
        let mut there = writer.next_row_group()?;
        let rows = group.num_rows() as usize;
        for column in group.columns() {
            let (bytes, close) = column_compressed(plain, column, rows)?;
            there.append_column(&bytes, close)?;
        }
        there.close()?;
    }
    writer.into_inner()
}

fn properties(metadata: &ParquetMetaData) -> WriterProperties {
    let notes = metadata.file_metadata().key_value_metadata().cloned();
    WriterProperties::builder().set_created_by("hairpin".into()).set_key_value_metadata(notes).build()
}

fn column_compressed(
    plain: &Bytes,
    column: &ColumnChunkMetaData,
    rows: usize,
) -> Result<(Bytes, ColumnCloseResult), ParquetError> {
    let mut sink = TrackedWrite::new(Vec::new());
    let mut pages = SerializedPageWriter::new(&mut sink);
    let (mut sizes, mut dictionary, mut first) = ([0, 0], None, None);
    for page in SerializedPageReader::new(Arc::new(plain.clone()), column, rows, None)? {
        let page = page?;
        let length = page.buffer().len();
        let is_dictionary = matches!(page, Page::DictionaryPage { .. });
        let written = pages.write_page(CompressedPage::new(page_compressed(page)?, length))?;
        sizes = [sizes[0] + written.compressed_size as i64, sizes[1] + written.uncompressed_size as i64];
        let place = if is_dictionary { &mut dictionary } else { &mut first };
        place.get_or_insert(written.offset as i64);
    }
    pages.close()?;
    let bytes: Bytes = sink.into_inner()?.into();
    let metadata = column
        .clone()
        .into_builder()
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(LEVEL)?))
        .set_total_compressed_size(sizes[0])
        .set_total_uncompressed_size(sizes[1])
        .set_dictionary_page_offset(dictionary)
        .set_data_page_offset(first.unwrap_or(0))
        .build()?;
    Ok((bytes, closed(metadata, rows)))
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

/// Pages of the first version of the format are compressed as a whole.
fn page_compressed(page: Page) -> Result<Page, ParquetError> {
    Ok(match page {
        Page::DictionaryPage { buf, num_values, encoding, is_sorted } => {
            Page::DictionaryPage { buf: packed(&buf)?, num_values, encoding, is_sorted }
        }
        Page::DataPage { buf, num_values, encoding, def_level_encoding, rep_level_encoding, statistics } => {
            let buf = packed(&buf)?;
            Page::DataPage { buf, num_values, encoding, def_level_encoding, rep_level_encoding, statistics }
        }
        Page::DataPageV2 { .. } => return Err(ParquetError::General("a page of version 2 of the format".into())),
    })
}

fn packed(bytes: &[u8]) -> io::Result<Bytes> {
    COMPRESSOR.with_borrow_mut(|compressor| {
        let compressor = match compressor {
            Some(compressor) => compressor,
            none => none.insert(Compressor::new(LEVEL)?),
        };
        compressor.compress(bytes).map(Bytes::from)
    })
}

#[cfg(test)]
mod tests {
    use ::parquet::arrow::ArrowWriter;
    use arrow_array::{ArrayRef, Float64Array, Int32Array, RecordBatch, StringArray};

    use super::*;
    use crate::parquet::table::properties as packing;

    /// Numbers, their repetitions, words and what is not there, a hundred rows of each and none.
    fn batch(rows: usize) -> RecordBatch {
        let numbers: Float64Array = (0..rows).map(|k| (k % 7 != 3).then_some((k as f64).sin())).collect();
        let legs: Int32Array = (0..rows).map(|k| Some(k as i32 / 9)).collect();
        let words: StringArray = (0..rows).map(|k| (k % 2 == 0).then(|| format!("word {}", k % 5))).collect();
        let nothing: Float64Array = (0..rows).map(|_| None).collect();
        let columns: [(&str, ArrayRef); 4] = [
            ("x_m", Arc::new(numbers)),
            ("leg", Arc::new(legs)),
            ("ended", Arc::new(words)),
            ("z_m", Arc::new(nothing)),
        ];
        RecordBatch::try_from_iter_with_nullable(columns.map(|(name, column)| (name, column, true))).unwrap()
    }

    fn written(batch: &RecordBatch, compression: Compression) -> Bytes {
        let properties = packing(&batch.schema())
            .set_compression(compression)
            .set_offset_index_disabled(true)
            .set_statistics_enabled(::parquet::file::properties::EnabledStatistics::None)
            .build();
        let mut writer = ArrowWriter::try_new(Vec::new(), batch.schema(), Some(properties)).unwrap();
        writer.write(batch).unwrap();
        writer.into_inner().unwrap().into()
    }

    #[test]
    fn the_bytes_are_those_of_the_writer() {
        for rows in [0, 1, 100, 30_000] {
            let batch = batch(rows);
            let by_the_writer = written(&batch, Compression::ZSTD(ZstdLevel::try_new(LEVEL).unwrap()));
            assert!(compressed(&written(&batch, Compression::UNCOMPRESSED)).unwrap() == by_the_writer, "{rows} rows");
        }
    }
}
