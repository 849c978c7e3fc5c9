//! What a campaign says on stdout: for people words (in its own file), for machines one object.

mod words;

use std::path::Path;

use hairpin::campaign::report::{violation, worst_first};
use hairpin::campaign::{Baseline, Case, CaseResult, Rank, Status, Tally};
use hairpin::judgement::Verdict;
use hairpin::judgement::moves::{Metric, Outcome, Regression};
use hairpin_formats::header::Header;
use hairpin_jobs::Spent;
use hairpin_jobs::judge::Judgement;
use hairpin_jobs::missions::{Compared, Ranked};
use hairpin_jobs::saved::Replayed;
use hairpin_jobs::work::Work;
use serde_json::{Value, json};

/// A verdict and what it is about.
pub struct Answer<'a> {
    /// The campaign.
    pub work: &'a Work,
    /// Its cases.
    pub cases: &'a [Case],
    /// What the search did.
    pub tally: &'a Tally,
    /// What judging came to.
    pub judgement: &'a Judgement,
    /// The judgement's, with what saved cases came to.
    pub verdict: &'a Verdict,
    /// Saved cases that were run first.
    pub replayed: &'a [Replayed],
    /// What came of the time for the whole, where that was limited.
    pub spent: Option<&'a Spent>,
    /// Where JUnit was asked for as well.
    pub junit: Option<&'a Path>,
    /// Whether `report.html` was written of this judgement: one that is there otherwise is of an earlier one.
    pub reported: bool,
}

impl Answer<'_> {
    fn header(&self) -> Header {
        Header::of(&self.work.setup, (self.cases, &self.judgement.results), self.tally)
    }

    fn claim(&self, result: &CaseResult) -> Option<String> {
        self.cases.iter().find(|case| case.number == result.case).map(Case::claim)
    }

    /// By how much the clocks of arms' recordings differ from the plan's.
    fn offsets(&self) -> Vec<Value> {
        let cases = self.judgement.moves.cases.iter();
        let runs = cases.flat_map(|case| case.runs.iter().map(move |run| (case, run)));
        runs.map(|(case, run)| {
            json!({
                "case": case.case.to_string(), "run": run.run, "offset_s": run.offset_s,
                "spread_s": run.offset_spread_s, "removed": run.offset_removed,
            })
        })
        .collect()
    }

    fn count(&self, status: Status) -> usize {
        self.judgement.results.iter().filter(|result| result.status == status).count()
    }

    /// The violations among the judged cases, and how these were come by; an interval only where that was at random.
    fn share(&self) -> Value {
        let scenario = &self.work.setup.scenario;
        let chosen = self.tally.chosen(&scenario.search());
        let violated = self.count(Status::Fail);
        let of = violated + self.count(Status::Pass) + self.count(Status::Unjudged);
        let share = chosen.share(violated, of, scenario.confidence_of_intervals());
        json!({
            "cases": chosen.word(), "violated": violated, "of": of,
            "low": share.map(|share| share.low), "high": share.map(|share| share.high),
        })
    }

    /// What machines get.
    pub fn object(&self) -> Value {
        let file = |name: &str| {
            let path = self.work.folder.path().join(name);
            if path.exists() { json!(path) } else { Value::Null }
        };
        let mut paths = json!({
            "folder": self.work.folder.path(),
            "scenario": file("scenario.toml"),
            "results": file("results.parquet"),
            "junit": file("junit.xml"),
            "report": if self.reported { file("report.html") } else { Value::Null },
        });
        // Only searches that execute have one.
        if let curve @ Value::String(_) = file("best-so-far.tsv") {
            paths["best_so_far"] = curve;
        }
        if let Some(place) = self.junit {
            paths["junit_copy"] = json!(place);
        }
        json!({
            "verdict": self.verdict.sentence,
            "exit_code": self.verdict.exit_code,
            "counts": {
                "asked": self.tally.asked(self.work.setup.scenario.search().cases),
                "cases": self.cases.len(),
                "pass": self.count(Status::Pass),
                "fail": self.count(Status::Fail),
                "unjudged": self.count(Status::Unjudged),
                "executor_failed": self.count(Status::ExecutorFailed),
                "inconclusive": self.count(Status::Inconclusive),
                "attitude_unknown": self.judgement.attitude_unknown,
            },
            "search": search(self.tally),
            "share": self.share(),
            "baseline": self.judgement.baseline.as_ref().map(baseline),
            "stress_percent": self.judgement.baseline.as_ref().and_then(|it| it.stress_percent(&self.judgement.results)),
            "missions": self.judgement.missions.as_ref().map(missions),
            "frame": self.header(),
            "worst": worst_first(&self.judgement.results).first().map(|result| {
                let mut object = worst(result, self.work.setup.scenario.confidence_of_intervals());
                object["evidence"] = json!(self.claim(result));
                object
            }),
            "replayed": self.replayed.iter().map(replayed_object).collect::<Vec<_>>(),
            "influences": self.judgement.influences,
            "offsets": self.offsets(),
            "budget": self.spent,
            "regression": self.judgement.regression.as_ref().map(regression),
            "paths": paths,
        })
    }
}

