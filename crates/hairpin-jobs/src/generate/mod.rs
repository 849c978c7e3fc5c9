//! Generation: trajectories, their planned motion, and what the search did.

use std::fmt::Display;
use std::ops::Range;
use std::time::{Duration, Instant};

use hairpin::campaign::arm::{ArmSetup, graph_of};
use hairpin::campaign::generate::{Known, generate_units};
use hairpin::campaign::{Case, Failures, Setup, Stop, Tally, learn, planned, planned_rows};
use hairpin_formats::atomic;
use hairpin_formats::parquet::track;
use rayon::prelude::*;

use crate::budget::UNPROVEN;
use crate::execute::{Asked, in_the_loop};
use crate::program::{Executing, fingerprint};
use crate::rounds::Rounds;
use crate::watch::not_waiting_for;
use crate::work::{CampaignSettings, Work, plan};
use crate::{Deadline, Problem, Watch, optimum};

/// Between checkpoints: what a kill may cost.
const CHECKPOINT: Duration = Duration::from_secs(30);
/// Cases whose planned motions are in memory at a time.
const AT_ONCE: usize = 1000;
/// What the watch is told of.
const WHAT: &str = "generate";

/// A campaign whose cases are there.
pub struct Generated {
    /// The campaign.
    pub work: Work,
    /// Its cases.
    pub cases: Vec<Case>,
    /// What the search did.
    pub tally: Tally,
}

/// Begins a campaign, or goes on with it, and finds its cases.
///
/// # Errors
/// As of [`plan`]; a file that cannot be written; it was asked to stop.
pub fn generate(settings: &CampaignSettings, watch: &dyn Watch) -> Result<Generated, Problem> {
    let work = plan(settings, watch)?.begin()?;
    let (cases, tally) = find_cases(&work, Deadline::after(settings.time_limit_s), Deadline::after(None), watch)?;
    Ok(Generated { work, cases, tally })
}

/// Finds the cases until `deadline` and writes them; what an arm claims of them is proven until `proof`. An interrupted
/// generation goes on where its last checkpoint was.
pub(crate) fn find_cases(
    work: &Work,
    deadline: Deadline,
    proof: Deadline,
    watch: &dyn Watch,
) -> Result<(Vec<Case>, Tally), Problem> {
    find_cases_together(work, [deadline, proof], None, watch)
}

/// The same with `rounds` of the search shared with other machines.
pub(crate) fn find_cases_together(
    work: &Work,
    [deadline, proof]: [Deadline; 2],
    rounds: Option<&Rounds>,
    watch: &dyn Watch,
) -> Result<(Vec<Case>, Tally), Problem> {
    let known = known(work)?;
    let executing = Executing::within(&work.folder)?;
    if known.tally.complete {
        tracing::info!("generation is complete already");
        return Ok((known.cases, known.tally));
    }
    let mut cases = known.cases.clone();
    let (mut saved, mut at) = (cases.len(), Instant::now());
    let mut trouble = None;
    let before = known.tally.failures.failed;
    let how = (&Scope::From(&known), rounds, &executing);
    let found = searched(&work.setup, how, (deadline, watch), &mut |new, tally| {
        cases.extend_from_slice(new);
        if at.elapsed() > CHECKPOINT && trouble.is_none() {
            let kept = executing.keep().map_err(Problem::from);
            let tally = kept.and_then(|()| by_who_failed(work, before, unfinished(tally)));
            trouble = tally.and_then(|tally| keep_cases(work, &cases, saved, &tally)).err();
            (saved, at) = (cases.len(), Instant::now());
        }
    });
    if let Some(problem) = trouble {
        return Err(problem);
    }
    let (tally, executor_trouble) = found?;
    executing.keep()?;
    if !executing.is_known()
        && let Some(program) = rounds.map(Rounds::program).transpose()?.flatten()
    {
        // Others have executed all of it.
        work.folder.take_executor(&program)?;
    }
    let mut tally = by_who_failed(work, before, tally)?;
    work.folder.write_executed(tally.answers.as_deref())?;
    keep_cases(work, &cases, saved, &unfinished(&tally))?;
    if let Some(problem) = executor_trouble {
        return Err(problem);
    }
    work.folder.write_curves(&hairpin::campaign::generate::column(&work.setup), &tally.curves)?;
    if let Some(model) = &tally.model {
        atomic::write_json(&work.folder.file(learn::NAME), model)?;
    }
    if let Some(arm) = work.setup.own::<ArmSetup>()
        && let Ok(graph) = graph_of(arm)
    {
        work.folder.write_graph(arm, &graph)?;
        // What is claimed is proven, or claimed no more.
        let begun = Instant::now();
        let stop = Stop {
            cancelled: &|| watch.stopped() || proof.passed(),
            progress: &|done, of| watch.progress(WHAT, done, of),
            clock: &|| begun.elapsed().as_secs_f64(),
        };
        let is_proven = optimum::keep(work, arm, &graph, &cases, &stop)?;
        if !is_proven && proof.passed() && !watch.stopped() {
            let claims = |case: &&mut Case| case.gap().is_some_and(|gap| gap <= 1e-9);
            cases.iter_mut().filter(claims).for_each(|case| case.bound = None);
            work.folder.write_results(&cases, &[])?;
            (tally.complete, tally.stopped, tally.cut) = (false, true, Some(UNPROVEN.into()));
        }
        // What a controller reads is what is executed and judged: numbers as the module has them.
        cases = work.folder.read_cases()?;
    }
    if watch.stopped() {
        return Err(Problem::Interrupted(format!("stopped after {} cases; --resume goes on", cases.len())));
    }
    // The last of all files: with it there is nothing left to do.
    work.folder.write_tally(&tally)?;
    tracing::info!("{} cases from {} graphs", cases.len(), tally.graphs);
    Ok((cases, tally))
}

