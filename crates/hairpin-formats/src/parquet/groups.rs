//! Row groups as they lie in a file, each read at once, and all their columns unpacked by one decompressor a thread.
//!
//! The readers of the crate `parquet` seek and read column by column, and make a compressor and a decompressor for each
//! of them: see [`super::compressed`] for what these cost.

use std::cell::RefCell;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::sync::Arc;

use ::parquet::arrow::arrow_reader::RowGroups;
use ::parquet::basic::Compression;
use ::parquet::column::page::{Page, PageIterator, PageMetadata, PageReader};
use ::parquet::errors::{ParquetError, Result};
use ::parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaData, RowGroupMetaData};
use ::parquet::file::reader::{ChunkReader, Length};
use ::parquet::file::serialized_reader::SerializedPageReader;
use bytes::{Buf, Bytes, buf::Reader};
use zstd::bulk::Decompressor;
use zstd::zstd_safe::get_frame_content_size;

thread_local! {
    static DECOMPRESSOR: RefCell<Option<Decompressor<'static>>> = const { RefCell::new(None) };
}

/// Some row groups of a file, with their bytes.
pub(super) struct Groups<'a> {
    metadata: &'a ParquetMetaData,
    groups: Vec<(&'a RowGroupMetaData, Arc<Stretch>)>,
    /// Bytes that a page may be unpacked to.
    most: u64,
}

impl<'a> Groups<'a> {
    /// # Errors
    /// They cannot be read; together they are longer than the file, so that some lie over each other.
    pub(super) fn read(file: &File, metadata: &'a ParquetMetaData, which: &[usize], most: u64) -> io::Result<Self> {
        let mut left = file.metadata()?.len();
        let mut groups = Vec::with_capacity(which.len());
        for group in which.iter().map(|group| metadata.row_group(*group)) {
            let stretch = Stretch::of(file, group, left)?;
            left -= stretch.bytes.len() as u64;
            groups.push((group, Arc::new(stretch)));
        }
        Ok(Self { metadata, groups, most })
    }

    /// Those of a file of our own in memory.
    pub(super) fn of(bytes: &Bytes, metadata: &'a ParquetMetaData) -> Self {
        let whole = Arc::new(Stretch { from: 0, bytes: bytes.clone() });
        let groups = metadata.row_groups().iter().map(|group| (group, Arc::clone(&whole)));
        Self { metadata, groups: groups.collect(), most: u64::MAX }
    }

    /// The bytes of each column of each group, as they lie there.
    ///
    /// # Errors
    /// It is said to be where nothing of its group is.
    pub(super) fn columns(&self) -> impl Iterator<Item = Result<Bytes>> {
        self.groups.iter().flat_map(|(group, stretch)| {
            group.columns().iter().map(|column| {
                let (start, length) = column.byte_range();
                stretch.get_bytes(start, usize::try_from(length)?)
            })
        })
    }
}

impl RowGroups for Groups<'_> {
    fn num_rows(&self) -> usize {
        self.groups.iter().map(|(group, _)| usize::try_from(group.num_rows()).unwrap_or(0)).sum()
    }

    fn column_chunks(&self, column: usize) -> Result<Box<dyn PageIterator>> {
        let chunks = self.groups.iter().map(|(group, stretch)| {
            let rows = usize::try_from(group.num_rows())?;
            Pages::of(stretch, group.column(column), rows, self.most)
        });
        Ok(Box::new(Chunks(chunks.collect::<Result<Vec<_>>>()?.into_iter())))
    }

    fn row_groups(&self) -> Box<dyn Iterator<Item = &RowGroupMetaData> + '_> {
        Box::new(self.groups.iter().map(|(group, _)| *group))
    }

    fn metadata(&self) -> &ParquetMetaData {
        self.metadata
    }
}

/// What lies in a file from a place on.
struct Stretch {
    from: u64,
    bytes: Bytes,
}

impl Stretch {
    /// The bytes of all columns of a row group, of which there may be `most`.
    fn of(mut file: &File, group: &RowGroupMetaData, most: u64) -> io::Result<Self> {
        let ranges = || group.columns().iter().map(ColumnChunkMetaData::byte_range);
        let from = ranges().map(|(start, _)| start).min().unwrap_or(0);
        let to = ranges().map(|(start, length)| start.saturating_add(length)).max().unwrap_or(0);
        if to - from > most {
            return Err(io::Error::other("its row groups are longer than it"));
        }
        let mut bytes = Vec::with_capacity((to - from) as usize);
        file.seek(SeekFrom::Start(from))?;
        file.take(to - from).read_to_end(&mut bytes)?;
        Ok(Self { from, bytes: bytes.into() })
    }

