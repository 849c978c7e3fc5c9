//! From the stream of poses to a flight: every promise of the protocol is checked, none is repaired silently. What is
//! broken here would be a violation that nobody flew; how it was flown is the judge's business.

use hairpin::campaign::{Mission, OnGround};
// Beyond it a simulation has diverged.
use hairpin::campaign::bounds::{FARTHEST_ON_EARTH_M, SHORTEST_STEP_S};
use hairpin::math::segment::point_distance;
use hairpin::trajectory::{Channel, Ended, Flight, Track, TrackError};
use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion};
use thiserror::Error;

use super::acceptance;
use super::first_pose::{Elsewhere, elsewhere};
use super::heard::{EndReason, PoseMessage};

use crate::velocities::{Disagreement, disagreement};
use hairpin::math::rotation::euler_from_quaternion;
use hairpin::trajectory::{ATTITUDE_UNKNOWN, END_UNSAID, HEIGHTS_BY_MAP};

/// How far from 1 the length of a quaternion may be: what six printed digits leave.
const QUATERNION_TOLERANCE: f64 = 1e-3;
/// What is flown after the time limit before hairpin calls it off, s: whoever flies on after his last waypoint is
/// within it. What is reached in it is not reached.
const OVERTIME_S: f64 = 10.0;
/// Seconds by which a stamp that is due at the time limit may be rounded beyond it: less than a millionth of any.
const ROUNDING_S: f64 = 1e-6;
/// Beyond it a simulation has diverged, m/s.
const FASTEST_M_S: f64 = 1e6;
/// Bound of the memory that one mission may take: 10⁶ poses are 100 MB.
const MOST_POSES: usize = 1_000_000;

/// The promise that a pose, or the whole stream, breaks. Poses are counted from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[expect(missing_docs, reason = "each variant's sentence names its fields")]
pub enum PoseError {
    /// The first stamp is not 0.
    #[error("its first pose has t_s = {time}: must be 0")]
    Start { time: f64 },
    /// The first place is not the start.
    #[error(transparent)]
    Place(#[from] Elsewhere),
    /// Stamps do not rise.
    #[error("pose {index}: t_s = {time} does not follow {before}: must rise strictly")]
    Time { index: usize, time: f64, before: f64 },
    /// A stamp too soon after the one before.
    #[error("pose {index}: t_s = {time:e} is {:e} s after {before:e}: must be at least {SHORTEST_STEP_S:e} s", time - before)]
    Soon { index: usize, time: f64, before: f64 },
    /// A quaternion that is no rotation.
    #[error("pose {index} (t_s = {time}): q_wxyz has length {length:.6}: must be 1 within {QUATERNION_TOLERANCE}")]
    Quaternion { index: usize, time: f64, length: f64 },
    /// A position at which no robot is.
    #[error("pose {index} (t_s = {time}): p_m[{axis}] = {value:e}: must be within ±{FARTHEST_ON_EARTH_M:e} m")]
    Far { index: usize, time: f64, axis: usize, value: f64 },
    /// A velocity that no robot has.
    #[error("pose {index} (t_s = {time}): v_m_s[{axis}] = {value:e}: must be within ±{FASTEST_M_S:e} m/s")]
    Fast { index: usize, time: f64, axis: usize, value: f64 },
    /// Velocities that are not those of the places.
    #[error(transparent)]
    Velocity(#[from] Disagreement),
    /// A leg that the mission has not.
    #[error("pose {index} (t_s = {time}): leg = {leg}: must be 0 … {last}")]
    Leg { index: usize, time: f64, leg: u64, last: u64 },
    /// Legs that are counted from 1: the first is never told, and one more than the last is.
    #[error(
        "pose {index} (t_s = {time}): leg = {leg}: must be 0 … {last}, and {leg} once all waypoints are reached: it seems to number legs from 1"
    )]
    FromOne { index: usize, time: f64, leg: u64, last: u64 },
    /// A leg that was over.
    #[error("pose {index} (t_s = {time}): leg = {leg} after {before}: must never fall")]
    Falls { index: usize, time: f64, leg: u64, before: u64 },
    /// Poses with and without a leg.
    #[error("pose {index} (t_s = {time}) comes {} \"leg\", those before it {}: must be in all poses or in none", with(.has), without(.has))]
    Mixed { index: usize, time: f64, has: bool },
    /// It goes on long after the time limit.
    #[error("pose {index}: t_s = {time} and no \"end\", time_limit_s is {limit}")]
    Overtime { index: usize, time: f64, limit: f64 },
    /// More poses than anybody needs.
    #[error("more than {MOST_POSES} poses in one mission: send 100 a second")]
    Many,
    /// Heights that nobody knows.
    #[error(
        "pose {index} (t_s = {time}): p_m[2] is 0 in all poses, and on the map's ground the vehicle cannot stand at ({x:.2}, {y:.2}) m: \
             must be told its height"
    )]
    NoFooting { index: usize, time: f64, x: f64, y: f64 },
    /// An end without a beginning.
    #[error("\"end\" before the first pose")]
    Empty,
    /// What the track itself refuses: NaN, infinities.
    #[error(transparent)]
    Track(#[from] TrackError),
}

