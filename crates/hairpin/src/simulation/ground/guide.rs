//! Where a run stands in its plan: progress along a section, stops between sections, turns in place. The same for every
//! controller of ours; what differs is how each steers.
//!
//! Sections are what lies between stops: driven in one gear, or a turn in place. Before each the vehicle waits until
//! its wheels are ready (or patience ends), and a section is over 2 mm or 0.005 rad before its end.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use super::command::{DriveCommand, DriveState};
use super::plan::{Plan, Section, Station, acceleration_at, direction_at, heading, speed_at};
use crate::math::power::square;
use crate::robot::rover::Rover;
use crate::trajectory::drive::Planar;

/// The part of a section that is being driven.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Along<'a> {
    /// Number of the section.
    pub(super) section: usize,
    /// Its stations.
    pub(super) stations: &'a [Station],
    /// +1 forward, −1 in reverse.
    pub(super) sign: f64,
    /// Heading of travel in the body as it is now, rad.
    pub(super) heading: f64,
    /// Direction of travel in the body to command, rad.
    pub(super) direction: f64,
    /// Commanded metres to the station nearest to the vehicle.
    pub(super) s: f64,
    /// Speed to go at, m/s, ≥ 0.
    pub(super) speed: f64,
}

/// What is to be done now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Task<'a> {
    /// Follow the section.
    Follow(Along<'a>),
    /// Hold still, the wheels steered for what comes, or turn in place.
    Hold(DriveCommand),
}

/// Farthest that the nearest station is looked for ahead of the last one, m.
const WINDOW: f64 = 0.5;
/// A section is over this close to its end, m.
const ARRIVED: f64 = 0.002;
/// A turn is over this close to its end, rad.
const TURNED: f64 = 0.005;
/// Rate of a turn per angle left, 1/s: stable for latencies up to 1 s.
const TURN_GAIN: f64 = 1.0;
/// The wheels are ready this close to what comes, as a share of the largest curvature.
const READY: f64 = 0.02;
/// Speeds below this are none, m/s.
const STILL: f64 = 1e-6;

/// Progress along a plan.
#[derive(Debug, Clone)]
pub(super) struct Guide<'a> {
    plan: &'a Plan,
    section: usize,
    /// Station of the section that the vehicle is nearest to.
    nearest: usize,
    /// Since when the vehicle waits for its wheels, s; `None`: it drives.
    waiting: Option<f64>,
    /// Longest wait, s.
    patience: f64,
    /// Angle turned in the section, rad, and the yaw measured last.
    turned: Option<(f64, f64)>,
    /// Time from a command to its effect, s.
    latency: f64,
    /// Speeds that were commanded and have not acted to their end, m/s, and when they were given, s.
    under_way: VecDeque<(f64, f64)>,
    speed: f64,
    turn_rate: f64,
    acceleration: f64,
    curvature: f64,
}

impl<'a> Guide<'a> {
    /// At the beginning of `plan`, driven at up to `speed` (m/s) and `turn_rate` (rad/s) by commands that act `latency`
    /// s late.
    ///
    /// Waits at most 3 s + 6 steering time constants + the time of a full swing.
    pub(super) fn new(plan: &'a Plan, nominal: &Rover, latency: f64, [speed, turn_rate]: [f64; 2]) -> Self {
        let response = &nominal.response;
        let swing = 2.0 * libm::atan(nominal.limits.curvature * response.steered_axle) / response.steering_rate;
        Self {
            plan,
            section: 0,
            nearest: 0,
            waiting: Some(0.0),
            patience: 3.0 + 6.0 * response.steering_time_constant + swing,
            turned: None,
            latency,
            under_way: VecDeque::new(),
            speed: speed.min(nominal.limits.speed),
            turn_rate,
            acceleration: nominal.limits.acceleration,
            curvature: nominal.limits.curvature,
        }
    }

    /// Whether the plan is over.
    pub(super) fn over(&self) -> bool {
        self.section >= self.plan.sections.len()
    }

    /// The leg being driven; after the last, the last.
    pub(super) fn leg(&self) -> usize {
        match self.plan.sections.get(self.section) {
            Some(Section::Way { stations, .. }) => stations[self.nearest].leg,
            Some(section @ Section::Turn { .. }) => section.first_leg(),
            None => match self.plan.sections.last() {
                Some(Section::Way { stations, .. }) => stations[stations.len() - 1].leg,
                Some(section) => section.first_leg(),
                None => 0,
            },
        }
    }

