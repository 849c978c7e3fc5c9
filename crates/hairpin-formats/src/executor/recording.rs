//! From the stream of poses to a flight: every promise of the protocol is checked, none is repaired silently.

use hairpin::campaign::Mission;
use hairpin::trajectory::{Channel, Ended, Flight, Track, TrackError};
use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion};
use thiserror::Error;

use super::message::{EndReason, PoseMessage};

/// How far from 1 the length of a quaternion may be: what six printed digits leave.
const QUATERNION_TOLERANCE: f64 = 1e-3;
/// Beyond this (m) a simulation has diverged.
const FARTHEST_M: f64 = 1e6;
/// What is flown after the time limit before hairpin calls it off, s.
const OVERTIME_S: f64 = 10.0;
/// Bound of the memory that one mission may take: 10⁶ poses are 100 MB.
const MOST_POSES: usize = 1_000_000;

/// The promise that a pose, or the whole stream, breaks. Poses are counted from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[expect(missing_docs, reason = "each variant's sentence names its fields")]
pub enum PoseError {
    /// The first stamp is not 0.
    #[error("its first pose has t_s = {time}: must be 0")]
    Start { time: f64 },
    /// Stamps do not rise.
    #[error("pose {index}: t_s = {time} does not follow {before}: must rise strictly")]
    Time { index: usize, time: f64, before: f64 },
    /// A quaternion that is no rotation.
    #[error("pose {index} (t_s = {time}): q_wxyz has length {length:.6}: must be 1 within {QUATERNION_TOLERANCE}")]
    Quaternion { index: usize, time: f64, length: f64 },
    /// A position at which no robot is.
    #[error("pose {index} (t_s = {time}): p_m[{axis}] = {value:e}: must be within ±{FARTHEST_M:e} m")]
    Far { index: usize, time: f64, axis: usize, value: f64 },
    /// A leg that the mission has not.
    #[error("pose {index} (t_s = {time}): leg = {leg}: must be 0 … {last}")]
    Leg { index: usize, time: f64, leg: u64, last: u64 },
    /// A leg after a later one.
    #[error("pose {index} (t_s = {time}): leg = {leg} after leg {before}: must not fall")]
    LegFalls { index: usize, time: f64, leg: u64, before: u64 },
    /// An optional field that comes and goes.
    #[error("pose {index} (t_s = {time}): {field} must be in every pose or in none")]
    Sometimes { index: usize, time: f64, field: &'static str },
    /// Not where the mission starts: most often another frame.
    #[error("its first pose is {distance:.2} m from waypoint 0 (accept_m {accept}): is p_m in the world frame, z up?")]
    Elsewhere { distance: f64, accept: f64 },
    /// It goes on long after the time limit.
    #[error("pose {index}: t_s = {time} and no \"end\", time_limit_s is {limit}")]
    Overtime { index: usize, time: f64, limit: f64 },
    /// More poses than anybody needs.
    #[error("more than {MOST_POSES} poses in one mission: send 100 a second")]
    Many,
    /// An end without a beginning.
    #[error("\"end\" before the first pose")]
    Empty,
    /// `done` far from the end.
    #[error("\"done\", but it never came nearer than {distance:.2} m to the last waypoint (accept_m {accept})")]
    NotDone { distance: f64, accept: f64 },
    /// `done` on an early leg.
    #[error("\"done\" on leg {leg}: the last one is {last}")]
    LegsLeft { leg: u64, last: u64 },
    /// What the track itself refuses: NaN, infinities.
    #[error(transparent)]
    Track(#[from] TrackError),
}

/// A flight being recorded.
#[derive(Debug)]
pub struct Recording<'a> {
    mission: &'a Mission,
    times: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
    velocities: Vec<[f64; 3]>,
    legs: Vec<u64>,
}

impl<'a> Recording<'a> {
    /// Nothing recorded yet.
    pub fn new(mission: &'a Mission) -> Self {
        Self { mission, times: Vec::new(), poses: Vec::new(), velocities: Vec::new(), legs: Vec::new() }
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
            _ => {}
        }
        if time > self.mission.time_limit + OVERTIME_S {
            return Err(PoseError::Overtime { index, time, limit: self.mission.time_limit });
        }
        if let Some(axis) = (0..3).find(|&axis| pose.p_m[axis].is_nan() || pose.p_m[axis].abs() > FARTHEST_M) {
            return Err(PoseError::Far { index, time, axis, value: pose.p_m[axis] });
        }
        let [w, x, y, z] = pose.q_wxyz;
        let quaternion = Quaternion::new(w, x, y, z);
        let length = quaternion.norm();
        if length.is_nan() || (length - 1.0).abs() > QUATERNION_TOLERANCE {
            return Err(PoseError::Quaternion { index, time, length });
        }
        let position = Point3::from(pose.p_m);
        if index == 0 {
            self.check_start(&position)?;
        }
        self.push_velocity(index, pose)?;
        self.push_leg(index, pose)?;
        self.times.push(if index == 0 { 0.0 } else { time });
        let rotation = UnitQuaternion::from_quaternion(quaternion);
        self.poses.push(Isometry3::from_parts(Translation3::from(position), rotation));
        Ok(())
    }

