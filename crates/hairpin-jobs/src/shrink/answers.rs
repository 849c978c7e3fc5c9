//! What candidates came to: from the file that an earlier search left, or by execution.
//!
//! What is asked depends on the answers alone, so that a search that begins again with them comes to where it was.

use std::collections::BTreeMap;
use std::path::PathBuf;

use hairpin::campaign::{self, Case, CaseNumber, CaseResult, Setup, Shrunk, Status};
use hairpin::judgement::{Measures, Violation};
use hairpin_formats::checksum::sha256;
use hairpin_formats::executor::{Greeting, was_never_asked};
use hairpin_formats::{atomic, bounds};
use serde::{Deserialize, Serialize};

use super::settings::ShrinkSettings;
use crate::execute::fly_told;
use crate::program::another_than;
use crate::work::Work;
use crate::{Deadline, Problem, Watch};

/// What the watch is told of.
const WHAT: &str = "shrink";

/// The file.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct State {
    /// Fingerprint of the scenario, the case and its run: answers to another question are none.
    question: String,
    /// By the candidate's fingerprint.
    answers: BTreeMap<String, Answer>,
}

/// What one execution came to.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    violations: Vec<Violated>,
    max_deviation_m: f64,
    t_worst_s: f64,
    leg_worst: usize,
    ended: String,
    /// Why it was not flown: the program that executes refused it, or failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    unflown: Option<String>,
}

/// A [`Violation`].
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Violated {
    what: String,
    value: f64,
    limit: f64,
    unit: String,
    at_s: f64,
    leg: usize,
}

/// Answers candidates until the budget or the time is used up.
pub(super) struct Answers<'a> {
    run: usize,
    path: PathBuf,
    state: State,
    budget: u64,
    deadline: Deadline,
    fresh: u64,
    /// Of [`Self::fresh`], those that were not flown, and why the first was not.
    unflown: (u64, Option<String>),
    /// What the program that flew last says of itself: at first the campaign's.
    flown_by: Option<Greeting>,
    watch: &'a dyn Watch,
}

impl<'a> Answers<'a> {
    /// Those of the folder's file, if it is about the same question.
    ///
    /// # Errors
    /// What the folder keeps of who executed is broken.
    pub(super) fn take_up(
        work: &Work,
        case: &Case,
        result: &CaseResult,
        settings: &ShrinkSettings,
        watch: &'a dyn Watch,
    ) -> Result<Self, Problem> {
        let path = work.folder.file(&format!("repro/{}-shrink.state", case.id()));
        let question = fingerprint(&work.setup, case, result.run);
        let kept = bounds::read_json_text(&path).ok().and_then(|text| serde_json::from_str::<State>(&text).ok());
        let state = kept.filter(|state| state.question == question);
        Ok(Self {
            run: result.run,
            path,
            state: state.unwrap_or(State { question, answers: BTreeMap::new() }),
            budget: settings.budget,
            deadline: Deadline::after(settings.time_limit_s),
            fresh: 0,
            unflown: (0, None),
            flown_by: work.folder.read_executor()?,
            watch,
        })
    }

    /// Shrinks `case` with these answers and as many new ones as there may be.
    pub(super) fn search(&mut self, setup: &Setup, case: &Case, result: &CaseResult) -> Result<Shrunk, Problem> {
        let mut trouble = None;
        let mut run = |setup: &Setup, candidate: &Case| {
            self.answer(setup, candidate).unwrap_or_else(|problem| {
                trouble = Some(problem);
                None
            })
        };
        let shrunk = campaign::shrink(setup, case, result, &mut run);
        self.watch.finished(WHAT);
        if let (count, Some(first)) = &self.unflown {
            let (of, case) = (self.fresh, case.id());
            self.watch.warn(&format!(
                "case {case}: {count} of {of} candidates were not flown, and count as within spec: {first}"
            ));
        }
        match trouble {
            Some(problem) => Err(problem),
            None => shrunk.map_err(Problem::input),
        }
    }

    /// Executions in all.
    pub(super) fn runs(&self) -> u64 {
        self.state.answers.len() as u64
    }

    /// What the program that flew last says of itself.
    pub(super) fn flown_by(&self) -> Option<Greeting> {
        self.flown_by.clone()
    }