/// How much of a campaign is searched.
enum Scope<'a> {
    /// All of it, on from what is known.
    From(&'a Known),
    /// These units of work, whose cases are numbered from the number beside them.
    Units(Range<u64>, u64),
}

/// Searches, and hands on what is found with the tally so far. Gives the tally in the end, and what went wrong with the
/// user's program where that was the end of it.
fn searched(
    setup: &Setup,
    (scope, rounds, executing): (&Scope, Option<&Rounds>, &Executing),
    (deadline, watch): (Deadline, &dyn Watch),
    found: &mut (dyn FnMut(&[Case], &Tally) + Send),
) -> Result<(Tally, Option<Problem>), Problem> {
    let begun = Instant::now();
    let code = setup.user_code();
    let code_trouble = || code.iter().find_map(|(key, user)| Some((key, user.trouble()?)));
    let stopped = || watch.stopped() || deadline.passed() || code_trouble().is_some();
    let stop = Stop {
        cancelled: &stopped,
        progress: &|done, of| watch.progress(WHAT, done, of),
        clock: &|| begun.elapsed().as_secs_f64(),
    };
    let search = |Asked { executor, stop: over }: Asked| {
        let stop = Stop { cancelled: over, ..stop };
        let found = &mut |new: &[Case], tally: &Tally| found(new, tally);
        not_waiting_for(&code, watch, deadline, || match scope {
            Scope::From(known) => hairpin::campaign::generate(setup, known, executor, &stop, found),
            Scope::Units(units, first) => generate_units(setup, (units.clone(), *first), executor, &stop, found),
        })
    };
    let answer = in_the_loop(setup, &stopped, (rounds, executing), watch, search)?;
    watch.finished(WHAT);
    match code_trouble() {
        Some((key, trouble)) => Err(Problem::input(format!("`{key}` = {trouble}"))),
        None => Ok(answer),
    }
}

/// What the search of the campaign in `work` finds, of which nothing is kept in its folder but who executed.
///
/// # Errors
/// Code or a program of the user's that failed, or is another than before; it was asked to stop.
pub(crate) fn found_beside(work: &Work, deadline: Deadline, watch: &dyn Watch) -> Result<Vec<Case>, Problem> {
    Ok(found_in(work, &Scope::From(&Known::default()), deadline, watch)?.cases)
}

/// What these units of work come to, the cases numbered from `first` on.
///
/// # Errors
/// As of [`found_beside`].
pub(crate) fn find_units(work: &Work, (units, first): (Range<u64>, u64), watch: &dyn Watch) -> Result<Known, Problem> {
    found_in(work, &Scope::Units(units, first), Deadline::after(None), watch)
}

fn found_in(work: &Work, scope: &Scope, deadline: Deadline, watch: &dyn Watch) -> Result<Known, Problem> {
    let mut cases = Vec::new();
    let executing = Executing::within(&work.folder)?;
    let how = (scope, None, &executing);
    let (tally, trouble) = searched(&work.setup, how, (deadline, watch), &mut |new, _| cases.extend_from_slice(new))?;
    executing.keep()?;
    match trouble {
        Some(problem) => Err(problem),
        None if watch.stopped() => Err(Problem::Interrupted("stopped; --resume goes on".into())),
        None => Ok(Known { cases, tally: by_who_failed(work, 0, tally)? }),
    }
}

