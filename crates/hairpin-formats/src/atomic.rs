//! Every file we write appears whole or not at all: a temporary name in the same folder, then a rename. What is no file
//! (a pipe, a device) is written to where it stands.

use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use thiserror::Error;

const PREFIX: &str = ".hairpin-";
const SUFFIX: &str = ".tmp";

/// A file that could not be written; what stood there before still stands.
#[derive(Debug, Error)]
#[error("cannot write {}: {cause}", path.display())]
pub struct WriteError {
    /// The file, or the folder that was to be made.
    pub path: PathBuf,
    /// The system's answer: a full disk, a folder that is not writable, ….
    pub cause: io::Error,
}

impl WriteError {
    /// Whether the place was there and did not take the bytes, as [`is_lost`] has it.
    pub fn is_lost(&self) -> bool {
        is_lost(&self.cause)
    }
}

/// Whether a write failed although its place was there: no space (ENOSPC, EDQUOT), a file too large (EFBIG), or the
/// device failed (EIO). What cannot even be opened is the user's to mend, and a reader that has gone away no mistake.
pub fn is_lost(cause: &io::Error) -> bool {
    const EIO: i32 = 5;
    let full = matches!(cause.kind(), ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge);
    full || (cfg!(unix) && cause.raw_os_error() == Some(EIO))
}

/// Writes `bytes` to `path`.
///
/// # Errors
/// Whatever the system refuses; the temporary file is gone then, and an old `path` is as it was.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    write_with(path, |file| file.write_all(bytes))
}

/// Writes `what` as [`json_text`] has it.
///
/// # Errors
/// As [`write()`]; data that JSON cannot hold.
pub fn write_json(path: &Path, what: &impl Serialize) -> Result<(), WriteError> {
    let text = json_text(what).map_err(|error| WriteError { path: path.into(), cause: error.into() })?;
    write(path, text.as_bytes())
}

/// JSON as our files have it: indented, with a line's end.
///
/// # Errors
/// Data that JSON cannot hold.
pub fn json_text(what: &impl Serialize) -> Result<String, serde_json::Error> {
    Ok(serde_json::to_string_pretty(what)? + "\n")
}

/// Hands `fill` a temporary file beside `path` and renames it to `path` once its bytes are on disk. A process killed at
/// any moment leaves the old file or the new one, and at worst a temporary that [`remove_leftovers`] takes away. A link
/// stays a link to the file that is written. A pipe or a device gets the bytes themselves: a rename would put a file in
/// its place.
///
/// # Errors
/// As [`write()`], and whatever `fill` returns.
pub fn write_with(path: &Path, fill: impl FnOnce(&mut (dyn Write + Send)) -> io::Result<()>) -> Result<(), WriteError> {
    let refuse = |cause| WriteError { path: path.into(), cause };
    let kind = fs::metadata(path).map(|found| found.file_type());
    if kind.is_ok_and(|kind| !kind.is_file() && !kind.is_dir()) {
        let mut place = File::options().write(true).open(path).map_err(refuse)?;
        return pour(&mut place, fill).map_err(refuse);
    }
    // Where nothing stands yet there is nothing to follow.
    let path = &fs::canonicalize(path).unwrap_or_else(|_| path.into());
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut temporary = temporary_in(folder).map_err(|cause| match folder.is_dir() {
        // The system would tell of a name that nobody gave.
        false => refuse(io::Error::new(cause.kind(), format!("there is no folder {}", folder.display()))),
        true => refuse(cause),
    })?;
    pour(temporary.as_file_mut(), fill).map_err(refuse)?;
    temporary.as_file().sync_all().map_err(refuse)?;
    temporary.persist(path).map_err(|error| refuse(error.error))?;
    Ok(())
}

/// Writes `bytes` to `path` unless something stands there; whether it was written. Who reads it finds all of it or
/// nothing; a machine that fails may still lose it, so what is written so has to say whether it is whole.
///
/// # Errors
/// As [`write()`].
pub fn write_new(path: &Path, bytes: &[u8]) -> Result<bool, WriteError> {
    let refuse = |cause| WriteError { path: path.into(), cause };
    let mut temporary = temporary_in(path.parent().unwrap_or(Path::new("."))).map_err(refuse)?;
    temporary.as_file_mut().write_all(bytes).map_err(refuse)?;
    match temporary.persist_noclobber(path) {
        Ok(_) => Ok(true),
        Err(error) if error.error.kind() == ErrorKind::AlreadyExists => Ok(false),
        Err(error) => Err(refuse(error.error)),
    }
}

fn pour(file: &mut File, fill: impl FnOnce(&mut (dyn Write + Send)) -> io::Result<()>) -> io::Result<()> {
    let mut buffered = BufWriter::new(file);
    fill(&mut buffered)?;
    buffered.flush()
}

/// Makes `path` and its parents.
///
/// # Errors
/// Whatever the system refuses, naming `path`.
pub fn make_folder(path: &Path) -> Result<(), WriteError> {
    fs::create_dir_all(path).map_err(|cause| WriteError { path: path.into(), cause })
}

/// A folder under a temporary name in `parent`, which is made where it is not there; it goes when this is dropped.
///
/// # Errors
/// As [`make_folder`].
pub fn temporary_folder(parent: &Path) -> Result<tempfile::TempDir, WriteError> {
    make_folder(parent)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o777));
    }
    builder.tempdir_in(parent).map_err(|cause| WriteError { path: parent.into(), cause })
}

/// Gives a temporary folder its name, `path`, at once. Whether it has it: not where a folder with something in it
/// stands there already.
///
/// # Errors
/// Whatever else the system refuses.
pub fn put_folder(temporary: tempfile::TempDir, path: &Path) -> Result<bool, WriteError> {
    match fs::rename(temporary.path(), path) {
        Ok(()) => {
            let _ = temporary.keep();
            Ok(true)
        }
        Err(cause) if matches!(cause.kind(), ErrorKind::DirectoryNotEmpty | ErrorKind::AlreadyExists) => Ok(false),
        Err(cause) => Err(WriteError { path: path.into(), cause }),
    }
}

/// Removes the temporaries that a killed process left in `folder` (not below it). Call it only where no other process
/// writes. What cannot be removed does no harm: readers never look at these names.
pub fn remove_leftovers(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if is_temporary(&entry.file_name().to_string_lossy()) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether a file of this name is a temporary of ours.
pub fn is_temporary(name: &str) -> bool {
    name.starts_with(PREFIX) && name.ends_with(SUFFIX)
}

fn temporary_in(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    #[cfg(unix)]
    {
        // The default is readable by the owner alone; results are for the team (the umask still applies).
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}
