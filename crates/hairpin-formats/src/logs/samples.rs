//! How many samples a log may hold, counted over all of its topics while they are read.

use super::error::Fault;

/// Samples of all topics of a log at most: four hours at 250 Hz.
pub const MOST_SAMPLES: usize = 4_000_000;

/// What is left of [`MOST_SAMPLES`].
#[derive(Debug)]
pub(super) struct Budget(usize);

impl Default for Budget {
    fn default() -> Self {
        Self(MOST_SAMPLES)
    }
}

impl Budget {
    /// Room for one sample more.
    pub(super) fn take(&mut self) -> Result<(), Fault> {
        self.0 = self.0.checked_sub(1).ok_or(Fault::TooLong)?;
        Ok(())
    }
}
