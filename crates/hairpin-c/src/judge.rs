//! A track against the waypoints that were planned, and against limits.

use std::ffi::c_void;

use hairpin::judgement::{Limits, Reference, Settings, deviation_of_samples, measure, violations};
use hairpin::trajectory::{ATTITUDE_UNKNOWN, Channel, Ended, Flight, Track};
use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion};

use crate::measures::{TrackLeg, TrackMeasures, TrackViolation};
use crate::memory::{Room, given, many, put, result};
use crate::refusal::{Code, Error, HAIRPIN_INVALID, Refused, enter};

/// One moment of a track, in one right-handed frame with z up.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Sample {
    /// Time, s; rises from sample to sample.
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

/// Signed distance of a place (x, y, z, m) to the nearest obstacle, m, the robot's radius subtracted. It must not throw
/// and may be asked by several threads at once.
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
    /// Least distance to obstacles, m.
    pub min_clearance_m: f64,
    /// Longest duration, s.
    pub max_total_time_s: f64,
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
    }
}

/// Measures a track against its waypoints and holds it to limits; a value equal to its limit keeps it. Nothing is
/// aligned: both are in one frame. Maxima are over samples. Takes memory.
///
/// @param waypoints_m the waypoints, x, y, z each, m
/// @param waypoints how many, at least 2
/// @param samples the track
/// @param count how many samples
/// @param settings how it is judged; NULL: hairpin_judge_defaults
/// @param measures what is measured
/// @param legs NULL, or room for waypoints - 1 legs
/// @param deviations_m NULL, or room for a deviation of each sample, NaN where it does not count
/// @param found where violations are written, the gravest first; NULL: nowhere
/// @param found_room how many there is room for
/// @param violated how many there are; HAIRPIN_TOO_SMALL where there is room, but too little
/// @param error NULL, or where the call says why it did nothing
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_judge(
    waypoints_m: *const f64,
    waypoints: usize,
    samples: *const Sample,
    count: usize,
    settings: *const JudgeSettings,
    measures: *mut TrackMeasures,
    legs: *mut TrackLeg,
    deviations_m: *mut f64,
    found: *mut TrackViolation,
    found_room: usize,
    violated: *mut usize,
    error: *mut Error,
) -> Code {
    // SAFETY: all are NULL or what their types say, with as many values or room for them, as the header has it.
    unsafe {
        enter(error, || {
            let usual = hairpin_judge_defaults();
            let settings = if settings.is_null() { usual } else { *given(settings, "settings")? };
            let path = match settings.reference {
                HAIRPIN_FROM_PATH => places(settings.path_m, settings.path_points, "path_m")?,
                _ => Vec::new(),
            };
            let reached = match settings.reached_s.is_null() {
                true => None,
                false => Some(many(settings.reached_s, waypoints, "reached_s")?),
            };
            let (waypoints, samples) =
                (places(waypoints_m, waypoints, "waypoints_m")?, many(samples, count, "samples")?);
            let measures = result(measures, "measures")?;
            let one_each = |place: bool, many: usize| if place { many } else { 0 };
            let last = waypoints.len().saturating_sub(1);
            let mut legs = Room::new(legs, one_each(!legs.is_null(), last), "legs")?;
            let mut off = Room::new(deviations_m, one_each(!deviations_m.is_null(), count), "deviations_m")?;
            let listed = !found.is_null();
            let mut found = Room::new(found, one_each(listed, found_room), "found")?;
            let violated = result(violated, "violated")?;

            let asked = Asked { settings, waypoints, path, reached };
            let judged = asked.judge(samples, off.is_wanted())?;
            put(measures, TrackMeasures::from(&judged.measures))?;
            if legs.is_wanted() {
                legs.fill(judged.measures.legs.iter().map(TrackLeg::from))?;
            }
            off.fill(judged.off.iter().map(|off| off.unwrap_or(f64::NAN)))?;
            put(violated, judged.violations.len())?;
            if listed {
                found.fill(judged.violations.iter().map(TrackViolation::from))?;
            }
            Ok(())
        })
    }
}

