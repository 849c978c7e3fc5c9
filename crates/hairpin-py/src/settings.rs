//! From what Python hands over to the settings of jobs.

use std::path::PathBuf;

use hairpin::math::simd::Simd;
use hairpin_jobs::consent::Consent;
use hairpin_jobs::sets::Set;
use hairpin_jobs::work::{CampaignSettings, IfThere};
use pyo3::prelude::*;

use crate::callables::Code;

/// What runs, and by which kernels.
#[derive(FromPyObject)]
pub(crate) struct Means {
    /// Whether kernels are those of the level that all machines have.
    portable: bool,
    /// Whether what a folder asks to run may.
    allow_commands: bool,
    /// Callables of Python's that answer in place of files.
    code: Py<Code>,
}

impl Means {
    pub(crate) fn simd(&self) -> Simd {
        if self.portable { Simd::Portable } else { Simd::Widest }
    }

    pub(crate) fn consent(&self) -> Consent {
        let consent = Consent::of_user(self.allow_commands, |name| std::env::var_os(name));
        Consent { code: self.code.get().callers(), ..consent }
    }
}

/// What a campaign is begun with.
#[derive(FromPyObject)]
pub(crate) struct Begun {
    scenario: String,
    out: Option<PathBuf>,
    sets: Vec<Set>,
    /// `refuse`, `resume` or `replace`.
    if_there: String,
    time_limit_s: Option<f64>,
    budget_s: Option<f64>,
}

impl Begun {
    pub(crate) fn settings(self, means: &Means) -> CampaignSettings {
        let Self { scenario, out, sets, if_there, time_limit_s, budget_s } = self;
        let if_there = match if_there.as_str() {
            "resume" => IfThere::Resume,
            "replace" => IfThere::Replace,
            _ => IfThere::Refuse,
        };
        let (simd, consent) = (means.simd(), means.consent());
        CampaignSettings { scenario, out, sets, if_there, time_limit_s, budget_s, simd, consent }
    }
}
