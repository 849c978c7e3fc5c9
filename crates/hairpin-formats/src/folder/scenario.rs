//! The resolved scenario of a campaign folder, and what made it.

use hairpin::campaign::Setup;

use super::list::List;
use super::{CampaignFolder, FolderError};
use crate::atomic;
use crate::scenario::{MadeBy, read_made_by, to_toml};

impl CampaignFolder {
    /// Writes the resolved scenario, with what the results depend on beside it (this version, and the SIMD level of the
    /// kernels), and the files that it names.
    ///
    /// # Errors
    /// A file cannot be written; TOML cannot hold the scenario.
    pub fn keep_scenario(&self, setup: &Setup, simd: &str) -> Result<(), FolderError> {
        let root_seed = setup.scenario.seed();
        let made_by = MadeBy { version: env!("CARGO_PKG_VERSION").into(), root_seed, simd: simd.into() };
        let text = to_toml(&setup.scenario, Some(&made_by))?;
        let files = setup.attachments.files();
        let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
        List::read(self.path())?.unwrap_or_default().take_in(self.path(), &names)?;
        // First the files, then what says that there are such.
        for (file, bytes) in files {
            atomic::write(&self.file(file), bytes)?;
        }
        self.write_scenario(&text)
    }

    /// The SIMD level at which the campaign was begun, if that is written in its scenario.
    ///
    /// # Errors
    /// The scenario cannot be read.
    pub fn simd_level(&self) -> Result<Option<String>, FolderError> {
        Ok(read_made_by(&self.read_scenario()?).map(|made_by| made_by.simd))
    }
}
