//! A campaign's folder, gone on with under a scenario of which some keys are changed.

use std::path::Path;

use hairpin::campaign::scenario::shapes_the_plan;
use hairpin::campaign::{Scenario, Setup};
use hairpin::math::simd::Simd;
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::scenario::check_asked;

use super::asked::check_command;
use super::campaign::Work;
use super::open::resolve;
use super::unchanged::same_level;
use crate::Problem;
use crate::differences::differences;
use crate::sets::Set;

/// Opens a campaign folder for the next part, its scenario changed by `sets` in the tables `allowed`; [`keep_changes`]
/// writes it. Its SIMD level stays: a part that runs kernels goes on at it, those of the version `flown`, or not at
/// all.
pub(crate) fn open_to_change(
    path: &Path,
    sets: &[Set],
    allowed: &[&str],
    flown: Option<Simd>,
) -> Result<Work, Problem> {
    check_tables(sets, allowed)?;
    let folder = CampaignFolder::open_to_write(path)?;
    let setup = changed(&folder, sets)?;
    // The users' own programs run none of our kernels.
    match (flown, setup.scenario.executor().command) {
        (Some(Simd::Portable), _) => same_level(&folder, Simd::Portable)?,
        (Some(Simd::Widest), None) => same_level(&folder, setup.simd)?,
        (Some(Simd::Widest), Some(_)) | (None, _) => {}
    }
    Ok(Work { folder, setup })
}

/// That `sets` change nothing but the tables `allowed`.
///
/// # Errors
/// The first that does.
pub(crate) fn check_tables(sets: &[Set], allowed: &[&str]) -> Result<(), Problem> {
    for (key, _) in sets {
        let table = key.split(['.', '[']).next().unwrap_or_default().trim();
        if !allowed.contains(&table) {
            return Err(Problem::input(format!(
                "--set {key}: the folder's trajectories were made with its value; here only {} can be set",
                allowed.join(", ")
            )));
        }
    }
    Ok(())
}

/// What the scenario of `folder` describes once `sets` change it.
///
/// # Errors
/// A scenario with mistakes, or one that the folder's trajectories are none of.
pub(crate) fn changed(folder: &CampaignFolder, sets: &[Set]) -> Result<Setup, Problem> {
    let setup = resolve(folder, sets)?;
    check_asked(&setup.scenario, &folder.file("scenario.toml"))?;
    check_command(&setup.scenario)?;
    let plans = |scenario: &Scenario| {
        let of_plans = scenario.vary().iter().filter(|(key, _)| shapes_the_plan(key));
        of_plans.map(|(key, drawn)| (key.clone(), drawn.clone())).collect::<Vec<_>>()
    };
    if !sets.is_empty() && plans(&setup.scenario) != plans(&resolve(folder, &[])?.scenario) {
        return Err(Problem::input(
            "--set vary: the folder's trajectories were drawn by its keys under `task` and `generate`; these must stay",
        ));
    }
    Ok(setup)
}

/// Writes the scenario of `work` as [`open_to_change`] changed it.
pub(crate) fn keep_changes(work: &Work) -> Result<(), Problem> {
    let level = work.folder.simd_level()?;
    let level = level.as_deref().unwrap_or(work.setup.simd.level());
    Ok(work.folder.keep_scenario(&work.setup, level, work.folder.clear_within_mm()?)?)
}

/// The first key of the folder's scenario that `sets` change, or else the first of its files: one of the same name may
/// say something else.
pub(crate) fn changed_by(folder: &CampaignFolder, sets: &[Set]) -> Result<Option<String>, Problem> {
    Ok(first_difference(&resolve(folder, &[])?, &resolve(folder, sets)?))
}

/// The first key that differs, or else the first file.
pub(super) fn first_difference(before: &Setup, now: &Setup) -> Option<String> {
    let mut files = before.attachments.files().into_iter().zip(now.attachments.files());
    let file = || files.find(|(before, now)| before != now).map(|((name, _), _)| name.to_owned());
    differences(&before.scenario, &now.scenario).into_iter().next().or_else(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unwatched;
    use crate::work::{CampaignSettings, open_to_read, plan};

    /// What was proven clear within a limit is proven within it, however often the limit was changed since.
    #[test]
    fn proofs_hold_for_their_limit() {
        let place = tempfile::tempdir().unwrap();
        let (file, folder) = (place.path().join("cell.toml"), place.path().join("out"));
        let text = "hairpin = 1\nrobot = \"irb120\"\n[spec]\npath = { max_mm = 10 }\n[task]\npoints = [[300, 0, 300], [300, 100, 300]]\n";
        std::fs::write(&file, text).unwrap();
        let scenario = file.to_string_lossy().into_owned();
        let settings = CampaignSettings { scenario, out: Some(folder.clone()), ..CampaignSettings::default() };
        plan(&settings, &Unwatched).unwrap().begin().unwrap();
        for max in ["5", "500", "8"] {
            let sets = [("spec.path.max_mm".to_owned(), max.to_owned())];
            keep_changes(&open_to_change(&folder, &sets, &["spec"], None).unwrap()).unwrap();
            assert_eq!(open_to_read(&folder).unwrap().folder.clear_within_mm().unwrap(), Some(10.0), "{max}");
        }
    }
}
