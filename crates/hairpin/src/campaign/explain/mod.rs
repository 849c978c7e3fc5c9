//! Why nothing, or little, is feasible: where candidates for legs are lost, and the smallest single change that helps.
//!
//! Losses say where to look; only a change that was searched with, over the same graphs, is told to help.

mod changes;

use serde::Serialize;

use self::changes::{searched, smallest};
use super::graph::Losses;
use super::{Mistake, Scenario, Setup, Stop, Tally, verdict};
use crate::judgement::Verdict;

pub use changes::Change;

/// What is known of a scenario's feasibility.
///
/// `solved` above 0 means that something is feasible; then there are losses but no changes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Explanation {
    /// Graphs that were sampled and searched; of arms the one that there is.
    pub graphs: u64,
    /// Of these, graphs with a feasible trajectory.
    pub solved: u64,
    /// What became of the candidates for legs.
    ///
    /// Candidates near the starts of a few graphs, by the stage that refused them.
    #[serde(rename = "deaths")]
    pub losses: Losses,
    /// What stands in the way, each in a sentence, where more is known than what is counted.
    pub reasons: Vec<String>,
    /// Single changes with which something is feasible, the smallest first; none are looked for where something is.
    pub changes: Vec<Change>,
    /// Whether the search for changes was stopped before it came to an end.
    pub stopped: bool,
    /// What the search did.
    #[serde(skip)]
    tally: Tally,
}

/// Samples and searches `graphs` graphs of `setup`; where none has a trajectory, every relevant key is changed until
/// one has.
///
/// The same graphs (of the same seeds) are asked with every change. `stop` ends the search of the scenario's own
/// graphs, `looking` that for changes, with those that were found; it is told how many keys were tried.
///
/// Only one key is changed at a time: that two together would help is not found.
///
/// # Errors
/// A scenario that no search can be begun with.
///
/// `graphs` bounds each search; every change asks the same numbers of graphs. Searches that execute are replaced by
/// uniform draws, since feasibility does not depend on executions; `[vary]` is left out.
pub fn explain(setup: &Setup, graphs: u64, stop: &Stop, looking: &Stop) -> Result<Explanation, Mistake> {
    let setup = first_of(setup, graphs).and_then(|scenario| setup.of_draw(scenario))?;
    let tally = searched(&setup, true, stop);
    let losses = setup.kind().lost(graphs);
    let reasons = setup.kind().programs().map_or_else(Vec::new, |programs| programs.in_the_way());
    let changes = if tally.solved > 0 { Vec::new() } else { smallest(&setup, looking) };
    let stopped = tally.solved == 0 && (looking.cancelled)();
    Ok(Explanation { graphs: tally.graphs, solved: tally.solved, losses, reasons, changes, stopped, tally })
}

impl Explanation {
    /// Whether it is known if the scenario's own graphs have something: its search was not stopped before.
    pub fn is_found_out(&self) -> bool {
        self.solved > 0 || !self.tally.stopped
    }

    /// `NOTHING FEASIBLE (proof, hull): no chain of 10 waypoints from start to end; smallest change: length 12, or
    /// max_speed 8.0 → 9.3 m/s`, exit code 3; or that there is something, 0.
    pub fn verdict(&self, setup: &Setup) -> Verdict {
        if self.solved > 0 {
            let reach = setup.scenario.reach();
            let sentence = format!("FEASIBLE ({reach}): {} of {} graphs have a trajectory", self.solved, self.graphs);
            return Verdict { sentence, exit_code: 0 };
        }
        let told: Vec<String> = self.changes.iter().map(|change| change.words.clone()).collect();
        let change = match (told.as_slice(), self.stopped) {
            ([], true) => "not found in time".into(),
            ([], false) => "none of one key alone".into(),
            (words, _) => words.join(", or "),
        };
        verdict::nothing_feasible(setup, &self.tally, Some(&change))
    }
}

/// The scenario asked for one case of `graphs` graphs, and nothing varied.
fn first_of(setup: &Setup, graphs: u64) -> Result<Scenario, Mistake> {
    let knobs = setup.kind().knobs();
    let mut draws: Vec<_> = knobs.counts.iter().map(|key| ((*key).to_owned(), graphs.into())).collect();
    draws.push((knobs.per_graph.into(), 1.into()));
    if setup.scenario.search().method.executes() {
        // What is feasible does not depend on what it does to the robot.
        draws.push(("generate.search.method".into(), "uniform".into()));
    }
    draws.extend(knobs.settled);
    super::vary::apply(&setup.scenario, &draws)
}
