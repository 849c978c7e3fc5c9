//! What a command leaves behind.

use std::path::Path;
use std::{fs, io};

/// Bytes and files of a file, or of a folder with all below it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Size {
    pub(super) bytes: u64,
    pub(super) files: u64,
}

impl Size {
    /// Of what lies at `path`; links are counted as what they are.
    pub(super) fn of(path: &Path) -> io::Result<Self> {
        let what = fs::symlink_metadata(path)?;
        if !what.is_dir() {
            return Ok(Self { bytes: what.len(), files: 1 });
        }
        fs::read_dir(path)?.try_fold(Self::default(), |sum, entry| {
            let within = Self::of(&entry?.path())?;
            Ok(Self { bytes: sum.bytes + within.bytes, files: sum.files + within.files })
        })
    }

    /// Megabytes of a million bytes.
    pub(super) fn megabytes(self) -> f64 {
        self.bytes as f64 * 1e-6
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_as_large_as_their_files() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir_all(folder.path().join("a/b")).unwrap();
        fs::write(folder.path().join("a/b/one"), [0; 30]).unwrap();
        fs::write(folder.path().join("two"), [0; 12]).unwrap();
        assert_eq!(Size::of(folder.path()).unwrap(), Size { bytes: 42, files: 2 });
        assert_eq!(Size::of(&folder.path().join("two")).unwrap(), Size { bytes: 12, files: 1 });
        assert!(Size::of(&folder.path().join("three")).is_err());
    }
}
