//! Marks of one user: a keyed hash each over a folder's real path and one wish of it. The key is random, made once, and
//! readable by its user alone; so nobody who is not this user can make a mark, and an edit after it makes it none.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use super::wish::Wish;

const KEY: &str = "key";
const MARKS: &str = "marks";
/// Of BLAKE3's keys, bytes.
const KEY_LENGTH: usize = 32;

/// The marks of one user.
pub(super) struct Marks {
    state: PathBuf,
    key: [u8; KEY_LENGTH],
}

impl Marks {
    /// Those in the folder `state`; `None` where there is none, or its key is not the user's alone.
    pub(super) fn there(state: &Path) -> Option<Self> {
        let mut file = File::open(state.join(KEY)).ok()?;
        if !is_private(&file) {
            return None;
        }
        let mut key = [0; KEY_LENGTH];
        file.read_exact(&mut key).ok()?;
        Some(Self { state: state.into(), key })
    }

    /// The same, made where there is none.
    pub(super) fn make(state: &Path) -> io::Result<Self> {
        let there = || {
            Self::there(state).ok_or_else(|| io::Error::other(format!("its {KEY} is broken, or readable by others")))
        };
        if state.join(KEY).exists() {
            return there();
        }
        make_private(&state.join(MARKS))?;
        let mut key = [0; KEY_LENGTH];
        getrandom::fill(&mut key).map_err(io::Error::other)?;
        let mut file = tempfile::Builder::new().prefix(".key-").tempfile_in(state)?;
        file.write_all(&key)?;
        file.as_file().sync_all()?;
        // Another process of the user's may have been faster: then its key is the key.
        match file.persist_noclobber(state.join(KEY)) {
            Err(error) if error.error.kind() != io::ErrorKind::AlreadyExists => Err(error.error),
            _ => there(),
        }
    }

    /// Whether there is a mark on `wish` of `folder`.
    pub(super) fn has(&self, folder: &Path, wish: &Wish) -> bool {
        self.file(folder, wish).is_some_and(|file| file.is_file())
    }

    /// Leaves one.
    pub(super) fn put(&self, folder: &Path, wish: &Wish) -> io::Result<()> {
        let file = self.file(folder, wish).ok_or_else(|| io::Error::other("the folder has no real path"))?;
        make_private(&self.state.join(MARKS))?;
        // Only its name counts; what it says is for the user who looks.
        fs::write(file, format!("{}: {wish}\n", folder.canonicalize()?.display()))
    }

    /// Where the mark on `wish` of `folder` is, if it is.
    fn file(&self, folder: &Path, wish: &Wish) -> Option<PathBuf> {
        let real = folder.canonicalize().ok()?;
        let mut hash = blake3::Hasher::new_keyed(&self.key);
        let path = real.as_os_str().as_encoded_bytes();
        for part in
            [b"hairpin consent 1".as_slice(), path].into_iter().chain(wish.parts(&real).iter().map(Vec::as_slice))
        {
            // With its length, so that no two lists of parts are the same bytes.
            hash.update(&(part.len() as u64).to_le_bytes()).update(part);
        }
        Some(self.state.join(MARKS).join(hash.finalize().to_hex().as_str()))
    }
}

/// Whether nobody but its user can read an open file.
#[cfg(unix)]
fn is_private(file: &File) -> bool {
    use std::os::unix::fs::PermissionsExt;
    file.metadata().is_ok_and(|found| found.is_file() && found.permissions().mode() & 0o077 == 0)
}

#[cfg(not(unix))]
fn is_private(file: &File) -> bool {
    file.metadata().is_ok_and(|found| found.is_file())
}

/// Makes a folder that is the user's alone.
fn make_private(folder: &Path) -> io::Result<()> {
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(folder)
}
