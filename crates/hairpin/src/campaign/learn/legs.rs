//! What a search sees of a leg, and legs that were executed.

use super::Feature;
use crate::feasibility::reach::LegFeatures;

/// Number of features of a leg.
const FEATURES: usize = 8;

/// Names and units, in the order of [`inputs`]: speeds at both ends, turn from the leg before, length, sines of elevation of the leg and of the one
/// before, planned duration, and what the reach set knows of the ground.
pub(super) fn named() -> Vec<Feature> {
    let named: [(&str, &str); FEATURES] = [
        ("v_in", "m/s"),
        ("v_out", "m/s"),
        ("turn", "rad"),
        ("length", "m"),
        ("slope", ""),
        ("slope_in", ""),
        ("duration", "s"),
        ("ground", ""),
    ];
    named.into_iter().map(|(name, unit)| Feature { name: name.into(), unit: unit.into() }).collect()
}

pub(super) fn inputs(leg: &LegFeatures, duration: f64) -> [f64; FEATURES] {
    let slope = if leg.length > 0.0 { leg.climb / leg.length } else { 0.0 };
    [leg.v_in, leg.v_out, leg.turn, leg.length, slope, leg.slope_in, duration, leg.ground]
}

/// A leg that was executed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegSample {
    /// Number of its trajectory: legs of one trajectory are never on both sides of a fold.
    pub trajectory: usize,
    /// What a search sees of it.
    pub features: LegFeatures,
    /// Its planned duration, s.
    pub duration: f64,
    /// Its stress.
    pub stress: f64,
}
