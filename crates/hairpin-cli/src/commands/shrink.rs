//! `hairpin shrink`: a violating case reduced to the shortest feasible one that still violates.

mod answers;

use std::path::Path;
use std::time::Instant;

use hairpin::campaign::report::violation;
use hairpin::campaign::{Case, CaseResult, Shrunk};
use hairpin::judgement::Violation;
use serde_json::json;

use super::parts::{Repro, ShrunkFrom};
use crate::args::Shrink;
use crate::console;
use crate::folder::{self, Work};
use crate::interrupt;
use crate::problem::Problem;
use answers::Answers;

/// Names that a sentence has room for.
const TOLD: usize = 12;

/// Runs the command: 0 when there is a smaller case, or none can be.
pub(crate) fn run(asked: &Shrink) -> Result<u8, Problem> {
    let work = folder::open(&asked.folder, &[], &[], Some(&asked.kernels))?;
    let (case, result) = violating(&work, asked)?;
    let (before, kind) = (case.waypoints.len(), result.violations[0].what.clone());
    if !asked.json {
        console::say(&format!("case {}: {before} waypoints, {}", case.id(), violation(&result.violations[0])));
    }
    let began = Instant::now();
    let target = asked.out.clone().unwrap_or_else(|| work.folder.file(&format!("repro/{}-shrunk.json", case.id())));
    let mut answers = Answers::take_up(&work, &case, &result, asked);
    let shrunk = answers.search(&work.setup, &case, &result)?;
    repro(&work, &shrunk, &result, before, answers.runs())?.write(&target)?;
    let told =
        Told { shrunk: &shrunk, before, kind: &kind, runs: answers.runs(), seconds: began.elapsed().as_secs_f64() };
    if asked.json {
        console::say(&told.object(answers.fresh(), &target).to_string());
    } else {
        console::say(&told.sentence());
        console::warn(&format!("repro: {} (hairpin replay runs it)", target.display()));
    }
    if interrupt::asked() {
        return Err(Problem::Interrupted(format!("stopped; {} is kept, the same command goes on", target.display())));
    }
    Ok(0)
}

/// The case that was asked for, with its profile, and its result.
fn violating(work: &Work, asked: &Shrink) -> Result<(Case, CaseResult), Problem> {
    let folder = asked.folder.display();
    let cases = work.folder.read_cases()?;
    let there = named(&cases);
    let case = cases.into_iter().find(|case| case.number == asked.case);
    let case = case.ok_or_else(|| Problem::input(format!("--case {}: {folder} has {there}", asked.case)))?;
    let result = work.folder.read_results()?.into_iter().find(|result| result.case == case.number);
    let result = result.ok_or_else(|| Problem::input(format!("not judged yet: hairpin judge {folder}")))?;
    if result.violations.is_empty() {
        return Err(Problem::input(format!("case {} does not violate: there is nothing to shrink", case.id())));
    }
    Ok((case, result))
}

/// `the cases 0001, 0003, 0004`; of many the first ones and the last.
fn named(cases: &[Case]) -> String {
    let names: Vec<String> = cases.iter().map(Case::id).collect();
    match names.as_slice() {
        [] => "no cases".into(),
        [one] => format!("the case {one} alone"),
        [some @ .., last] if names.len() > TOLD => format!("the cases {}, … {last}", some[..TOLD - 1].join(", ")),
        all => format!("the cases {}", all.join(", ")),
    }
}

fn repro(work: &Work, shrunk: &Shrunk, before: &CaseResult, waypoints: usize, runs: u64) -> Result<Repro, Problem> {
    let setup = work.setup.changed(shrunk.scenario.clone())?;
    Ok(Repro {
        shrunk: Some(ShrunkFrom {
            waypoints,
            violations: before.violations.iter().map(violation).collect(),
            simplified: shrunk.simplified.clone(),
            finished: shrunk.finished,
            runs,
        }),
        ..Repro::of(&setup, &shrunk.case, &shrunk.result)
    })
}

/// What came of it.
struct Told<'a> {
    shrunk: &'a Shrunk,
    before: usize,
    kind: &'a str,
    runs: u64,
    seconds: f64,
}

impl Told<'_> {
    /// `14 waypoints -> 3, still 0.53 m > 0.50 m (38 runs, 9 s)`.
    fn sentence(&self) -> String {
        let after = self.shrunk.case.waypoints.len();
        let without = match self.shrunk.simplified.as_slice() {
            [] => String::new(),
            words => format!("; {}", words.join(", ")),
        };
        let open = if self.shrunk.finished { "" } else { "; stopped, the same command goes on" };
        format!(
            "{} waypoints -> {after}, still {} ({} runs, {:.0} s){without}{open}",
            self.before,
            self.still(),
            self.runs,
            self.seconds
        )
    }

    fn still(&self) -> String {
        let Some(found) = self.shrunk.result.violations.iter().find(|violation| violation.what == self.kind) else {
            return self.kind.into();
        };
        found.event().unwrap_or_else(|| {
            let (value, limit) = found.printed();
            let name =
                if found.what == "deviation" { String::new() } else { format!("{} ", found.what.replace('-', " ")) };
            format!("{name}{value} {} {limit}", if found.is_lower_limit() { '<' } else { '>' })
        })
    }

    fn object(&self, fresh: u64, target: &Path) -> serde_json::Value {
        let violation: Option<&Violation> = self.shrunk.result.violations.iter().find(|v| v.what == self.kind);
        json!({
            "verdict": self.sentence(),
            "exit_code": 0,
            "case": self.shrunk.case.id(),
            "waypoints_before": self.before,
            "waypoints": self.shrunk.case.waypoints.len(),
            "what": self.kind,
            "value": violation.map(|violation| violation.value),
            "limit": violation.map(|violation| violation.limit),
            "evidence": self.shrunk.case.evidence.word(),
            "simplified": self.shrunk.simplified,
            "finished": self.shrunk.finished,
            "runs": self.runs,
            "runs_now": fresh,
            "time_s": self.seconds,
            "repro": target,
        })
    }
}
