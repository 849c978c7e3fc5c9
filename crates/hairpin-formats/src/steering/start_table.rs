//! Files of start tables: a head, the entries as little-endian numbers, and a SHA-256 of all that.

use hairpin::trajectory::start_table::{ENTRIES, Entry, NODES, StartTable, StartTableError};
use sha2::{Digest, Sha256};
use thiserror::Error;

/// What such files begin with; the version is the number after it.
const MAGIC: &[u8; 12] = b"hairpin-arcs";
const VERSION: u32 = 1;
/// Magic, version, nodes along each axis, most_rate/most².
const HEAD: usize = 12 + 4 + 12 + 8;
const SUM: usize = 32;
/// Bytes of a whole file.
pub const START_TABLE_BYTES: usize = HEAD + ENTRIES * size_of::<Entry>() + SUM;

/// Why bytes are no start table.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum BrokenTable {
    /// Something else.
    #[error("no start table: it does not begin with {}", String::from_utf8_lossy(MAGIC))]
    Magic,
    /// Of another program's time.
    #[error("version {found}: must be {VERSION}; make it anew by `hairpin start-table`")]
    Version {
        /// The file's.
        found: u32,
    },
    /// Of another grid, or cut off.
    #[error("{found} bytes: must be {START_TABLE_BYTES}")]
    Size {
        /// The file's.
        found: usize,
    },
    /// Another grid.
    #[error("a grid of {found:?} goals: must be {NODES:?}")]
    Nodes {
        /// The file's.
        found: [u32; 3],
    },
    /// The bytes have changed since they were written.
    #[error("its checksum is not that of its numbers")]
    Checksum,
    /// Numbers that are no table.
    #[error(transparent)]
    Numbers(#[from] StartTableError),
}

/// The bytes of a file with `table`.
pub fn start_table_bytes(table: &StartTable) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(START_TABLE_BYTES);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&VERSION.to_le_bytes());
    NODES.iter().for_each(|nodes| bytes.extend_from_slice(&(*nodes as u32).to_le_bytes()));
    bytes.extend_from_slice(&table.steering().to_le_bytes());
    table.entries().iter().flatten().for_each(|value| bytes.extend_from_slice(&value.to_le_bytes()));
    let sum = Sha256::digest(&bytes);
    bytes.extend_from_slice(&sum);
    bytes
}

/// The table of a file.
///
/// # Errors
/// [`BrokenTable`].
pub fn read_start_table(bytes: &[u8]) -> Result<StartTable, BrokenTable> {
    let number = |at: usize| bytes.get(at..at + 4).and_then(|four| four.try_into().ok()).map(u32::from_le_bytes);
    if !bytes.starts_with(MAGIC) {
        return Err(BrokenTable::Magic);
    }
    let size = BrokenTable::Size { found: bytes.len() };
    match number(12) {
        Some(VERSION) => {}
        Some(found) => return Err(BrokenTable::Version { found }),
        None => return Err(size),
    }
    if bytes.len() != START_TABLE_BYTES {
        return Err(size);
    }
    let found = [16, 20, 24].map(|at| number(at).unwrap_or_default());
    if found != NODES.map(|nodes| nodes as u32) {
        return Err(BrokenTable::Nodes { found });
    }
    let (told, sum) = bytes.split_at(START_TABLE_BYTES - SUM);
    if Sha256::digest(told).as_slice() != sum {
        return Err(BrokenTable::Checksum);
    }
    let steering = f64::from_le_bytes(told[28..HEAD].try_into().unwrap_or_default());
    let values: Vec<f32> =
        told[HEAD..].chunks_exact(4).map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]])).collect();
    let entries = values.chunks_exact(5).map(|five| [five[0], five[1], five[2], five[3], five[4]]).collect();
    Ok(StartTable::new(steering, entries)?)
}

#[cfg(test)]
mod tests {
    use hairpin::trajectory::start_table::NONE;

    use super::*;

    #[test]
    fn what_was_written_is_read_and_what_was_changed_is_refused() {
        let entries = (0..ENTRIES).map(|i| if i % 3 == 0 { NONE } else { [1.5, -2.0, 0.25, 3.0, i as f32 * 1e-4] });
        let table = StartTable::new(0.7, entries.collect()).unwrap();
        let bytes = start_table_bytes(&table);
        assert!(bytes.len() == START_TABLE_BYTES && bytes.len() < 200_000, "{}", bytes.len());
        let again = read_start_table(&bytes).unwrap();
        assert_eq!(start_table_bytes(&again), bytes);
        let changed = |at: usize, to: u8| {
            let mut other = bytes.clone();
            other[at] = to;
            read_start_table(&other).unwrap_err()
        };
        assert_eq!(changed(0, b'x'), BrokenTable::Magic);
        assert_eq!(changed(12, 9), BrokenTable::Version { found: 9 });
        assert_eq!(changed(16, 7), BrokenTable::Nodes { found: [7, 17, 16] });
        assert_eq!(changed(HEAD + 50, 1), BrokenTable::Checksum);
        assert_eq!(changed(START_TABLE_BYTES - 1, bytes[START_TABLE_BYTES - 1] ^ 1), BrokenTable::Checksum);
        for cut in [0, 5, 12, 14, 40, START_TABLE_BYTES - 1] {
            let error = read_start_table(&bytes[..cut]).unwrap_err();
            let expected = if cut < 12 { BrokenTable::Magic } else { BrokenTable::Size { found: cut } };
            assert_eq!(error, expected);
        }
        // Numbers that are no arc's, with a sum that fits.
        let mut wrong = bytes[..START_TABLE_BYTES - SUM].to_vec();
        wrong[HEAD + 20..HEAD + 24].copy_from_slice(&f32::INFINITY.to_le_bytes());
        let sum = Sha256::digest(&wrong);
        wrong.extend_from_slice(&sum);
        assert!(matches!(read_start_table(&wrong), Err(BrokenTable::Numbers(_))));
    }
}
