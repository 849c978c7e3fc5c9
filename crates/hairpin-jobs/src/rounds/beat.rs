//! The word that one is alive: a file of its own that says something else every second.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use hairpin_formats::atomic;
use hairpin_formats::folder::ALIVE;

use crate::Problem;

/// Says so until it is dropped; then the file goes.
pub(super) struct Beat {
    path: PathBuf,
    name: String,
    /// Closes when this ends.
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Beat {
    /// Under a name in `folder` that nobody else has.
    pub(super) fn begin(folder: &Path, every: Duration) -> Result<Self, Problem> {
        let new = tempfile::Builder::new().prefix(ALIVE).rand_bytes(12).tempfile_in(folder);
        let (_, path) = new
            .and_then(|file| file.keep().map_err(|error| error.error))
            .map_err(|cause| atomic::WriteError { path: folder.into(), cause })?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let (end, ended) = channel::<()>();
        let own = path.clone();
        let thread = thread::spawn(move || {
            let mut beats = 0_u64;
            // A new file under the old name: where folders are cached (NFS), who changes one sees it as it is.
            while ended.recv_timeout(every) == Err(RecvTimeoutError::Timeout) {
                beats += 1;
                // One that is missed is missed.
                let _ = atomic::write(&own, beats.to_string().as_bytes());
            }
        });
        Ok(Self { path, name, end: Some(end), thread: Some(thread) })
    }

    /// What the file is called.
    pub(super) fn name(&self) -> &str {
        &self.name
    }
}

impl Drop for Beat {
    fn drop(&mut self) {
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
        let _ = fs::remove_file(&self.path);
    }
}
