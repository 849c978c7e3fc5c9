//! `generate.search`: how a graph is searched, whatever moves through it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::findings::Findings;
use crate::judgement::Stress;

pub use crate::search::Aggregate;
pub use crate::world::Sampling;

/// The score that is the stress which partial trajectories were executed to.
pub const EXECUTED: &str = "executed";

/// `generate.search`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SearchSection {
    /// beam | exact | uniform | in-loop | adaptive.
    pub method: SearchMethod,
    /// Waypoints sampled per graph.
    pub waypoints: u64,
    /// How they are sampled.
    pub sampling: Sampling,
    /// Partial trajectories expanded per iteration.
    pub width: u64,
    /// Cases asked for: one best per sampled graph, unless `per_graph` asks for more.
    pub cases: u64,
    /// Trajectories taken from one graph at most.
    pub per_graph: u64,
    /// Whether a waypoint may be used twice.
    pub revisits: bool,
    /// How scores of legs become the score of a trajectory.
    pub aggregate: Aggregate,
    /// Iterations per graph at most.
    pub iterations: u64,
    /// Partial trajectories kept on the frontier at most; the worst are dropped.
    pub frontier: u64,
    /// Graphs sampled at most; 20 per case asked for if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub graphs: Option<u64>,
    /// `in-loop`, and the score `executed`: executions per graph at most; `adaptive`: executions of all rounds
    /// together.
    pub executions: u64,
    /// `in-loop`: executions under noise that what would be kept is given in addition; its stress is the mean. 0: none.
    pub confirm: u64,
    /// `adaptive`: rounds of executing and learning; in the first nothing is known, and all is drawn uniformly. If not
    /// given, one for 45 executions, at least 4 where there are enough, at most 15.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rounds: Option<u64>,
    /// `adaptive`: share of every later round's executions that no model chooses: half of them drawn uniformly, half
    /// optima of scores by hand.
    pub explore: f64,
    /// `adaptive`: time for executing and learning beside `executions`; what is found then depends on the clock.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
    /// `in-loop`: whether waypoints are moved off their graph, as far as the reach set lets them.
    pub move_waypoints: bool,
    /// `in-loop`, `adaptive`, and the score `executed`: what is searched for: max-deviation | mean-deviation |
    /// max-acceleration | time | overshoot | saturation | clearance | tilt.
    pub stress: Stress,
}

impl Default for SearchSection {
    fn default() -> Self {
        Self {
            method: SearchMethod::Beam,
            waypoints: 250,
            sampling: Sampling::Uniform,
            width: 5,
            cases: 100,
            per_graph: 1,
            revisits: false,
            aggregate: Aggregate::Sum,
            iterations: 10_000,
            frontier: 100_000,
            graphs: None,
            executions: 200,
            confirm: 0,
            rounds: None,
            explore: 0.2,
            time_s: None,
            move_waypoints: false,
            stress: Stress::MaxDeviation,
        }
    }
}

/// The searches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SearchMethod {
    /// Algorithms 1 and 2 of the paper.
    Beam,
    /// Dynamic programming: the optimum, or the proof that there is none.
    Exact,
    /// Uniform over all feasible trajectories: the random baseline.
    Uniform,
    /// Simulation in the loop: trajectories are scored by executing them.
    InLoop,
    /// Rounds of executing trajectories and learning from them which are worth executing next.
    Adaptive,
}

impl SearchMethod {
    /// Whether trajectories are executed while they are searched for.
    pub fn executes(self) -> bool {
        matches!(self, Self::InLoop | Self::Adaptive)
    }
}

/// Rounds at most.
const MOST_ROUNDS: u64 = 1_000;
/// Every round of an adaptive campaign keeps its legs: at ten legs a trajectory, a million rows to fit.
const MOST_LEARNED: u64 = 100_000;
/// Executions that a round needs at least to learn from: one more than a model does, so that one that fails does not
/// cost the round.
const LEAST_PER_ROUND: u64 = 13;
/// Executions of a round where the scenario does not say how many there are: what a round taught decides what the next
/// one executes, so that many small ones get farther than few large ones, as long as each has something to teach.
const PER_ROUND: u64 = 45;
/// Rounds then, where there are enough executions for them.
const ROUNDS: [u64; 2] = [4, 15];

impl SearchSection {
    /// Graphs that an adaptive campaign executes in.
    pub fn adaptive_graphs(&self) -> u64 {
        self.cases.div_ceil(self.per_graph.max(1))
    }

    /// Executions that a round needs: one in each graph, and enough to learn from.
    fn least_per_round(&self) -> u64 {
        self.adaptive_graphs().max(LEAST_PER_ROUND)
    }

