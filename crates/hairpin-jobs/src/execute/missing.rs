//! Every case flown as often as the scenario asks for, where it was not yet.

use hairpin::campaign::arm::ArmSetup;
use hairpin::campaign::scenario::Record;
use hairpin::campaign::{self, Case, OnGround, Run, Status};
use hairpin::trajectory::ATTITUDE_UNKNOWN;
use hairpin_formats::executor::was_never_asked;
use rayon::prelude::*;

use super::fly::{Landing, fly};
use super::job::{Job, comes_again};
use super::kept::runs_with_motion;
use super::recorded::take_in;
use super::to_judge::runs_to_judge;
use super::worst::keep_worst;
use crate::missions::{self, read_told};
use crate::work::Work;
use crate::{Problem, Watch};

/// What the runs of a campaign are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Flown {
    /// All runs.
    pub runs: usize,
    /// Of these, runs that the executor failed to fly.
    pub failed: usize,
    /// Of these, runs that no program was asked to fly: to go on is to fly them.
    pub never_asked: usize,
    /// Of these, runs of which the executor sent no attitudes.
    pub attitude_unknown: usize,
    /// Of these, runs of which the executor did not say how they ended.
    pub end_unsaid: usize,
    /// Of these, runs of which the executor sent no heights: what drives is on the map's ground.
    pub heights_by_map: usize,
}

impl Flown {
    /// What the executor left out, in sentences, if it did.
    pub(crate) fn left_out(&self) -> impl Iterator<Item = String> {
        self.unsaid().into_iter().chain(self.without_heights())
    }

    /// That heights are the map's.
    fn without_heights(&self) -> Option<String> {
        let whose = (self.attitude_unknown == 0).then_some("executor");
        (self.heights_by_map > 0).then(|| {
            format!(
                "The executor sent no heights of {} of {} runs (0 in all of their poses): they are {}.",
                self.heights_by_map,
                self.runs,
                OnGround::in_words(whose)
            )
        })
    }

    /// That the executor left out how runs ended, if it did.
    fn unsaid(&self) -> Option<String> {
        (self.end_unsaid > 0).then(|| {
            format!(
                "The executor did not say how {} of {} runs ended: they are taken for `done`, which holds where they came to their \
                 last waypoint alone; a crash that it did not tell is none here.",
                self.end_unsaid, self.runs
            )
        })
    }
}

/// Flies all runs of `cases` that are not in the folder yet, and violations as often again as the scenario asks for.
pub(crate) fn fly_missing(work: &Work, cases: &[Case], watch: &dyn Watch) -> Result<Flown, Problem> {
    let repeat = work.setup.scenario.executor().repeat as usize;
    if let (Some(arm), Some(pattern)) = (work.setup.own::<ArmSetup>(), work.setup.recordings()) {
        take_in(work, (arm, pattern), cases, watch)?;
        return count(work, cases, repeat);
    }
    let all = || cases.iter().flat_map(|case| (0..repeat).map(move |run| (case, run)));
    let missing: Vec<Job> = all()
        .filter(|(case, run)| !work.folder.has_valid_run(case.number, *run))
        .map(|(case, run)| Job { case, run, again: None })
        .collect();
    let writer = work.folder.write_runs(repeat, all().map(|(case, run)| (case.number, run)));
    let (record, again) = (work.setup.scenario.executor().record, comes_again(&work.setup));
    let keeps = |run: &Run| match record {
        Record::All => true,
        // Which these are is known once all have landed; what can be had again is then executed once more.
        Record::Worst => run.full_rate.is_none() || !again,
        Record::None => is_indispensable(run, again),
    };
    fly(work, &missing, Landing { of: all().count(), writer, keeps: &keeps }, watch)?;
    if record == Record::Worst {
        keep_worst(work, cases, watch)?;
    }
    let flown = count(work, cases, repeat)?;
    fly_again(work, cases, watch)?;
    if flown.attitude_unknown > 0 {
        watch.warn(&format!(
            "Warning: {} runs came without q_wxyz: their attitude is unknown (column {ATTITUDE_UNKNOWN}); qw … qz mean nothing",
            flown.attitude_unknown
        ));
    }
    flown.left_out().for_each(|told| watch.warn(&format!("Warning: {told}")));
    Ok(flown)
}

