//! What a search sees of a leg, and legs that were executed.

use super::Feature;
use crate::campaign::case::SeenLeg;
use crate::feasibility::reach::LegFeatures;

/// Number of features of a leg.
const FEATURES: usize = 8;

/// Names and units, in the order of [`inputs`]: logarithms of the speeds at both ends, turn from the leg before,
/// length, sines of elevation of the leg and of the one before, planned duration, and what the reach set knows of the
/// ground.
pub(super) fn named() -> Vec<Feature> {
    let named: [(&str, &str); FEATURES] = [
        ("ln(1 + v_in)", "v in m/s"),
        ("ln(1 + v_out)", "v in m/s"),
        ("turn", "rad"),
        ("ln(1 + length)", "length in m"),
        ("slope", ""),
        ("slope_in", ""),
        ("duration", "s"),
        ("ground", ""),
    ];
    named.into_iter().map(|(name, unit)| Feature { name: name.into(), unit: unit.into() }).collect()
}

/// Slope = climb / length; 0 for a leg without a length. `duration` in s.
///
/// ln(1 + v_in), ln(1 + v_out), turn, ln(1 + length), slope, slope_in, duration, ground; m/s, rad, m, s.
pub(super) fn inputs(leg: &LegFeatures, duration: f64) -> [f64; FEATURES] {
    let slope = if leg.length > 0.0 { leg.climb / leg.length } else { 0.0 };
    let [v_in, v_out, length] = [leg.v_in, leg.v_out, leg.length].map(|size| libm::log(1.0 + size));
    [v_in, v_out, leg.turn, length, slope, leg.slope_in, duration, leg.ground]
}

/// A leg that was executed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegSample {
    /// Number of its trajectory: legs of one trajectory are never on both sides of a fold.
    pub trajectory: usize,
    /// What a search sees of it.
    pub seen: SeenLeg,
    /// What a search sees of the leg before it; `None` for a first one.
    pub before: Option<SeenLeg>,
    /// Its stress.
    ///
    /// In the unit of what is learned (that of its `Stress`), as the run that was executed had it.
    pub stress: f64,
}
