//! Tracks as C has them, and how they are judged.

use std::ffi::c_void;

/// One moment of a track, in one right-handed frame with z up.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Sample {
    /// Time, s; rises from sample to sample, by half a nanosecond at least.
    pub t_s: f64,
    /// Place, m.
    pub position_m: [f64; 3],
    /// world_from_body as w, x, y, z, of length 1; read with HAIRPIN_TOLD_ATTITUDE.
    pub attitude_wxyz: [f64; 4],
    /// Velocity in the world, m/s; read with HAIRPIN_TOLD_VELOCITY.
    pub velocity_m_s: [f64; 3],
    /// The leg that is flown, from 0, by its first waypoint; read with HAIRPIN_TOLD_LEG.
    pub leg: i32,
}

/// Samples have attitudes.
pub const HAIRPIN_TOLD_ATTITUDE: u32 = 1;
/// Samples have velocities.
pub const HAIRPIN_TOLD_VELOCITY: u32 = 2;
/// Samples have legs.
pub const HAIRPIN_TOLD_LEG: u32 = 4;

/// Deviation from the segment of the leg that is flown.
pub const HAIRPIN_FROM_LEG: i32 = 0;
/// Deviation from the nearer of that segment and the one before.
pub const HAIRPIN_FROM_NEAREST_LEG: i32 = 1;
/// Deviation from the polyline `path_m`.
pub const HAIRPIN_FROM_PATH: i32 = 2;

/// The track ends where the mission did.
pub const HAIRPIN_ENDED_DONE: i32 = 0;
/// The track ends because its time was over.
pub const HAIRPIN_ENDED_TIME: i32 = 1;
/// The track ends in a crash.
pub const HAIRPIN_ENDED_CRASH: i32 = 2;

/// Signed distance of a place (x, y, z, m) to the nearest obstacle, m, the robot's radius subtracted: infinite where
/// there is none, never NaN. It must not throw and may be asked by several threads at once.
pub type Clearance = Option<unsafe extern "C" fn(context: *mut c_void, position_m: *const f64) -> f64>;

/// How a track is judged. hairpin_judge_defaults fills it in: nothing has a limit.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct JudgeSettings {
    /// What samples have beside time and place: a sum of HAIRPIN_TOLD_...
    pub told: u32,
    /// One of HAIRPIN_FROM_...
    pub reference: i32,
    /// Points of a programmed path, x, y, z each, m; read with HAIRPIN_FROM_PATH.
    pub path_m: *const f64,
    /// How many.
    pub path_points: usize,
    /// Samples as near to a waypoint of their leg, m, do not count in the deviation.
    pub corner_m: f64,
    /// One of HAIRPIN_ENDED_...
    pub ended: i32,
    /// When each waypoint was reached, s, NaN: never; NULL: all were.
    pub reached_s: *const f64,
    /// Distance to obstacles, or NULL.
    pub clearance: Clearance,
    /// What `clearance` is called with.
    pub clearance_context: *mut c_void,
    /// Largest deviation, m; NaN here and below: no limit.
    pub max_deviation_m: f64,
    /// Largest overshoot at a waypoint, m.
    pub max_overshoot_m: f64,
    /// Largest acceleration, m/s^2.
    pub max_acceleration_m_s2: f64,
    /// Least distance to obstacles, m; stands with `clearance`.
    pub min_clearance_m: f64,
    /// Longest duration, s.
    pub max_total_time_s: f64,
    /// When each waypoint was to be reached, s, as a program of an arm has it; NaN: at no time; NULL: none has one.
    /// Read with `reached_s`, of which it is taken off.
    pub planned_s: *const f64,
    /// Latest arrival at a waypoint after its planned time, s.
    pub max_late_s: f64,
}

/// Samples of times and places, deviation from legs, no limits.
#[unsafe(no_mangle)]
pub extern "C" fn hairpin_judge_defaults() -> JudgeSettings {
    JudgeSettings {
        told: 0,
        reference: HAIRPIN_FROM_LEG,
        path_m: std::ptr::null(),
        path_points: 0,
        corner_m: 0.0,
        ended: HAIRPIN_ENDED_DONE,
        reached_s: std::ptr::null(),
        clearance: None,
        clearance_context: std::ptr::null_mut(),
        max_deviation_m: f64::NAN,
        max_overshoot_m: f64::NAN,
        max_acceleration_m_s2: f64::NAN,
        min_clearance_m: f64::NAN,
        max_total_time_s: f64::NAN,
        planned_s: std::ptr::null(),
        max_late_s: f64::NAN,
    }
}
