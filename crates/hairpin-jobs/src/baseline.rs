//! Random feasible cases, run as the campaign's are: what its stress stands beside. They are measured and never judged,
//! and no case of the campaign is one of them.

use hairpin::campaign::generate::{ByChance, Purpose, by_chance};
use hairpin::campaign::{self, Baseline, Case, CaseResult, Run, Setup, Status, Stop, Tally, vary};

use crate::execute::{Flown, fly_by_case};
use crate::generate::found_beside;
use crate::watch::not_waiting_for;
use crate::work::Work;
use crate::{Deadline, Problem, Watch};

/// What the watch is told of.
const WHAT: &str = "baseline";
/// And of cases that a search found beside missions.
const SEARCHED: &str = "searched";

/// Draws and runs as many as `work` asks for, where cases of a search have `flown` to compare with, and they are not
/// there yet. The file is written once all are measured. They are of the program that flew those.
pub(crate) fn fly_baseline(work: &Work, tally: &Tally, flown: Flown, watch: &dyn Watch) -> Result<(), Problem> {
    let setup = &work.setup;
    let wanted = setup.scenario.baseline_cases();
    let beside_nothing = flown.runs == flown.failed || has_none(setup, tally);
    if wanted == 0 || beside_nothing || work.folder.read_baseline()?.is_some() {
        return Ok(());
    }
    let ByChance { cases, .. } = drawn(setup, (Purpose::Baseline, wanted), WHAT, watch)?;
    if cases.is_empty() {
        return Ok(());
    }
    Ok(work.folder.write_baseline(&cases, &flown_beside(work, &cases, (WHAT, watch))?)?)
}

/// Searches as the scenario says and runs what is found, for missions to be compared with; the file is written once all
/// are measured.
pub(crate) fn fly_searched(work: &Work, deadline: Deadline, watch: &dyn Watch) -> Result<(), Problem> {
    if work.folder.read_searched()?.is_some() {
        return Ok(());
    }
    let cases = found_beside(work, deadline, watch)?;
    Ok(work.folder.write_searched(&cases, &flown_beside(work, &cases, (SEARCHED, watch))?)?)
}

/// Runs `cases` as the campaign's are, and measures them.
fn flown_beside(work: &Work, cases: &[Case], told: (&'static str, &dyn Watch)) -> Result<Vec<CaseResult>, Problem> {
    let setup = &work.setup;
    let flown = fly_by_case((setup, Some(&work.folder)), cases, &|case, runs| measure(setup, case, runs), told)?;
    flown.into_iter().collect()
}

/// What the cases by chance of a campaign's folder measured; `None` where there are none.
pub(crate) fn read_baseline(work: &Work) -> Result<Option<Baseline>, Problem> {
    let scenario = &work.setup.scenario;
    let found = work.folder.read_baseline()?;
    Ok(found.and_then(|measured| Baseline::of(scenario.sought(), scenario.executor().repeat, &measured)))
}

/// Random feasible cases that a campaign with these `results` asks for and has not, in a sentence; `None` where they
/// are there, or none is to be.
pub(crate) fn missing(work: &Work, tally: &Tally, results: &[CaseResult]) -> Result<Option<String>, Problem> {
    let wanted = work.setup.scenario.baseline_cases();
    let is_flown = results.iter().any(|result| result.measures.is_some());
    if wanted == 0 || !is_flown || has_none(&work.setup, tally) || work.folder.read_baseline()?.is_some() {
        return Ok(None);
    }
    let folder = work.folder.path().display();
    Ok(Some(format!(
        "{folder} has no baseline.parquet: the verdict stands beside none of the {wanted} random feasible cases that are asked for \
         (execute.baseline); hairpin execute {folder} --resume flies them"
    )))
}

/// Whether a campaign has no feasible cases to be compared with: what was recorded, and missions of another robot's
/// kind.
fn has_none(setup: &Setup, tally: &Tally) -> bool {
    setup.recordings().is_some() || (setup.has_programs() && !tally.missions.is_empty())
}

/// Cases by chance, as many as are `asked` for or found; `what` is told of as it goes on.
pub(crate) fn drawn(
    setup: &Setup,
    asked: (Purpose, u64),
    what: &'static str,
    watch: &dyn Watch,
) -> Result<ByChance, Problem> {
    let code = setup.user_code();
    let stop = Stop {
        cancelled: &|| watch.stopped() || code.iter().any(|(_, user)| user.trouble().is_some()),
        progress: &|done, of| watch.progress(what, done, of),
        clock: &|| 0.0,
    };
    let drawn = not_waiting_for(&code, watch, Deadline::after(None), || by_chance(setup, asked, &stop));
    watch.finished(what);
    if watch.stopped() {
        return Err(Problem::Interrupted("stopped; the runs that have landed are kept, --resume goes on".into()));
    }
    if let Some(reason) = &drawn.reason {
        tracing::info!("{} of {} random cases: {reason}", drawn.cases.len(), asked.1);
    }
    Ok(drawn)
}

/// The worst run of `case` and the worst of each measure over all, without what the spec says of it: whether a random
/// case violates is not counted anywhere, and what is told of it is the same by any spec of the same reference.
fn measure(setup: &Setup, case: &Case, runs: &[Run]) -> Result<CaseResult, Problem> {
    let mut result = campaign::judge(setup, case, runs)?;
    result.drawn.extend(vary::draw_for_case(&setup.scenario, case.seed, case.number));
    match runs.iter().find_map(|run| campaign::unlike(setup, case, run)) {
        // What no robot does is no number to stand beside.
        Some(why) => {
            (result.status, result.message) = (Status::Inconclusive, Some(why));
            (result.measures, result.of_runs) = (None, None);
        }
        None if result.status != Status::ExecutorFailed => result.status = Status::Unjudged,
        None => {}
    }
    (result.violations, result.elsewhere, result.draws) = (Vec::new(), Vec::new(), None);
    Ok(result)
}
