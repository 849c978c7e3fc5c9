//! The folder of a campaign: whether it can be made or taken up, and doing so.

use std::path::{Component, Path, PathBuf};

use hairpin::campaign::Setup;
use hairpin_formats::folder::{CampaignFolder, Existing, FolderError};

use super::campaign::Work;
use super::change::first_difference;
use super::open::resolve;
use super::settings::IfThere;
use super::unchanged::{same_as_made, same_level};
use crate::Problem;

/// Whether two paths lead to one place.
pub(crate) fn same_place(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// Makes `path` the folder of the campaign of `setup`.
///
/// # Errors
/// As of [`super::plan`] and [`super::Planned::begin`].
pub fn make(path: &Path, setup: Setup, if_there: IfThere) -> Result<Work, Problem> {
    may_make(path, &setup, if_there)?;
    Ok(Work { folder: create(path, &setup, if_there)?, setup })
}

/// Whether `path`, which can become the folder of a campaign, is taken up again.
///
/// # Errors
/// It can be neither.
pub(super) fn may_make(path: &Path, setup: &Setup, if_there: IfThere) -> Result<bool, Problem> {
    // `new/../old` is no place before `new` is made, and `old` once it is.
    let mut begun = PathBuf::new();
    for part in path.components() {
        if part == Component::ParentDir && !begun.as_os_str().is_empty() && !begun.exists() {
            return Err(Problem::input(format!("--out {}: there is no folder {}", path.display(), begun.display())));
        }
        begun.push(part);
    }
    CampaignFolder::refuse_anothers(path)?;
    let old = match CampaignFolder::open(path) {
        Err(FolderError::NoCampaign { .. }) => return Ok(false),
        old => old?,
    };
    match if_there {
        IfThere::Refuse => Err(Problem::input(format!(
            "{} holds a campaign already: --resume goes on with it, --force replaces it, --out DIR keeps both",
            path.display()
        ))),
        IfThere::Resume => may_resume(&old, setup).map(|()| true),
        IfThere::Replace => Ok(false),
    }
}

/// Whether the campaign in `old` was begun as `setup` would begin it.
fn may_resume(old: &CampaignFolder, setup: &Setup) -> Result<(), Problem> {
    let before = resolve(old, &[])?;
    if old.has_cases() || old.has_runs() {
        same_as_made(old, &before, &[])?;
    }
    if let Some(key) = first_difference(&before, setup) {
        return Err(Problem::input(format!(
            "--resume: `{key}` is not what it was when {} was begun: give the same arguments, or another --out",
            old.path().display()
        )));
    }
    same_level(old, setup.simd)
}

pub(super) fn create(path: &Path, setup: &Setup, if_there: IfThere) -> Result<CampaignFolder, Problem> {
    let existing = if if_there == IfThere::Resume { Existing::Resume } else { Existing::Replace };
    let folder = CampaignFolder::create(path, existing)?;
    folder.keep_scenario(setup, setup.simd.level(), setup.scenario.clear_within_mm())?;
    Ok(folder)
}
