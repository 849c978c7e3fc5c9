//! `hairpin shrink`: a violating case reduced to the shortest feasible one that still violates.

use hairpin::campaign::CaseNumber;
use hairpin::campaign::report::violation;
use hairpin::judgement::Violation;
use hairpin_jobs::shrink::{ShrinkSettings, Shrinking, ShrunkCase};
use hairpin_jobs::{Problem, Watch};
use serde_json::json;

use crate::args::Shrink;
use crate::exit::DONE;
use crate::{console, settings};

/// Runs the command: 0 when there is a smaller case, or none can be.
pub(crate) fn run(asked: &Shrink, watch: &dyn Watch) -> Result<u8, Problem> {
    let shrinking = Shrinking::open(ShrinkSettings {
        folder: asked.folder.clone(),
        case: CaseNumber(asked.case),
        budget: asked.budget,
        time_limit_s: asked.time_limit,
        out: asked.out.clone(),
        simd: settings::simd(&asked.kernels),
        consent: settings::consent(&asked.commands),
    })?;
    let (case, violated) = (&shrinking.case, &shrinking.result.violations[0]);
    let before = case.waypoints.len();
    if !asked.json {
        console::say(&format!("case {}: {before} waypoints, {}", case.id(), violation(violated)));
    }
    let found = shrinking.search(watch)?;
    let answer = Answer { found: &found, before, what: &violated.what };
    if asked.json {
        console::say(&answer.object().to_string());
    } else {
        console::say(&answer.sentence());
        console::warn(&format!("repro: {} (hairpin replay runs it)", found.target.display()));
    }
    if watch.stopped() {
        let target = found.target.display();
        return Err(Problem::Interrupted(format!("stopped; {target} is kept, the same command goes on")));
    }
    Ok(DONE)
}

/// What came of it.
struct Answer<'a> {
    found: &'a ShrunkCase,
    /// Waypoints of the case.
    before: usize,
    /// What it violated first.
    what: &'a str,
}

impl Answer<'_> {
    /// `14 waypoints -> 3, still 0.53 m > 0.50 m (38 runs, 9 s)`.
    fn sentence(&self) -> String {
        let after = self.found.shrunk.case.waypoints.len();
        let without = match self.found.shrunk.simplified.as_slice() {
            [] => String::new(),
            words => format!("; {}", words.join(", ")),
        };
        let open = if self.found.shrunk.finished { "" } else { "; stopped, the same command goes on" };
        format!(
            "{} waypoints -> {after}, still {} ({} runs, {:.0} s){without}{open}",
            self.before,
            self.still(),
            self.found.runs,
            self.found.time.as_secs_f64()
        )
    }

    fn still(&self) -> String {
        let Some(found) = self.found.shrunk.result.violations.iter().find(|violation| violation.what == self.what)
        else {
            return self.what.into();
        };
        found.event().unwrap_or_else(|| {
            let (value, limit) = found.printed();
            let name =
                if found.what == "deviation" { String::new() } else { format!("{} ", found.what.replace('-', " ")) };
            format!("{name}{value} {} {limit}", if found.is_lower_limit() { '<' } else { '>' })
        })
    }

    fn object(&self) -> serde_json::Value {
        let violation: Option<&Violation> = self.found.shrunk.result.violations.iter().find(|v| v.what == self.what);
        json!({
            "verdict": self.sentence(),
            "exit_code": DONE,
            "case": self.found.shrunk.case.id(),
            "waypoints_before": self.before,
            "waypoints": self.found.shrunk.case.waypoints.len(),
            "what": self.what,
            "value": violation.map(|violation| violation.value),
            "limit": violation.map(|violation| violation.limit),
            "evidence": self.found.shrunk.case.evidence.word(),
            "simplified": self.found.shrunk.simplified,
            "finished": self.found.shrunk.finished,
            "runs": self.found.runs,
            "runs_now": self.found.fresh,
            "time_s": self.found.time.as_secs_f64(),
            "repro": self.found.target,
        })
    }
}
