//! What JUnit gets of a judged campaign.

use std::collections::BTreeMap;

use hairpin::campaign::{CaseResult, Status, Tally};
use hairpin::judgement::Verdict;
use hairpin::judgement::moves::{Outcome, Regression};
use hairpin_formats::junit::Suite;

use crate::next::replay_command;
use crate::saved::Replayed;
use crate::work::Work;

/// The suite of a judged campaign.
pub(super) fn suite(
    work: &Work,
    tally: &Tally,
    verdict: &Verdict,
    results: &[CaseResult],
    (regression, replayed): (Option<&Regression>, &[Replayed]),
) -> Suite {
    let programs = regression.iter().flat_map(|regression| &regression.programs).zip(results);
    let worse = programs.map(|(one, result)| {
        let against = &one.comparison.baseline;
        let worse = one.comparison.compared.iter().filter(|one| one.outcome == Outcome::Worse);
        let lost =
            one.comparison.lost.iter().map(|index| format!("move {index} no longer completed, against {against}"));
        (result.case, worse.map(|one| format!("{} against {against}", one.in_words())).chain(lost).collect())
    });
    let scenario = &work.setup.scenario;
    // No single case is to blame for what failed in the search for them.
    let blamed = if verdict.exit_code == 4 { Status::ExecutorFailed } else { Status::Inconclusive };
    let by_a_case = results.iter().any(|result| result.status == blamed);
    let property = |name: &str, value: String| (name.to_owned(), value);
    Suite {
        name: work.setup.robot_name().to_owned(),
        asked: tally.asked(scenario.search().cases),
        missing: tally.nothing.clone().unwrap_or_else(|| "not found within the budget".into()),
        inconclusive: ([4, 5].contains(&verdict.exit_code) && !by_a_case).then(|| verdict.sentence.clone()),
        properties: [
            property("verdict", verdict.sentence.clone()),
            property("seed", scenario.seed().to_string()),
            property("cases", tally.chosen(&scenario.search()).word().into()),
            property("version", env!("CARGO_PKG_VERSION").into()),
        ]
        .into_iter()
        .chain(results.iter().filter_map(|result| rerun_property(result, scenario.confidence_of_intervals())))
        .collect(),
        regressions: worse.collect(),
        saved: replayed.iter().map(Replayed::named).collect(),
        again: again(work, results, replayed),
    }
}

/// The commands that carry failing cases out again. What was recorded cannot be.
fn again(work: &Work, results: &[CaseResult], replayed: &[Replayed]) -> BTreeMap<String, String> {
    let is_failing = |result: &CaseResult| result.status == Status::Fail && work.setup.recordings().is_none();
    let failing = results.iter().filter(|result| is_failing(result));
    let own = failing.map(|result| {
        let case = result.case.to_string();
        (case.clone(), replay_command(work.folder.path(), Some(&case)))
    });
    let saved = replayed.iter().map(|one| (one.named().0, replay_command(&one.file, None)));
    saved.chain(own).collect()
}

/// `reruns 0117`: `3 of 10 violate, share 0.30 [0.07, 0.65]`. A test case of Jenkins' schema has no properties of its
/// own.
fn rerun_property(result: &CaseResult, confidence: f64) -> Option<(String, String)> {
    let reruns = result.reruns?;
    let share = reruns.share(confidence)?;
    let (violated, of) = (reruns.violated, reruns.of);
    let value = format!("{violated} of {of} violate, share {:.2} [{:.2}, {:.2}]", share.value, share.low, share.high);
    Some((format!("reruns {}", result.case), value))
}
