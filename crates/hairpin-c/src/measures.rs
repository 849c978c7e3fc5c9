//! What is measured on a track, and which limits it violates, as C has them. A number that is NaN was not measured.

use std::ffi::c_char;

use hairpin::judgement::{LegMeasures, LegSource, Limits, Measures, Violation};

use crate::drive::HAIRPIN_NAME;

/// What is measured of a whole track. NaN: not measured.
#[repr(C)]
pub struct TrackMeasures {
    /// Largest deviation from what was planned, m.
    pub max_deviation_m: f64,
    /// When, s.
    pub t_worst_s: f64,
    /// On which leg, by its first waypoint.
    pub leg_worst: usize,
    /// Mean deviation over time, m.
    pub mean_deviation_m: f64,
    /// Largest overshoot at a waypoint, m.
    pub max_overshoot_m: f64,
    /// Largest acceleration, m/s^2.
    pub max_acceleration_m_s2: f64,
    /// When, s.
    pub t_acceleration_s: f64,
    /// Least distance to an obstacle, m; infinite where there is none.
    pub min_clearance_m: f64,
    /// When, s.
    pub t_clearance_s: f64,
    /// Largest angle of the body's upward axis from the world's, degrees.
    pub max_tilt_deg: f64,
    /// Duration, s.
    pub total_time_s: f64,
    /// Latest arrival at a waypoint, by its planned time, s; negative: all were early.
    pub latest_s: f64,
    /// When, s.
    pub t_latest_s: f64,
    /// Which leg led there.
    pub leg_latest: usize,
    /// 1 where legs were not told, and samples were assigned to them along the path.
    pub legs_assigned: i32,
    /// Limits that were asked for and could not be measured, a sum of HAIRPIN_UNMEASURED_...; not 0: a track that
    /// violates nothing is open, not within its limits.
    pub unmeasured: u32,
}

/// No sample counts in the deviation: all are within `corner_m` of a waypoint.
pub const HAIRPIN_UNMEASURED_DEVIATION: u32 = 1;
/// There are too few samples for an acceleration.
pub const HAIRPIN_UNMEASURED_ACCELERATION: u32 = 2;
/// A waypoint that was to be reached at a time was not reached.
pub const HAIRPIN_UNMEASURED_LATE: u32 = 4;
/// A waypoint was not reached, by `reached_s`, of a track that came to its end.
pub const HAIRPIN_UNMEASURED_WAYPOINTS: u32 = 8;

/// What is measured of one leg. NaN: not measured.
#[repr(C)]
pub struct TrackLeg {
    /// Largest deviation, m.
    pub max_deviation_m: f64,
    /// Mean deviation over time, m.
    pub mean_deviation_m: f64,
    /// Overshoot at the leg's last waypoint, m.
    pub overshoot_m: f64,
    /// Largest acceleration, m/s^2.
    pub max_acceleration_m_s2: f64,
    /// Least distance to an obstacle, m.
    pub min_clearance_m: f64,
    /// Time spent on it, s.
    pub time_s: f64,
    /// How late its last waypoint was reached, by its planned time, s; negative is early.
    pub lateness_s: f64,
}

/// One limit that is violated.
#[repr(C)]
pub struct TrackViolation {
    /// What: `deviation`, `overshoot`, `acceleration`, `total-time`, `late`, `clearance`; or `crash`, `unfinished`,
    /// `stalled`.
    pub what: [c_char; HAIRPIN_NAME],
    /// What was measured, in the limit's unit; of `crash` when, s; of a track without its end how many waypoints.
    pub value: f64,
    /// The limit; of `crash` 0; of a track without its end the number of waypoints.
    pub limit: f64,
    /// When, s.
    pub t_s: f64,
    /// On which leg, by its first waypoint.
    pub leg: usize,
}

impl TrackMeasures {
    /// What was measured, and what of it `limits` ask for in vain, or is open by waypoints that were `missed`.
    pub(crate) fn of(of: &Measures, limits: &Limits, missed: u32) -> Self {
        let open = limits.unmeasured(of).into_iter().map(|what| match what {
            "deviation" => HAIRPIN_UNMEASURED_DEVIATION,
            "acceleration" => HAIRPIN_UNMEASURED_ACCELERATION,
            "late" => HAIRPIN_UNMEASURED_LATE,
            other => unreachable!("a limit of C's on {other}, which is refused or measured"),
        });
        Self {
            max_deviation_m: of.deviation().unwrap_or(f64::NAN),
            t_worst_s: of.t_worst,
            leg_worst: of.leg_worst,
            mean_deviation_m: of.deviation().map_or(f64::NAN, |_| of.mean_deviation),
            max_overshoot_m: of.max_overshoot(),
            max_acceleration_m_s2: of.acceleration().unwrap_or(f64::NAN),
            t_acceleration_s: of.t_acceleration,
            min_clearance_m: of.min_clearance.unwrap_or(f64::NAN),
            t_clearance_s: of.min_clearance.map_or(f64::NAN, |_| of.t_clearance),
            max_tilt_deg: of.max_tilt.unwrap_or(f64::NAN),
            total_time_s: of.total_time,
            latest_s: of.latest.map_or(f64::NAN, |latest| latest.by),
            t_latest_s: of.latest.map_or(f64::NAN, |latest| latest.at),
            leg_latest: of.latest.map_or(0, |latest| latest.leg),
            legs_assigned: (of.leg_source == LegSource::Assigned).into(),
            unmeasured: open.fold(missed, |all, one| all | one),
        }
    }
}

impl From<&LegMeasures> for TrackLeg {
    fn from(of: &LegMeasures) -> Self {
        Self {
            max_deviation_m: of.max_deviation,
            mean_deviation_m: of.mean_deviation,
            overshoot_m: of.overshoot,
            max_acceleration_m_s2: of.max_acceleration,
            min_clearance_m: of.min_clearance.unwrap_or(f64::NAN),
            time_s: of.time,
            lateness_s: of.lateness.unwrap_or(f64::NAN),
        }
    }
}

impl From<&Violation> for TrackViolation {
    fn from(of: &Violation) -> Self {
        let mut what = [0; HAIRPIN_NAME];
        // One place is left for the NUL.
        let letters = what[..HAIRPIN_NAME - 1].iter_mut().zip(of.what.bytes());
        letters.for_each(|(place, letter)| *place = letter as c_char);
        Self { what, value: of.value, limit: of.limit, t_s: of.at, leg: of.leg }
    }
}
