//! What was measured of a run while all of its rows were there: later only those where it bends are.

use std::collections::BTreeSet;

use super::scenario::{DeviationFrom, Terms};
use crate::judgement::Measures;

/// What was measured of a run at its full rate, and by what reference.
///
/// As good as all rows for the terms that it was measured by; for others it is not used.
#[derive(Debug, Clone, PartialEq)]
pub struct FullRate {
    /// The reference of the deviation.
    pub from: DeviationFrom,
    /// Inside this distance of the leg's own waypoints overshoot was measured instead, m.
    pub corner: f64,
    /// What was measured.
    pub measures: Measures,
    /// The cells of the grid of motion that it met.
    pub met: BTreeSet<usize>,
}

impl FullRate {
    /// Whether `terms` would measure the same.
    pub(super) fn is_by(&self, terms: &Terms) -> bool {
        (self.from, self.corner) == (terms.from, terms.corner)
    }
}
