//! What a Parquet file may claim of its sizes, asked before it is decoded: one of a megabyte can stand for gigabytes.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::sync::Arc;

use ::parquet::arrow::arrow_reader::{ArrowReaderMetadata, ArrowReaderOptions, RowGroups};
use ::parquet::file::metadata::ParquetMetaDataReader;
use arrow_schema::{DataType, Schema};

use super::groups::Groups;
use super::thrift::Walker;

/// Bytes of a table in memory that any file may stand for …
const ANY: u64 = 64 << 20;
/// … and for each of its own bytes. Measured numbers come to a third of theirs, numbers of cases to nearly nothing.
const PER_BYTE: u64 = 50;
/// No table of ours comes near this.
const MOST: u64 = 4 << 30;

/// Bytes in memory that a file of so many bytes may stand for.
pub(super) fn most_decoded(file: u64) -> u64 {
    file.saturating_mul(PER_BYTE).saturating_add(ANY).min(MOST)
}

/// What the footer says, which a decoder takes room by: it is read once, and decoded if it does not contradict itself.
pub(super) fn read_footer(file: &mut File) -> Result<ArrowReaderMetadata, String> {
    let contradicts = |_: io::Error| "it ends too soon".to_owned();
    let size = file.seek(SeekFrom::End(0)).map_err(contradicts)?;
    if size < 12 {
        return Err("it is shorter than any".into());
    }
    file.seek(SeekFrom::Start(size - 8)).map_err(contradicts)?;
    let mut end = [0; 8];
    file.read_exact(&mut end).map_err(contradicts)?;
    let length = u64::from(u32::from_le_bytes([end[0], end[1], end[2], end[3]]));
    if &end[4..] != b"PAR1" {
        return Err("it does not end as one".into());
    }
    let start = (size - 8).checked_sub(length).ok_or("its footer is longer than the file")?;
    file.seek(SeekFrom::Start(start)).map_err(contradicts)?;
    let mut footer = vec![0; length as usize];
    file.read_exact(&mut footer).map_err(contradicts)?;
    Walker::new(&footer).structure(&mut |_, _| ()).ok_or("its footer contradicts itself")?;
    let metadata = ParquetMetaDataReader::decode_metadata(&footer);
    let metadata = metadata.and_then(|all| ArrowReaderMetadata::try_new(Arc::new(all), ArrowReaderOptions::new()));
    metadata.map_err(|error| error.to_string())
}

/// Refuses row groups that would decode to more than `most` bytes, as far as they say.
pub(super) fn check_sizes(groups: &Groups<'_>, schema: &Schema, most: u64) -> Result<(), String> {
    let mut rows = 0_u64;
    for group in groups.row_groups() {
        let more = u64::try_from(group.num_rows()).map_err(|_| "it has less than no rows")?;
        rows = rows.saturating_add(more);
    }
    let width = |kind: &DataType| match kind {
        DataType::Boolean => 1,
        other => other.primitive_width().unwrap_or(4) as u64,
    };
    let wide: u64 = schema.fields().iter().map(|field| width(field.data_type())).sum();
    if rows.saturating_mul(wide) > most {
        return Err(format!("{rows} rows of {} columns are more than its size can hold", schema.fields().len()));
    }
    let mut taken = 0_u64;
    for column in groups.columns() {
        let bytes = column.map_err(|error| error.to_string())?;
        taken = taken.saturating_add(unpacked(&bytes, most - taken)?);
    }
    Ok(())
}

/// What the pages of a column say that they decode to, bytes; an error where that is more than `most`.
fn unpacked(bytes: &[u8], most: u64) -> Result<u64, String> {
    let (mut at, mut taken) = (0, 0_u64);
    while at < bytes.len() {
        let mut walker = Walker::new(&bytes[at..]);
        let (mut unpacked, mut packed) = (0, 0);
        walker
            .structure(&mut |field, number| match field {
                2 => unpacked = number,
                3 => packed = number,
                _ => {}
            })
            .ok_or("the header of a page contradicts itself")?;
        let sizes = (u64::try_from(unpacked), usize::try_from(packed));
        let (Ok(unpacked), Ok(packed)) = sizes else { return Err("a page has less than no bytes".into()) };
        taken = taken.saturating_add(unpacked);
        if taken > most {
            return Err(format!("its pages say {taken} bytes and more, which are more than its size can hold"));
        }
        at = at.saturating_add(walker.position()).saturating_add(packed);
    }
    Ok(taken)
}
