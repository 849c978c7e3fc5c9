//! The runs of a case as the judge needs them: what was measured of them, or else their motion.

use hairpin::campaign::judge::is_at_full_rate;
use hairpin::campaign::{Case, Run, Setup};
use hairpin_formats::folder::FolderError;
use hairpin_formats::parquet::runs::RunFacts;

use super::kept::{reruns_with_motion, runs_with_motion};
use crate::Problem;
use crate::work::Work;

/// The runs of a case.
pub(crate) struct ToJudge {
    pub(crate) runs: Vec<Run>,
    /// How many of them have their deviations measured of the rows that are kept, for the scenario measures otherwise
    /// than it did when they were flown.
    pub(crate) from_rows: usize,
    /// How many were flown anew for that, their motion not being kept.
    pub(crate) flown_anew: usize,
}

/// The runs of `case` with what was measured of them; with their motion where that is asked for otherwise.
pub(crate) fn runs_to_judge(work: &Work, case: &Case) -> Result<ToJudge, Problem> {
    let measured = work.folder.read_measured(case.number)?;
    check_mission(work, case, measured.as_deref().unwrap_or_default())?;
    let otherwise = measured.is_some();
    if let Some(runs) = measured
        && are_measured(work, case, &runs)?
    {
        let (known, kept) = (|| work.folder.facts_of(case.number), |run| work.folder.read_run(case.number, run));
        let runs = looked_at(&work.setup, runs, &known, &kept)?;
        return Ok(ToJudge { runs, from_rows: 0, flown_anew: 0 });
    }
    let runs = runs_with_motion(work, case)?;
    let left_out = || Ok::<_, Problem>(work.folder.facts_of(case.number)?.iter().filter(|run| !run.is_kept()).count());
    let flown_anew = if otherwise { left_out()? } else { 0 };
    Ok(ToJudge { from_rows: measured_otherwise(work, case, &runs)?, flown_anew, runs })
}

/// The runs of `case` with what was measured of them when they were flown; with their motion where nothing was.
pub(crate) fn measured_runs(work: &Work, case: &Case) -> Result<Vec<Run>, Problem> {
    let measured = work.folder.read_measured(case.number)?;
    check_mission(work, case, measured.as_deref().unwrap_or_default())?;
    measured.map_or_else(|| runs_with_motion(work, case), Ok)
}

/// That what is known of `runs` is of the mission of `case`: a leg for every leg, a time for every waypoint, and no run
/// that nobody asked for.
///
/// Programs of arms may have other moves than legs: arcs only pass some waypoints.
fn check_mission(work: &Work, case: &Case, runs: &[Run]) -> Result<(), Problem> {
    let (waypoints, repeat) = (case.waypoints.len(), work.setup.scenario.executor().repeat as usize);
    for run in runs {
        let refuse = |what: String| {
            let table = work.folder.file("runs");
            Err(Problem::of_file(&table, format!("case {case}, run {run}: {what}", case = case.id(), run = run.run)))
        };
        if run.run >= repeat && work.setup.recordings().is_none() {
            return refuse(format!("`run` = {}: must be below `execute.repeat` = {repeat}", run.run));
        }
        let legs = run.full_rate.as_ref().map_or(waypoints.saturating_sub(1), |found| found.measures.legs.len());
        if legs + 1 != waypoints {
            return refuse(format!("`leg_max_deviation_m` has {legs} legs: must be {}", waypoints.saturating_sub(1)));
        }
        let reached = run.outcome.as_ref().map_or(waypoints, |flight| flight.reached.len());
        if run.full_rate.is_some() && !work.setup.has_programs() && reached != waypoints {
            return refuse(format!("`reached_s` has {reached} waypoints: must be {waypoints}, each a time or null"));
        }
    }
    Ok(())
}

/// As [`runs_to_judge`] those that were flown again.
pub(crate) fn reruns_to_judge(work: &Work, case: &Case) -> Result<Vec<Run>, Problem> {
    match work.folder.read_measured_reruns(case.number)? {
        Some(runs) if are_measured(work, case, &runs)? => {
            let known = || work.folder.rerun_facts_of(case.number);
            looked_at(&work.setup, runs, &known, &|again| work.folder.read_rerun(case.number, again))
        }
        _ => reruns_with_motion(work, case),
    }
}

/// `runs`, those of programs with their motion as far as it was `kept` where nobody looked for what no robot of theirs
/// does: earlier versions did not.
fn looked_at(
    setup: &Setup,
    runs: Vec<Run>,
    known: &dyn Fn() -> Result<Vec<RunFacts>, FolderError>,
    kept: &dyn Fn(usize) -> Result<Option<Run>, FolderError>,
) -> Result<Vec<Run>, Problem> {
    let is_missing = |run: &Run| run.full_rate.as_ref().is_some_and(|known| known.implausible.is_none());
    if setup.program().is_none() || !runs.iter().any(is_missing) {
        return Ok(runs);
    }
    let known = known()?;
    let is_kept = |run: &Run| known.iter().any(|facts| facts.run == run.run && facts.is_kept());
    let with_rows = |run: Run| match is_missing(&run) && is_kept(&run) {
        true => Ok(kept(run.run)?.unwrap_or(run)),
        false => Ok(run),
    };
    runs.into_iter().map(with_rows).collect()
}

/// Whether what was measured of `runs`, where it was, is what the scenario asks for.
fn are_measured(work: &Work, case: &Case, runs: &[Run]) -> Result<bool, Problem> {
    Ok(measured_otherwise(work, case, runs)? == 0)
}

/// How many of `runs` were measured otherwise than the scenario asks for.
fn measured_otherwise(work: &Work, case: &Case, runs: &[Run]) -> Result<usize, Problem> {
    let mut count = 0;
    for run in runs.iter().filter(|run| run.full_rate.is_some()) {
        count += usize::from(!is_at_full_rate(&work.setup, case, run)?);
    }
    Ok(count)
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::FullRate;

    use super::*;
    use crate::testing::executed;
    use crate::work::open_to_read;

    /// A run of another mission passed: one that ended "done" after three waypoints of five had come to its last.
    #[test]
    fn what_is_of_another_mission_is_refused() {
        let (_place, folder) = executed();
        let work = open_to_read(&folder).unwrap();
        let case = &work.folder.read_cases().unwrap()[0];
        let run = &work.folder.read_measured(case.number).unwrap().unwrap()[0];
        check_mission(&work, case, std::slice::from_ref(run)).unwrap();
        let told = |run: Run| check_mission(&work, case, &[run]).unwrap_err().to_string();
        let flight = run.outcome.clone().unwrap();
        let reached = flight.reached[..2].to_vec();
        let shorter = Run { outcome: Ok(hairpin::trajectory::Flight { reached, ..flight }), ..run.clone() };
        assert!(told(shorter).contains("case 0000, run 0: `reached_s` has 2 waypoints: must be"));
        let known = run.full_rate.clone().unwrap();
        let mut measures = known.measures.clone();
        measures.legs.pop();
        let fewer = Run { full_rate: Some(Box::new(FullRate { measures, ..*known })), ..run.clone() };
        assert!(told(fewer).contains("`leg_max_deviation_m` has"));
        assert!(told(Run { run: 1, ..run.clone() }).contains("`run` = 1: must be below `execute.repeat` = 1"));
    }
}
