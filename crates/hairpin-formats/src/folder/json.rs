//! The folder's JSON files: indented, with a line's end.

use std::io;

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
        let path = self.file(name);
        let text = bounds::read_json_text(&path);
        let found = text.and_then(|text| serde_json::from_str(&text).map_err(io::Error::from));
        found.map_err(|cause| FolderError::Unreadable { path, cause })
    }

    /// The same; `None` where there is no such file.
    pub(super) fn read_json_if_there<T: DeserializeOwned>(&self, name: &str) -> Result<Option<T>, FolderError> {
        match self.read_json(name) {
            Err(FolderError::Unreadable { cause, .. }) if cause.kind() == io::ErrorKind::NotFound => Ok(None),
            found => found.map(Some),
        }
    }
}