/// `count` places of three numbers each.
///
/// # Safety
/// As many numbers lie there, where it is not NULL.
unsafe fn places(numbers: *const f64, count: usize, name: &str) -> Result<Vec<Point3<f64>>, Refused> {
    let all = count.saturating_mul(3);
    // SAFETY: handed on.
    let numbers = unsafe { many(numbers, all, name)? };
    Ok(numbers.as_chunks().0.iter().map(|[x, y, z]| Point3::new(*x, *y, *z)).collect())
}

/// What a track is judged by.
struct Asked<'a> {
    settings: JudgeSettings,
    waypoints: Vec<Point3<f64>>,
    path: Vec<Point3<f64>>,
    reached: Option<&'a [f64]>,
}

/// What came of it.
struct Judged {
    measures: hairpin::judgement::Measures,
    off: Vec<Option<f64>>,
    violations: Vec<hairpin::judgement::Violation>,
}

/// A caller's distance to obstacles.
struct Obstacles {
    ask: unsafe extern "C" fn(*mut c_void, *const f64) -> f64,
    context: *mut c_void,
}

// SAFETY: `ask` may be called from any thread, and its context with it, as the header has it; nothing else of it is
// looked at through the pointer.
unsafe impl Sync for Obstacles {}

impl Obstacles {
    fn distance(&self, place: &Point3<f64>) -> f64 {
        // SAFETY: it is a function of this type by the caller's word, called with what it came with and three numbers.
        unsafe { (self.ask)(self.context, place.coords.as_ptr()) }
    }
}

