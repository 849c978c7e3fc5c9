//! `junit.xml` for build servers, in the subset that Jenkins' xUnit schema takes: it drops the whole file for one
//! attribute too many. A `testcase` has a name, a classname and a time, and nothing else; properties stand on the
//! suite.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::time::Duration;

use hairpin::campaign::{CaseNumber, CaseResult, Status, report};
use hairpin::judgement::is_command;
use quick_junit::{NonSuccessKind, Property, Report, TestCase, TestCaseStatus, TestSuite};

use crate::atomic::{self, WriteError};
use crate::quote::on_one_line;

/// What a suite says beside its cases.
#[derive(Debug, Clone, Default)]
pub struct Suite {
    /// Name of the suite: the scenario's or robot's.
    pub name: String,
    /// Cases asked for; those that were not found are skipped tests, so that the file has this many.
    pub asked: usize,
    /// Why cases are missing.
    pub missing: String,
    /// Why the campaign as a whole allows no verdict, where no single case is to blame: then no case is a pass.
    pub inconclusive: Option<String>,
    /// Name and value.
    pub properties: Vec<(String, String)>,
    /// What is worse than a baseline, in sentences, by case: a failure even within spec.
    pub regressions: BTreeMap<CaseNumber, Vec<String>>,
    /// Saved cases that were run before: name and result of each. They make a suite of their own, where there are any.
    pub saved: Vec<(String, CaseResult)>,
    /// The command that carries a failing test case out again, by the test case's name.
    pub again: BTreeMap<String, String>,
}

/// Name of the suite of saved cases.
const SAVED: &str = "saved cases";

/// The file's text: one test case per case asked for, in the order of their numbers.
pub fn text(suite: &Suite, results: &[CaseResult]) -> String {
    let mut tests = TestSuite::new(clean(&on_one_line(&suite.name)));
    for (name, value) in &suite.properties {
        tests.add_property(Property::new(clean(name), clean(value)));
    }
    let mut ordered: Vec<&CaseResult> = results.iter().collect();
    ordered.sort_by_key(|result| result.case);
    for result in &ordered {
        tests.add_test_case(test_case(suite, result.case.to_string(), result));
    }
    let judged: BTreeSet<CaseNumber> = results.iter().map(|result| result.case).collect();
    let missing =
        (0..).map(CaseNumber).filter(|number| !judged.contains(number)).take(suite.asked.saturating_sub(results.len()));
    for number in missing {
        tests.add_test_case(named(suite, number.to_string(), not_found(suite, results.is_empty())));
    }
    let mut report = Report::new("hairpin");
    report.add_test_suite(tests);
    if !suite.saved.is_empty() {
        let plain = Suite { name: SAVED.into(), again: suite.again.clone(), ..Suite::default() };
        let mut tests = TestSuite::new(SAVED);
        for (name, result) in &suite.saved {
            tests.add_test_case(test_case(&plain, name.clone(), result));
        }
        report.add_test_suite(tests);
    }
    let text = report.to_string().expect("cleaned text is XML");
    without_root_skipped(&text)
}

/// One test of a suite that is no case: a log that was judged, a pair that was compared.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Outcome {
    /// Name of the test.
    pub name: String,
    /// What came of it: the kinds of JUnit.
    pub kind: OutcomeKind,
    /// In a sentence.
    pub sentence: String,
    /// What stands below it, line by line, where it did not pass.
    pub more: Vec<String>,
}

/// What a test came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OutcomeKind {
    /// A pass.
    Pass,
    /// A violation.
    Violation,
    /// Worse than before.
    Regression,
    /// Nothing was asked for.
    Skipped,
    /// The data allow no verdict, which is no pass.
    Open,
}

/// The text of a file with one suite of `outcomes`, in their order.
pub fn outcomes_text(name: &str, properties: &[(String, String)], outcomes: &[Outcome]) -> String {
    let suite = Suite { name: name.into(), ..Suite::default() };
    let mut tests = TestSuite::new(clean(&on_one_line(name)));
    for (name, value) in properties {
        tests.add_property(Property::new(clean(name), clean(value)));
    }
    for Outcome { name, kind, sentence, more } in outcomes {
        let status = match kind {
            OutcomeKind::Pass => TestCaseStatus::success(),
            OutcomeKind::Violation => not_passed(NonSuccessKind::Failure, "SpecViolation", sentence, more),
            OutcomeKind::Regression => not_passed(NonSuccessKind::Failure, "Regression", sentence, more),
            OutcomeKind::Skipped => skipped(sentence),
            OutcomeKind::Open => not_passed(NonSuccessKind::Error, "Inconclusive", sentence, more),
        };
        tests.add_test_case(named(&suite, name.clone(), status));
    }
    let mut report = Report::new("hairpin");
    report.add_test_suite(tests);
    without_root_skipped(&report.to_string().expect("cleaned text is XML"))
}

