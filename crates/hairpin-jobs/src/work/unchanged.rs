//! Whether what is in a campaign's folder is of the scenario that it has, and of these kernels.

use hairpin::campaign::{CaseResult, Setup, contradiction};
use hairpin::math::simd::Simd;
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::quote::shell_word;

use crate::Problem;

/// Whether the runs in `folder` are of the scenario that it has: whoever edits that makes no other runs of them.
///
/// # Errors
/// A key beside those of `spec`, or the controller's file, was changed since hairpin wrote them.
pub(crate) fn same_as_executed(folder: &CampaignFolder, setup: &Setup) -> Result<(), Problem> {
    if folder.has_runs() { same_as_made(folder, setup, &[]) } else { Ok(()) }
}

/// Where on Earth a world is may be written afterwards, for exports and logs that ask for it.
pub(crate) const PLACE: [&str; 2] = ["world.origin", "world.terrain.epsg"];

/// Whether the cases in `folder`, and its runs where it has some, are of the scenario that it has. Keys that are, or
/// lie under, one of `beside` may change.
///
/// # Errors
/// As of [`same_as_executed`].
pub(crate) fn same_as_made(folder: &CampaignFolder, setup: &Setup, beside: &[&str]) -> Result<(), Problem> {
    let is_beside = |key: &String| {
        let under = |of: &&str| key.strip_prefix('`').and_then(|key| key.strip_prefix(*of));
        beside.iter().filter_map(under).any(|rest| rest.starts_with(['.', '`']))
    };
    let edited: Vec<String> = folder.edited(setup)?.into_iter().filter(|key| !is_beside(key)).collect();
    if edited.is_empty() {
        return Ok(());
    }
    let (what, anew) = match folder.has_runs() {
        true => ("runs were executed", format!("fly all anew: {}", execute_of(folder))),
        false => ("cases were made", format!("make them anew, or fly them by it: {}", execute_of(folder))),
    };
    let (kept, edited) = (what.split(' ').next().unwrap_or_default(), edited.join(", "));
    Err(Problem::of_file(
        &folder.file("scenario.toml"),
        format!(
            "was changed beside `spec` since its {what}: {edited}. The {kept} are of what it was. Put it back, or {anew}"
        ),
    ))
}

/// That another version of hairpin made what is in `folder`, in a sentence; `None` where this one did, or it is not
/// told.
pub(crate) fn of_another_version(folder: &CampaignFolder) -> Result<Option<String>, Problem> {
    let ours = env!("CARGO_PKG_VERSION");
    let theirs = folder.written_by()?.filter(|theirs| theirs != ours);
    let path = folder.path().display();
    Ok(theirs.map(|theirs| {
        format!(
            "{path} is of hairpin {theirs}, and this is {ours}: what was executed and measured then is that version's"
        )
    }))
}

/// That no result of `results` is a pass that its own measures contradict.
///
/// # Errors
/// The first that does, with its limit.
pub(crate) fn no_contradiction(folder: &CampaignFolder, setup: &Setup, results: &[CaseResult]) -> Result<(), Problem> {
    let found = results.iter().find_map(|result| Some((result.case, contradiction(setup, result)?)));
    found.map_or(Ok(()), |(case, broken)| {
        let judge = format!("hairpin judge {}", shell_word(&folder.path().display().to_string()));
        let why = format!("case {case} is `pass`, and its own measures are not: {broken}. Judge it anew: {judge}");
        Err(Problem::of_file(&folder.file("results.parquet"), why))
    })
}

fn execute_of(folder: &CampaignFolder) -> String {
    format!("hairpin execute {}", shell_word(&folder.path().display().to_string()))
}

/// Refuses to go on in `folder` at another SIMD level: the bits would be the same, but what is written of their origin
/// would not be true.
pub(crate) fn same_level(folder: &CampaignFolder, simd: Simd) -> Result<(), Problem> {
    let (now, path) = (simd.level(), folder.path().display());
    match folder.simd_level()? {
        Some(before) if before != now => Err(Problem::input(if before == Simd::Portable.level() {
            format!("{path} was begun with --portable: go on with it, or take another --out")
        } else {
            format!(
                "{path} was begun at the SIMD level {before}, and this is {now}: go on at {before}, or begin another \
                 with --portable, which goes on anywhere"
            )
        })),
        _ => Ok(()),
    }
}
