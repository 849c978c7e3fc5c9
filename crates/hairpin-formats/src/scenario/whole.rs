//! Files that scenarios and commands name: what they are by their names, and all of what is in one.

use std::borrow::Cow;
use std::io::ErrorKind;
use std::path::Path;

use crate::bounds::{self, MOST_BYTES};
use crate::library;

/// Whether a file's name is one of URDF.
pub(super) fn is_urdf(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    name.ends_with(".urdf") || name.ends_with(".xml")
}

pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, String> {
    bounds::read(path, MOST_BYTES).map_err(|error| match error.kind() {
        // Names are relative to the scenario, wherever they were typed.
        ErrorKind::NotFound => format!("{error}, looked for at {}", path.display()),
        _ => error.to_string(),
    })
}

/// The name of a file, told apart from a shipped robot's of the same name.
pub(super) fn as_path(file: &str) -> Cow<'_, str> {
    if library::robots().any(|robot| robot.name == file) { format!("./{file}").into() } else { file.into() }
}