    /// Takes note of where the vehicle is, and says what to do for the next `dt` s.
    pub(super) fn task(&mut self, measured: &DriveState, dt: f64) -> Task<'a> {
        let task = self.next(measured, dt);
        let speed = if let Task::Follow(along) = &task { along.speed } else { 0.0 };
        self.under_way.push_back((measured.t, speed));
        while self.under_way.get(1).is_some_and(|(given, _)| *given <= measured.t + dt - self.latency) {
            self.under_way.pop_front();
        }
        task
    }

    /// Metres that the commands under way still bring before one given at `t` acts.
    fn coming(&self, t: f64) -> f64 {
        let acts = |index: usize| self.under_way.get(index).map_or(t, |(given, _)| *given) + self.latency;
        let time = |index: usize| (acts(index + 1).min(t + self.latency) - acts(index).max(t)).max(0.0);
        self.under_way.iter().enumerate().map(|(index, (_, speed))| speed * time(index)).sum()
    }

    /// The speed to command `s` metres along `stations`: what is planned where the vehicle will be when the command has
    /// acted.
    ///
    /// With the acceleration a the way until then is v·dt + ½ a dt² behind the commands under way. Near the end half of
    /// what is left, so that it is reached. Wheels that take any speed at once go by the plan's own v and a, which lead
    /// it out of rest.
    fn pace(&self, stations: &[Station], measured: &DriveState, s: f64, dt: f64) -> f64 {
        let end = stations[stations.len() - 1].s;
        let left = (end - s - self.coming(measured.t)).max(0.0);
        let most = self.speed.min(left / dt);
        if !self.acceleration.is_finite() {
            // What has stopped short of where a section begins starts there all the same.
            let acts = (end - left).max(0.0);
            let way = (speed_at(stations, acts) + 0.5 * acceleration_at(stations, acts) * dt) * dt;
            return speed_at(stations, acts + way.max(0.0)).min(most);
        }
        let before = self.under_way.back().map_or(0.0, |(_, speed)| *speed);
        let gained = 0.5 * self.acceleration * dt;
        let ahead = end - left + (before + gained) * dt;
        let braking = (2.0 * self.acceleration * (left - (before + gained) * dt).max(0.0)).sqrt();
        let creeping = (0.5 * left / dt).min(gained);
        speed_at(stations, ahead).min(braking).max(creeping).min(most)
    }

    /// The first section that is not over says what to do; turns are counted from angle to angle, so that more than
    /// half a turn is one.
    fn next(&mut self, measured: &DriveState, dt: f64) -> Task<'a> {
        let plan = self.plan;
        loop {
            match plan.sections.get(self.section) {
                None => return Task::Hold(held(measured)),
                Some(Section::Way { sign, stations }) => {
                    if let Some(since) = self.waiting {
                        let wanted = stations[0].at.curvature;
                        let ready = (wanted - measured.at.curvature).abs() <= READY * self.curvature
                            && measured.speed.abs() < STILL;
                        if !ready && measured.t - since < self.patience {
                            let direction = stations[0].direction;
                            return Task::Hold(DriveCommand {
                                curvature: wanted,
                                direction,
                                ..DriveCommand::default()
                            });
                        }
                        self.waiting = None;
                    }
                    let s = self.progress(stations, &measured.at, *sign);
                    let left = stations[stations.len() - 1].s - s;
                    if left > ARRIVED {
                        let speed = self.pace(stations, measured, s, dt);
                        let heading = heading(measured.direction, *sign);
                        // Where the vehicle will be while the command acts.
                        let direction = direction_at(stations, s + self.coming(measured.t) + 0.5 * speed * dt);
                        let section = self.section;
                        return Task::Follow(Along { section, stations, sign: *sign, heading, direction, s, speed });
                    }
                }
                Some(Section::Turn { from, angle, .. }) => {
                    let yaw = measured.at.yaw;
                    let (turned, before) = self.turned.unwrap_or_else(|| (wrap(yaw - from), yaw));
                    let turned = turned + wrap(yaw - before);
                    self.turned = Some((turned, yaw));
                    let left = angle - turned;
                    if left.abs() > TURNED {
                        let braking = (2.0 * self.acceleration * left.abs()).sqrt();
                        let rate = self.turn_rate.min(TURN_GAIN * left.abs()).min(braking);
                        return Task::Hold(DriveCommand { turn_rate: rate.copysign(left), ..held(measured) });
                    }
                }
            }
            self.section += 1;
            (self.nearest, self.waiting, self.turned) = (0, Some(measured.t), None);
        }
    }

    /// The metres to the place on the section that is nearest to the vehicle, never behind the last station found and
    /// never far ahead of it: a section may cross itself.
    fn progress(&mut self, stations: &[Station], at: &Planar, sign: f64) -> f64 {
        let distance = |i: usize| square(stations[i].at.x - at.x) + square(stations[i].at.y - at.y);
        let from = self.nearest;
        let mut best = distance(from);
        for i in from + 1..stations.len() {
            if stations[i].s > stations[from].s + WINDOW {
                break;
            }
            let here = distance(i);
            if here < best {
                (self.nearest, best) = (i, here);
            }
        }
        let station = &stations[self.nearest];
        let (sin, cos) = libm::sincos(station.at.yaw + heading(station.direction, sign));
        let beyond = cos * (at.x - station.at.x) + sin * (at.y - station.at.y);
        // Between stations; only at the end also beyond, which says that it is over.
        let last = self.nearest + 1 == stations.len();
        station.s + if last { beyond } else { beyond.clamp(-WINDOW, stations[self.nearest + 1].s - station.s) }
    }
}

/// Standing, with the wheels as they are.
fn held(measured: &DriveState) -> DriveCommand {
    DriveCommand { curvature: measured.at.curvature, direction: measured.direction, ..DriveCommand::default() }
}

/// An angle in (−π, π].
pub(super) fn wrap(angle: f64) -> f64 {
    let turns = libm::rint(angle / TAU);
    angle - turns * TAU
}
