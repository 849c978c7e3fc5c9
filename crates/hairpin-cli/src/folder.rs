//! Campaign folders, for commands that are no jobs yet.

use std::path::Path;

use hairpin::campaign::Setup;
use hairpin_formats::folder::CampaignFolder;
pub(crate) use hairpin_jobs::differences::differences;
use hairpin_jobs::work::{self, Planned};
pub(crate) use hairpin_jobs::work::{Work, changed_by, keep_changes, look};
use hairpin_jobs::{Problem, sets};

use crate::args::{Campaign, Kernels};
use crate::settings;
pub(crate) use crate::settings::{simd, split, take_threads};
use crate::terminal::Terminal;

pub(crate) fn plan(campaign: &Campaign, executor: Option<&str>) -> Result<Planned, Problem> {
    take_threads(&campaign.threads);
    work::plan(&settings::campaign(campaign, executor)?, &Terminal::default())
}

pub(crate) fn begin(campaign: &Campaign, executor: Option<&str>) -> Result<Work, Problem> {
    plan(campaign, executor)?.begin()
}

pub(crate) fn as_command(command: &str) -> sets::Set {
    sets::executor(command)
}

pub(crate) fn as_logs(folder: &Path, pattern: &str) -> sets::Set {
    sets::logs(folder, pattern)
}

pub(crate) fn make(path: &Path, setup: &Setup, resume: bool, force: bool) -> Result<CampaignFolder, Problem> {
    Ok(work::make(path, setup.clone(), settings::if_there(resume, force))?.folder)
}

pub(crate) fn open(
    path: &Path,
    sets: &[sets::Set],
    allowed: &[&str],
    flown: Option<&Kernels>,
) -> Result<Work, Problem> {
    work::open(path, sets, allowed, flown.map(simd))
}
