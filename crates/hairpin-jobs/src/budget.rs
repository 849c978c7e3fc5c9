//! The time that a whole campaign has: until when it searches, executes and judges, and what was left undone for want
//! of it. What is left undone is never taken for done: its cases are neither pass nor fail, and the verdict says so.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use hairpin::campaign::digits::grouped;
use hairpin::campaign::scenario::{Scenario, SearchMethod};
use hairpin::campaign::{Case, Tally};
use hairpin::judgement::Verdict;
use serde::Serialize;

use crate::watch::Until;
use crate::{Deadline, Problem, Watch};

/// What is left undone of an arm whose first program is not proven in time to be the heaviest.
pub(crate) const UNPROVEN: &str = "the proof that no program is heavier than the first";

/// What the report takes at least, s, where the budget is not as short as that.
const REPORT_S: f64 = 2.0;

/// The time for a whole campaign; without one it takes as long as it does.
#[derive(Debug)]
pub struct Budget {
    begun: Instant,
    seconds: Option<f64>,
    time_limit: Deadline,
    cut: Mutex<Vec<Cut>>,
}

/// What was left undone.
#[derive(Debug, Clone)]
struct Cut {
    words: String,
    /// Whether the cases or the tally show it, so that the judge tells it.
    shows: bool,
}

/// A part of a campaign, each with its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// The search, saved cases before it.
    Search,
    /// The runs of its cases.
    Runs,
    /// Random cases beside them.
    Beside,
    /// The judgement; what is left is the report's.
    Judgement,
}

/// What came of a budget.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Spent {
    /// The time there was, s.
    pub seconds: f64,
    /// The time that was used, s.
    pub used_s: f64,
    /// What was left undone, in sentences' parts.
    pub cut: Vec<String>,
}

impl Budget {
    /// `seconds` from now for a whole campaign, of which its search has `time_limit_s` at most.
    pub fn of(seconds: Option<f64>, time_limit_s: Option<f64>) -> Self {
        let time_limit = Deadline::after(time_limit_s);
        Self { begun: Instant::now(), seconds, time_limit, cut: Mutex::default() }
    }

    /// As long as it takes.
    pub fn endless() -> Self {
        Self::of(None, None)
    }

    /// When `part` ends, whatever the parts before it took.
    pub(crate) fn end(&self, part: Part) -> Deadline {
        Deadline::since(self.begun, self.seconds.map(|seconds| seconds * share(part, seconds)))
    }

    /// When a search ends that is done in `part`: in time for the others, and by its own limit.
    pub(crate) fn end_of_search(&self, part: Part) -> Deadline {
        self.end(part).or_before(self.time_limit)
    }

    /// Does `work` until `part` ends; `None` where it was cut short.
    ///
    /// # Errors
    /// As `work`.
    pub(crate) fn within<T>(
        &self,
        part: Part,
        watch: &dyn Watch,
        work: impl FnOnce(&dyn Watch) -> Result<T, Problem>,
    ) -> Result<Option<T>, Problem> {
        let until = Until { watch, end: self.end(part) };
        match work(&until) {
            Err(Problem::Interrupted(_)) if !watch.stopped() => Ok(None),
            done => done.map(Some),
        }
    }

    /// Notes that something was left undone which neither cases nor tally show.
    pub(crate) fn leave_undone(&self, words: &str) {
        self.note(Cut { words: words.into(), shows: false });
    }

    /// The same of what they show.
    pub(crate) fn leave_undone_visibly(&self, words: String) {
        self.note(Cut { words, shows: true });
    }

    fn note(&self, cut: Cut) {
        self.cut.lock().unwrap_or_else(PoisonError::into_inner).push(cut);
    }

    /// `verdict` with what was left undone that the judge cannot see.
    pub(crate) fn told_in(&self, verdict: Verdict) -> Verdict {
        let cut = self.cut.lock().unwrap_or_else(PoisonError::into_inner);
        let words: Vec<&str> = cut.iter().filter(|cut| !cut.shows).map(|cut| cut.words.as_str()).collect();
        if words.is_empty() {
            return verdict;
        }
        Verdict { sentence: format!("{}; for want of time {}", verdict.sentence, words.join(", ")), ..verdict }
    }

