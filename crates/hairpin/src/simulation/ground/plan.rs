//! The planned drive as controllers and the judge see it: where its commands lead the vehicle that was planned with.
//!
//! Stations every 2 cm, between stops: progress along a section is monotone even where sections cross. Latency is left
//! out, as plans leave it out.
//!
//! Data flow: commands of a [`Drive`] → followed on the ground by the nominal vehicle, leg by leg → sections between
//! stops, with stations → what controllers look up ([`station_at`], [`speed_at`]) and the track that runs are
//! compared with.

use nalgebra::Isometry3;

use super::command::DriveCommand;
use super::plant::{Lost, Plant};
use crate::math::power::square;
use crate::robot::rover::{Rims, Rover};
use crate::simulation::SimulationError;
use crate::trajectory::drive::{Motion, Planar, Segment};
use crate::trajectory::{Channel, Direction, Drive, DriveLeg, Timing, Track};
use crate::world::terrain::ElevationMap;

/// Distance of neighbouring stations, m, at most.
const SPACING: f64 = 0.02;
/// Steps from one station to the next, for commands that change on the way: as long as the plant's own, so that each
/// command is held for one of those.
const STEPS: usize = 5;
/// Angle between neighbouring poses of a turn in place, rad, at most.
const TURN_SPACING: f64 = 0.05;

/// What rounding leaves of segments of no length, m or rad: too short for time to pass.
const NOTHING: f64 = 1e-9;

/// A place on the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Station {
    /// Where, and the steered curvature.
    pub(super) at: Planar,
    /// Commanded metres since the section's first station.
    pub(super) s: f64,
    /// Rise of the body per metre along its way and to the left of it.
    pub(super) rises: [f64; 2],
    /// Planned speed, m/s, ≥ 0.
    pub(super) speed: f64,
    /// Planned direction of travel in the body, rad.
    pub(super) direction: f64,
    /// The leg it belongs to.
    pub(super) leg: usize,
}

/// A part of the plan between two stops.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Section {
    /// Driven in one gear; two stations or more.
    Way {
        /// +1 forward, −1 in reverse.
        sign: f64,
        /// With rising `s`.
        stations: Vec<Station>,
    },
    /// Turned in place.
    Turn {
        /// ψ before it, rad.
        from: f64,
        /// Change of ψ, rad.
        angle: f64,
        /// The leg it belongs to.
        leg: usize,
    },
}

/// The whole plan.
///
/// Made once a run; nothing in it depends on the true vehicle.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plan {
    /// In the order they are driven.
    pub(super) sections: Vec<Section>,
    /// Duration as commanded, s.
    pub(super) duration: f64,
    /// Poses in time with the channels `leg`, `vx_m_s`, `vy_m_s`, `vz_m_s`.
    pub(super) track: Track,
}

/// A plan that is being driven for the first time.
///
/// Columns of the track, filled as the plan is driven.
#[derive(Default)]
struct Draft {
    sections: Vec<Section>,
    duration: f64,
    times: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
    legs: Vec<f64>,
    velocities: [Vec<f64>; 3],
}

/// Where the commands of `drive` lead the vehicle `nominal`, leg after leg from each leg's own start: poses over time
/// with the channels `leg`, `vx_m_s`, `vy_m_s`, `vz_m_s`. It is the path that a run is to be compared with
/// ([`crate::trajectory::Track`] of `judgement::Reference::Path`), at the speeds that were planned. Latency is left
/// out.
///
/// # Errors
/// A drive without legs or with numbers that are none; a place where the vehicle cannot stand.
///
/// World frame, m and s; the channel `leg` counts from 0. Velocities are the planned speeds along the way that the body
/// takes there, 0 where it rests. About one pose every 2 cm, and every 0.05 rad of turns in
/// place.
pub fn planned_track(nominal: &Rover, terrain: &ElevationMap, drive: &Drive) -> Result<Track, SimulationError> {
    Ok(Plan::new(nominal, terrain, drive)?.track)
}

