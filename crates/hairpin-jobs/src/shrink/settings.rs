//! What is shrunk, and how long.

use std::path::PathBuf;

use hairpin::campaign::CaseNumber;
use hairpin::math::simd::Simd;

use crate::consent::Consent;

/// What is shrunk, and how long.
#[derive(Debug, Clone)]
pub struct ShrinkSettings {
    /// Judged campaign folder.
    pub folder: PathBuf,
    /// Number of the violating case.
    pub case: CaseNumber,
    /// Executions at most.
    pub budget: u64,
    /// Seconds after which it stops with the smallest so far.
    pub time_limit_s: Option<f64>,
    /// File to write; repro/CASE-shrunk.json in the folder if not given.
    pub out: Option<PathBuf>,
    /// Version of the kernels.
    pub simd: Simd,
    /// What of the folder may run.
    pub consent: Consent,
}

impl Default for ShrinkSettings {
    fn default() -> Self {
        let (folder, case, time_limit_s, out, simd, consent) = Default::default();
        Self { folder, case, budget: 200, time_limit_s, out, simd, consent }
    }
}
