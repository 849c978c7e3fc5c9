//! Who finds cases, and by which keys.

use serde::{Deserialize, Serialize};

/// What is measured beside random trajectories.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Way {
    /// The evolution strategy over waypoints.
    Cmaes,
    /// The search in the loop, in its graphs.
    InLoop,
    /// The same, which moves waypoints.
    InLoopMoves,
    /// The default search without moved waypoints.
    WorstInGraph,
    /// The default search.
    Worst,
}

impl Way {
    /// The word in sheets and tables.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Cmaes => "cmaes",
            Self::InLoop => "in-loop",
            Self::InLoopMoves => "in-loop-moves",
            Self::WorstInGraph => "worst-in-graph",
            Self::Worst => "worst",
        }
    }

    /// Method, and whether waypoints are moved, of those that are methods of hairpin's.
    pub(super) fn method(self) -> Option<(&'static str, bool)> {
        match self {
            Self::Cmaes => None,
            Self::InLoop => Some(("in-loop", false)),
            Self::InLoopMoves => Some(("in-loop", true)),
            Self::WorstInGraph => Some(("worst", false)),
            Self::Worst => Some(("worst", true)),
        }
    }
}