/// Writes [`text`].
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, suite: &Suite, results: &[CaseResult]) -> Result<(), WriteError> {
    atomic::write(path, text(suite, results).as_bytes())
}

fn test_case(suite: &Suite, name: String, result: &CaseResult) -> TestCase {
    let worse = suite.regressions.get(&result.case).map_or(&[][..], Vec::as_slice);
    let violations: Vec<String> =
        result.violations.iter().map(report::violation).chain(result.elsewhere.iter().chain(worse).cloned()).collect();
    let again = suite.again.get(&name).map(|command| format!("again: {command}"));
    let below = |lines: &[String]| lines.iter().skip(1).cloned().chain(again.clone()).collect::<Vec<_>>();
    let status = match result.status {
        Status::Pass if !worse.is_empty() => {
            not_passed(NonSuccessKind::Failure, "Regression", &worse[0], &below(worse))
        }
        Status::Pass => match &suite.inconclusive {
            None => TestCaseStatus::success(),
            Some(why) => not_passed(NonSuccessKind::Error, no_verdict(why), why, &[]),
        },
        Status::Unjudged => skipped("spec = \"none\": nothing was asked for"),
        Status::Fail => {
            let gravest = violations.first().map_or("violates the specification", String::as_str);
            not_passed(NonSuccessKind::Failure, "SpecViolation", gravest, &below(&violations))
        }
        Status::ExecutorFailed => {
            let message = result.message.as_deref().unwrap_or("the executor failed");
            // The first line tells; the log that may follow it belongs below.
            let mut lines = message.lines();
            let first = lines.next().unwrap_or_default();
            let rest: Vec<String> = lines.map(str::to_owned).collect();
            not_passed(NonSuccessKind::Error, "ExecutorFailed", first, &rest)
        }
        Status::Inconclusive => {
            let message = result.message.as_deref().or(violations.first().map(String::as_str));
            not_passed(NonSuccessKind::Error, "Inconclusive", message.unwrap_or("the data allow no verdict"), &[])
        }
    };
    let mut case = named(suite, name, status);
    if let Some(measures) = &result.measures {
        case.set_time(Duration::try_from_secs_f64(measures.total_time).unwrap_or_default());
    }
    case
}

/// A case that was not found is skipped; where there is none at all and nobody knows why, that is no success.
fn not_found(suite: &Suite, none_at_all: bool) -> TestCaseStatus {
    match suite.inconclusive.as_ref().filter(|_| none_at_all) {
        Some(why) => not_passed(NonSuccessKind::Error, no_verdict(why), why, &[]),
        None => skipped(&suite.missing),
    }
}

/// The type of a verdict on the campaign as a whole that is no pass, by its beginning.
fn no_verdict(sentence: &str) -> &'static str {
    if sentence.starts_with("EXECUTOR FAILED") { "ExecutorFailed" } else { "Inconclusive" }
}

fn skipped(why: &str) -> TestCaseStatus {
    let mut status = TestCaseStatus::skipped();
    status.set_message(clean(why));
    status
}

fn not_passed(kind: NonSuccessKind, ty: &str, message: &str, more: &[String]) -> TestCaseStatus {
    let mut status = TestCaseStatus::non_success(kind);
    status.set_type(ty).set_message(clean(message));
    if !more.is_empty() {
        status.set_description(clean(&more.join("\n")));
    }
    status
}

fn named(suite: &Suite, name: String, status: TestCaseStatus) -> TestCase {
    let mut case = TestCase::new(clean(&on_one_line(&name)), status);
    case.set_classname(clean(&on_one_line(&suite.name)));
    case
}

/// Without control characters and ANSI colours, which XML 1.0 cannot say; line ends and tabs stay.
fn clean(text: &str) -> String {
    let mut kept = String::with_capacity(text.len());
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        if c == '\u{1b}' && rest.peek() == Some(&'[') {
            while rest.next().is_some_and(|end| !end.is_ascii_alphabetic()) {}
        } else if matches!(c, '\n' | '\t') || !(is_command(c) || matches!(c, '\u{fffe}' | '\u{ffff}')) {
            kept.push(c);
        }
    }
    kept
}

/// The schema has no `skipped` on `testsuites`; the writer puts one there.
fn without_root_skipped(text: &str) -> String {
    let Some(start) = text.find("<testsuites") else { return text.into() };
    let end = text[start..].find('>').map_or(text.len(), |length| start + length);
    let root: Vec<&str> = text[start..end].split(' ').filter(|part| !part.starts_with("skipped=")).collect();
    format!("{}{}{}", &text[..start], root.join(" "), &text[end..])
}
