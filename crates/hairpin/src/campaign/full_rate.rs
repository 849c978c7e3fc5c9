//! What was measured of a run while all of its rows were there: later only those where it bends are.

use std::collections::BTreeSet;

use super::implausible::Implausible;
use super::scenario::{DeviationFrom, Terms};
use crate::judgement::{LegMeasures, LegSource, Measures, Missing};

/// What was measured of a run at its full rate, and by what reference.
///
/// As good as all rows for the terms that it was measured by; for others but its deviations and overshoots.
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
    /// What no robot of its kind does; `None` where nobody looked: of our own simulators' runs, and of what earlier
    /// versions wrote.
    pub implausible: Option<Implausible>,
}

impl FullRate {
    /// Whether `terms` would measure the same.
    pub(super) fn is_by(&self, terms: &Terms) -> bool {
        (self.from, self.corner) == (terms.from, terms.corner)
    }

    /// What was measured, with deviations and overshoots as `rows` that were kept measure them, by another reference:
    /// everything else does not depend on one, and of all rows is exact.
    pub(super) fn beside(&self, rows: Measures) -> Measures {
        let exact = self.measures.clone();
        // Legs that were assigned may be others by another reference; those that are told stay.
        let are_told = [exact.leg_source, rows.leg_source] == [LegSource::Executor; 2];
        let of_rows = |(exact, rows): (LegMeasures, &LegMeasures)| LegMeasures {
            max_deviation: rows.max_deviation,
            mean_deviation: rows.mean_deviation,
            overshoot: rows.overshoot,
            ..exact
        };
        let legs = match are_told && exact.legs.len() == rows.legs.len() {
            true => exact.legs.into_iter().zip(&rows.legs).map(of_rows).collect(),
            false => rows.legs,
        };
        Measures {
            max_deviation: rows.max_deviation,
            mean_deviation: rows.mean_deviation,
            t_worst: rows.t_worst,
            leg_worst: rows.leg_worst,
            most_between: rows.most_between,
            overshoots: rows.overshoots,
            t_overshoot: rows.t_overshoot,
            overshoot_between: rows.overshoot_between,
            missing: Missing { deviation: rows.missing.deviation, ..exact.missing },
            leg_source: rows.leg_source,
            legs,
            ..exact
        }
    }
}