/// A flight being recorded. Attitudes and velocities that miss in one pose are `None` from then on.
#[derive(Debug)]
pub struct Recording<'a> {
    mission: &'a Mission,
    /// How far above or below a waypoint counts as reached, m; as far as on all sides where that is not told.
    height: Option<f64>,
    times: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
    velocities: Option<Vec<[f64; 3]>>,
    legs: Option<Vec<u64>>,
    /// The first pose that says that all waypoints are reached.
    all_reached: Option<usize>,
    attitude_known: bool,
    /// Whether it has told no height yet: a planar simulation of what drives on a map sends 0 for all of them.
    flat: bool,
    /// Whether the reason for its end is assumed.
    pub(super) end_unsaid: bool,
}

impl<'a> Recording<'a> {
    /// Nothing recorded yet of what a program says in `protocol`.
    pub fn new(mission: &'a Mission, protocol: u64) -> Self {
        Self {
            mission,
            height: (protocol > 1).then(|| acceptance::height(mission)),
            times: Vec::new(),
            poses: Vec::new(),
            velocities: Some(Vec::new()),
            legs: Some(Vec::new()),
            all_reached: None,
            attitude_known: true,
            flat: mission.setup.footing().is_some(),
            end_unsaid: false,
        }
    }

    /// Adds the next pose.
    ///
    /// # Errors
    /// The promise it breaks.
    pub fn push(&mut self, pose: &PoseMessage) -> Result<(), PoseError> {
        let (index, time) = (self.times.len(), pose.t_s);
        if index >= MOST_POSES {
            return Err(PoseError::Many);
        }
        if !time.is_finite() {
            return Err(TrackError::NotFinite { column: "t_s".into(), index, value: time }.into());
        }
        match self.times.last() {
            None if time.abs() > 1e-9 => return Err(PoseError::Start { time }),
            Some(&before) if time <= before => return Err(PoseError::Time { index, time, before }),
            Some(&before) if time - before < SHORTEST_STEP_S => {
                return Err(PoseError::Soon { index, time, before });
            }
            _ => {}
        }
        if time > self.mission.time_limit + OVERTIME_S {
            return Err(PoseError::Overtime { index, time, limit: self.mission.time_limit });
        }
        if let Some(axis) = (0..3).find(|&axis| pose.p_m[axis].is_nan() || pose.p_m[axis].abs() > FARTHEST_ON_EARTH_M) {
            return Err(PoseError::Far { index, time, axis, value: pose.p_m[axis] });
        }
        let velocity = pose.v_m_s.unwrap_or_default();
        if let Some(axis) = (0..3).find(|&axis| velocity[axis].is_nan() || velocity[axis].abs() > FASTEST_M_S) {
            return Err(PoseError::Fast { index, time, axis, value: velocity[axis] });
        }
        if self.flat && pose.p_m[2] != 0.0 {
            self.flat = false;
            // The heights before were told as well.
            self.poses.first().map_or(Ok(()), |first| self.begins_at(first.translation.vector.into()))?;
        }
        if let (0, Some(start)) = (index, self.mission.waypoints.first()) {
            let [x, y, z] = pose.p_m;
            self.begins_at([x, y, if self.flat { start.z } else { z }])?;
        }
        let rotation = attitude(index, pose)?;
        self.take_leg(index, time, pose.leg)?;
        self.attitude_known &= rotation.is_some();
        keep(&mut self.velocities, pose.v_m_s);
        self.times.push(if index == 0 { 0.0 } else { time });
        let place = Translation3::from(Point3::from(pose.p_m));
        self.poses.push(Isometry3::from_parts(place, rotation.unwrap_or_default()));
        Ok(())
    }