impl Plan {
    /// Bounds of speed, curvature and acceleration are lifted, as the plan's commands keep them already; steering lags
    /// and slip of the nominal vehicle act. 5 steps of at most 4 mm between stations.
    ///
    /// # Errors
    /// Numbers that are no drive, or a leg along which the vehicle loses ground or rest, by the leg's number.
    pub(super) fn new(nominal: &Rover, terrain: &ElevationMap, drive: &Drive) -> Result<Self, SimulationError> {
        check(drive)?;
        let mut at_once = nominal.clone();
        at_once.limits.acceleration = f64::INFINITY;
        at_once.limits.speed = f64::INFINITY;
        at_once.limits.curvature = f64::INFINITY;
        at_once.limits.turns_in_place = true;
        at_once.rims = nominal.rims.map(|rims| Rims { speed: f64::INFINITY, ..rims });
        at_once.response = nominal.response.as_planned();
        let mut draft = Draft::default();
        for leg in 0..drive.legs.len() {
            draft.add_leg(&at_once, terrain, drive, leg).map_err(|lost| {
                let bound = match lost {
                    Lost::NoGround => "over ground all along",
                    Lost::NoRest => "over ground on which the wheels find rest",
                };
                SimulationError::new("drive.legs", format!("leg {leg}"), bound)
            })?;
        }
        let Draft { sections, duration, times, poses, legs, velocities } = draft;
        if times.len() < 2 {
            return Err(SimulationError::new("drive.legs", "no motion".into(), "of some length"));
        }
        let legs = Channel { name: "leg".into(), values: legs };
        let velocities = ["vx_m_s", "vy_m_s", "vz_m_s"].into_iter().zip(velocities);
        let velocities = velocities.map(|(name, values)| Channel { name: name.into(), values });
        let channels = std::iter::once(legs).chain(velocities).collect();
        let track = Track::new(times, poses, channels).expect("our own samples are finite and in order");
        Ok(Self { sections, duration, track })
    }

    /// The longest time that the plan takes to move by `way` m or turn by `angle` rad, s.
    ///
    /// What a run's patience is measured by: a plan that waits is no vehicle that is stuck.
    pub(super) fn longest_rest(&self, [way, angle]: [f64; 2]) -> f64 {
        // Of two attitudes as quaternions.
        let alike = libm::cos(0.5 * angle);
        let times = self.track.times();
        let (mut from, mut longest) = (0, 0.0_f64);
        for (i, pose) in self.track.poses().iter().enumerate() {
            let (moved, before) = (times[i] - times[from], &self.track.poses()[from]);
            longest = longest.max(moved);
            let off = (pose.translation.vector - before.translation.vector).norm();
            if off > way || pose.rotation.coords.dot(&before.rotation.coords).abs() < alike {
                from = i;
            }
        }
        longest
    }
}

impl Draft {
    /// From the leg's own start, wherever the one before came to.
    fn add_leg(&mut self, vehicle: &Rover, terrain: &ElevationMap, drive: &Drive, leg: usize) -> Result<(), Lost> {
        let timing = drive.legs[leg].timing();
        let mut driven = 0.0;
        let DriveLeg { from, direction, .. } = &drive.legs[leg];
        let mut plant = Plant::new(vehicle, terrain, direction.start, from)?;
        if self.times.is_empty() {
            let first = drive.legs[leg].segments.iter().find(|segment| !is_nothing(segment));
            let speed = first.map_or(0.0, |segment| match segment.motion {
                Motion::Arc { .. } => segment.gear.sign() * timing.speed_at(0.0),
                Motion::Turn { .. } => 0.0,
            });
            self.note(&plant, [speed, 0.0], leg);
        }
        for segment in &drive.legs[leg].segments {
            match segment.motion {
                Motion::Arc { length_m, .. } if length_m > NOTHING => {
                    self.add_way(&mut plant, direction, segment, &timing, driven, leg)?;
                }
                Motion::Turn { angle_rad } if angle_rad.abs() > NOTHING => {
                    self.sections.push(Section::Turn { from: plant.yaw, angle: angle_rad, leg });
                    let parts = (angle_rad.abs() / TURN_SPACING).ceil();
                    let time = angle_rad.abs() / drive.turn_rate / parts;
                    let command = DriveCommand {
                        turn_rate: drive.turn_rate.copysign(angle_rad),
                        curvature: plant.curvature(),
                        direction: plant.direction,
                        ..DriveCommand::default()
                    };
                    plant.speed = 0.0;
                    for part in 1..=parts as usize {
                        plant.advance(&command, time)?;
                        self.duration += time;
                        let rate = if part < parts as usize { command.turn_rate } else { 0.0 };
                        self.note(&plant, [0.0, rate], leg);
                    }
                    plant.turn_rate = 0.0;
                    plant.steer_at_once(0.0);
                }
                _ => {}
            }
            driven += segment.length_m();
        }
        Ok(())
    }