    fn since(&self, start: u64) -> Result<Bytes> {
        let at = start.checked_sub(self.from).and_then(|at| usize::try_from(at).ok());
        let at = at.filter(|at| *at <= self.bytes.len());
        at.map(|at| self.bytes.slice(at..)).ok_or_else(|| ParquetError::EOF("a column lies outside of it".into()))
    }
}

impl Length for Stretch {
    fn len(&self) -> u64 {
        self.from + self.bytes.len() as u64
    }
}

impl ChunkReader for Stretch {
    type T = Reader<Bytes>;

    fn get_read(&self, start: u64) -> Result<Self::T> {
        Ok(self.since(start)?.reader())
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes> {
        let bytes = self.since(start)?;
        if bytes.len() < length { Err(ParquetError::EOF("it ends too soon".into())) } else { Ok(bytes.slice(..length)) }
    }
}

/// A column of each group.
struct Chunks(std::vec::IntoIter<Pages>);

impl Iterator for Chunks {
    type Item = Result<Box<dyn PageReader>>;

    fn next(&mut self) -> Option<Self::Item> {
        Some(Ok(Box::new(self.0.next()?)))
    }
}

impl PageIterator for Chunks {}

/// The pages of a column of a group.
struct Pages {
    pages: SerializedPageReader<Stretch>,
    /// Bytes that each may be unpacked to; `None` where the crate unpacks them, of another packing than ours.
    most: Option<u64>,
}

impl Pages {
    fn of(stretch: &Arc<Stretch>, column: &ColumnChunkMetaData, rows: usize, most: u64) -> Result<Self> {
        let ours = matches!(column.compression(), Compression::ZSTD(_));
        // Who reads them as they lie there makes no decompressor.
        let read_as = if ours { Compression::UNCOMPRESSED } else { column.compression() };
        let column = column.clone().into_builder().set_compression(read_as).build()?;
        let pages = SerializedPageReader::new(Arc::clone(stretch), &column, rows, None)?;
        Ok(Self { pages, most: ours.then_some(most) })
    }
}

impl Iterator for Pages {
    type Item = Result<Page>;

    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}

impl PageReader for Pages {
    fn get_next_page(&mut self) -> Result<Option<Page>> {
        let page = self.pages.get_next_page()?;
        match (page, self.most) {
            (Some(page), Some(most)) => page_unpacked(page, most).map(Some),
            (page, _) => Ok(page),
        }
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
        self.pages.peek_next_page()
    }