impl Asked<'_> {
    fn judge(&self, samples: &[Sample], off_wanted: bool) -> Result<Judged, Refused> {
        let (ended, limits) = (self.ended()?, self.limits()?);
        let track = self.track(samples)?;
        let path = line(&self.path)?;
        let reference = match self.settings.reference {
            HAIRPIN_FROM_LEG => Reference::Leg,
            HAIRPIN_FROM_NEAREST_LEG => Reference::NearestLeg,
            HAIRPIN_FROM_PATH => Reference::Path(&path),
            other => {
                let sentence = format_args!("`reference` = {other}: must be 0, 1 or 2");
                return Err(Refused::new(HAIRPIN_INVALID, sentence));
            }
        };
        let obstacles = self.settings.clearance.map(|ask| Obstacles { ask, context: self.settings.clearance_context });
        let distance = |place: &Point3<f64>| obstacles.as_ref().map_or(f64::INFINITY, |all| all.distance(place));
        let settings = Settings {
            reference,
            corner: self.settings.corner_m,
            clearance: if self.settings.clearance.is_some() { Some(&distance) } else { None },
            ..Settings::default()
        };
        let measures = measure(&track, &self.waypoints, &settings).map_err(Refused::invalid)?;
        let off = match off_wanted {
            true => deviation_of_samples(&track, &self.waypoints, &settings).map_err(Refused::invalid)?,
            false => Vec::new(),
        };
        if measures.min_clearance.is_some_and(f64::is_nan) {
            return Err(Refused::new(HAIRPIN_INVALID, format_args!("`clearance` answers NaN: must be a distance")));
        }
        let reached = match self.reached {
            Some(times) => times.iter().map(|time| (!time.is_nan()).then_some(*time)).collect(),
            None => vec![Some(0.0); self.waypoints.len()],
        };
        let flight = Flight { track, ended, left_world: None, reached };
        let violations = violations(&measures, &flight, &limits);
        Ok(Judged { measures, off, violations })
    }

    fn ended(&self) -> Result<Ended, Refused> {
        match self.settings.ended {
            HAIRPIN_ENDED_DONE => Ok(Ended::Done),
            HAIRPIN_ENDED_TIME => Ok(Ended::Time),
            HAIRPIN_ENDED_CRASH => Ok(Ended::Crash),
            other => Err(Refused::new(HAIRPIN_INVALID, format_args!("`ended` = {other}: must be 0, 1 or 2"))),
        }
    }

    fn limits(&self) -> Result<Limits, Refused> {
        let of = &self.settings;
        let limit = |field: &str, value: f64| match value {
            value if value.is_nan() => Ok(None),
            value if value >= 0.0 && value.is_finite() => Ok(Some(value)),
            value => {
                let sentence = format_args!("`{field}` = {value}: must be finite and >= 0, or NaN for no limit");
                Err(Refused::new(HAIRPIN_INVALID, sentence))
            }
        };
        Ok(Limits {
            deviation: limit("max_deviation_m", of.max_deviation_m)?,
            overshoot: limit("max_overshoot_m", of.max_overshoot_m)?,
            acceleration: limit("max_acceleration_m_s2", of.max_acceleration_m_s2)?,
            clearance: limit("min_clearance_m", of.min_clearance_m)?,
            total_time: limit("max_total_time_s", of.max_total_time_s)?,
            ..Limits::default()
        })
    }

    fn track(&self, samples: &[Sample]) -> Result<Track, Refused> {
        let told = self.settings.told;
        if told > HAIRPIN_TOLD_ATTITUDE | HAIRPIN_TOLD_VELOCITY | HAIRPIN_TOLD_LEG {
            let sentence = format_args!("`told` = {told}: must be a sum of 1, 2 and 4, each once");
            return Err(Refused::new(HAIRPIN_INVALID, sentence));
        }
        let mut channels = Vec::new();
        let mut add = |name: &str, value: &dyn Fn(&Sample) -> f64| {
            channels.push(Channel { name: name.into(), values: samples.iter().map(value).collect() });
        };
        let attitudes = told & HAIRPIN_TOLD_ATTITUDE != 0;
        if !attitudes {
            add(ATTITUDE_UNKNOWN, &|_| 1.0);
        }
        if told & HAIRPIN_TOLD_VELOCITY != 0 {
            for (axis, name) in ["vx_m_s", "vy_m_s", "vz_m_s"].into_iter().enumerate() {
                add(name, &|sample| sample.velocity_m_s[axis]);
            }
        }
        if told & HAIRPIN_TOLD_LEG != 0 {
            add("leg", &|sample| sample.leg.into());
        }
        let pose = |(index, sample): (usize, &Sample)| {
            let [x, y, z] = sample.position_m;
            let rotation = if attitudes { attitude(index, &sample.attitude_wxyz)? } else { UnitQuaternion::identity() };
            Ok(Isometry3::from_parts(Translation3::new(x, y, z), rotation))
        };
        let poses = samples.iter().enumerate().map(pose).collect::<Result<Vec<_>, Refused>>()?;
        let times = samples.iter().map(|sample| sample.t_s).collect();
        Track::new(times, poses, channels).map_err(Refused::invalid)
    }
}

/// What a quaternion may differ from length 1 by.
const UNIT: f64 = 1e-3;

fn attitude(index: usize, wxyz: &[f64; 4]) -> Result<UnitQuaternion<f64>, Refused> {
    let [w, x, y, z] = *wxyz;
    let quaternion = Quaternion::new(w, x, y, z);
    let length = quaternion.norm();
    if length.is_nan() || (length - 1.0).abs() > UNIT {
        let sentence = format_args!("`samples[{index}].attitude_wxyz` has length {length}: must be 1");
        return Err(Refused::new(HAIRPIN_INVALID, sentence));
    }
    Ok(UnitQuaternion::new_normalize(quaternion))
}

/// A path as the judge has it.
fn line(points: &[Point3<f64>]) -> Result<Track, Refused> {
    let times = (0..points.len()).map(|i| i as f64).collect();
    let poses = points.iter().map(|point| Isometry3::translation(point.x, point.y, point.z)).collect();
    Track::new(times, poses, Vec::new()).map_err(Refused::invalid)
}