    /// What came of it; `None` where there was none.
    pub fn spent(&self) -> Option<Spent> {
        let cut = self.cut.lock().unwrap_or_else(PoisonError::into_inner);
        let cut = cut.iter().map(|cut| cut.words.clone()).collect();
        let used_s = (1000.0 * self.begun.elapsed().as_secs_f64()).round() / 1000.0;
        Some(Spent { seconds: self.seconds?, used_s, cut })
    }

    /// `tally` with what the budget cut of its search, if it did.
    pub(crate) fn cut_of_search(&self, scenario: &Scenario, cases: &[Case], tally: &Tally) -> Option<String> {
        if tally.complete || !tally.stopped {
            return None;
        }
        if tally.cut.as_deref() == Some(UNPROVEN) {
            self.leave_undone_visibly(UNPROVEN.into());
            return tally.cut.clone();
        }
        if !self.end(Part::Search).passed() {
            // It was cut before, and nobody went on with it.
            return tally.cut.clone();
        }
        let words = search_words(scenario, cases, tally);
        self.leave_undone_visibly(words.clone());
        Some(words)
    }
}

/// `the search after 1 200 of 4 000 executions`.
fn search_words(scenario: &Scenario, cases: &[Case], tally: &Tally) -> String {
    let search = scenario.search();
    let executed: u64 = tally.curves.iter().map(|curve| curve.executions).sum();
    match search.method {
        SearchMethod::Worst if search.seconds.is_none() => {
            let all = scenario.searched_executions();
            format!("the search after {} of {} executions", grouped(executed), grouped(all))
        }
        SearchMethod::Worst => format!("the search after {} executions", grouped(executed)),
        _ => {
            let why = tally.nothing.as_ref().map_or(String::new(), |reason| format!(": {reason}"));
            format!("the search after {} graphs with {} of {} cases{why}", tally.graphs, cases.len(), search.cases)
        }
    }
}

/// The share of `seconds` at which `part` ends: a search takes what it gets, so it gets two thirds.
fn share(part: Part, seconds: f64) -> f64 {
    let judged = 1.0 - (REPORT_S / seconds).clamp(0.05, 0.2);
    judged
        * match part {
            Part::Search => 0.65,
            Part::Runs => 0.88,
            Part::Beside => 0.95,
            Part::Judgement => 1.0,
        }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unwatched;

    #[test]
    fn parts_end_one_after_the_other_and_before_the_whole() {
        for seconds in [0.1, 3.0, 60.0, 3600.0] {
            let parts = [Part::Search, Part::Runs, Part::Beside, Part::Judgement];
            let shares = parts.map(|part| share(part, seconds));
            assert!(shares.is_sorted() && shares[3] < 1.0, "{shares:?} of {seconds} s");
        }
        // An hour leaves three minutes for the report, a minute three seconds.
        assert!((share(Part::Judgement, 3600.0) - 0.95).abs() < 1e-12);
        assert!((60.0 * (1.0 - share(Part::Judgement, 60.0)) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn what_does_not_end_in_time_is_told() {
        let none = Budget::of(Some(0.0), None);
        let cut = none.within(Part::Runs, &Unwatched, |watch| match watch.stopped() {
            true => Err(Problem::Interrupted("stopped".into())),
            false => Ok(()),
        });
        assert!(matches!(cut, Ok(None)));
        none.leave_undone("runs");
        assert_eq!(none.spent().unwrap().cut, ["runs"]);
        let verdict = Verdict { sentence: "PASS 1/1 (simulated)".into(), exit_code: 0 };
        assert_eq!(none.told_in(verdict.clone()).sentence, "PASS 1/1 (simulated); for want of time runs");
        let endless = Budget::endless();
        assert_eq!(endless.told_in(verdict.clone()), verdict);
        assert!(matches!(endless.within(Part::Runs, &Unwatched, |watch| Ok(!watch.stopped())), Ok(Some(true))));
        assert_eq!(endless.spent(), None);
        // Whoever asks to stop is no budget.
        let refused = none.within(Part::Runs, &Unwatched, |_| Err::<(), _>(Problem::input("no")));
        assert!(matches!(refused, Err(Problem::Input(_))));
    }
}
