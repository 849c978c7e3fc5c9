//! The path of states of a drive, with what its wheels do: sampled in time, and held to the bounds of speeds and
//! joints.
//!
//! Data flow: a drive → its motion predicted on the ground, step by step → states at even times → wheel speeds, steer
//! angles, rates and joints of each → the largest of all, held to the vehicle's limits.
//!
//! ```text
//! t(s, turned) = T(s) + |turned|/ω          T the time of the speed profile, s the metres driven
//! rolling speed of wheel i = rolls_i · v / r   rolls_i its share of the body's twist, v m/s (ω turned in place), r m
//! ```
//!
//! Attitudes, joints and clearances are those of the body at rest on the ground at each step (quasi-static). Rates of
//! wheels are differences between steps, so that a peak is a mean over one step and errs low by what it bends within
//! it.

mod peaks;
mod vehicle_state;
mod walk;

use self::vehicle_state::sampled;
use self::walk::Walk;
use crate::feasibility::steering::shooting::rough::{Blocked, Course, Steps, predict};
use crate::robot::rover::{Response, Rover, Slip};
use crate::trajectory::drive::{Gear, Planar, Segment, shortened};
use crate::trajectory::{Direction, SpeedProfile, Timing};
use crate::world::terrain::{Flat, Terrain};

pub use peaks::WheelPeaks;
pub use vehicle_state::{VehicleState, WheelState};

/// How a drive is followed.
#[derive(Debug, Clone, Copy)]
pub struct Followed<'a> {
    /// The vehicle.
    pub rover: &'a Rover,
    /// Speed along the drive.
    ///
    /// m/s, over the metres driven.
    pub speed: SpeedProfile,
    /// Rate of turns in place, rad/s, > 0.
    pub turn_rate: f64,
    /// Direction of travel in the body.
    ///
    /// rad, left positive; from the drive's start to its end.
    pub direction: Direction,
    /// Time between states, s, > 0.
    pub time_step: f64,
    /// Steps at most; what would take more is followed in longer ones.
    ///
    /// At least 16.
    pub most_steps: usize,
}

/// The states of a drive, and what its wheels come to.
#[derive(Debug, Clone, PartialEq)]
pub struct States {
    /// In the order of time; the first and the last at the drive's ends.
    pub states: Vec<VehicleState>,
    /// Wheels of the vehicle, 0 to 6.
    pub wheels: usize,
    /// The largest along it.
    pub peaks: WheelPeaks,
}

/// Longest step on the ground, m and rad: what its cells and wheels can be told by.
///
/// At most 0.02 m, and 0.02 rad in turns.
const FINEST: f64 = 0.02;

