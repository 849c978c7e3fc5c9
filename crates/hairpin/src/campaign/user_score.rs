//! Scores of the user's own: whatever tells legs apart outside of hairpin.

use std::fmt;

use serde::Serialize;

use super::user_code::UserCode;
use crate::feasibility::reach::LegFeatures;
use crate::search::LegView;

/// Name of the score's file in a campaign folder.
pub const NAME: &str = "score.py";

/// A leg as a score of the user's sees it; the names are those that the user's function knows.
///
/// World frame; SI: m, m/s, s, rad.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LegFacts {
    /// Speed at its first waypoint.
    pub v_in_m_s: f64,
    /// Speed at its second waypoint.
    pub v_out_m_s: f64,
    /// Angle between the leg before and this one: 0 straight on, π back.
    pub turn_rad: f64,
    /// Its length.
    pub length_m: f64,
    /// Height gained.
    pub climb_m: f64,
    /// Sine of the elevation of the leg before.
    pub slope_in: f64,
    /// Slope and slip of drives; 0 for flyers.
    pub ground: f64,
    /// Planned duration.
    pub duration_s: f64,
    /// Its first waypoint.
    pub from_m: [f64; 3],
    /// Its second waypoint.
    pub to_m: [f64; 3],
    /// The trajectory's first waypoint.
    pub start_m: [f64; 3],
    /// The trajectory's last waypoint; where that may lie anywhere, the last one of the graph.
    pub end_m: [f64; 3],
}

impl LegFacts {
    /// What is known of a leg of a graph.
    pub(super) fn of(leg: &LegView<'_>) -> Self {
        let place = |index: usize| leg.candidates[index].coords.into();
        let LegFeatures { v_in, v_out, turn, length, climb, slope_in, ground } = leg.features;
        Self {
            v_in_m_s: v_in,
            v_out_m_s: v_out,
            turn_rad: turn,
            length_m: length,
            climb_m: climb,
            slope_in,
            ground,
            duration_s: leg.duration,
            from_m: place(leg.from as usize),
            to_m: place(leg.to as usize),
            start_m: place(0),
            end_m: place(leg.candidates.len() - 1),
        }
    }
}

/// Scores legs. The same leg must get the same numbers whenever, and in whatever company, it is asked for.
pub trait LegScorer: UserCode {
    /// Of every leg what it scores whatever was flown before it, and what it adds to the score of the leg after it; NaN
    /// where there is [trouble](UserCode::trouble).
    ///
    /// One pair a leg, in their order: what is asked for at once is a batch, whose size means nothing.
    fn own_and_left(&self, legs: &[LegFacts]) -> Vec<[f64; 2]>;
}

impl fmt::Debug for dyn LegScorer + '_ {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("LegScorer")
    }
}
