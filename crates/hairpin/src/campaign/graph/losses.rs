//! Candidates for legs by what became of them.
//!
//! Data for explaining: counts by stage and limit, each candidate counted once, by the first that refuses it.

use std::collections::BTreeMap;

use serde::Serialize;

/// At which step a candidate is lost, in the order in which they are asked.
///
/// `Ord` is the order of asking.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stage {
    /// A limit of the scenario.
    Limits,
    /// The robot cannot get there.
    Reach,
    /// The world's walls, or the ground.
    World,
    /// Something is in the way.
    Obstacle,
    /// The leg is feasible, but the end cannot be reached from there in the legs that are left.
    EndPoint,
}

impl Stage {
    /// As it is told.
    pub fn word(self) -> &'static str {
        match self {
            Self::Limits => "limits",
            Self::Reach => "reach",
            Self::World => "world",
            Self::Obstacle => "obstacle",
            Self::EndPoint => "end point",
        }
    }
}

/// How many candidates one limit cost.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Lost {
    /// The step.
    pub stage: Stage,
    /// The limit: a scenario's key, or in words.
    pub limit: String,
    /// Candidates.
    pub count: u64,
}

/// What became of candidates for legs: pairs of a state that can be reached and a waypoint, or a state of it.
///
/// Counted on a few graphs near their starts: shares are what matters, not totals.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Losses {
    /// What a candidate is.
    pub of: &'static str,
    /// Candidates.
    ///
    /// [`Self::left`] and all of [`Self::lost`] together.
    pub asked: u64,
    /// Those that are legs on which the end can still be reached.
    pub left: u64,
    /// The others, each counted once, the most frequent first.
    pub lost: Vec<Lost>,
}

/// Counts them.
///
/// Keyed by stage and limit, so that the order of counting does not show.
#[derive(Debug, Default)]
pub(in crate::campaign) struct Counter {
    left: u64,
    lost: BTreeMap<(Stage, String), u64>,
}

impl Counter {
    pub(in crate::campaign) fn keep(&mut self) {
        self.left += 1;
    }

    pub(in crate::campaign) fn lose(&mut self, stage: Stage, limit: &str) {
        self.lose_many(stage, limit, 1);
    }

    pub(in crate::campaign) fn lose_many(&mut self, stage: Stage, limit: &str, count: u64) {
        if count > 0 {
            *self.lost.entry((stage, limit.to_owned())).or_default() += count;
        }
    }

    pub(in crate::campaign) fn keep_many(&mut self, count: u64) {
        self.left += count;
    }

    /// Equally frequent ones are in the order of the steps, then of their names.
    pub(in crate::campaign) fn losses(self, of: &'static str) -> Losses {
        let mut lost: Vec<Lost> =
            self.lost.into_iter().map(|((stage, limit), count)| Lost { stage, limit, count }).collect();
        // Stable: equals stay in the order of the steps.
        lost.sort_by_key(|lost| std::cmp::Reverse(lost.count));
        let asked = self.left + lost.iter().map(|lost| lost.count).sum::<u64>();
        Losses { of, asked, left: self.left, lost }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn every_candidate_is_counted_once() {
        let mut counter = Counter::default();
        counter.keep();
        counter.lose(Stage::Reach, "hull");
        counter.lose_many(Stage::Obstacle, "mast", 3);
        counter.lose(Stage::Limits, "max_speed");
        counter.lose_many(Stage::World, "walls", 0);
        let losses = counter.losses("legs");
        assert_eq!((losses.asked, losses.left, losses.lost.len()), (6, 1, 3));
        let order: Vec<&str> = losses.lost.iter().map(|lost| lost.stage.word()).collect();
        assert_eq!(order, ["obstacle", "limits", "reach"]);
    }
}
