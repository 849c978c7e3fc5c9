//! A shard: the parts that are its own and not there yet.

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::part::{Part, is_current, make};
use super::plan::{Plan, Unit};
use super::shard::Shard;
use crate::consent::{Consent, Wish};
use crate::rounds::{Pace, Rounds};
use crate::watch::Steps;
use crate::work::{Work, open_to_read, same_level};
use crate::{Problem, Seen, Watch};

/// What a shard came to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ran {
    /// Its parts.
    pub parts: u64,
    /// Of these, those that were made now.
    pub made: u64,
    /// Cases in all of them.
    pub cases: u64,
    /// Runs in all of them that the executor failed to fly.
    pub failed: u64,
    /// Of these, runs that no program was asked to fly, as none could be started: the same shard, run again, flies
    /// them.
    pub never_asked: u64,
    /// Of how many parts the plan is.
    pub of: u64,
    /// What is beside that to be known, in a sentence.
    pub told: Option<String>,
}

/// Makes the parts of `shard` that the campaign in `folder` does not have, or not whole.
///
/// # Errors
/// The folder is not divided, or by another version, or not for this machine's kernels; it asks to run what its user
/// has not allowed; something cannot be written; it was asked to stop.
pub fn run_shard(folder: &Path, shard: Shard, consent: &Consent, watch: &dyn Watch) -> Result<Ran, Problem> {
    let work = open_to_read(folder)?.answered_by(&consent.code)?;
    let plan = Plan::read(&work)?;
    same_level(&work.folder, work.setup.simd)?;
    consent.ask(folder, &Wish::of_campaign(&work.setup))?;
    let own: Vec<u64> = shard.own(plan.parts).collect();
    let (made, cases) = (AtomicU64::new(0), AtomicU64::new(0));
    let (failed, never_asked) = (AtomicU64::new(0), AtomicU64::new(0));
    if plan.unit == Unit::Rounds && !is_there(&work, &plan, 0) {
        search_together(&work, &plan, shard, watch)?;
        made.fetch_add(u64::from(own.first() == Some(&0)), Ordering::Relaxed);
    }
    let steps = Steps::new(watch, "shard", 0, own.len());
    let one = |part: &u64| -> Result<(), Problem> {
        if watch.stopped() {
            return Err(Problem::Interrupted(
                "stopped; the parts that are whole stay, and the same command goes on".into(),
            ));
        }
        let there = Part::whole(&work, &plan, *part);
        if !there.as_ref().is_some_and(|(told, _)| is_current(&work, &plan, told)) {
            let before = there.as_ref().map(|(_, folder)| folder);
            make(&work, &plan, (*part, before), None, &Quiet(watch))?;
            made.fetch_add(1, Ordering::Relaxed);
        }
        // Those that one search has found are flown in the parts beside it.
        let counts = !plan.is_one_search() || *part > 0 || plan.parts == 1;
        if let Some(told) = Part::told(&work, &plan, *part) {
            cases.fetch_add(if counts { told.cases } else { 0 }, Ordering::Relaxed);
            failed.fetch_add(told.failed, Ordering::Relaxed);
            never_asked.fetch_add(told.never_asked, Ordering::Relaxed);
        }
        steps.step();
        Ok(())
    };
    // Programs of the user's are started part by part: as many of them run as the scenario says.
    let programs = has_programs(&work);
    // What others need comes first.
    let searches = plan.is_one_search() && own.first() == Some(&0);
    let (before, others) = own.split_at(usize::from(searches));
    before.iter().try_for_each(one)?;
    if programs {
        others.iter().try_for_each(one)?
    } else {
        others.par_iter().try_for_each(one)?
    }
    let (made, cases) = (made.into_inner(), cases.into_inner());
    let idle = || format!("shard {shard} has nothing to do: {} has {} parts", folder.display(), plan.parts);
    let early = || {
        "the search of shard 1 was not there yet: run this shard again after it, or leave its runs to merge".to_owned()
    };
    let none_found = plan.unit == Unit::Search && cases == 0 && Part::told(&work, &plan, 0).is_none();
    let told = own.is_empty().then(idle).or_else(|| none_found.then(early));
    let (failed, never_asked) = (failed.into_inner(), never_asked.into_inner());
    Ok(Ran { parts: own.len() as u64, made, cases, failed, never_asked, of: plan.parts, told })
}

fn is_there(work: &Work, plan: &Plan, part: u64) -> bool {
    Part::whole(work, plan, part).is_some_and(|(told, _)| is_current(work, plan, &told))
}

/// Whether runs are dear, so far as one can know: a program of the user's flies or steers them.
fn has_programs(work: &Work) -> bool {
    work.setup.scenario.executor().command.is_some() || work.setup.steering_code().is_some()
}

/// Follows the search, whoever it is of whose parts it is one: what it needs executed is shared with all others that
/// run.
fn search_together(work: &Work, plan: &Plan, shard: Shard, watch: &dyn Watch) -> Result<(), Problem> {
    let (folder, place) = (work.folder.rounds(&plan.hash), (shard.number - 1, shard.of));
    let rounds = Rounds::join(&folder, place, has_programs(work), Pace::default())?;
    let made = make(work, plan, (0, None), Some(&rounds), watch);
    if matches!(made, Err(Problem::Executor(_))) && !rounds.any_flown() {
        // What nobody's program flew says nothing of the trajectories: with a program that is mended all is flown anew.
        drop(rounds);
        work.folder.forget_rounds()?;
    }
    made
}

/// Hears nothing of the steps of single parts.
struct Quiet<'a>(&'a dyn Watch);

impl Watch for Quiet<'_> {
    fn stopped(&self) -> bool {
        self.0.stopped()
    }

    fn seen(&self, run: Seen) {
        self.0.seen(run);
    }

    fn warn(&self, line: &str) {
        self.0.warn(line);
    }
}