    /// Executions of this command.
    pub(super) fn fresh(&self) -> u64 {
        self.fresh
    }

    /// What `candidate` comes to under `setup`; `None` where it is not known and may not be found out.
    fn answer(&mut self, setup: &Setup, candidate: &Case) -> Result<Option<CaseResult>, Problem> {
        let key = fingerprint(setup, candidate, self.run);
        if let Some(answer) = self.state.answers.get(&key) {
            return Ok(Some(answer.result(candidate.number, self.run)));
        }
        if self.fresh >= self.budget || self.deadline.passed() || self.watch.stopped() {
            return Ok(None);
        }
        let (flown, now) = fly_told(&[(setup, candidate, self.run)], self.watch)?;
        let result = campaign::judge(setup, candidate, &flown)?;
        // One whose name is another each time that it is started is told of once.
        if self.fresh == 0
            && let Some(told) = another_than(self.flown_by.as_ref(), now.as_ref())
        {
            self.watch.warn(&format!("Warning: case {}: {told}", candidate.id()));
        }
        self.flown_by = now.or(self.flown_by.take());
        if let Some(Err(message)) = flown.first().map(|run| &run.outcome) {
            self.note_unflown(candidate, message)?;
        }
        self.fresh += 1;
        self.watch.progress(WHAT, self.fresh as usize, self.budget as usize);
        self.state.answers.insert(key, Answer::of(&result));
        atomic::write_json(&self.path, &self.state)?;
        Ok(Some(result))
    }

    /// A program may refuse what it cannot fly, and what is not flown does not violate. But where nothing was flown yet
    /// (the first that is asked is the case itself), or the program cannot be started, it is the program that failed.
    fn note_unflown(&mut self, candidate: &Case, message: &str) -> Result<(), Problem> {
        let was_flown = self.state.answers.values().any(|answer| answer.unflown.is_none());
        if !was_flown || was_never_asked(message) {
            return Err(Problem::Executor(format!("case {}: the executor failed: {message}", candidate.id())));
        }
        let (count, first) = &mut self.unflown;
        *count += 1;
        first.get_or_insert_with(|| message.to_owned());
        Ok(())
    }
}

impl Answer {
    fn of(result: &CaseResult) -> Self {
        let measures = result.measures.clone().unwrap_or_default();
        let violated = |v: &Violation| Violated {
            what: v.what.clone(),
            value: v.value,
            limit: v.limit,
            unit: v.unit.clone(),
            at_s: v.at,
            leg: v.leg,
        };
        Self {
            violations: result.violations.iter().map(violated).collect(),
            max_deviation_m: measures.max_deviation,
            t_worst_s: measures.t_worst,
            leg_worst: measures.leg_worst,
            ended: result.ended.clone(),
            unflown: result.message.clone().filter(|_| result.status == Status::ExecutorFailed),
        }
    }

    /// As much of the result as shrinking and repro files ask for.
    fn result(&self, case: CaseNumber, run: usize) -> CaseResult {
        let violation = |v: &Violated| Violation {
            what: v.what.clone(),
            value: v.value,
            limit: v.limit,
            unit: v.unit.clone(),
            at: v.at_s,
            leg: v.leg,
        };
        let status = match (&self.unflown, self.violations.is_empty()) {
            (Some(_), _) => Status::ExecutorFailed,
            (None, true) => Status::Pass,
            (None, false) => Status::Fail,
        };
        CaseResult {
            run,
            measures: Some(Measures {
                max_deviation: self.max_deviation_m,
                t_worst: self.t_worst_s,
                leg_worst: self.leg_worst,
                ..Measures::default()
            }),
            ended: self.ended.clone(),
            violations: self.violations.iter().map(violation).collect(),
            message: self.unflown.clone(),
            ..CaseResult::bare(case, status)
        }
    }
}

/// What an execution depends on.
fn fingerprint(setup: &Setup, case: &Case, run: usize) -> String {
    let points: Vec<[f64; 3]> = case.waypoints.iter().map(|p| p.coords.into()).collect();
    let all = serde_json::json!([setup.scenario, case.seed, run, points, case.leg_times, case.commands()]);
    sha256(all.to_string())
}