/// Whether nothing but its motion tells what a run was: it was not measured, and cannot be had again.
fn is_indispensable(run: &Run, again: bool) -> bool {
    run.full_rate.is_none() && !again
}

/// Flies the worst run of every violating case as often again as the scenario asks for, where it was not yet.
fn fly_again(work: &Work, cases: &[Case], watch: &dyn Watch) -> Result<(), Problem> {
    let wanted = work.setup.scenario.executor().reruns as usize;
    if wanted == 0 {
        return Ok(());
    }
    let told = read_told(&work.folder)?;
    // A case, its worst run, and how many of that are there.
    let violating: Result<Vec<_>, Problem> = cases
        .par_iter()
        .map(|case: &Case| {
            let mut result = campaign::judge(&work.setup, case, &runs_to_judge(work, case)?.runs)?;
            let asked = told.as_ref().and_then(|told| told.asked_of(case.number));
            missions::hold(asked, (&work.setup, case), || runs_with_motion(work, case), &mut result)?;
            let is_violation = result.status == Status::Fail;
            let known = if is_violation { known_reruns(work, case)? } else { 0 };
            Ok(is_violation.then_some((case, result.run, known)))
        })
        .collect();
    let violating: Vec<(&Case, usize, usize)> = violating?.into_iter().flatten().collect();
    let all = violating.iter().flat_map(|(case, ..)| (0..wanted).map(|again| (case.number, again)));
    let writer = work.folder.write_reruns(wanted, all);
    let jobs = violating
        .iter()
        .flat_map(|(case, run, known)| (*known..wanted).map(move |again| Job { case, run: *run, again: Some(again) }));
    let jobs: Vec<Job> = jobs.collect();
    if let Some(why) = work.setup.repeats().filter(|_| !jobs.is_empty()) {
        watch.warn(&format!("violations are run again, each time as the same run: {why}"));
    }
    let (all_stay, again) = (work.setup.scenario.executor().record.is_all(), comes_again(&work.setup));
    let keeps = |run: &Run| all_stay || is_indispensable(run, again);
    fly(work, &jobs, Landing { of: jobs.len(), writer, keeps: &keeps }, watch)
}

/// How often the violation of `case` was run again.
fn known_reruns(work: &Work, case: &Case) -> Result<usize, Problem> {
    let known = work.folder.rerun_facts_of(case.number)?.len();
    // Files of their own say it of themselves.
    Ok(if known == 0 { work.folder.read_reruns(case.number)?.len() } else { known })
}

/// Whether the folder has all runs of `cases` that the scenario asks for.
pub(super) fn all_flown(work: &Work, cases: &[Case]) -> bool {
    let repeat = work.setup.scenario.executor().repeat as usize;
    cases.iter().all(|case| (0..repeat).all(|run| work.folder.has_valid_run(case.number, run)))
}

/// How often violations of `cases` were run again in all.
pub(super) fn count_reruns(work: &Work, cases: &[Case]) -> Result<usize, Problem> {
    cases.iter().map(|case| known_reruns(work, case)).sum()
}

/// What the runs of `cases` that are in the folder came to.
pub(crate) fn count_flown(work: &Work, cases: &[Case]) -> Result<Flown, Problem> {
    count(work, cases, work.setup.scenario.executor().repeat as usize)
}

fn count(work: &Work, cases: &[Case], repeat: usize) -> Result<Flown, Problem> {
    let mut flown = Flown { runs: 0, failed: 0, never_asked: 0, attitude_unknown: 0, end_unsaid: 0, heights_by_map: 0 };
    for case in cases {
        for facts in work.folder.facts_of(case.number)?.iter().filter(|facts| facts.run < repeat) {
            flown.runs += 1;
            flown.failed += usize::from(facts.message.is_some());
            flown.never_asked += usize::from(facts.message.as_deref().is_some_and(was_never_asked));
            flown.attitude_unknown += usize::from(facts.attitude_unknown);
            flown.end_unsaid += usize::from(facts.end_unsaid);
            flown.heights_by_map += usize::from(facts.heights_by_map);
        }
    }
    Ok(flown)
}

/// Whether the executor flew and sent no attitudes.
pub(crate) fn attitude_unknown(run: &Run) -> bool {
    run.outcome.as_ref().is_ok_and(|flight| flight.track.channel(ATTITUDE_UNKNOWN).is_some())
}
