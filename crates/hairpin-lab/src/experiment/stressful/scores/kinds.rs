//! The kinds of ways that are compared.

use serde::Deserialize;

/// What ways are told apart by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum WayKind {
    #[serde(skip)]
    Baseline,
    ByHand,
    Learned,
    InLoop,
    InLoopLearned,
    Moved,
    MovedLearned,
}

impl WayKind {
    /// Whether what is found depends on who will fly it.
    pub(super) fn knows_controller(self) -> bool {
        !matches!(self, Self::Baseline | Self::ByHand)
    }
}

/// The kinds beside the baselines, as they are named.
pub(super) const KINDS: [(WayKind, &str); 6] = [
    (WayKind::ByHand, "best by hand"),
    (WayKind::Learned, "learned"),
    (WayKind::InLoop, "in the loop"),
    (WayKind::InLoopLearned, "in the loop, from the learned"),
    (WayKind::Moved, "in the loop, waypoints moved"),
    (WayKind::MovedLearned, "in the loop, waypoints moved, from the learned"),
];
