//! What was read of a few files, the last one asked for first: neighbours are asked for one after another.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Of at most [`MOST`] files.
#[derive(Debug)]
pub(super) struct Recent<T>(Mutex<Vec<(PathBuf, Arc<T>)>>);

/// Files that are held at a time.
const MOST: usize = 6;

impl<T> Default for Recent<T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<T> Recent<T> {
    /// The first that is `wanted`.
    pub(super) fn find(&self, wanted: impl Fn(&Path, &T) -> bool) -> Option<Arc<T>> {
        let mut held = self.held();
        let place = held.iter().position(|(path, read)| wanted(path, read))?;
        let found = held.remove(place);
        let read = found.1.clone();
        held.insert(0, found);
        Some(read)
    }

    /// That of the file `path`; if it is not held, what `read` makes of it.
    ///
    /// # Errors
    /// As `read`.
    pub(super) fn or_read<E>(&self, path: &Path, read: impl FnOnce(&Path) -> Result<T, E>) -> Result<Arc<T>, E> {
        if let Some(known) = self.find(|known, _| known == path) {
            return Ok(known);
        }
        let new = Arc::new(read(path)?);
        let mut held = self.held();
        held.insert(0, (path.into(), new.clone()));
        held.truncate(MOST);
        Ok(new)
    }

    /// Lets go of the file `path`.
    pub(super) fn forget(&self, path: &Path) {
        self.held().retain(|(known, _)| known != path);
    }

    /// Lets go of all.
    pub(super) fn forget_all(&self) {
        self.held().clear();
    }

    fn held(&self) -> MutexGuard<'_, Vec<(PathBuf, Arc<T>)>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
