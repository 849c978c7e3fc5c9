//! Where commands run: a folder of its own, with the inputs that they need.
//!
//! Small inputs are frozen as files. Large ones are made by a fixed rule and seed, and held to the SHA-256 of the bytes
//! that were made when they were frozen.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use hairpin_formats::checksum::sha256;
use hairpin_jobs::Problem;
use tempfile::TempDir;

use super::inputs::make;

/// The sums of what is made, in the words of `sha256sum`.
pub(super) const SUMS: &str = "SHA256SUMS";

/// The folder of a measurement; gone with it.
pub(super) struct Scratch {
    folder: TempDir,
    frozen: Frozen,
}

/// The inputs as they were frozen.
pub(super) struct Frozen {
    folder: PathBuf,
    sums: BTreeMap<String, String>,
}

impl Frozen {
    /// Those in `folder`.
    ///
    /// # Errors
    /// There are none.
    pub(super) fn of(folder: &Path) -> Result<Self, Problem> {
        let text = fs::read_to_string(folder.join(SUMS)).map_err(|error| {
            Problem::input(format!(
                "{}: no inputs of `hairpin bench commands` there ({SUMS}: {error}); run it in a checkout of hairpin, or \
                 name the checkout's bench/commands by --inputs DIR",
                folder.display()
            ))
        })?;
        let sums = text.lines().filter_map(|line| line.split_once("  "));
        let sums = sums.map(|(sum, name)| (name.to_owned(), sum.to_owned())).collect();
        Ok(Self { folder: folder.to_owned(), sums })
    }

    /// The bytes of the input `name`.
    ///
    /// # Errors
    /// There is no such input; what its rule makes is no longer what was frozen.
    pub(super) fn bytes(&self, name: &str) -> Result<Vec<u8>, Problem> {
        let path = self.folder.join(name);
        if path.is_file() {
            return fs::read(&path).map_err(|error| Problem::of_file(&path, error));
        }
        let bytes = make(name, |other| self.bytes(other))?;
        let (made, frozen) = (sha256(&bytes), self.sums.get(name).map_or("none", String::as_str));
        if made != frozen {
            return Err(Problem::input(format!(
                "{name}: its rule makes bytes of the SHA-256 {made}, frozen in {} is {frozen}: that would be another \
                 question",
                self.folder.join(SUMS).display()
            )));
        }
        Ok(bytes)
    }
}

impl Scratch {
    /// In `parent`, or where the system has such folders, with what is `frozen`.
    ///
    /// # Errors
    /// The folder cannot be made.
    pub(super) fn new(frozen: Frozen, parent: Option<&Path>) -> Result<Self, Problem> {
        let mut builder = tempfile::Builder::new();
        builder.prefix("hairpin-bench-");
        let folder = parent.map_or_else(|| builder.tempdir(), |parent| builder.tempdir_in(parent));
        Ok(Self { folder: folder.map_err(Problem::input)?, frozen })
    }

    pub(super) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Puts the input `name` there, where it is not yet.
    ///
    /// # Errors
    /// As [`Frozen::bytes`]; it cannot be written.
    pub(super) fn provide(&self, name: &str) -> Result<(), Problem> {
        let path = self.path().join(name);
        if path.exists() {
            return Ok(());
        }
        fs::write(&path, self.frozen.bytes(name)?).map_err(|error| Problem::of_file(&path, error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The checkout's own.
    fn frozen() -> Frozen {
        Frozen::of(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../bench/commands"))).unwrap()
    }

    #[test]
    fn what_is_made_is_what_was_frozen() {
        for name in ["anywhere.csv", "ground.npy", "proof-100-0.csv", "clusters-50-8.csv"] {
            frozen().bytes(name).unwrap_or_else(|why| panic!("{why}"));
        }
        assert!(frozen().bytes("nothing.csv").is_err());
    }

    #[test]
    fn other_bytes_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(SUMS), "00  proof-100-0.csv\n").unwrap();
        let why = Frozen::of(folder.path()).unwrap().bytes("proof-100-0.csv").unwrap_err().to_string();
        assert!(why.contains("another question"), "{why}");
    }

    #[test]
    fn a_folder_without_inputs_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let why = Frozen::of(folder.path()).err().map(|why| why.to_string()).unwrap_or_default();
        assert!(why.contains("--inputs"), "{why}");
    }
}
