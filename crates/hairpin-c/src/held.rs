//! How a track is held to what was asked.

use std::ffi::c_void;

use hairpin::campaign::bounds::SHORTEST_STEP_S;
use hairpin::judgement::{
    Late, Limits, Measures, Reference, Settings, Violation, deviation_of_samples, measure, violations,
};
use hairpin::trajectory::{ATTITUDE_UNKNOWN, Channel, Ended, Flight, Track};
use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion};

use crate::measures::{HAIRPIN_UNMEASURED_LATE, HAIRPIN_UNMEASURED_WAYPOINTS};
use crate::refusal::{HAIRPIN_INVALID, Refused};
use crate::track::{
    HAIRPIN_ENDED_CRASH, HAIRPIN_ENDED_DONE, HAIRPIN_ENDED_TIME, HAIRPIN_FROM_LEG, HAIRPIN_FROM_NEAREST_LEG,
    HAIRPIN_FROM_PATH, HAIRPIN_TOLD_ATTITUDE, HAIRPIN_TOLD_LEG, HAIRPIN_TOLD_VELOCITY, JudgeSettings, Sample,
};

/// What a track is judged by.
pub(crate) struct Asked<'a> {
    pub(crate) settings: JudgeSettings,
    pub(crate) waypoints: Vec<Point3<f64>>,
    pub(crate) path: Vec<Point3<f64>>,
    /// Times of all waypoints: when they were reached, and when they were to be.
    pub(crate) reached: Option<&'a [f64]>,
    pub(crate) planned: Option<&'a [f64]>,
}

/// What came of it.
pub(crate) struct Judged {
    pub(crate) measures: Measures,
    pub(crate) limits: Limits,
    pub(crate) off: Vec<Option<f64>>,
    pub(crate) violations: Vec<Violation>,
    /// What is open by waypoints that were not reached, a sum of HAIRPIN_UNMEASURED_...
    pub(crate) missed: u32,
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
    pub(crate) fn judge(&self, samples: &[Sample], off_wanted: bool) -> Result<Judged, Refused> {
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
        let mut measures = measure(&track, &self.waypoints, &settings).map_err(Refused::invalid)?;
        let off = match off_wanted {
            true => deviation_of_samples(&track, &self.waypoints, &settings).map_err(Refused::invalid)?,
            false => Vec::new(),
        };
        // Asked everywhere, it knows of no obstacle.
        measures.min_clearance = measures.min_clearance.or(obstacles.as_ref().map(|_| f64::INFINITY));
        self.find_late(&mut measures);
        let reached = match self.reached {
            Some(times) => times.iter().map(|time| (!time.is_nan()).then_some(*time)).collect(),
            None => vec![Some(0.0); self.waypoints.len()],
        };
        let flight = Flight { track, ended, left_world: None, reached };
        let violations = violations(&measures, &flight, &limits);
        let missed = self.missed(ended, &limits);
        Ok(Judged { measures, limits, off, violations, missed })
    }

    /// Which limits a waypoint leaves open that was not reached: its lateness has no value, and what came to its end
    /// without it is not what was asked for.
    fn missed(&self, ended: Ended, limits: &Limits) -> u32 {
        let Some(reached) = self.reached else { return 0 };
        let late = self.planned.zip(limits.late).is_some_and(|(planned, _)| {
            planned.iter().zip(reached).skip(1).any(|(planned, at)| !planned.is_nan() && at.is_nan())
        });
        let passed_by = ended == Ended::Done && limits.are_given() && reached.iter().skip(1).any(|at| at.is_nan());
        u32::from(late) * HAIRPIN_UNMEASURED_LATE + u32::from(passed_by) * HAIRPIN_UNMEASURED_WAYPOINTS
    }

    /// How late each waypoint was reached that was to be at a time, and the latest of them.
    fn find_late(&self, measures: &mut Measures) {
        let (Some(reached), Some(planned)) = (self.reached, self.planned) else { return };
        let arrivals = reached.iter().zip(planned).skip(1).zip(&mut measures.legs).enumerate();
        for (leg, ((at, planned), of_leg)) in arrivals {
            let by = at - planned;
            if by.is_nan() {
                continue;
            }
            of_leg.lateness = Some(by);
            if measures.latest.is_none_or(|latest| by > latest.by) {
                measures.latest = Some(Late { by, at: *at, leg });
            }
        }
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
        let late = limit("max_late_s", of.max_late_s)?;
        moments("reached_s", self.reached)?;
        moments("planned_s", self.planned)?;
        if (late.is_some() || self.planned.is_some()) && (self.planned.is_none() || self.reached.is_none()) {
            let sentence = format_args!("`max_late_s`, `planned_s`: must stand with `planned_s` and `reached_s`");
            return Err(Refused::new(HAIRPIN_INVALID, sentence));
        }
        let clearance = limit("min_clearance_m", of.min_clearance_m)?;
        if let (Some(least), None) = (clearance, of.clearance) {
            let sentence = format_args!("`min_clearance_m` = {least}: must stand with `clearance`, or be NaN");
            return Err(Refused::new(HAIRPIN_INVALID, sentence));
        }
        Ok(Limits {
            deviation: limit("max_deviation_m", of.max_deviation_m)?,
            overshoot: limit("max_overshoot_m", of.max_overshoot_m)?,
            acceleration: limit("max_acceleration_m_s2", of.max_acceleration_m_s2)?,
            clearance,
            total_time: limit("max_total_time_s", of.max_total_time_s)?,
            late,
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
        let track = Track::new(times, poses, channels).map_err(Refused::invalid)?;
        // Stamps that do not rise are told by the track.
        apart(samples).map(|()| track)
    }
}

/// Refuses times of waypoints that are neither times nor NaN.
fn moments(field: &str, times: Option<&[f64]>) -> Result<(), Refused> {
    let mut infinite = times.unwrap_or_default().iter().enumerate().filter(|(_, time)| time.is_infinite());
    match infinite.next() {
        Some((index, time)) => {
            let sentence = format_args!("`{field}[{index}]` = {time}: must be finite, or NaN for none");
            Err(Refused::new(HAIRPIN_INVALID, sentence))
        }
        None => Ok(()),
    }
}

/// Refuses samples that follow on each other sooner than can be measured.
fn apart(samples: &[Sample]) -> Result<(), Refused> {
    let step = |index: usize| samples[index].t_s - samples[index - 1].t_s;
    match (1..samples.len()).find(|index| step(*index) < SHORTEST_STEP_S) {
        Some(index) => {
            let (step, least) = (step(index), SHORTEST_STEP_S);
            let sentence =
                format_args!("`samples[{index}].t_s` is {step:e} s after the one before: must be at least {least:e}");
            Err(Refused::new(HAIRPIN_INVALID, sentence))
        }
        None => Ok(()),
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
