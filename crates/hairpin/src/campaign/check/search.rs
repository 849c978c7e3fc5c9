//! Bounds of `generate.search`.

use super::Findings;
use crate::campaign::scenario::{EXECUTED, LEAST_PER_ROUND, SearchMethod, SearchSection, TARGET_KEY};

/// Rounds at most.
const MOST_ROUNDS: u64 = 1_000;
/// Every round of an adaptive campaign keeps its legs: at ten legs a trajectory, a million rows to fit.
///
/// Trajectories, each with all of its legs.
const MOST_LEARNED: u64 = 100_000;

/// Bounds of all that does not depend on what moves: but for `waypoints`.
///
/// Upper bounds refuse what would fill the memory, not what is slow.
///
/// | key | bound |
/// | --- | --- |
/// | `width` | 1 … 1e5 |
/// | `cases`, `per_graph`, `executions` | 1 … 1e6 |
/// | `iterations`, `graphs` | 1 … 1e9 |
/// | `frontier` | 1 … 1e7 |
/// | `rounds` | 1 … 1000 |
/// | `explore` | 0 … 1 |
/// | `seconds`, `time_s` | above 0, at most 1e6 s |
/// | `confirm` | 0 … 1000, and fewer than `executions` |
pub(in crate::campaign) fn check_search(search: &SearchSection, found: &mut Findings) {
    found.count("generate.search.width", search.width, 1, 100_000);
    found.count("generate.search.cases", search.cases, 1, 1_000_000);
    found.count("generate.search.per_graph", search.per_graph, 1, 1_000_000);
    found.count("generate.search.iterations", search.iterations, 1, 1_000_000_000);
    // A partial trajectory on the frontier is some hundred bytes: ten million are a few GB.
    found.count("generate.search.frontier", search.frontier, 1, 10_000_000);
    found.count("generate.search.executions", search.executions, 1, 1_000_000);
    if let Some(seconds) = search.seconds {
        let worst = search.method == SearchMethod::Worst;
        found.above("generate.search.seconds", seconds, 0.0, 1e6, " s");
        found.require(worst, "generate.search.seconds", seconds, "left out: only the method `worst` ends by it");
    }
    if let Some(target) = &search.target {
        let worst = search.method == SearchMethod::Worst;
        let bound = "left out: only the method `worst` has a target (`stress` is what others search for)";
        found.require(worst, TARGET_KEY, format!("\"{}\"", target.word()), bound);
    }
    found.count("generate.search.confirm", search.confirm, 0, search.executions.saturating_sub(1).min(1_000));
    if let Some(graphs) = search.graphs {
        found.count("generate.search.graphs", graphs, 1, 1_000_000_000);
    }
    if let Some(rounds) = search.rounds {
        found.count("generate.search.rounds", rounds, 1, MOST_ROUNDS);
    }
    found.from("generate.search.explore", search.explore, 0.0, 1.0, "");
    if let Some(time) = search.time_s {
        found.above("generate.search.time_s", time, 0.0, 1e6, " s");
        let adaptive = search.method == SearchMethod::Adaptive;
        found.require(
            adaptive,
            "generate.search.time_s",
            time,
            "left out: only the method `adaptive` has rounds to end",
        );
    }
    if search.method == SearchMethod::Adaptive {
        check_adaptive(search, found);
    }
}

/// What the score `executed`, the value of `key`, needs.
///
/// The beam alone grows trajectories leg by leg; it executes at least one for each trajectory that is kept, does not
/// move waypoints, and confirms none.
pub(in crate::campaign) fn check_executed(search: &SearchSection, key: &str, found: &mut Findings) {
    let beam = search.method == SearchMethod::Beam;
    let bound = "another score, or generate.search.method = \"beam\": no other method grows trajectories leg by leg";
    found.require(beam, key, format!("\"{EXECUTED}\""), bound);
    let enough = search.executions >= search.per_graph;
    let bound = format!("{} … 1 000 000: one for each of the generate.search.per_graph trajectories", search.per_graph);
    found.require(enough || !beam, "generate.search.executions", search.executions, &bound);
    let what = format!("the score `{EXECUTED}`");
    let bound = format!("false: {what} grows trajectories along their graphs' legs");
    found.require(!search.moves_waypoints(), "generate.search.move_waypoints", true, &bound);
    check_unconfirmed(search, &what, found);
}

/// `what` executes each trajectory once, without noise.
fn check_unconfirmed(search: &SearchSection, what: &str, found: &mut Findings) {
    let bound = format!("0: {what} executes without noise; only the method `in-loop` confirms");
    found.require(search.confirm == 0, "generate.search.confirm", search.confirm, &bound);
}

/// Executions: at least what every round needs, at most 100 000.
///
/// The least is rounds × the larger of graphs and [`LEAST_PER_ROUND`], by the search's own count of both.
fn check_adaptive(search: &SearchSection, found: &mut Findings) {
    // Told already.
    if search.rounds.is_some_and(|rounds| rounds > MOST_ROUNDS) {
        return;
    }
    let graphs = search.adaptive_graphs();
    let least = search.least_per_round().saturating_mul(search.adaptive_rounds());
    let rounds = search.rounds.map_or("each round".into(), |rounds| format!("each of {rounds} rounds"));
    let bound = format!(
        "{least} … {MOST_LEARNED} for the method `adaptive`: in {rounds} one in each of {graphs} graphs, and \
         {LEAST_PER_ROUND} to learn from"
    );
    let fine = (least..=MOST_LEARNED).contains(&search.executions);
    found.require(fine, "generate.search.executions", search.executions, &bound);
    let bound = "false: the method `adaptive` stays on its graphs' legs, which are what it learns of";
    found.require(!search.moves_waypoints(), "generate.search.move_waypoints", true, bound);
    check_unconfirmed(search, "the method `adaptive`", found);
}
