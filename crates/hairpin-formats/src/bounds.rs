//! What is read from files, and how much of it at most: the one place where a reader's file is opened.
//!
//! A file that somebody else made is data: how large it is, is asked before room is taken for it, and what is no plain
//! file (a device that never ends, a pipe that nobody writes to, a folder) is refused, not waited for.

use std::fs::{self, File, FileType};
use std::io::{self, Read};
use std::path::Path;

/// Bytes of a file at most, where its kind has no bound of its own: a mesh of this size has two million triangles.
pub const MOST_BYTES: u64 = 100_000_000;
/// Bytes of a raster or an array: 10⁸ cells of eight bytes.
pub const MOST_RASTER_BYTES: u64 = 1_000_000_000;
/// Bytes of what stands beside a file and says how it is to be read.
pub const MOST_SIDECAR_BYTES: u64 = 1_000_000;

/// Bytes of what somebody wrote as text: scenarios, robots, programs, JSON.
pub const MOST_TEXT_BYTES: u64 = 32_000_000;
/// Rows of a table of text: two hours of a controller's log at 250 Hz.
pub const MOST_ROWS: usize = 2_000_000;
/// Bytes of a row: twenty thousand cells of fifty.
pub const LONGEST_ROW: usize = 1_000_000;
/// Values of a TOML text, each of which takes a place in a tree: as many as 300 000 vertices and triangles have.
pub const MOST_VALUES: usize = 1_500_000;
/// Values of a JSON text.
pub const MOST_JSON_VALUES: usize = 6_000_000;
/// Vertices and triangles of all meshes that one scenario names.
pub const MOST_MESH_PARTS: usize = 200_000;

/// The bytes of a table of text at `path`.
///
/// # Errors
/// As of [`read`]; more rows, or longer ones, than any table has.
pub fn read_table(path: &Path) -> io::Result<Vec<u8>> {
    let bytes = read(path, MOST_BYTES)?;
    check_table(&bytes).map_err(|what| io::Error::new(io::ErrorKind::InvalidData, what))?;
    Ok(bytes)
}

/// Refuses a table of more than [`MOST_ROWS`] rows or [`LONGEST_ROW`] bytes in one.
///
/// # Errors
/// What there is too much of.
pub fn check_table(bytes: &[u8]) -> Result<(), String> {
    TableCheck::default().go_on(bytes)
}

/// [`check_table`] of a table that comes piece by piece.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct TableCheck {
    rows: usize,
    /// Bytes of the row so far.
    row: usize,
}

impl TableCheck {
    /// # Errors
    /// As of [`check_table`], with the piece in which it is told.
    pub(crate) fn go_on(&mut self, bytes: &[u8]) -> Result<(), String> {
        for byte in bytes {
            if matches!(byte, b'\n' | b'\r') {
                (self.rows, self.row) = (self.rows + 1, 0);
            } else if self.row >= LONGEST_ROW {
                return Err(format!("line {}: longer than {LONGEST_ROW} bytes", self.rows + 1));
            } else {
                self.row += 1;
            }
        }
        if self.rows <= 2 * MOST_ROWS { Ok(()) } else { Err(format!("more than {MOST_ROWS} rows")) }
    }
}

/// Refuses a TOML text of more than [`MOST_VALUES`] values, told by its signs alone.
///
/// # Errors
/// How many there are.
pub fn check_values(text: &str) -> Result<(), String> {
    let values = count(text, b"[{=,");
    if values <= MOST_VALUES { Ok(()) } else { Err(format!("{values} values: at most {MOST_VALUES}")) }
}

/// The text of a JSON file at `path`.
///
/// # Errors
/// As of [`read_text`]; more than [`MOST_JSON_VALUES`] values, told by its signs alone.
pub fn read_json_text(path: &Path) -> io::Result<String> {
    let text = read_text(path, MOST_TEXT_BYTES)?;
    let values = count(&text, b"[{:,");
    if values <= MOST_JSON_VALUES {
        return Ok(text);
    }
    let what = format!("{values} values: at most {MOST_JSON_VALUES}");
    Err(io::Error::new(io::ErrorKind::InvalidData, what))
}

fn count(text: &str, signs: &[u8; 4]) -> usize {
    text.bytes().filter(|byte| signs.contains(byte)).count()
}