    /// Follows `segment`, which begins `driven` metres after its leg.
    fn add_way(
        &mut self,
        plant: &mut Plant,
        direction: &Direction,
        segment: &Segment,
        timing: &Timing,
        driven: f64,
        leg: usize,
    ) -> Result<(), Lost> {
        let (length, gear) = (segment.length_m(), segment.gear.sign());
        let (first, response) = (segment.curvature_at(0.0), &plant.vehicle.response);
        let (lags, steering_lag) = (response.lags(), response.steering_time_constant);
        let direction_at = |done: f64| direction.at(driven + done, timing.length());
        let goes_on = matches!(self.sections.last(), Some(Section::Way { sign, .. }) if *sign == gear);
        let station = |plant: &Plant, s: f64, done: f64| Station {
            at: Planar { x: plant.x, y: plant.y, yaw: plant.yaw, curvature: plant.curvature() },
            s,
            speed: timing.speed_at(driven + done),
            direction: direction_at(done),
            rises: rises([plant.pose.roll, plant.pose.pitch], direction_at(done), gear),
            leg,
        };
        if !goes_on {
            // Where the vehicle stands its wheels swing to what comes. At one speed it never stands.
            if !(timing.is_constant() && lags) {
                plant.steer_at_once(first);
            }
            self.sections.push(Section::Way { sign: gear, stations: vec![station(plant, 0.0, 0.0)] });
        }
        let parts = (length / SPACING).ceil();
        let step = length / parts / STEPS as f64;
        for part in 0..parts as usize {
            for i in 0..STEPS {
                let begun = step * (part * STEPS + i) as f64;
                let time = timing.time_over(driven + begun, step);
                let held = if lags { held_at(time, steering_lag) } else { 0.5 };
                let curvature = segment.curvature_at(begun + held * step);
                let direction = direction_at(begun + 0.5 * step);
                plant
                    .advance(&DriveCommand { speed: gear * step / time, curvature, turn_rate: 0.0, direction }, time)?;
                self.duration += time;
            }
            let done = step * ((part + 1) * STEPS) as f64;
            if !lags {
                plant.steer_at_once(segment.curvature_at(done));
            }
            self.note(plant, [gear * timing.speed_at(driven + done), 0.0], leg);
            if let Some(Section::Way { stations, .. }) = self.sections.last_mut() {
                let s = stations.last().map_or(0.0, |last| last.s) + step * STEPS as f64;
                stations.push(station(plant, s, done));
            }
        }
        plant.speed = 0.0;
        Ok(())
    }

    /// A pose of the track, now.
    ///
    /// At the time that is planned, with the velocity that belongs to the speed (m/s, signed) and the rate of a turn in
    /// place (rad/s) there.
    fn note(&mut self, plant: &Plant, pace: [f64; 2], leg: usize) {
        let velocity = plant.velocity_at(pace);
        self.velocities.iter_mut().zip(velocity.iter()).for_each(|(column, value)| column.push(*value));
        self.times.push(self.duration);
        self.poses.push(plant.world_from_body());
        self.legs.push(leg as f64);
    }
}

/// At which share of a step of `time` s a ramp of commands is what a lag of first order, T = `lag` s, ends the step at
/// when it is held all along.
///
/// 1/(1 − e⁻ʳ) − 1/r, r = time/T: the end of the step where nothing but a rate is bounded, as wheels that stay half a
/// step behind turn the body by less all the way; the middle of it for slow wheels.
fn held_at(time: f64, lag: f64) -> f64 {
    let r = time / lag;
    if r < 1e-4 { 0.5 } else { -1.0 / libm::expm1(-r) - lag / time }
}

/// Whether `segment` is too short for time to pass.
fn is_nothing(segment: &Segment) -> bool {
    match segment.motion {
        Motion::Arc { length_m, .. } => length_m <= NOTHING,
        Motion::Turn { angle_rad } => angle_rad.abs() <= NOTHING,
    }
}

/// Segments of 0 … 100 km, turns of at most 1000 rad, everything finite; errors name the field and the leg.
fn check(drive: &Drive) -> Result<(), SimulationError> {
    if drive.legs.is_empty() {
        return Err(SimulationError::new("drive.legs", "0".into(), "at least one"));
    }
    for (field, value) in [("drive.speed", drive.speed), ("drive.turn_rate", drive.turn_rate)] {
        if !(value.is_finite() && value > 0.0) {
            return Err(SimulationError::new(field, value.to_string(), "finite and > 0"));
        }
    }
    for (index, leg) in drive.legs.iter().enumerate() {
        let known = |p: &Planar| [p.x, p.y, p.yaw, p.curvature].iter().all(|v| v.is_finite());
        let possible = |segment: &Segment| match segment.motion {
            Motion::Arc { length_m, curvature } => {
                (0.0..=1e5).contains(&length_m) && curvature.iter().all(|a| a.is_finite())
            }
            Motion::Turn { angle_rad } => angle_rad.abs() <= 1e3,
        };
        let Direction { start, end } = leg.direction;
        if !(start.is_finite() && end.is_finite()) {
            return Err(SimulationError::new("drive.legs.direction", format!("leg {index}"), "finite"));
        }
        if let Err(error) = leg.speed.checked() {
            return Err(SimulationError::new("drive.legs.speed", format!("leg {index}: {error}"), "a profile"));
        }
        if !(known(&leg.from) && known(&leg.to) && leg.segments.iter().all(possible)) {
            return Err(SimulationError::new("drive.legs", format!("leg {index}"), "finite, of length 0 to 100 km"));
        }
    }
    Ok(())
}

