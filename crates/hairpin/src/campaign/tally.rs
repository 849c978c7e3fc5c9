//! What a generation did, in numbers.
//!
//! Counts of units that were taken over, in their order, hence the same on any number of threads; written beside the
//! cases after every unit, so that a killed campaign goes on from it.

use serde::{Deserialize, Serialize};

use super::answers::Answers;
use super::curve::Curve;
use super::digits::grouped;
use super::failures::Failures;
use super::learn::ScoreModel;
use super::scenario::{Keys, SearchMethod, SearchSection};
use crate::judgement::Chosen;

/// What a generation did, in numbers; the report's and the verdict's.
///
/// Numbers of one generation from its beginning, interruptions included. The default is that of a generation that has
/// not begun.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Tally {
    /// Units of work done and taken over: graphs or, where `[vary]` shapes the plan, cases. Generation goes on here.
    pub units: u64,
    /// Graphs sampled and searched.
    pub graphs: u64,
    /// Of these, graphs that gave at least one trajectory.
    pub solved: u64,
    /// Of these, graphs proven to have none.
    /// With as many as [`Self::graphs`], that nothing is feasible in them is a proof.
    pub proven_empty: u64,
    /// Nodes expanded.
    /// Draws of the method `uniform`, executions of searches that execute.
    pub expansions: u64,
    /// Partial trajectories dropped because the frontier was full.
    /// Above 0, a graph without a trajectory is none that is proven to have none.
    pub dropped: u64,
    /// Trajectories found again and not counted twice.
    pub duplicates: u64,
    /// Whether every case asked for was found.
    pub complete: bool,
    /// Whether it was stopped, by a time limit or by Ctrl-C, before its graphs were used up.
    pub stopped: bool,
    /// What of the search was left undone because the time for the whole campaign was over, in a sentence's part.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cut: Option<String>,
    /// Where nothing was found: why, in a sentence's part.
    pub nothing: Option<String>,
    /// Executions that failed: of trajectories that are no cases for it.
    #[serde(skip_serializing_if = "Failures::is_none")]
    pub failures: Failures,
    /// Where trajectories were executed in the loop: the largest stress so far in every graph, as executions went on.
    /// In the order of graphs; one for a pool.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub curves: Vec<Curve>,
    /// Of one pool of executions: what its curve is told in, which follows from the limits that there were then.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub told_in: Option<String>,
    /// Rounds of an adaptive campaign.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rounds: Vec<RoundTally>,
    /// What an adaptive campaign learned from all its executions; a file of its own in a campaign's folder.
    #[serde(skip)]
    pub model: Option<Box<ScoreModel>>,
    /// Of one pool of executions that was stopped: what they came to; a file of its own in a campaign's folder.
    #[serde(skip)]
    pub answers: Option<Box<Answers>>,
    /// Why it learned nothing, in a sentence's part.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unlearned: Option<String>,
    /// Of one pool of executions: those that were of trajectories drawn at random.
    #[serde(skip_serializing_if = "is_zero")]
    pub drawn: u64,
    /// Of one pool of executions: the number of the run that each was.
    /// 0 is nominal.
    #[serde(skip_serializing_if = "is_zero")]
    pub run: u64,
    /// How they were drawn, in a sentence's part.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sampler: Option<String>,
    /// Of one pool of executions: how far apart its cases are at least, as `select` measures, on the scale of the
    /// trajectories that were drawn first.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub apart: Option<f64>,
    /// How far off their paths (mm) what was proven clear of the cases holds, whatever is limited by now; the folder's
    /// scenario has it. `None` where nothing was, or where it is the limit's.
    #[serde(skip)]
    pub clear_within_mm: Option<f64>,
    /// Names of the files that the cases were read from, in their order, where these are missions made elsewhere.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub missions: Vec<String>,
    /// Whether its cases are some of another campaign's, chosen for what they are.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub selected: bool,
}

impl Tally {
    /// How far off their paths (mm) what was proven clear of the cases holds, where `scenario` lets runs be farther
    /// off.
    pub fn proven_short_of(&self, scenario: &dyn Keys) -> Option<f64> {
        self.clear_within_mm.filter(|within| scenario.clear_within_mm().is_some_and(|now| now > *within))
    }

