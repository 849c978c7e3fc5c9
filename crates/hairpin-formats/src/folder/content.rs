//! What a campaign says, in one number: two folders that have it in common hold the same campaign.

use std::io::Read;
use std::path::{Path, PathBuf};

use super::list::List;
use super::names::{EXPORT, LIST, LOG, PARTS, PLAN, stands_for};
use super::{CampaignFolder, FOLDERS, FolderError, LOCK, entries};
use crate::bounds;

/// What depends on clock or place, follows from the rest, or is about how it was made.
const BESIDE: [&str; 6] = ["report.html", "junit.xml", PLAN, LIST, LOCK, LOG];
/// Bytes that are read at a time.
const BLOCK: usize = 1 << 16;
/// Folders of what follows from the rest.
const FOLLOWS: [&str; 3] = [EXPORT, "repro", "missions"];

impl CampaignFolder {
    /// BLAKE3 over the names and bytes of all files in which the campaign stands, in their order: neither those that
    /// tell of the clock (`report.html`, `junit.xml`, logs), nor repro files and exports, which follow from them.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn content_hash(&self) -> Result<String, FolderError> {
        let ours = List::read(&self.path)?.unwrap_or_default();
        let mut names: Vec<String> = Vec::new();
        for path in entries(&self.path)?.into_iter().filter(|path| path.is_file()) {
            names.extend(name_below(&self.path, &path));
        }
        for folder in FOLDERS.iter().filter(|folder| !FOLLOWS.contains(folder)) {
            let place = self.path.join(folder);
            for path in if place.is_dir() { entries(&place)? } else { Vec::new() } {
                names.extend(name_below(&self.path, &path));
            }
        }
        names.retain(|name| ours.names(name) && !BESIDE.iter().any(|pattern| stands_for(pattern, name)));
        names.sort_unstable();
        let mut all = blake3::Hasher::new();
        for name in names {
            let path = self.path.join(&name);
            let hash = hash_of(&path).map_err(|cause| FolderError::Unreadable { path, cause })?;
            all.update(name.as_bytes()).update(&[0]).update(hash.as_bytes());
        }
        Ok(all.finalize().to_hex().to_string())
    }

    /// Where the parts lie that several machines make of the campaign.
    pub fn parts(&self) -> PathBuf {
        self.path.join(PARTS)
    }
}

fn hash_of(path: &Path) -> std::io::Result<blake3::Hash> {
    let mut file = bounds::open(path, u64::MAX)?;
    let (mut hasher, mut block) = (blake3::Hasher::new(), vec![0; BLOCK]);
    loop {
        match file.read(&mut block)? {
            0 => return Ok(hasher.finalize()),
            count => hasher.update(&block[..count]),
        };
    }
}

fn name_below(folder: &Path, path: &Path) -> Option<String> {
    Some(path.strip_prefix(folder).ok()?.to_str()?.replace('\\', "/"))
}