    /// Rounds of an adaptive campaign.
    pub fn adaptive_rounds(&self) -> u64 {
        let [least, most] = ROUNDS;
        let enough = (self.executions / self.least_per_round()).max(1);
        self.rounds.unwrap_or_else(|| (self.executions / PER_ROUND).clamp(least, most).min(enough))
    }

    /// Bounds of all that does not depend on what moves: but for `waypoints`.
    pub(super) fn check(&self, found: &mut Findings) {
        found.count("generate.search.width", self.width, 1, 100_000);
        found.count("generate.search.cases", self.cases, 1, 1_000_000);
        found.count("generate.search.per_graph", self.per_graph, 1, 1_000_000);
        found.count("generate.search.iterations", self.iterations, 1, 1_000_000_000);
        // A partial trajectory on the frontier is some hundred bytes: ten million are a few GB.
        found.count("generate.search.frontier", self.frontier, 1, 10_000_000);
        found.count("generate.search.executions", self.executions, 1, 1_000_000);
        found.count("generate.search.confirm", self.confirm, 0, self.executions.saturating_sub(1).min(1_000));
        if let Some(graphs) = self.graphs {
            found.count("generate.search.graphs", graphs, 1, 1_000_000_000);
        }
        if let Some(rounds) = self.rounds {
            found.count("generate.search.rounds", rounds, 1, MOST_ROUNDS);
        }
        found.from("generate.search.explore", self.explore, 0.0, 1.0, "");
        if let Some(time) = self.time_s {
            found.above("generate.search.time_s", time, 0.0, 1e6, " s");
            let adaptive = self.method == SearchMethod::Adaptive;
            found.require(
                adaptive,
                "generate.search.time_s",
                time,
                "left out: only the method `adaptive` has rounds to end",
            );
        }
        if self.method == SearchMethod::Adaptive {
            self.check_adaptive(found);
        }
    }

    /// Whether trajectories are executed while they are searched for under `score`.
    pub fn executes(&self, score: &str) -> bool {
        self.method.executes() || score == EXECUTED
    }

    /// What the score `executed`, the value of `key`, needs.
    pub(super) fn check_executed(&self, key: &str, found: &mut Findings) {
        let beam = self.method == SearchMethod::Beam;
        let bound =
            "another score, or generate.search.method = \"beam\": no other method grows trajectories leg by leg";
        found.require(beam, key, format!("\"{EXECUTED}\""), bound);
        let enough = self.executions >= self.per_graph;
        let bound =
            format!("{} … 1 000 000: one for each of the generate.search.per_graph trajectories", self.per_graph);
        found.require(enough || !beam, "generate.search.executions", self.executions, &bound);
        let what = format!("the score `{EXECUTED}`");
        let bound = format!("false: {what} grows trajectories along their graphs' legs");
        found.require(!self.move_waypoints, "generate.search.move_waypoints", true, &bound);
        self.check_unconfirmed(&what, found);
    }

    /// `what` executes each trajectory once, without noise.
    fn check_unconfirmed(&self, what: &str, found: &mut Findings) {
        let bound = format!("0: {what} executes without noise; only the method `in-loop` confirms");
        found.require(self.confirm == 0, "generate.search.confirm", self.confirm, &bound);
    }

    fn check_adaptive(&self, found: &mut Findings) {
        // Told already.
        if self.rounds.is_some_and(|rounds| rounds > MOST_ROUNDS) {
            return;
        }
        let graphs = self.adaptive_graphs();
        let least = self.least_per_round().saturating_mul(self.adaptive_rounds());
        let rounds = self.rounds.map_or("each round".into(), |rounds| format!("each of {rounds} rounds"));
        let bound = format!(
            "{least} … {MOST_LEARNED} for the method `adaptive`: in {rounds} one in each of {graphs} graphs, and \
             {LEAST_PER_ROUND} to learn from"
        );
        let fine = (least..=MOST_LEARNED).contains(&self.executions);
        found.require(fine, "generate.search.executions", self.executions, &bound);
        let bound = "false: the method `adaptive` stays on its graphs' legs, which are what it learns of";
        found.require(!self.move_waypoints, "generate.search.move_waypoints", true, bound);
        self.check_unconfirmed("the method `adaptive`", found);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_follow_from_executions() {
        let rounds = |cases, executions, rounds| {
            SearchSection { cases, executions, rounds, ..SearchSection::default() }.adaptive_rounds()
        };
        let of_six = [12, 26, 52, 200, 360, 900].map(|executions| rounds(6, executions, None));
        assert_eq!(of_six, [1, 2, 4, 4, 8, 15]);
        assert_eq!((rounds(100, 250, None), rounds(100, 250, Some(7))), (2, 7));
    }
}
