//! What is executed, and how; and what came of it.

use std::path::PathBuf;

use hairpin::math::simd::Simd;

use super::missing::Flown;
use crate::consent::Consent;
use crate::saved::Replayed;
use crate::sets::Set;

/// What is executed, and how.
#[derive(Debug, Clone, Default)]
pub struct ExecuteSettings {
    /// Campaign folder.
    pub folder: PathBuf,
    /// Folder of a campaign of its own with the same cases, where the runs land; where not given they land in the
    /// campaign's.
    pub out: Option<PathBuf>,
    /// Whether a campaign that is in `out` makes room.
    pub replaces: bool,
    /// Keys of `execute`, `vary` and `spec` with other values.
    pub sets: Vec<Set>,
    /// A mission made elsewhere or a folder of them, which take the place of the folder's cases.
    pub missions: Option<PathBuf>,
    /// Folder of repro files that are run first; those of the campaign folder if not given.
    pub repro: Option<PathBuf>,
    /// Whether the runs that are there stay.
    pub resume: bool,
    /// Version of the kernels.
    pub simd: Simd,
    /// What of the folder may run.
    pub consent: Consent,
}

/// An executed campaign.
#[derive(Debug)]
pub struct Executed {
    /// Its folder.
    pub folder: PathBuf,
    /// How many cases it has.
    pub cases: usize,
    /// Their runs.
    pub flown: Flown,
    /// The case of the first run that was not flown, why it was not, and by which program.
    pub trouble: Option<String>,
    /// Names of the missions that were made elsewhere.
    pub missions: Vec<String>,
    /// Saved cases that were run first.
    pub replayed: Vec<Replayed>,
}
