//! What a campaign folder keeps of the program of the user's that executed: what it says of itself, and its logs.

use std::fs;
use std::io;
use std::sync::PoisonError;

use hairpin::campaign::CaseNumber;

use super::list::List;
use super::{CampaignFolder, EXECUTOR, FolderError};
use crate::atomic::{self, WriteError};
use crate::executor::{Failed, Greeting};

impl CampaignFolder {
    /// Writes `executor.json`: what the program of the user's that executes says of itself.
    ///
    /// # Errors
    /// The file cannot be written, or is another's.
    pub fn write_executor(&self, greeting: &Greeting) -> Result<(), FolderError> {
        self.executor_before()?;
        List::read(&self.path)?.unwrap_or_default().take_in(&self.path, &[EXECUTOR])?;
        self.write_json(EXECUTOR, greeting)
    }

    /// Reads it; `None` where none has executed, or has said nothing.
    ///
    /// # Errors
    /// The file is broken.
    pub fn read_executor(&self) -> Result<Option<Greeting>, FolderError> {
        self.read_json_if_there(EXECUTOR)
    }

    /// The program that executed what stood in the folder before this process: of that all that is executed is to be. A
    /// program may call itself otherwise each time that it is started, and within one process it is that one all the
    /// same.
    ///
    /// # Errors
    /// As [`Self::read_executor`].
    pub fn executor_before(&self) -> Result<Option<Greeting>, FolderError> {
        let mut known = self.executor_before.lock().unwrap_or_else(PoisonError::into_inner);
        if known.is_none() {
            *known = Some(self.read_executor()?);
        }
        Ok(known.clone().flatten())
    }

    /// Writes it of what is taken over from elsewhere, which stood there before this process as well.
    ///
    /// # Errors
    /// As [`Self::write_executor`].
    pub fn take_executor(&self, greeting: &Greeting) -> Result<(), FolderError> {
        self.write_executor(greeting)?;
        self.set_executor_before(Some(greeting.clone()));
        Ok(())
    }

    pub(super) fn set_executor_before(&self, greeting: Option<Greeting>) {
        *self.executor_before.lock().unwrap_or_else(PoisonError::into_inner) = Some(greeting);
    }

    /// Writes `executor-CASE-RUN.log`: why a program of the user's failed to fly a run, and the end of its stderr.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_executor_log(&self, case: CaseNumber, run: usize, failed: &Failed) -> Result<(), FolderError> {
        let Failed { failure, stderr } = failed;
        let text = format!("{failure}\n\n--- the end of its stderr ---\n{stderr}");
        Ok(atomic::write(&self.file(&format!("executor-{case}-{run}.log")), text.as_bytes())?)
    }

    /// Removes it, where there is one: the run was flown.
    ///
    /// # Errors
    /// It cannot be removed.
    pub fn remove_executor_log(&self, case: CaseNumber, run: usize) -> Result<(), FolderError> {
        let path = self.file(&format!("executor-{case}-{run}.log"));
        match fs::remove_file(&path) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(WriteError { path, cause }.into()),
            _ => Ok(()),
        }
    }
}