    /// That the first pose is at the start.
    fn begins_at(&self, place: [f64; 3]) -> Result<(), PoseError> {
        let Some(start) = self.mission.waypoints.first() else { return Ok(()) };
        let is_at = self.is_at(&Point3::from(place), start);
        Ok(elsewhere(place, start, (self.mission.accept, is_at)).map_or(Ok(()), Err)?)
    }

    /// Puts what told no height on the map's ground, where that is not at 0 itself; whether it did.
    fn take_heights(&mut self) -> Result<bool, PoseError> {
        let Some(footing) = self.mission.setup.footing().filter(|_| self.flat) else { return Ok(false) };
        let places: Vec<[f64; 2]> = self.poses.iter().map(|pose| pose.translation.vector.xy().into()).collect();
        let yaw = |pose: &Isometry3<f64>| {
            let q = pose.rotation;
            self.attitude_known.then(|| euler_from_quaternion(&[q.w, q.i, q.j, q.k])[2])
        };
        let told: Vec<Option<f64>> = self.poses.iter().map(yaw).collect();
        let OnGround { heights, lost } = OnGround::of(footing, &places, &told);
        if let Some(&index) = lost.first() {
            let [x, y] = places[index];
            return Err(PoseError::NoFooting { index, time: self.times[index], x, y });
        }
        if heights.iter().all(|height| *height == 0.0) {
            return Ok(false);
        }
        for (pose, height) in self.poses.iter_mut().zip(heights) {
            pose.translation.vector.z = height;
        }
        // What was sent knows of no way up or down.
        self.velocities = None;
        Ok(true)
    }

    /// One more than the last leg means "all reached", and counts as the last.
    fn take_leg(&mut self, index: usize, time: f64, leg: Option<u64>) -> Result<(), PoseError> {
        let last = self.last_leg();
        let has = leg.is_some();
        if index == 0 && !has {
            self.legs = None;
        }
        match (&mut self.legs, leg) {
            (_, Some(leg)) if leg > last + 1 => return Err(PoseError::Leg { index, time, leg, last }),
            (Some(legs), Some(leg)) => match legs.last() {
                Some(&before) if leg < before => return Err(PoseError::Falls { index, time, leg, before }),
                _ => {
                    if leg > last {
                        self.all_reached = self.all_reached.or(Some(index));
                    }
                    legs.push(leg.min(last));
                }
            },
            (None, None) => {}
            _ => return Err(PoseError::Mixed { index, time, has }),
        }
        Ok(())
    }

    /// Whether a waypoint counts as reached at a place.
    fn is_at(&self, place: &Point3<f64>, waypoint: &Point3<f64>) -> bool {
        let (away, accept) = (place - waypoint, self.mission.accept);
        match self.height {
            None => away.norm() <= accept,
            Some(height) => away.xy().norm() <= accept && away.z.abs() <= height,
        }
    }

    /// Whether it came, on the legs before and after a waypoint, within acceptance or the limit of deviation of it,
    /// straight from pose to pose: an executor may have a radius of its own, but its word alone is no place.
    fn was_near(&self, legs: &[u64], number: u64, waypoint: &Point3<f64>) -> bool {
        let within = self.mission.accept.max(self.mission.setup.scenario.deviation_limit().unwrap_or(0.0));
        let place = |i: usize| Point3::from(self.poses[i].translation.vector);
        (0..self.poses.len()).any(|i| {
            let before = i.saturating_sub(1);
            let is_about = legs[i] + 1 >= number && legs[before] <= number;
            let is_near = || point_distance(waypoint, &place(before), &place(i)) <= within;
            is_about && (self.is_at(&place(i), waypoint) || is_near())
        })
    }

    fn last_leg(&self) -> u64 {
        self.mission.waypoints.len().saturating_sub(2) as u64
    }