    fn check_start(&self, position: &Point3<f64>) -> Result<(), PoseError> {
        let accept = self.mission.accept;
        let distance = self.mission.waypoints.first().map_or(0.0, |start| (position - start).norm());
        if distance > accept { Err(PoseError::Elsewhere { distance, accept }) } else { Ok(()) }
    }

    fn push_velocity(&mut self, index: usize, pose: &PoseMessage) -> Result<(), PoseError> {
        if index > 0 && pose.v_m_s.is_some() == self.velocities.is_empty() {
            return Err(PoseError::Sometimes { index, time: pose.t_s, field: "v_m_s" });
        }
        self.velocities.extend(pose.v_m_s);
        Ok(())
    }

    fn push_leg(&mut self, index: usize, pose: &PoseMessage) -> Result<(), PoseError> {
        let time = pose.t_s;
        if index > 0 && pose.leg.is_some() == self.legs.is_empty() {
            return Err(PoseError::Sometimes { index, time, field: "leg" });
        }
        let Some(leg) = pose.leg else { return Ok(()) };
        let (last, before) = (self.last_leg(), self.legs.last().copied().unwrap_or(0));
        if leg > last {
            return Err(PoseError::Leg { index, time, leg, last });
        }
        if leg < before {
            return Err(PoseError::LegFalls { index, time, leg, before });
        }
        self.legs.push(leg);
        Ok(())
    }

    fn last_leg(&self) -> u64 {
        self.mission.waypoints.len().saturating_sub(2) as u64
    }

    /// Ends the flight.
    ///
    /// # Errors
    /// No pose; `done` where the end was not reached.
    pub fn finish(self, reason: EndReason) -> Result<Flight, PoseError> {
        if self.times.is_empty() {
            return Err(PoseError::Empty);
        }
        if reason == EndReason::Done {
            self.check_done()?;
        }
        let ended = match reason {
            EndReason::Done => Ended::Done,
            EndReason::Time => Ended::Time,
            EndReason::Crash => Ended::Crash,
        };
        let reached = self.reached();
        let outside = |pose: &Isometry3<f64>| {
            self.mission.setup.world.wall_distance(&Point3::from(pose.translation.vector)) < 0.0
        };
        let left_world = self.poses.iter().position(outside).map(|index| self.times[index]);
        let mut channels = Vec::new();
        if !self.legs.is_empty() {
            channels.push(channel("leg", self.legs.iter().map(|&leg| leg as f64)));
        }
        if !self.velocities.is_empty() {
            for (axis, name) in ["vx_m_s", "vy_m_s", "vz_m_s"].into_iter().enumerate() {
                channels.push(channel(name, self.velocities.iter().map(|v| v[axis])));
            }
        }
        Ok(Flight { track: Track::new(self.times, self.poses, channels)?, ended, left_world, reached })
    }

    /// A flight that claims to be done must have been at the end, or "no deviation" would mean "did not fly".
    fn check_done(&self) -> Result<(), PoseError> {
        let last = self.last_leg();
        if let Some(&leg) = self.legs.last()
            && leg < last
        {
            return Err(PoseError::LegsLeft { leg, last });
        }
        let Some(end) = self.mission.waypoints.last() else { return Ok(()) };
        let accept = self.mission.accept;
        let distance = self.poses.iter().map(|pose| (pose.translation.vector - end.coords).norm()).reduce(f64::min);
        match distance {
            Some(distance) if distance > accept => Err(PoseError::NotDone { distance, accept }),
            _ => Ok(()),
        }
    }

    /// When each waypoint was reached: where the executor tells the leg, when that leg was over; otherwise, and for the
    /// last waypoint, when the robot was first inside the acceptance radius, one waypoint after the other.
    fn reached(&self) -> Vec<Option<f64>> {
        let last = self.mission.waypoints.len().saturating_sub(1);
        let mut from = 0;
        let mut reached = Vec::with_capacity(last + 1);
        for (number, waypoint) in self.mission.waypoints.iter().enumerate() {
            let inside = |i: usize| (self.poses[i].translation.vector - waypoint.coords).norm() <= self.mission.accept;
            let found = match number {
                0 => Some(0),
                _ if number < last && !self.legs.is_empty() => {
                    (from..self.legs.len()).find(|&i| self.legs[i] >= number as u64)
                }
                // The last waypoint counts on the last leg only: paths cross.
                _ => (from..self.poses.len())
                    .find(|&i| self.legs.get(i).is_none_or(|&leg| leg == self.last_leg()) && inside(i)),
            };
            from = found.unwrap_or(self.poses.len());
            reached.push(found.map(|i| self.times[i]));
        }
        reached
    }
}

fn channel(name: &str, values: impl Iterator<Item = f64>) -> Channel {
    Channel { name: name.into(), values: values.collect() }
}