impl Section {
    /// The leg at the section's beginning.
    pub(super) fn first_leg(&self) -> usize {
        match self {
            Section::Way { stations, .. } => stations[0].leg,
            Section::Turn { leg, .. } => *leg,
        }
    }
}

/// Rise per metre along the way, and to the left of it, of a body that leans by `lean` (φ, θ) and travels along
/// `direction` (rad) of itself with `sign`.
pub(super) fn rises([roll, pitch]: [f64; 2], direction: f64, sign: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(direction);
    let (ahead, left) = (-libm::sin(pitch), libm::cos(pitch) * libm::sin(roll));
    [sign * (cos * ahead + sin * left), sign * (cos * left - sin * ahead)]
}

/// The planned speed `s` commanded metres along `stations`, m/s: v² is linear between two; beyond the last, its own.
///
/// Constant acceleration between stations.
pub(super) fn speed_at(stations: &[Station], s: f64) -> f64 {
    let next = stations.partition_point(|station| station.s < s);
    let (Some(b), Some(a)) = (stations.get(next), stations.get(next.wrapping_sub(1))) else {
        return stations[next.min(stations.len() - 1)].speed;
    };
    let share = (s - a.s) / (b.s - a.s);
    (square(a.speed) + share * (square(b.speed) - square(a.speed))).sqrt()
}

/// The planned acceleration `s` commanded metres along `stations`, m/s²: that of the piece that begins there.
pub(super) fn acceleration_at(stations: &[Station], s: f64) -> f64 {
    let next = stations.partition_point(|station| station.s <= s).clamp(1, stations.len() - 1);
    let [a, b] = [&stations[next - 1], &stations[next]];
    0.5 * (square(b.speed) - square(a.speed)) / (b.s - a.s)
}

/// Heading of travel in the body, rad, of what goes with `sign` in `direction` of it.
pub(super) fn heading(direction: f64, sign: f64) -> f64 {
    direction + if sign < 0.0 { std::f64::consts::PI } else { 0.0 }
}

/// The planned direction of travel `s` commanded metres along `stations`, rad: between two linear, beyond the ends as
/// there.
pub(super) fn direction_at(stations: &[Station], s: f64) -> f64 {
    let next = stations.partition_point(|station| station.s < s);
    let (Some(b), Some(a)) = (stations.get(next), stations.get(next.wrapping_sub(1))) else {
        return stations[next.min(stations.len() - 1)].direction;
    };
    a.direction + (s - a.s) / (b.s - a.s) * (b.direction - a.direction)
}

/// Mean change of the planned direction over the `ahead` metres after `s`, rad/m.
///
/// `ahead` > 0.
pub(super) fn turning(stations: &[Station], s: f64, ahead: f64) -> f64 {
    (direction_at(stations, s + ahead) - direction_at(stations, s)) / ahead
}

/// The place `s` commanded metres along `stations`, which are driven with `sign`: between two by linear interpolation,
/// beyond the last straight on.
pub(super) fn station_at(stations: &[Station], s: f64, sign: f64) -> Planar {
    let next = stations.partition_point(|station| station.s < s);
    if next == 0 {
        return stations[0].at;
    }
    let a = &stations[next - 1];
    let Some(b) = stations.get(next) else {
        let (sin, cos) = libm::sincos(a.at.yaw + heading(a.direction, sign));
        let beyond = s - a.s;
        return Planar { x: a.at.x + beyond * cos, y: a.at.y + beyond * sin, ..a.at };
    };
    let share = (s - a.s) / (b.s - a.s);
    let between = |p: f64, q: f64| p + share * (q - p);
    Planar {
        x: between(a.at.x, b.at.x),
        y: between(a.at.y, b.at.y),
        yaw: between(a.at.yaw, b.at.yaw),
        curvature: between(a.at.curvature, b.at.curvature),
    }
}
