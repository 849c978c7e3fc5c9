//! The folder's JSON files: indented, with a line's end.

use std::io;
use std::path::PathBuf;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{CampaignFolder, FolderError};
use crate::atomic;
use crate::bounds;

impl CampaignFolder {
    pub(super) fn write_json(&self, name: &str, what: &impl Serialize) -> Result<(), FolderError> {
        Ok(atomic::write_json(&self.file(name), what)?)
    }

    pub(super) fn read_json<T: DeserializeOwned>(&self, name: &str) -> Result<T, FolderError> {
        read_json(self.file(name))
    }

    /// The same; `None` where there is no such file.
    pub(super) fn read_json_if_there<T: DeserializeOwned>(&self, name: &str) -> Result<Option<T>, FolderError> {
        read_json_if_there(self.file(name))
    }
}

fn read_json<T: DeserializeOwned>(path: PathBuf) -> Result<T, FolderError> {
    let text = bounds::read_json_text(&path);
    let found = text.and_then(|text| serde_json::from_str(&text).map_err(io::Error::from));
    found.map_err(|cause| FolderError::Unreadable { path, cause })
}

/// What the file at `path` holds; `None` where there is none.
pub(super) fn read_json_if_there<T: DeserializeOwned>(path: PathBuf) -> Result<Option<T>, FolderError> {
    match read_json(path) {
        Err(FolderError::Unreadable { cause, .. }) if cause.kind() == io::ErrorKind::NotFound => Ok(None),
        found => found.map(Some),
    }
}