/// `tally` with who executes now as the one that failed, where more failed than `before`.
fn by_who_failed(work: &Work, before: u64, mut tally: Tally) -> Result<Tally, Problem> {
    if tally.failures.failed > before {
        tally.failures.by = Some(fingerprint(&work.setup, work.folder.read_executor()?.as_ref()));
    }
    Ok(tally)
}

/// The tally of a generation that goes on: cases may come, and what is made of all of them is not there.
pub(crate) fn unfinished(tally: &Tally) -> Tally {
    Tally { complete: false, stopped: true, ..tally.clone() }
}

/// What an interrupted generation left: the tally, which is written last, and the cases that it counts. Cases beyond it
/// are of a checkpoint that a kill cut short; they are found again.
fn known(work: &Work) -> Result<Known, Problem> {
    let folder = &work.folder;
    let answers = folder.read_executed()?.map(Box::new);
    if !folder.has_cases() || !folder.has_tally() {
        // As where it was gone on with, and could not be.
        let failures = if folder.has_tally() { folder.read_tally()?.failures } else { Failures::default() };
        let failures = answers.as_ref().map_or_else(Failures::default, |_| failures);
        return Ok(Known { cases: Vec::new(), tally: Tally { answers, failures, ..Tally::default() } });
    }
    let tally = Tally { answers, cut: None, ..folder.read_tally()? };
    let known = Known { cases: folder.read_cases()?, tally };
    let begun = !known.cases.is_empty();
    if !known.tally.missions.is_empty() {
        return Err(Problem::input(format!(
            "--resume: {} holds missions made elsewhere, not an interrupted generation; --force replaces them",
            folder.path().display()
        )));
    }
    let known = hairpin::campaign::generate::counted(&work.setup.scenario, known);
    if begun && known.cases.is_empty() {
        // Flights of what is generated anew would be taken for those of what is.
        let program = folder.executor_before()?.filter(|_| known.tally.answers.is_some());
        folder.forget_cases()?;
        if let Some(program) = program {
            folder.take_executor(&program)?;
        }
        folder.write_executed(known.tally.answers.as_deref())?;
        if !known.tally.failures.is_none() {
            // What failed is executed no second time, and is to be known however the search ends now.
            folder.write_tally(&unfinished(&known.tally))?;
        }
    }
    Ok(known)
}

/// Whether the motion of every case can be planned, which is kept of it: asked before a folder is made for them.
///
/// # Errors
/// The first that cannot be.
pub(crate) fn check_plans(setup: &Setup, cases: &[Case]) -> Result<(), Problem> {
    let plan = |case: &Case| match planned(setup, case) {
        Ok(_) => Ok(()),
        Err(error) => Err(Problem::input(format!("case {}: {error}", case.id()))),
    };
    cases.par_iter().try_for_each(plan)
}

/// Writes the cases from number `from` of the list on, the tables of all, and the tally that belongs to them. Each file
/// says no more than those before it: a kill in between leaves cases too many, never too few.
pub(crate) fn keep_cases(work: &Work, cases: &[Case], from: usize, tally: &Tally) -> Result<(), Problem> {
    let pack = |case: &Case| {
        let refuse = |error: &dyn Display| Problem::input(format!("case {}: {error}", case.id()));
        let piece = match planned_rows(&work.setup, case).map_err(|error| refuse(&error))? {
            Some((rows, period)) => track::planned_rows(case.number, (&rows, period)),
            None => {
                let planned = planned(&work.setup, case).map_err(|error| refuse(&error))?;
                track::planned(case.number, &planned)
            }
        };
        Ok((case.number, piece.map_err(|error| refuse(&error))?))
    };
    let packed = |block: &[Case]| block.par_iter().map(pack).collect::<Result<Vec<_>, Problem>>();
    let mut blocks = cases[from..].chunks(AT_ONCE);
    let mut ready = blocks.next().map(packed).transpose()?;
    while let Some(pieces) = ready {
        // One thread writes a part while the others pack the next.
        let next = blocks.next();
        let (written, after) = rayon::join(|| work.folder.write_planned(pieces), || next.map(packed).transpose());
        written?;
        ready = after?;
    }
    work.folder.write_new_cases(cases, from)?;
    Ok(work.folder.write_tally(tally)?)
}

#[cfg(test)]
mod tests;
