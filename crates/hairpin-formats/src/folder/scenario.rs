//! The resolved scenario of a campaign folder, and what made it.

use hairpin::campaign::Setup;

use super::list::List;
use super::{CampaignFolder, FolderError};
use crate::atomic;
use crate::scenario::{Digests, MadeBy, changed_keys, read_made_by, to_toml};

impl CampaignFolder {
    /// Writes the resolved scenario, with what the results depend on beside it (this version, and the SIMD level of the
    /// kernels), and the files that it names. What was proven clear of its plans holds `clear_within` mm off their
    /// paths.
    ///
    /// # Errors
    /// A file cannot be written; TOML cannot hold the scenario.
    pub fn keep_scenario(&self, setup: &Setup, simd: &str, clear_within: Option<f64>) -> Result<(), FolderError> {
        let root_seed = setup.scenario.seed();
        let text = to_toml(&setup.scenario, None)?;
        let digests = Digests::of(&text, controller_of(setup));
        let (settings, keys) = digests.map(|Digests { settings, keys }| (settings, keys)).unzip();
        let keys = keys.unwrap_or_default();
        let version = env!("CARGO_PKG_VERSION").into();
        let made_by = MadeBy { version, root_seed, settings, keys, clear_within_mm: clear_within, simd: simd.into() };
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

    /// What of the scenario, but for `spec`, and of the controller's file is not as hairpin wrote it: in words, keys
    /// between backticks. Nothing of folders of earlier versions, which did not say.
    ///
    /// # Errors
    /// The scenario cannot be read.
    pub fn edited(&self, setup: &Setup) -> Result<Vec<String>, FolderError> {
        let text = self.read_scenario()?;
        let Some(MadeBy { settings: Some(written), keys, .. }) = read_made_by(&text) else { return Ok(Vec::new()) };
        let now = Digests::of(&text, controller_of(setup));
        if now.as_ref().is_some_and(|now| now.settings == written) {
            return Ok(Vec::new());
        }
        if keys.is_empty() {
            return Ok(vec!["a key beside `spec`, or the controller's file".into()]);
        }
        let changed = changed_keys(&keys, &now.map(|now| now.keys).unwrap_or_default());
        Ok(match changed.len() {
            0 => vec!["the controller's file".into()],
            _ => changed.into_iter().map(|key| format!("`{key}`")).collect(),
        })
    }

    /// How far off their paths (mm) what was proven clear of the plans holds, if that is written in its scenario.
    ///
    /// # Errors
    /// The scenario cannot be read.
    pub fn clear_within_mm(&self) -> Result<Option<f64>, FolderError> {
        Ok(read_made_by(&self.read_scenario()?).and_then(|made_by| made_by.clear_within_mm))
    }

    /// The version of hairpin that wrote the campaign's scenario, if that is written there.
    ///
    /// # Errors
    /// The scenario cannot be read.
    pub fn written_by(&self) -> Result<Option<String>, FolderError> {
        Ok(read_made_by(&self.read_scenario()?).map(|made_by| made_by.version))
    }

    /// The SIMD level at which the campaign was begun, if that is written in its scenario.
    ///
    /// # Errors
    /// The scenario cannot be read.
    pub fn simd_level(&self) -> Result<Option<String>, FolderError> {
        Ok(read_made_by(&self.read_scenario()?).map(|made_by| made_by.simd))
    }
}

/// The bytes of the user's controller, where one steers.
fn controller_of(setup: &Setup) -> Option<&[u8]> {
    setup.attachments.user_controller.as_ref()?.file.as_ref().map(|(_, bytes)| &**bytes)
}
