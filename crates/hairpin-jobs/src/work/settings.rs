//! What a campaign is begun with.

use std::path::PathBuf;

use hairpin::math::simd::Simd;

use crate::consent::Consent;
use crate::sets::Set;

/// What a campaign is begun with.
#[derive(Debug, Clone, Default)]
pub struct CampaignSettings {
    /// Scenario file, or the name of a shipped scenario or robot.
    pub scenario: String,
    /// Campaign folder; out/NAME of the scenario if not given.
    pub out: Option<PathBuf>,
    /// Keys of the scenario with other values.
    pub sets: Vec<Set>,
    /// What happens to a campaign that is in the folder already.
    pub if_there: IfThere,
    /// Seconds after which generation stops and keeps what exists.
    pub time_limit_s: Option<f64>,
    /// Seconds for the whole campaign; what is not done by then is told, and no pass.
    pub budget_s: Option<f64>,
    /// Version of the kernels.
    pub simd: Simd,
    /// What of a folder may run.
    pub consent: Consent,
}

/// What beginning a campaign does about one that is in its folder already.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum IfThere {
    /// Refuses.
    #[default]
    Refuse,
    /// Goes on with it, if it was begun with the same settings.
    Resume,
    /// Replaces it.
    Replace,
}
