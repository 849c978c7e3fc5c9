//! A part of a table being gathered: pieces come in any order, and stand in that of cases and runs, so that the same
//! pieces are the same bytes.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::SerializedFileWriter;
use arrow_schema::Field;
use hairpin::campaign::CaseNumber;

use super::Key;
use super::compressed::Packed;
use super::piece::{Piece, union};
use super::table::{PERIOD, io_error, notes};
use super::track::TOLERANCES;
use crate::atomic::{self, WriteError};

/// Bytes of pieces that are held in memory; more go to a file without a name.
const IN_MEMORY: usize = 16 << 20;

/// Where the bytes of a piece are until it is written.
#[derive(Debug)]
enum Place {
    Held(Packed),
    /// As a file of its own within a file: from that byte on, so many.
    Filed(u64, usize),
}

/// A piece that waits.
#[derive(Debug)]
struct Slot {
    place: Place,
    fields: Arc<[Field]>,
    period: Option<f64>,
}

/// The pieces of a part.
#[derive(Debug)]
pub(crate) struct PartWriter {
    slots: BTreeMap<Key, Slot>,
    /// Bytes of those that are held, and how many may be.
    held: usize,
    most: usize,
    /// Where the file of the others is made.
    folder: Option<PathBuf>,
    file: Option<File>,
}

impl Default for PartWriter {
    fn default() -> Self {
        Self { slots: BTreeMap::new(), held: 0, most: IN_MEMORY, folder: None, file: None }
    }
}

impl PartWriter {
    /// One whose pieces wait in `folder` where there are many.
    pub(crate) fn in_folder(folder: &Path) -> Self {
        Self { folder: Some(folder.into()), ..Self::default() }
    }

    /// Takes a piece in, in the place of one with the same key.
    ///
    /// # Errors
    /// There is no room for it.
    pub(crate) fn put(&mut self, key: Key, piece: Piece) -> io::Result<()> {
        self.leave_out(key);
        // Pieces of one table hardly ever differ in their columns.
        let like = self.slots.values().next_back().map(|slot| &slot.fields).filter(|fields| **fields == piece.fields);
        let fields = like.cloned().unwrap_or(piece.fields);
        let place = match self.held + piece.packed.size() <= self.most {
            true => Place::Held(piece.packed),
            false => self.filed(&piece.packed.to_file()?)?,
        };
        self.held += place.held();
        self.slots.insert(key, Slot { place, fields, period: piece.period });
        Ok(())
    }

    fn filed(&mut self, bytes: &[u8]) -> io::Result<Place> {
        let file = match (&mut self.file, &self.folder) {
            (Some(file), _) => file,
            (none, Some(folder)) => none.insert(tempfile::tempfile_in(folder)?),
            (none, None) => none.insert(tempfile::tempfile()?),
        };
        let at = file.seek(SeekFrom::End(0))?;
        file.write_all(bytes)?;
        Ok(Place::Filed(at, bytes.len()))
    }

    /// The pieces that are there.
    pub(crate) fn keys(&self) -> impl Iterator<Item = Key> {
        self.slots.keys().copied()
    }

    /// Leaves a piece out.
    pub(crate) fn leave_out(&mut self, key: Key) {
        self.held -= self.slots.remove(&key).map_or(0, |slot| slot.place.held());
    }

    /// Writes what is there as the part at `path`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(crate) fn save(&mut self, path: &Path, schema_name: &str) -> Result<(), WriteError> {
        let Self { slots, file: waiting, .. } = self;
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
                let piece = slot.read(waiting.as_mut())?.with_fields(&fields)?;
                if let Some(file) = file.take() {
                    let (root, properties) = (Arc::clone(piece.packed.root()), Arc::new(properties.clone()));
                    writer = Some(SerializedFileWriter::new(file, root, properties).map_err(io_error)?);
                }
                if let Some(writer) = &mut writer {
                    piece.packed.append_to(writer)?;
                }
            }
            writer.map_or(Ok(()), |writer| writer.close().map(drop).map_err(io_error))
        })
    }
}

impl Place {
    /// Bytes in memory.
    fn held(&self) -> usize {
        if let Self::Held(packed) = self { packed.size() } else { 0 }
    }
}

impl Slot {
    fn read(&self, file: Option<&mut File>) -> io::Result<Piece> {
        let packed = match (&self.place, file) {
            (Place::Held(packed), _) => packed.clone(),
            (Place::Filed(at, length), Some(file)) => {
                file.seek(SeekFrom::Start(*at))?;
                let mut bytes = vec![0; *length];
                file.read_exact(&mut bytes)?;
                Packed::read(&bytes.into())?
            }
            (Place::Filed(..), None) => return Err(io::ErrorKind::NotFound.into()),
        };
        Ok(Piece { packed, fields: self.fields.clone(), period: self.period })
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

#[cfg(test)]
mod tests {
    use arrow_array::{ArrayRef, Float64Array, RecordBatch, StringArray};

    use super::*;

    fn piece(case: usize, values: &[f64]) -> Piece {
        let cases: StringArray = values.iter().map(|_| Some(CaseNumber(case).to_string())).collect();
        let columns: [(&str, ArrayRef); 2] =
            [("case", Arc::new(cases)), ("x_m", Arc::new(Float64Array::from(values.to_vec())))];
        let batch = RecordBatch::try_from_iter_with_nullable(columns.map(|(name, column)| (name, column, true)));
        Piece::of_batch(&batch.unwrap(), None).unwrap()
    }

    /// Pieces wait in memory or in a file; what comes in the place of another counts alone.
    #[test]
    fn a_part_has_the_same_bytes_wherever_its_pieces_waited() {
        let place = tempfile::tempdir().unwrap();
        let one = piece(1, &[1.0, 2.0]).packed.size();
        let written = |most: usize| {
            let mut part = PartWriter { most, ..PartWriter::in_folder(place.path()) };
            for (case, values) in [(2, [3.0, 4.0]), (0, [5.0, 6.0]), (2, [7.0, 8.0]), (1, [9.0, 0.5])] {
                part.put((CaseNumber(case), 0), piece(case, &values)).unwrap();
            }
            part.leave_out((CaseNumber(0), 0));
            assert!(part.held <= most && (part.file.is_some() == (most < 3 * one)), "{most}: {}", part.held);
            let path = place.path().join("part.parquet");
            part.save(&path, "trajectory").unwrap();
            std::fs::read(path).unwrap()
        };
        let in_memory = written(IN_MEMORY);
        assert!([0, one, 2 * one].into_iter().all(|most| written(most) == in_memory));
    }
}