/// What the search executed, and what of that failed; null of one that executed nothing.
fn search(tally: &Tally) -> Value {
    let (executed, failures) = (tally.executed(), &tally.failures);
    if executed == 0 {
        return Value::Null;
    }
    json!({
        "executions": executed, "failed": failures.failed, "why": failures.why,
        "flown_by_another_since": failures.is_past,
    })
}

/// How stressful missions made elsewhere are, beside what a search finds.
fn missions(found: &Compared) -> Value {
    let rank = |rank: &Rank| {
        let mut object = baseline(&rank.of);
        object["below"] = json!(rank.below);
        object["percentile"] = json!(rank.percentile());
        object["ratio"] = json!(rank.to_worst);
        object["ratio_to_mean"] = json!(rank.to_mean);
        object
    };
    let one = |one: &Ranked| {
        let told = found.told.missions.get(one.case.0);
        json!({
            "case": one.case.to_string(), "stress": one.stress, "mission": told,
            "searched": one.searched.as_ref().map(rank), "random": one.random.as_ref().map(rank),
        })
    };
    json!({ "worst": one(&found.worst), "each": found.each.iter().map(one).collect::<Vec<_>>(), "words": found.words })
}

/// What random feasible cases came to.
pub(super) fn baseline(found: &Baseline) -> Value {
    json!({
        "cases": found.cases, "failed": found.failed, "implausible": found.implausible, "executions": found.executions,
        "metric": found.stress.column(), "mean": found.mean,
        "interval": found.interval, "median": found.median, "max": found.max, "worst": found.worst,
    })
}

/// A saved case and what it comes to now.
pub(super) fn replayed_object(one: &Replayed) -> Value {
    let result = &one.result;
    json!({
        "file": one.file,
        "status": result.status.word(),
        "max_deviation_m": result.measures.as_ref().map(|measures| measures.max_deviation),
        "violations": result.violations.iter().map(violation).collect::<Vec<_>>(),
    })
}

/// A comparison with a baseline: what is outside its band, and how moves went from release to release.
fn regression(found: &Regression) -> Value {
    let name = |metric: Metric| match metric {
        Metric::Duration => "duration_s",
        Metric::Deviation => "deviation_m",
    };
    let outside = |wanted: Outcome| -> Vec<Value> {
        let programs = found.programs.iter();
        let all = programs.flat_map(|one| one.comparison.compared.iter().map(move |compared| (one, compared)));
        all.filter(|(_, compared)| compared.outcome == wanted)
            .map(|(one, compared)| {
                json!({
                    "case": one.program, "move": compared.name, "index": compared.index, "what": name(compared.metric),
                    "baseline": compared.baseline, "new": compared.new, "band": compared.band,
                })
            })
            .collect()
    };
    let trends = found.programs.iter().flat_map(|one| one.trends.iter().map(move |trend| (one, trend)));
    let trends = trends.map(|(one, trend)| {
        json!({
            "case": one.program, "move": trend.name, "index": trend.index, "what": name(trend.metric),
            "means": trend.means, "slope": trend.slope, "rank_correlation": trend.correlation,
        })
    });
    json!({
        "releases": found.releases,
        "moves": found.moves(),
        "worse": outside(Outcome::Worse),
        "better": outside(Outcome::Better),
        "trends": trends.collect::<Vec<_>>(),
    })
}

/// The worst run of a case, with intervals of that confidence.
fn worst(result: &CaseResult, confidence: f64) -> Value {
    let measures = result.measures.as_ref();
    json!({
        "case": result.case.to_string(),
        "run": result.run,
        "status": result.status.word(),
        "max_deviation_m": measures.map(|m| m.max_deviation),
        "runs_max_deviation_m": result.measured().map(|m| m.max_deviation),
        "t_worst_s": measures.map(|m| m.t_worst),
        "leg_worst": measures.map(|m| m.leg_worst),
        "saturation_share": measures.and_then(|m| m.saturation_share),
        "joint_effort_rad2_s3": measures.and_then(|m| m.joint_effort),
        "ended": result.ended,
        "draws": result.draws.map(|draws| {
            let share = draws.share(confidence);
            json!({
                "violated": draws.violated, "of": draws.of,
                "low": share.map(|share| share.low), "high": share.map(|share| share.high),
            })
        }),
        "reruns": result.reruns.map(|reruns| {
            let share = reruns.share(confidence);
            json!({
                "violated": reruns.violated, "of": reruns.of,
                "low": share.map(|share| share.low), "high": share.map(|share| share.high),
            })
        }),
        "violations": result.violations.iter().map(violation).collect::<Vec<_>>(),
        "message": result.message,
    })
}
