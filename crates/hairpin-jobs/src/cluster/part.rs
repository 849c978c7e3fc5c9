//! One part: a small campaign folder with the cases of its units and their runs, put in place whole.

use std::path::Path;

use hairpin::campaign::Case;
use hairpin::campaign::generate::{Known, expected_before, renumbered};
use hairpin_formats::folder::{CampaignFolder, Existing, PART};
use hairpin_formats::{atomic, bounds};
use serde::{Deserialize, Serialize};

use super::plan::{Plan, Unit};
use crate::execute::fly_missing;
use crate::generate::{find_cases_together, find_units, keep_cases};
use crate::rounds::Rounds;
use crate::work::Work;
use crate::{Deadline, Problem, Watch};

/// What a part says of itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Part {
    hairpin_part: u32,
    /// The plan that it is of.
    plan: String,
    part: u64,
    /// The number of its first case: what those before it give, where that is known, else what they may give.
    pub(super) first: u64,
    /// How many cases it has.
    pub(super) cases: u64,
    /// Its runs that the executor failed to fly.
    #[serde(default)]
    pub(super) failed: u64,
    /// Of these, runs that no program was asked to fly.
    #[serde(default)]
    pub(super) never_asked: u64,
    /// The hash of all that it holds.
    content: String,
}

impl Part {
    /// What part number `part` says; `None` where it is not there or is of another plan. What it holds is not looked
    /// at.
    pub(super) fn told(work: &Work, plan: &Plan, part: u64) -> Option<Self> {
        let place = work.folder.part_folder(part);
        // A link could lead anywhere.
        std::fs::symlink_metadata(&place).ok().filter(std::fs::Metadata::is_dir)?;
        let text = bounds::read_json_text(&place.join(PART)).ok()?;
        let told: Self = serde_json::from_str(&text).ok()?;
        (told.plan == plan.hash && told.part == part).then_some(told)
    }

    /// The same where it also holds what it says, and was made of the campaign's scenario.
    pub(super) fn whole(work: &Work, plan: &Plan, part: u64) -> Option<(Self, CampaignFolder)> {
        let told = Self::told(work, plan, part)?;
        let folder = CampaignFolder::open(&work.folder.part_folder(part)).ok()?;
        let is_of_it = folder.read_scenario().ok()? == work.folder.read_scenario().ok()?;
        (is_of_it && folder.content_hash().ok()? == told.content).then_some((told, folder))
    }
}

/// The number of the first case of part number `part`, as far as that can be known: where all parts before it are
/// there, what these have.
pub(super) fn first_of(work: &Work, plan: &Plan, part: u64) -> u64 {
    let told = (0..part).map(|before| Part::told(work, plan, before).map(|told| told.cases)).sum::<Option<u64>>();
    let by_case = plan.unit == Unit::Case;
    let expected = || expected_before(&work.setup.scenario, plan.units_of(part).start);
    told.filter(|_| !by_case).unwrap_or_else(expected)
}

/// What a part holds.
pub(super) fn known_in(folder: &CampaignFolder) -> Result<Known, Problem> {
    Ok(Known { cases: folder.read_cases()?, tally: folder.read_tally()? })
}

/// Whether a part is as it would be made now: all its runs were asked for, and nothing is known now that was not when
/// it was made.
pub(super) fn is_current(work: &Work, plan: &Plan, told: &Part) -> bool {
    if told.never_asked > 0 {
        return false;
    }
    match plan.unit {
        Unit::Case => true,
        Unit::Graph => told.first == first_of(work, plan, told.part),
        Unit::Search | Unit::Rounds if told.part == 0 => true,
        Unit::Search | Unit::Rounds => Part::told(work, plan, 0).is_none_or(|search| {
            let own = plan.flown_by(told.part);
            told.cases == own.end.min(search.cases).saturating_sub(own.start)
        }),
    }
}

/// Makes part number `part`, the `rounds` of a search shared with others; of one that is there with other numbers,
/// `before`, only the runs are made again.
pub(super) fn make(
    work: &Work,
    plan: &Plan,
    (part, before): (u64, Option<&CampaignFolder>),
    rounds: Option<&Rounds>,
    watch: &dyn Watch,
) -> Result<(), Problem> {
    let place = work.folder.part_folder(part);
    let temporary = atomic::temporary_folder(&work.folder.parts())?;
    let folder = CampaignFolder::create(temporary.path(), Existing::Resume)?;
    folder.write_scenario(&work.folder.read_scenario()?)?;
    let own = Work { folder, setup: work.setup.clone() };
    let (first, cases, found) = match plan.unit {
        Unit::Search | Unit::Rounds => searched(work, (&own, part), plan, rounds, watch)?,
        Unit::Graph | Unit::Case => {
            let first = first_of(work, plan, part);
            let known = match before {
                Some(before) => {
                    let Known { cases, tally } = known_in(before)?;
                    Known { cases: renumbered(&own.setup.scenario, cases, first), tally }
                }
                None => find_units(&own, (plan.units_of(part), first), watch)?,
            };
            keep_cases(&own, &known.cases, 0, &known.tally)?;
            // What a controller reads is what is flown: numbers as they are written.
            let cases = if own.setup.has_programs() { own.folder.read_cases()? } else { known.cases };
            let found = cases.len();
            (first, cases, found)
        }
    };
    // Recordings are taken in where all is put together.
    let flies = own.setup.recordings().is_none() && !cases.is_empty();
    let flown = if flies { Some(fly_missing(&own, &cases, watch)?) } else { None };
    let [failed, never_asked] = flown.map_or([0; 2], |flown| [flown.failed as u64, flown.never_asked as u64]);
    let (plan_hash, content) = (plan.hash.clone(), own.folder.content_hash()?);
    let told =
        Part { hairpin_part: 1, plan: plan_hash, part, first, cases: found as u64, failed, never_asked, content };
    atomic::write_json(&own.folder.file(PART), &told)?;
    drop(own);
    put(temporary, &place, &|| Part::whole(work, plan, part).is_some_and(|(there, _)| is_current(work, plan, &there)))
}

/// The first part of one search is the search; the others fly their share of what it found, if it is there. Gives the
/// number of the first case, the cases to be flown, and how many the part says that it has.
fn searched(
    work: &Work,
    (own, part): (&Work, u64),
    plan: &Plan,
    rounds: Option<&Rounds>,
    watch: &dyn Watch,
) -> Result<(u64, Vec<Case>, usize), Problem> {
    let share = plan.flown_by(part);
    let cases = if part == 0 {
        find_cases_together(own, [Deadline::after(None); 2], rounds, watch)?.0
    } else {
        Part::whole(work, plan, 0).map_or_else(|| Ok(Vec::new()), |(_, folder)| folder.read_cases())?
    };
    let found = cases.len();
    let flown: Vec<Case> = cases.into_iter().take(share.end as usize).skip(share.start as usize).collect();
    let said = if part == 0 { found } else { flown.len() };
    Ok((share.start, flown, said))
}

/// Puts a part in its place; of what stands there, one that `is_whole` stays.
fn put(temporary: tempfile::TempDir, place: &Path, is_whole: &dyn Fn() -> bool) -> Result<(), Problem> {
    let refuse = |cause| Problem::from(atomic::WriteError { path: place.into(), cause });
    if place.is_dir() && !is_whole() {
        std::fs::remove_dir_all(place).map_err(refuse)?;
    }
    // Another process may have put it there meanwhile: its bytes are the same.
    atomic::put_folder(temporary, place)?;
    Ok(())
}