    /// Ends the flight for the reason that the executor gives, but that who comes to the last waypoint after the time
    /// limit is not `done`: it ends as `time`, as our own simulator would have ended it. Whether `done` is so otherwise
    /// is told by `reached`.
    ///
    /// # Errors
    /// No pose; velocities that are not those of the places; heights that are not told where the robot cannot stand;
    /// legs counted from 1.
    pub fn finish(mut self, reason: EndReason) -> Result<Flight, PoseError> {
        if self.times.is_empty() {
            return Err(PoseError::Empty);
        }
        let never_first = self.legs.as_ref().and_then(|legs| legs.first()).is_some_and(|leg| *leg > 0);
        if let (Some(index), true) = (self.all_reached, never_first) {
            let last = self.last_leg();
            return Err(PoseError::FromOne { index, time: self.times[index], leg: last + 1, last });
        }
        if let Some(velocities) = &self.velocities {
            disagreement(&self.times, &self.poses, velocities).map_or(Ok(()), Err)?;
        }
        let by_map = self.take_heights()?;
        let mut reached = self.reached();
        let late = |time: &mut Option<f64>| time.take_if(|at| *at > self.mission.time_limit + ROUNDING_S).is_some();
        // In order, so that none is late whose last one is not.
        let too_late = reached.iter_mut().map(late).fold(false, |_, last| last);
        let ended = match reason {
            EndReason::Done if too_late => Ended::Time,
            EndReason::Done => Ended::Done,
            EndReason::Time => Ended::Time,
            EndReason::Crash => Ended::Crash,
        };
        let outside = |pose: &Isometry3<f64>| self.mission.setup.is_outside(&Point3::from(pose.translation.vector));
        let left_world = self.poses.iter().position(outside).map(|index| self.times[index]);
        let mut channels = Vec::new();
        if let Some(legs) = self.legs.take() {
            channels.push(channel("leg", legs.iter().map(|&leg| leg as f64)));
        }
        if let Some(velocities) = self.velocities.take() {
            for (axis, name) in ["vx_m_s", "vy_m_s", "vz_m_s"].into_iter().enumerate() {
                channels.push(channel(name, velocities.iter().map(|v| v[axis])));
            }
        }
        if !self.attitude_known {
            channels.push(channel(ATTITUDE_UNKNOWN, self.times.iter().map(|_| 1.0)));
        }
        if self.end_unsaid {
            channels.push(channel(END_UNSAID, self.times.iter().map(|_| 1.0)));
        }
        if by_map {
            channels.push(channel(HEIGHTS_BY_MAP, self.times.iter().map(|_| 1.0)));
        }
        Ok(Flight { track: Track::new(self.times, self.poses, channels)?, ended, left_world, reached })
    }

    /// When each waypoint was reached: where the executor tells the leg, when that leg was over, if it was near it at
    /// all; otherwise, and for the last waypoint, when the robot was first within acceptance, one waypoint after the
    /// other. One that was missed does not hide those after it; but the last counts only on the last leg or, without
    /// legs, after another one: paths cross, and a robot that never left a start near the end has flown nothing.
    fn reached(&self) -> Vec<Option<f64>> {
        let last = self.mission.waypoints.len().saturating_sub(1);
        let mut from = 0;
        let mut reached: Vec<Option<f64>> = Vec::with_capacity(last + 1);
        for (number, waypoint) in self.mission.waypoints.iter().enumerate() {
            let inside = |i: &usize| self.is_at(&Point3::from(self.poses[*i].translation.vector), waypoint);
            let mut later = from..self.poses.len();
            let found = match &self.legs {
                _ if number == 0 => Some(0),
                Some(legs) if number < last && !self.was_near(legs, number as u64, waypoint) => None,
                Some(legs) if number < last => later.find(|&i| legs[i] >= number as u64),
                Some(legs) => later.find(|i| legs[*i] == self.last_leg() && inside(i)),
                None if number == last && last > 1 && reached[1..].iter().all(Option::is_none) => None,
                None => later.find(inside),
            };
            from = found.unwrap_or(from);
            reached.push(found.map(|i| self.times[i]));
        }
        reached
    }
}

/// The attitude of a pose, where it has one.
fn attitude(index: usize, pose: &PoseMessage) -> Result<Option<UnitQuaternion<f64>>, PoseError> {
    let Some([w, x, y, z]) = pose.q_wxyz else { return Ok(None) };
    let quaternion = Quaternion::new(w, x, y, z);
    let length = quaternion.norm();
    if length.is_nan() || (length - 1.0).abs() > QUATERNION_TOLERANCE {
        return Err(PoseError::Quaternion { index, time: pose.t_s, length });
    }
    Ok(Some(UnitQuaternion::from_quaternion(quaternion)))
}

fn with(has: &bool) -> &'static str {
    if *has { "with" } else { "without" }
}

fn without(has: &bool) -> &'static str {
    with(&!has)
}

fn keep<T>(column: &mut Option<Vec<T>>, value: Option<T>) {
    match (column.as_mut(), value) {
        (Some(values), Some(value)) => values.push(value),
        _ => *column = None,
    }
}

fn channel(name: &str, values: impl Iterator<Item = f64>) -> Channel {
    Channel { name: name.into(), values: values.collect() }
}