/// The bytes of the file at `path`, of which it may have `most`.
///
/// # Errors
/// It cannot be read; it is no plain file; it is larger.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = open(path, most)?;
    let mut bytes = Vec::with_capacity(file.metadata()?.len().min(most) as usize);
    // It may grow while it is read.
    file.take(most + 1).read_to_end(&mut bytes)?;
    refuse_larger(bytes.len() as u64, most)?;
    Ok(bytes)
}

/// The text of the file at `path`, of which it may have `most` bytes.
///
/// # Errors
/// As of [`read`]; it is no UTF-8.
pub fn read_text(path: &Path, most: u64) -> io::Result<String> {
    String::from_utf8(read(path, most)?).map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "it is no UTF-8 text"))
}

/// An open file that other libraries read piece by piece.
///
/// # Errors
/// As of [`read`].
pub fn open(path: &Path, most: u64) -> io::Result<File> {
    // Opening a pipe would wait for a writer.
    refuse_special(fs::metadata(path)?.file_type())?;
    let file = File::open(path)?;
    // What is open is what is asked: the name may lead to another file by now.
    let metadata = file.metadata()?;
    refuse_special(metadata.file_type())?;
    refuse_larger(metadata.len(), most)?;
    Ok(file)
}

fn refuse_larger(bytes: u64, most: u64) -> io::Result<()> {
    if bytes <= most {
        return Ok(());
    }
    let what = format!("{bytes} bytes are more than {} MB", most / 1_000_000);
    Err(io::Error::new(io::ErrorKind::FileTooLarge, what))
}

fn refuse_special(kind: FileType) -> io::Result<()> {
    if kind.is_file() {
        return Ok(());
    }
    let what = if kind.is_dir() { "a directory" } else { special(kind) };
    Err(io::Error::new(io::ErrorKind::InvalidInput, format!("{what}, where a file is needed")))
}

#[cfg(unix)]
fn special(kind: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    if kind.is_fifo() {
        "a pipe"
    } else if kind.is_socket() {
        "a socket"
    } else {
        "a device"
    }
}

#[cfg(not(unix))]
fn special(_: FileType) -> &'static str {
    "a device"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_read_up_to_their_bound() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        fs::write(&path, "12345").unwrap();
        assert_eq!(read(&path, 5).unwrap(), b"12345");
        assert_eq!(read(&path, 4).unwrap_err().kind(), io::ErrorKind::FileTooLarge);
        fs::write(&path, [0xff, 0xfe]).unwrap();
        assert!(read_text(&path, 5).unwrap_err().to_string().contains("no UTF-8"));
        assert!(read(folder.path(), 5).unwrap_err().to_string().contains("a directory"));
        assert_eq!(read(&folder.path().join("none"), 5).unwrap_err().kind(), io::ErrorKind::NotFound);
    }

    #[test]
    fn tables_and_trees_have_bounds_of_their_own() {
        assert!(check_table(b"a,b\r\n1,2\r\n").is_ok());
        let long = vec![b','; LONGEST_ROW + 1];
        assert!(check_table(&long).unwrap_err().contains("line 1"));
        let many = vec![b'\n'; 2 * MOST_ROWS + 1];
        assert!(check_table(&many).unwrap_err().contains("rows"));
        assert!(check_values(&"a=1\n".repeat(1000)).is_ok());
        assert!(check_values(&"[".repeat(MOST_VALUES + 1)).is_err());
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        fs::write(&path, ",".repeat(MOST_JSON_VALUES + 1)).unwrap();
        assert!(read_json_text(&path).unwrap_err().to_string().contains("values"));
    }

    #[cfg(unix)]
    #[test]
    fn what_never_ends_is_refused() {
        for (path, what) in [("/dev/zero", "a device"), ("/dev/null", "a device")] {
            assert!(read(Path::new(path), MOST_BYTES).unwrap_err().to_string().contains(what), "{path}");
        }
        let folder = tempfile::tempdir().unwrap();
        let (pipe, socket) = (folder.path().join("pipe"), folder.path().join("socket"));
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        assert!(read(&pipe, 1).unwrap_err().to_string().contains("a pipe"));
        assert!(open(&socket, 1).unwrap_err().to_string().contains("a socket"));
    }
}
