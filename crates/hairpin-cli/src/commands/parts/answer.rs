//! What a campaign says on stdout: for people a table of the worst cases and the verdict, for machines one object.

use std::path::Path;

use hairpin::campaign::report::{COLUMNS, cells, violation, worst_first};
use hairpin::campaign::{Case, CaseResult, Status};
use hairpin::judgement::Verdict;
use serde_json::{Value, json};

use crate::console;

/// Rows of the table.
const WORST: usize = 5;

/// A verdict and what it is about.
pub(crate) struct Answer<'a> {
    pub(crate) folder: &'a Path,
    pub(crate) asked: usize,
    pub(crate) cases: &'a [Case],
    pub(crate) results: &'a [CaseResult],
    pub(crate) verdict: &'a Verdict,
}

impl Answer<'_> {
    /// Says it, and gives the exit code.
    pub(crate) fn say(&self, json: bool) -> u8 {
        if json {
            console::say(&self.object().to_string());
        } else {
            if !self.results.is_empty() {
                console::say(&self.table());
                console::say("");
            }
            console::say(&self.verdict.sentence);
            let report = self.folder.join("report.html");
            if report.is_file() {
                console::warn(&format!("report: {}", report.display()));
            }
        }
        self.verdict.exit_code
    }

    fn table(&self) -> String {
        let header = COLUMNS.iter().map(|name| (*name).to_owned()).collect();
        let rows = worst_first(self.results).into_iter().take(WORST).map(|result| cells(result).to_vec());
        console::table(&std::iter::once(header).chain(rows).collect::<Vec<_>>())
    }

    fn count(&self, status: Status) -> usize {
        self.results.iter().filter(|result| result.status == status).count()
    }

    fn object(&self) -> Value {
        let file = |name: &str| {
            let path = self.folder.join(name);
            if path.exists() { json!(path) } else { Value::Null }
        };
        json!({
            "verdict": self.verdict.sentence,
            "exit_code": self.verdict.exit_code,
            "counts": {
                "asked": self.asked,
                "cases": self.cases.len(),
                "pass": self.count(Status::Pass),
                "fail": self.count(Status::Fail),
                "executor_failed": self.count(Status::ExecutorFailed),
                "inconclusive": self.count(Status::Inconclusive),
            },
            "worst": worst_first(self.results).first().map(|result| worst(result)),
            "paths": {
                "folder": self.folder,
                "scenario": file("scenario.toml"),
                "results": file("results.parquet"),
                "junit": file("junit.xml"),
                "report": file("report.html"),
            },
        })
    }
}

/// The worst run of a case.
pub(crate) fn worst(result: &CaseResult) -> Value {
    let measures = result.measures.as_ref();
    json!({
        "case": format!("{:04}", result.case),
        "run": result.run,
        "status": result.status.word(),
        "max_deviation_m": measures.map(|m| m.max_deviation),
        "t_worst_s": measures.map(|m| m.t_worst),
        "leg_worst": measures.map(|m| m.leg_worst),
        "saturation_share": measures.and_then(|m| m.saturation_share),
        "ended": result.ended,
        "violations": result.violations.iter().map(violation).collect::<Vec<_>>(),
        "message": result.message,
    })
}
