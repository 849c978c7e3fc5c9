//! `execute.record = "worst"`: which runs' motion stays once all have landed.

use std::collections::BTreeSet;

use hairpin::campaign::report::worst_first;
use hairpin::campaign::{self, Case, CaseResult};
use hairpin_formats::parquet::runs::RunFacts;
use rayon::prelude::*;

use super::fly::{Landing, fly};
use super::job::{Job, comes_again};
use super::to_judge::runs_to_judge;
use crate::work::Work;
use crate::{Problem, Watch};

/// Cases that count as the worst: they get repro files if they violate, and of these `worst` keeps a run.
pub(crate) const WORST: usize = 10;
/// Cases that are judged at a time.
const AT_ONCE: usize = 1000;

/// Keeps the worst run of each of the worst cases, as they are judged now, and no other that can be done without.
/// What was not kept while it landed is executed again.
pub(super) fn keep_worst(work: &Work, cases: &[Case], watch: &dyn Watch) -> Result<(), Problem> {
    let mut worst: Vec<CaseResult> = Vec::new();
    for block in cases.chunks(AT_ONCE) {
        let judge = |case: &Case| Ok(campaign::judge(&work.setup, case, &runs_to_judge(work, case)?.runs)?);
        worst.extend(block.par_iter().map(judge).collect::<Result<Vec<_>, Problem>>()?);
        worst = worst_first(&worst).into_iter().take(WORST).cloned().collect();
    }
    let chosen: BTreeSet<_> = worst.iter().map(|result| (result.case, result.run)).collect();
    let again = comes_again(&work.setup);
    let is_left_out = |facts: &RunFacts| again && !facts.is_kept() && chosen.contains(&(facts.case, facts.run));
    let mut jobs = Vec::new();
    for case in cases.iter().filter(|case| worst.iter().any(|result| result.case == case.number)) {
        let known = work.folder.facts_of(case.number)?;
        jobs.extend(known.iter().filter(|facts| is_left_out(facts)).map(|facts| Job {
            case,
            run: facts.run,
            again: None,
        }));
    }
    if !jobs.is_empty() {
        let repeat = work.setup.scenario.executor().repeat as usize;
        let writer = work.folder.write_runs(repeat, jobs.iter().map(|job| (job.case.number, job.run)));
        fly(work, &jobs, Landing { of: jobs.len(), writer, keeps: &|_| true }, watch)?;
    }
    let stays = |facts: &RunFacts| chosen.contains(&(facts.case, facts.run)) || !(facts.is_measured() || again);
    Ok(work.folder.keep_motion_of(&stays)?)
}