    /// Executions of the search, those that failed among them.
    pub fn executed(&self) -> u64 {
        let curves = self.curves.iter().map(|curve| curve.executions).sum::<u64>();
        curves.max(self.failures.of.unwrap_or_default()).max(self.failures.failed)
    }

    /// `31 of 80 executions of the search failed (why)`; `None` where none did.
    pub fn failures_in_words(&self) -> Option<String> {
        let failed = self.failures.failed;
        let why = self.failures.why_in_words();
        let of = grouped(self.executed());
        (failed > 0).then(|| format!("{} of {of} executions of the search failed{why}", grouped(failed)))
    }

    /// The same where another has executed the cases since.
    pub fn past_failures_in_words(&self) -> Option<String> {
        let failed = self.failures_in_words().filter(|_| self.failures.is_past)?;
        Some(format!("{failed} before another executor flew the cases, and what they were of was never executed"))
    }

    /// How the cases were come by, that `search` was to find.
    ///
    /// Which decides whether a share of violations is an estimate with an interval (drawn at random) or only a count
    /// (searched or selected).
    pub fn chosen(&self, search: &SearchSection) -> Chosen {
        match search.method {
            _ if self.selected => Chosen::Selected,
            _ if !self.missions.is_empty() => Chosen::Given,
            SearchMethod::Uniform if search.per_graph > 1 => Chosen::InGroups,
            SearchMethod::Uniform => Chosen::AtRandom,
            _ => Chosen::Searched,
        }
    }

    /// Cases asked for: as many as `wanted`, or as there were missions.
    pub fn asked(&self, wanted: u64) -> usize {
        if self.missions.is_empty() { wanted as usize } else { self.missions.len() }
    }
}

fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// A round of an adaptive campaign.
///
/// Stresses are in the unit of the search's stress; means of nothing are `None`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RoundTally {
    /// Executions in it.
    pub executions: u64,
    /// Of these, the uniform draws.
    pub drawn: u64,
    /// Of these, optima of scores by hand.
    pub by_hand: u64,
    /// Executions that failed, or whose stress could not be measured.
    pub failed: u64,
    /// Mean stress of its uniform draws; `None` where there were none.
    pub drawn_mean: Option<f64>,
    /// Mean stress of its optima of scores by hand; `None` where there were none.
    pub by_hand_mean: Option<f64>,
    /// Mean stress of what models chose; `None` where there was nothing.
    pub chosen_mean: Option<f64>,
    /// The largest stress of any graph, up to its end.
    pub largest: Option<f64>,
    /// Mean over the graphs of the largest stress in each, up to its end.
    pub mean_largest: Option<f64>,
    /// How well the model that it chose by told trajectories that it had not seen: R² over legs.
    /// At most 1; below 0 it is worse than their mean.
    pub r2: Option<f64>,
    /// The same: Spearman's ρ of the largest stress of a trajectory.
    /// −1 … 1. It is what a search makes use of: only ranks matter.
    pub rank_correlation: Option<f64>,
    /// Why there was no model, in a sentence's part; never of the first round.
    pub unlearned: Option<String>,
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn cases_are_at_random_that_were_drawn_one_by_one() {
        let of =
            |method, per_graph, tally: &Tally| tally.chosen(&SearchSection { method, per_graph, ..Default::default() });
        let tally = Tally::default();
        assert_eq!(of(SearchMethod::Uniform, 1, &tally), Chosen::AtRandom);
        assert_eq!(of(SearchMethod::Uniform, 5, &tally), Chosen::InGroups);
        for method in [SearchMethod::Beam, SearchMethod::Exact, SearchMethod::InLoop, SearchMethod::Adaptive] {
            assert_eq!(of(method, 1, &tally), Chosen::Searched);
        }
        let given = Tally { missions: vec!["a".into()], ..Tally::default() };
        assert_eq!(of(SearchMethod::Uniform, 1, &given), Chosen::Given);
        assert_eq!(of(SearchMethod::Uniform, 1, &Tally { selected: true, ..given }), Chosen::Selected);
    }
}
