//! A campaign being worked on.

use hairpin::campaign::{CallersCode, Setup};
use hairpin_formats::folder::CampaignFolder;

use crate::Problem;

/// A campaign being worked on.
pub struct Work {
    /// Its folder.
    pub folder: CampaignFolder,
    /// Its scenario, resolved and ready to run.
    pub setup: Setup,
}

impl Work {
    /// The same, with the caller's code in place of files.
    ///
    /// # Errors
    /// As of [`Setup::answered_by`].
    pub(crate) fn answered_by(self, code: &CallersCode) -> Result<Self, Problem> {
        Ok(Self { setup: self.setup.answered_by(code)?, ..self })
    }

    /// Its setup as it is told of: with what the program that executed calls itself.
    ///
    /// # Errors
    /// What the folder keeps of that is broken.
    pub(crate) fn told(&self) -> Result<Setup, Problem> {
        let greeting = self.folder.read_executor()?;
        let name = greeting.map(|greeting| greeting.name).unwrap_or_default();
        Ok(self.setup.clone().executed_by(&name))
    }
}
