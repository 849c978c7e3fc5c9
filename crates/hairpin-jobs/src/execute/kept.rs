//! Runs with their motion: as it was kept or, where it was not, executed again.

use hairpin::campaign::{Case, Run};
use hairpin_formats::parquet::runs::RunFacts;

use super::job::{Job, comes_again};
use crate::Problem;
use crate::work::Work;

/// The runs of `case`, in their order.
pub(crate) fn runs_with_motion(work: &Work, case: &Case) -> Result<Vec<Run>, Problem> {
    let known = work.folder.facts_of(case.number)?;
    if known.iter().all(RunFacts::is_kept) {
        return Ok(work.folder.read_runs(case.number)?);
    }
    let with_motion = |facts: &RunFacts| match facts.is_kept() {
        true => work.folder.read_run(case.number, facts.run).transpose().map(|run| Ok(run?)),
        false => Some(executed_again(work, case, facts, |case| vec![Job { case, run: facts.run, again: None }])),
    };
    known.iter().filter_map(with_motion).collect()
}

/// One of them; `None` where it was not executed.
pub(crate) fn run_with_motion(work: &Work, case: &Case, run: usize) -> Result<Option<Run>, Problem> {
    match left_out(work, case, run)? {
        Some(facts) => executed_again(work, case, &facts, |case| vec![Job { case, run, again: None }]).map(Some),
        None => Ok(work.folder.read_run(case.number, run)?),
    }
}

/// Why a run is not to be had any more, where that is so.
pub(crate) fn why_lost(work: &Work, case: &Case, run: usize) -> Result<Option<Problem>, Problem> {
    let facts = left_out(work, case, run)?.filter(|_| !comes_again(&work.setup));
    Ok(facts.map(|facts| lost(work, &facts)))
}

/// The runs of `case` that were flown again, in their order.
pub(crate) fn reruns_with_motion(work: &Work, case: &Case) -> Result<Vec<Run>, Problem> {
    let known = work.folder.rerun_facts_of(case.number)?;
    if known.iter().all(RunFacts::is_kept) {
        return Ok(work.folder.read_reruns(case.number)?);
    }
    let repeat = work.setup.scenario.executor().repeat as usize;
    let with_motion = |facts: &RunFacts| match facts.is_kept() {
        true => work.folder.read_rerun(case.number, facts.run).transpose().map(|run| Ok(run?)),
        // Nothing says which run of the case it was, but what came of it.
        false => Some(executed_again(work, case, facts, |case| {
            (0..repeat).map(|run| Job { case, run, again: Some(facts.run) }).collect()
        })),
    };
    known.iter().filter_map(with_motion).collect()
}

/// What is known of a run whose motion was not kept.
fn left_out(work: &Work, case: &Case, run: usize) -> Result<Option<RunFacts>, Problem> {
    let known = work.folder.facts_of(case.number)?;
    Ok(known.into_iter().find(|facts| facts.run == run && !facts.is_kept()))
}

/// The run of which `facts` are known: the first of `jobs` that comes out so.
fn executed_again(
    work: &Work,
    case: &Case,
    facts: &RunFacts,
    jobs: impl for<'c> FnOnce(&'c Case) -> Vec<Job<'c>>,
) -> Result<Run, Problem> {
    if !comes_again(&work.setup) {
        return Err(lost(work, facts));
    }
    let mut own = case.clone();
    if own.witness.is_none() {
        work.folder.read_witness(&mut own)?;
    }
    let mut runs = jobs(&own).into_iter().map(|job| job.simulate(&work.setup));
    let other = "executed again it comes out otherwise, as where files were edited, or in another version of hairpin";
    runs.find(|run| facts.is_of(run)).ok_or_else(|| not_kept(work, facts, other))
}

fn lost(work: &Work, facts: &RunFacts) -> Problem {
    not_kept(work, facts, "a program flew it, which need not fly it so again")
}

fn not_kept(work: &Work, facts: &RunFacts, why: &str) -> Problem {
    Problem::input(format!(
        "case {}, run {}: its motion was not kept (`execute.record` = \"{}\"), and {why}; hairpin execute {} --keep all flies all anew",
        facts.case,
        facts.run,
        work.setup.scenario.executor().record.word(),
        work.folder.path().display()
    ))
}
