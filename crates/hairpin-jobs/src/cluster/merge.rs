//! Parts put together: the folder is then what one machine would have left behind at that point, and goes on as an
//! interrupted campaign does.

use std::path::Path;

use hairpin::campaign::CaseNumber;
use hairpin::campaign::generate::joined;
use hairpin::math::simd::Simd;
use hairpin_formats::folder::CampaignFolder;
use rayon::prelude::*;

use super::part::{Part, known_in};
use super::plan::{Plan, Unit};
use super::shard::Shard;
use crate::consent::{Consent, Wish};
use crate::generate::{keep_cases, unfinished};
use crate::program;
use crate::stress::{Stressed, stress_begun};
use crate::work::{Work, open_to_change};
use crate::{Budget, Problem, Watch};

/// What says that the files of a campaign's search are whole.
const LAST: &str = "generation.json";
/// Missing parts that are named.
const NAMED: usize = 5;

/// A campaign that was put together.
pub struct Merged {
    /// What it came to.
    pub stressed: Stressed,
    /// Of how many parts.
    pub parts: u64,
    /// Runs that were taken over.
    pub taken: usize,
    /// The hash of what it holds: the same for any number of shards, and of one machine.
    pub content_hash: String,
}

/// Puts the parts of the campaign in `folder` together, flies what no part has (random cases beside them, cases whose
/// number a part could not know), judges, and writes the report.
///
/// # Errors
/// A part is missing or broken, or another program's than the others; otherwise as of [`run_shard`](super::run_shard).
pub fn merge(folder: &Path, consent: &Consent, watch: &dyn Watch) -> Result<Merged, Problem> {
    let work = open_to_change(folder, &[], &["execute"], Some(Simd::Widest))?.answered_by(&consent.code)?;
    let plan = Plan::read(&work)?;
    consent.ask(folder, &Wish::of_campaign(&work.setup))?;
    let parts = whole_parts(&work, &plan)?;
    let program = program::of_all(&parts)?;
    work.folder.forget_cases()?;
    work.folder.forget_parts_cut_short()?;
    work.folder.forget_rounds()?;
    let taken = match plan.unit {
        Unit::Search | Unit::Rounds => take_all(&work, &parts)?,
        Unit::Graph | Unit::Case => take_over(&work, &parts)?,
    };
    drop(parts);
    if let Some(program) = program {
        work.folder.take_executor(&program)?;
    }
    let stressed = stress_begun(work, &Budget::endless(), Vec::new(), watch)?;
    let content_hash = stressed.work.folder.content_hash()?;
    Ok(Merged { stressed, parts: plan.parts, taken, content_hash })
}

fn whole_parts(work: &Work, plan: &Plan) -> Result<Vec<CampaignFolder>, Problem> {
    let found: Vec<Option<CampaignFolder>> =
        (0..plan.parts).map(|part| Part::whole(work, plan, part).map(|(_, folder)| folder)).collect();
    let missing: Vec<u64> =
        (0..plan.parts).zip(&found).filter(|(_, found)| found.is_none()).map(|(part, _)| part).collect();
    let Some(first) = missing.first() else { return Ok(found.into_iter().flatten().collect()) };
    let named = missing.iter().take(NAMED).map(|part| format!("part-{part:05}")).collect::<Vec<_>>().join(", ");
    let more = if missing.len() > NAMED { ", …" } else { "" };
    let shard = Shard { number: first + 1, of: plan.parts };
    Err(Problem::input(format!(
        "{} of {} parts of {} are missing or not whole: {named}{more}; hairpin run-shard {shard} {} makes the first, and any \
         run-shard i/N those of its share",
        missing.len(),
        plan.parts,
        work.folder.path().display(),
        work.folder.path().display()
    )))
}

/// The part that is the search, and the runs of the others.
fn take_all(work: &Work, parts: &[CampaignFolder]) -> Result<usize, Problem> {
    let Some((search, others)) = parts.split_first() else { return Ok(0) };
    search.copy_all(&work.folder, LAST)?;
    let cases: Vec<CaseNumber> = work.folder.read_cases()?.iter().map(|case| case.number).collect();
    let flown = |part: &CampaignFolder| -> Result<Vec<CaseNumber>, Problem> {
        let known = |case: &CaseNumber| Ok((!part.facts_of(*case)?.is_empty()).then_some(*case));
        cases.iter().filter_map(|case| known(case).transpose()).collect()
    };
    let own: Vec<CaseNumber> = flown(search)?;
    let each: Result<Vec<_>, Problem> = others.iter().map(flown).collect();
    let each = each?;
    let taken = own.len() + each.iter().map(Vec::len).sum::<usize>();
    take_runs(work, (others, &each), &cases)?;
    Ok(taken * work.setup.scenario.executor().repeat as usize)
}

/// The runs of `each` part as they stand there, those of `cases` being all that there will be.
fn take_runs(
    work: &Work,
    (parts, each): (&[CampaignFolder], &[Vec<CaseNumber>]),
    cases: &[CaseNumber],
) -> Result<(), Problem> {
    let repeat = work.setup.scenario.executor().repeat as usize;
    let writer = work.folder.write_runs(repeat, cases.iter().flat_map(|case| (0..repeat).map(move |run| (*case, run))));
    let mut reruns = Vec::new();
    for (part, own) in parts.iter().zip(each) {
        part.hand_runs(own, &writer, &work.folder)?;
        reruns.extend(part.reruns_of(own)?);
    }
    writer.finish()?;
    if reruns.is_empty() { Ok(()) } else { Ok(work.folder.land_reruns(reruns)?) }
}

/// The cases of all parts in their order, and those of their runs that were flown under the number that the case has.
fn take_over(work: &Work, parts: &[CampaignFolder]) -> Result<usize, Problem> {
    let known: Result<Vec<_>, Problem> = parts.par_iter().map(known_in).collect();
    let (all, same) = joined(&work.setup.scenario, known?);
    keep_cases(work, &all.cases, 0, &unfinished(&all.tally))?;
    let cases: Vec<CaseNumber> = all.cases.iter().map(|case| case.number).collect();
    take_runs(work, (parts, &same), &cases)?;
    Ok(same.iter().map(Vec::len).sum::<usize>() * work.setup.scenario.executor().repeat as usize)
}
