//! A file that a scenario names, as it was read, and what is wrong with one.

use std::path::Path;
use std::sync::Arc;

use hairpin::campaign::Attached;

/// A mistake in a key that names a file.
pub(super) struct Wrong {
    pub(super) key: String,
    pub(super) value: String,
    /// What it must be, or why it cannot be read.
    pub(super) bound: String,
    /// Where the mistake stands, if it is one within the file.
    pub(super) at: Option<Box<InFile>>,
}

/// A line of a file that a scenario names.
pub(super) struct InFile {
    /// The file as it was given.
    pub(super) file: String,
    /// What it holds.
    pub(super) text: String,
    /// From 1.
    pub(super) line: usize,
}

impl InFile {
    /// In a box, for mistakes go from hand to hand.
    pub(super) fn boxed(file: &str, bytes: &[u8], line: usize) -> Box<Self> {
        Box::new(Self { file: file.to_owned(), text: String::from_utf8_lossy(bytes).into_owned(), line })
    }
}

impl Wrong {
    pub(super) fn message(&self) -> String {
        let Self { key, value, bound, .. } = self;
        format!("`{key}` = {value:?}: {bound}")
    }
}

/// A file as it is kept.
pub(super) fn attached<T: ?Sized>(read: Arc<T>, bytes: Vec<u8>, name: &str, given: &str) -> Attached<T> {
    Attached { read, bytes: bytes.into(), name: name.to_owned(), given: given.to_owned() }
}

/// The ending of a file's name, in small letters.
pub(super) fn ending(file: &str) -> String {
    Path::new(file).extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}
