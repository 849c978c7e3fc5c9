//! A file that is read at once, of bounded size.

use std::path::Path;

/// A robot or world file is a page of numbers; a mesh file of 100 MB has two million triangles.
const LARGEST_FILE: u64 = 100_000_000;

/// Whether a file's name is one of URDF.
pub(super) fn is_urdf(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    name.ends_with(".urdf") || name.ends_with(".xml")
}

pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, String> {
    let about = std::fs::metadata(path).map_err(|error| error.to_string())?;
    let size = about.len();
    // Devices and pipes have no end.
    if !about.is_file() && !about.is_dir() {
        return Err("it is no file".into());
    }
    if size > LARGEST_FILE {
        return Err(format!("{size} bytes are more than 100 MB"));
    }
    std::fs::read(path).map_err(|error| error.to_string())
}
