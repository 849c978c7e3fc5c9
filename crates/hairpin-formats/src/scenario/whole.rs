//! A file that is read at once, of bounded size.

use std::path::Path;

use crate::bounds::{self, MOST_BYTES};

/// Whether a file's name is one of URDF.
pub(super) fn is_urdf(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    name.ends_with(".urdf") || name.ends_with(".xml")
}

pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, String> {
    bounds::read(path, MOST_BYTES).map_err(|error| error.to_string())
}