impl Followed<'_> {
    /// The states of `segments` from `start` on level ground, as they are commanded: without slip, latency and lag.
    ///
    /// # Errors
    /// Level ground blocks no vehicle; kept for what the wheels of a broken one might do.
    ///
    /// Steered axle and suspension stay; height, roll and pitch are those on level ground at height 0.
    pub fn in_the_plane(&self, start: &Planar, segments: &[Segment]) -> Result<States, Blocked> {
        let ideal = Response { steered_axle: self.rover.response.steered_axle, ..Response::default() };
        let rover = Rover { slip: Slip::default(), response: ideal, ..self.rover.clone() };
        Followed { rover: &rover, ..*self }.on(&Flat, start, segments)
    }

    /// The states of `segments` from `start` on `terrain`: with latency τ the vehicle first goes on for τ as it was,
    /// and the last τ of the commands never act.
    ///
    /// Predicted in steps of at most 2 cm and 0.02 rad, finer where `time_step` asks for it and coarser where they were
    /// more than `most_steps`; then sampled evenly in time, linear between.
    ///
    /// # Errors
    /// Where the ground ends or the body finds no rest.
    ///
    /// The count of states is about duration/`time_step`, at most `most_steps`; cost is that of one prediction,
    /// O(length/2 cm) looks at the ground. Peaks are of the steps of the prediction, not of the samples: they do not
    /// depend on `time_step` but where that makes steps finer.
    pub fn on<T: Terrain>(&self, terrain: &T, start: &Planar, segments: &[Segment]) -> Result<States, Blocked> {
        let latency = self.rover.response.latency;
        let wait = latency * self.speed.start();
        let mut states = Vec::new();
        let (mut from, mut peaks) = (*start, WheelPeaks::default());
        if wait > 0.0 {
            let waiting =
                Followed { speed: self.speed.start().into(), direction: self.direction.start.into(), ..*self };
            let held = Segment::clothoid(wait, start.curvature, start.curvature, Gear::Forward);
            let end;
            (states, peaks, end) = waiting.along(terrain, start, &[held])?;
            from = Planar { curvature: start.curvature, ..end };
        }
        let driven = shortened(segments, latency * self.speed.end());
        let (mut then, others, _) = self.along(terrain, &from, &driven)?;
        for state in &mut then {
            state.time += latency;
            state.s += wait;
        }
        if let Some(first) = then.first().filter(|first| first.time > 0.0 && states.is_empty()) {
            states.push(VehicleState { time: 0.0, ..*first });
        }
        states.extend(then);
        let finest = self.most_steps.max(16) as f64;
        let step = self.time_step.max(states.last().map_or(0.0, |last| last.time) / finest);
        let wheels = self.rover.suspension.wheels(&[0.0; 3]).1;
        // Without time to stop in, speed jumps where the gear changes.
        let jumps = Timing::new(&self.speed, &driven).is_constant();
        Ok(States { states: sampled(&states, step, jumps), wheels, peaks: peaks.or(&others) })
    }

    /// The states of commands that act at once, as finely as they are predicted, and the place where they end.
    ///
    /// Times and metres from the stretch's own beginning.
    ///
    /// At the ends the states of the first and the last step are carried over, with pose, speed and direction put
    /// right: what wheels do there is that of half a step inside. No states for commands without length.
    fn along<T: Terrain>(
        &self,
        terrain: &T,
        start: &Planar,
        segments: &[Segment],
    ) -> Result<(Vec<VehicleState>, WheelPeaks, Planar), Blocked> {
        let timing = Timing::new(&self.speed, segments);
        let turns: f64 = segments.iter().map(|segment| segment.turn_rad().abs()).sum();
        let finest = self.most_steps.max(16) as f64;
        let length = (self.time_step * self.speed.top()).min(FINEST).max(timing.length() / finest);
        let angle = (self.time_step * self.turn_rate).min(FINEST).max(turns / finest);
        let course = Course {
            rover: self.rover,
            terrain,
            speed: self.speed,
            direction: self.direction,
            steps: Steps { length, angle, least: 8 },
        };
        let mut walk = Walk {
            rover: self.rover,
            turn_rate: self.turn_rate,
            direction: self.direction,
            timing: &timing,
            terrain,
            states: Vec::new(),
            before: None,
            peaks: WheelPeaks::default(),
        };
        let prediction = predict(&course, start, segments, |driven| walk.add(driven))?;
        let Walk { mut states, peaks, .. } = walk;
        if let (Some(first), Some(last)) = (states.first().copied(), states.last().copied()) {
            let speed = self.signed(first.speed, timing.speed_at(0.0));
            let begin = VehicleState { time: 0.0, s: 0.0, at: *start, speed, ..first };
            let time = timing.time_at(timing.length()) + turns / self.turn_rate;
            let (s, speed) = (timing.length(), self.signed(last.speed, timing.end_speed()));
            let end = VehicleState { time, s, at: prediction.end, speed, ..last };
            states.insert(0, VehicleState { direction: self.direction.start, ..begin });
            states.push(VehicleState { direction: self.direction.end, ..end });
        }
        Ok((states, peaks, prediction.end))
    }

    /// `speed` ≥ 0 with the sign of `like`; 0 in turns in place.
    ///
    /// `like` is the speed of the step next to the end: its sign is the gear's.
    fn signed(&self, like: f64, speed: f64) -> f64 {
        if like == 0.0 { 0.0 } else { speed.copysign(like) }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::robot::rover::{Effort, RoverDescription, Weight};
    use crate::trajectory::drive::Motion;

    fn rover(latency: f64) -> Rover {
        let path = format!("{}/../../data/robots/rover/four-wheel.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).expect("a shipped rover");
        let rover = toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers");
        Rover { response: Response { latency, ..rover.response }, ..rover }
    }

    fn followed(rover: &Rover, speed: SpeedProfile) -> Followed<'_> {
        let direction = Direction::default();
        Followed { rover, speed, turn_rate: 0.5, direction, time_step: 0.01, most_steps: 10_000 }
    }

    #[test]
    fn times_places_and_wheels_of_a_drive_with_a_turn_are_those_of_closed_forms() {
        let rover = rover(0.0);
        let speed = SpeedProfile::Ramp { start: 0.0, end: 1.0 };
        let turn = Segment { motion: Motion::Turn { angle_rad: 1.0 }, gear: Gear::Forward };
        let drive = [turn, Segment::straight(2.0, Gear::Forward)];
        let start = Planar { x: 1.0, y: 2.0, yaw: 0.5, curvature: 0.0 };
        let States { states, wheels, peaks } =
            followed(&rover, speed).in_the_plane(&start, &drive).expect("level ground");
        // 2 s of turning at 0.5 rad/s, 4 s of 0.25 m/s².
        let last = states.last().expect("states");
        assert!(wheels == 4 && (last.time - 6.0).abs() < 1e-9 && (last.speed - 1.0).abs() < 1e-9, "{last:?}");
        assert!((last.at.x - 1.0 - 2.0 * 1.5f64.cos()).abs() < 1e-9 && (last.at.yaw - 1.5).abs() < 1e-9, "{last:?}");
        let at = |time: f64| {
            states.iter().min_by(|a, b| (a.time - time).abs().total_cmp(&(b.time - time).abs())).expect("one")
        };
        let (turning, driving) = (at(1.0), at(4.0));
        assert!((turning.at.yaw - 1.0).abs() < 0.01 && turning.speed == 0.0, "{turning:?}");
        let outer = 0.3f64.hypot(0.25) * 0.5 / 0.12;
        assert!(turning.wheels[..4].iter().all(|wheel| (wheel.speed.abs() - outer).abs() < 1e-9), "{turning:?}");
        assert!((driving.s - 0.5).abs() < 0.01 && (driving.speed - 0.5).abs() < 0.005, "{driving:?}");
        assert!((driving.wheels[0].speed - driving.speed / 0.12).abs() < 0.01 && driving.tilt < 1e-9, "{driving:?}");
        assert!((driving.clearance - (rover.suspension.ride_height() + rover.body.belly.height)).abs() < 1e-6);
        assert!((peaks.acceleration - 0.25 / 0.12).abs() < 0.01 && peaks.steer > 0.6, "{peaks:?}");
        assert!(driving.effort.is_none() && (driving.tip_over_margin - states[0].tip_over_margin).abs() < 1e-9);
        // 40 kg gain 0.25 m/s² against a tenth of their weight; turned in place the wheels are told nothing of.
        let weight = Some(Weight { mass: 40.0, gravity: 10.0, rolling_resistance: 0.1 });
        let heavy = Rover { weight, ..rover.clone() };
        let told = followed(&heavy, speed).in_the_plane(&start, &drive).expect("level ground");
        let torque = (40.0 * 0.25 + 0.1 * 400.0) * 0.12 / 4.0;
        assert!((told.peaks.torque - torque).abs() < 1e-9, "{:?}", told.peaks);
        let efforts: Vec<Effort> = told.states.iter().map(|state| state.effort.expect("a weight")).collect();
        assert!(efforts[0] == Effort::default() && (efforts[efforts.len() - 1].traction - 50.0).abs() < 1e-9);
        let weak = Rover { wheels: crate::robot::rover::Wheels { torque: 1.0, ..rover.wheels }, ..heavy.clone() };
        let (name, excess) = told.peaks.broken(&weak).expect("too weak");
        assert!(name == "wheel_torque" && (excess - (torque - 1.0)).abs() < 1e-9, "{name} {excess}");
        let slow = Rover { wheels: crate::robot::rover::Wheels { speed: 5.0, ..rover.wheels }, ..rover.clone() };
        let (name, excess) = peaks.broken(&slow).expect("too fast");
        assert!(name == "wheel_speed" && (excess - (1.0 / 0.12 - 5.0)).abs() < 0.02 && peaks.broken(&rover).is_none());
    }

    #[test]
    fn with_latency_the_vehicle_goes_on_as_it_was() {
        let rover = rover(0.5);
        let drive = [Segment::straight(2.0, Gear::Forward)];
        let start = Planar { curvature: 0.4, ..Planar::default() };
        let States { states, .. } = followed(&rover, 1.0.into()).on(&Flat, &start, &drive).expect("level ground");
        let last = states.last().expect("states");
        // Half a metre of the arc, and of the commands what is left of two metres.
        assert!((last.time - 2.0).abs() < 1e-9 && (last.s - 2.0).abs() < 1e-9, "{last:?}");
        assert!((last.at.yaw - 0.2).abs() < 1e-9, "{last:?}");
        assert!(states.windows(2).all(|pair| pair[1].time > pair[0].time));
    }
}