    fn skip_next_page(&mut self) -> Result<()> {
        self.pages.skip_next_page()
    }
}

fn page_unpacked(mut page: Page, most: u64) -> Result<Page> {
    match &mut page {
        Page::DictionaryPage { buf, .. } | Page::DataPage { buf, .. } => *buf = unpacked(buf, 0, most)?,
        Page::DataPageV2 { buf, def_levels_byte_len, rep_levels_byte_len, is_compressed: true, .. } => {
            let levels = u64::from(*def_levels_byte_len) + u64::from(*rep_levels_byte_len);
            *buf = unpacked(buf, levels as usize, most)?;
        }
        Page::DataPageV2 { .. } => {}
    }
    Ok(page)
}

/// `bytes`, of which those after the first `plain` are packed.
fn unpacked(bytes: &Bytes, plain: usize, most: u64) -> io::Result<Bytes> {
    let (plain, packed) = bytes.split_at_checked(plain).ok_or(io::ErrorKind::UnexpectedEof)?;
    let mut rest = Vec::new();
    match get_frame_content_size(packed) {
        _ if packed.is_empty() => {}
        Ok(Some(length)) => rest = unpacked_to(packed, length.min(most) as usize)?,
        // Written piece by piece, by others.
        _ => drop(zstd::Decoder::with_buffer(packed)?.take(most.saturating_add(1)).read_to_end(&mut rest)?),
    }
    if rest.len() as u64 > most {
        return Err(io::Error::other(format!("a page of more than {most} bytes")));
    }
    Ok(if plain.is_empty() { rest.into() } else { [plain, &rest].concat().into() })
}

fn unpacked_to(packed: &[u8], length: usize) -> io::Result<Vec<u8>> {
    DECOMPRESSOR.with_borrow_mut(|decompressor| {
        let decompressor = match decompressor {
            Some(decompressor) => decompressor,
            none => none.insert(Decompressor::new()?),
        };
        decompressor.decompress(packed, length)
    })
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use ::parquet::arrow::ArrowWriter;
    use ::parquet::arrow::arrow_reader::{ArrowReaderMetadata, ArrowReaderOptions};
    use ::parquet::basic::ZstdLevel;
    use ::parquet::file::properties::{WriterProperties, WriterVersion};
    use arrow_array::{ArrayRef, Float64Array, RecordBatch, StringArray};

    use super::*;
    use crate::parquet::table::decode_groups;

    /// Numbers with gaps, and words that repeat.
    fn batch(rows: usize) -> RecordBatch {
        let numbers: Float64Array = (0..rows).map(|k| (k % 7 != 3).then_some((k as f64).sin())).collect();
        let words: StringArray = (0..rows).map(|k| (k % 2 == 0).then(|| format!("word {}", k % 5))).collect();
        let columns: [(&str, ArrayRef); 2] = [("x_m", Arc::new(numbers)), ("ended", Arc::new(words))];
        RecordBatch::try_from_iter_with_nullable(columns.map(|(name, column)| (name, column, true))).unwrap()
    }

    /// A file of row groups of `a_group` rows.
    fn written(batch: &RecordBatch, how: (Compression, WriterVersion), a_group: usize) -> (File, ArrowReaderMetadata) {
        let properties = WriterProperties::builder()
            .set_compression(how.0)
            .set_writer_version(how.1)
            .set_max_row_group_row_count(Some(a_group))
            .set_data_page_row_count_limit(a_group / 3)
            .set_write_batch_size(a_group / 3)
            .build();
        let mut file = tempfile::tempfile().unwrap();
        let mut writer = ArrowWriter::try_new(Vec::new(), batch.schema(), Some(properties)).unwrap();
        writer.write(batch).unwrap();
        file.write_all(&writer.into_inner().unwrap()).unwrap();
        let metadata = ArrowReaderMetadata::load(&file, ArrowReaderOptions::new()).unwrap();
        (file, metadata)
    }

    #[test]
    fn rows_are_read_however_they_are_packed() {
        let batch = batch(90);
        for compression in [Compression::ZSTD(ZstdLevel::default()), Compression::SNAPPY, Compression::UNCOMPRESSED] {
            for version in [WriterVersion::PARQUET_1_0, WriterVersion::PARQUET_2_0] {
                let (file, metadata) = written(&batch, (compression, version), 30);
                let rows = decode_groups(&file, &metadata, &[0, 2], 1 << 20).unwrap();
                assert_eq!(rows.slice(0, 30), batch.slice(0, 30), "{compression:?} {version:?}");
                assert_eq!(rows.slice(30, 30), batch.slice(60, 30), "{compression:?} {version:?}");
            }
        }
    }

    #[test]
    fn a_page_is_unpacked_to_no_more_than_it_may_be() {
        let packed = Bytes::from(zstd::bulk::compress(&[7; 1000], 1).unwrap());
        assert_eq!(unpacked(&packed, 0, 1000).unwrap(), vec![7; 1000]);
        assert!(unpacked(&packed, 0, 999).is_err());
        let piece_by_piece = Bytes::from(zstd::stream::encode_all(&[7; 1000][..], 1).unwrap());
        assert_eq!(unpacked(&piece_by_piece, 0, 1000).unwrap(), vec![7; 1000]);
        assert!(unpacked(&piece_by_piece, 0, 999).is_err());
    }

    #[test]
    fn groups_that_lie_over_each_other_are_refused() {
        let (file, metadata) = written(&batch(90), (Compression::SNAPPY, WriterVersion::PARQUET_1_0), 90);
        let error = decode_groups(&file, &metadata, &[0, 0, 0], 1 << 20).unwrap_err();
        assert!(error.contains("longer than it"), "{error}");
    }
}
