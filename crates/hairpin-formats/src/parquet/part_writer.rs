//! A part of a table being gathered: pieces come in any order, and stand in that of cases and runs, so that the same
//! pieces are the same bytes.

use std::collections::BTreeMap;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::Arc;

use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::SerializedFileWriter;
use arrow_schema::Field;
use hairpin::campaign::CaseNumber;
use tempfile::SpooledTempFile;

use super::Key;
use super::compressed::closed;
use super::piece::{Piece, union};
use super::table::{PERIOD, io_error, notes};
use super::track::TOLERANCES;
use crate::atomic::{self, WriteError};

/// Bytes of pieces that are held in memory; more go to a file without a name.
const IN_MEMORY: usize = 16 << 20;

/// Where a piece lies until it is written.
#[derive(Debug)]
struct Slot {
    at: u64,
    length: usize,
    fields: Arc<[Field]>,
    period: Option<f64>,
}

/// The pieces of a part.
#[derive(Debug)]
pub(crate) struct PartWriter {
    slots: BTreeMap<Key, Slot>,
    spool: SpooledTempFile,
    end: u64,
}

impl Default for PartWriter {
    fn default() -> Self {
        Self { slots: BTreeMap::new(), spool: SpooledTempFile::new(IN_MEMORY), end: 0 }
    }
}

impl PartWriter {
    /// One whose pieces wait in `folder` where there are many.
    pub(crate) fn in_folder(folder: &Path) -> Self {
        Self { spool: tempfile::spooled_tempfile_in(IN_MEMORY, folder), ..Self::default() }
    }

    /// Takes a piece in, in the place of one with the same key.
    ///
    /// # Errors
    /// There is no room for it.
    pub(crate) fn put(&mut self, key: Key, piece: Piece) -> io::Result<()> {
        self.spool.seek(SeekFrom::Start(self.end))?;
        self.spool.write_all(&piece.bytes)?;
        let length = piece.bytes.len();
        // Pieces of one table hardly ever differ in their columns.
        let like = self.slots.values().next_back().map(|slot| &slot.fields).filter(|fields| **fields == piece.fields);
        let fields = like.cloned().unwrap_or(piece.fields);
        self.slots.insert(key, Slot { at: self.end, length, fields, period: piece.period });
        self.end += length as u64;
        Ok(())
    }

    /// The pieces that are there.
    pub(crate) fn keys(&self) -> impl Iterator<Item = Key> {
        self.slots.keys().copied()
    }

    /// Leaves a piece out.
    pub(crate) fn leave_out(&mut self, key: Key) {
        self.slots.remove(&key);
    }

    /// Writes what is there as the part at `path`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(crate) fn save(&mut self, path: &Path, schema_name: &str) -> Result<(), WriteError> {
        let Self { slots, spool, .. } = self;
        let fields = union(slots.values().map(|slot| &slot.fields));
        let period = slots.values().filter_map(|slot| slot.period).min_by(f64::total_cmp);
        let thinned = period.map(|period| [(PERIOD.to_owned(), period.to_string()), tolerances()]);
        let more: Vec<(String, String)> = thinned.into_iter().flatten().collect();
        let properties = WriterProperties::builder()
            .set_created_by("hairpin".into())
            .set_key_value_metadata(Some(notes(schema_name, &more)))
            .build();
        atomic::write_with(path, |file| {
            let mut writer: Option<SerializedFileWriter<_>> = None;
            let mut file = Some(file);
            for slot in slots.values() {
                let piece = slot.read(spool)?.with_fields(&fields)?;
                let metadata = piece.metadata()?;
                let metadata = metadata.metadata();
                if let Some(file) = file.take() {
                    let schema = metadata.file_metadata().schema_descr().root_schema_ptr();
                    writer =
                        Some(SerializedFileWriter::new(file, schema, Arc::new(properties.clone())).map_err(io_error)?);
                }
                let Some(writer) = &mut writer else { continue };
                for group in metadata.row_groups() {
                    let mut there = writer.next_row_group().map_err(io_error)?;
                    for column in group.columns() {
                        let close = closed(column.clone(), group.num_rows() as usize);
                        there.append_column(&piece.bytes, close).map_err(io_error)?;
                    }
                    there.close().map_err(io_error)?;
                }
            }
            writer.map_or(Ok(()), |writer| writer.close().map(drop).map_err(io_error))
        })
    }
}

impl Slot {
    fn read(&self, spool: &mut SpooledTempFile) -> io::Result<Piece> {
        spool.seek(SeekFrom::Start(self.at))?;
        let mut bytes = vec![0; self.length];
        spool.read_exact(&mut bytes)?;
        Ok(Piece { bytes: bytes.into(), fields: self.fields.clone(), period: self.period })
    }
}

/// Writes a part with one piece.
///
/// # Errors
/// The file cannot be written.
pub fn write_one(path: &Path, schema_name: &str, piece: Piece) -> Result<(), WriteError> {
    let mut part = PartWriter::default();
    part.put((CaseNumber(0), 0), piece).map_err(|cause| WriteError { path: path.into(), cause })?;
    part.save(path, schema_name)
}

/// What rows that are left out are within.
fn tolerances() -> (String, String) {
    let within = serde_json::json!({
        "position_m": TOLERANCES.position,
        "attitude": TOLERANCES.attitude,
        "share_of_range": TOLERANCES.share,
    });
    ("hairpin.tolerances".into(), within.to_string())
}
