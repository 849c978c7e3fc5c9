//! The kinds of ways that are compared.

use serde::Deserialize;

/// What ways are told apart by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Kind {
    #[serde(skip)]
    Baseline,
    ByHand,
    Learned,
    InLoop,
    InLoopLearned,
    Moved,
    MovedLearned,
}

impl Kind {
    /// Whether what is found depends on who will fly it.
    pub(super) fn knows_controller(self) -> bool {
        !matches!(self, Self::Baseline | Self::ByHand)
    }
}

/// The kinds beside the baselines, as they are named.
pub(super) const KINDS: [(Kind, &str); 6] = [
    (Kind::ByHand, "best by hand"),
    (Kind::Learned, "learned"),
    (Kind::InLoop, "in the loop"),
    (Kind::InLoopLearned, "in the loop, from the learned"),
    (Kind::Moved, "in the loop, waypoints moved"),
    (Kind::MovedLearned, "in the loop, waypoints moved, from the learned"),
];
