//! Predictive tracking: the boundary-value problem is solved again and again, from where the vehicle will be when the
//! answer acts to the planned path ahead.
//!
//! The commands under way say where the vehicle will be after the latency. How much more the ground gives way than was
//! planned is learnt from the way behind, in proportion to its slopes, by least squares that forget; the slopes ahead
//! are the plan's. The goal handed to the solver lies against the drift that they will cause, and the vehicle goes
//! crabwise along the path. Source: predictive trajectory tracking as the rover trajectory generator's papers have it
//! (Howard & Kelly 2007).

use std::collections::VecDeque;

use super::kind::Resolve;
use crate::robot::rover::{Rover, Settled, rates};
use crate::simulation::ground::command::{DriveCommand, DriveState};
use crate::simulation::ground::guide::{Along, wrap};
use crate::simulation::ground::plan::{direction_at, heading, rises, station_at, turning};
use crate::simulation::ground::pursuit::PurePursuit;
use crate::trajectory::Direction;
use crate::trajectory::drive::{Gear, Motion, Planar, Segment, SegmentList};

/// How far ahead on the path the goal lies, in smallest turning radii, and per speed, s.
/// Nearer goals ask for sharp curves, farther ones answer late.
const RADII: f64 = 1.5;
const TIME: f64 = 0.5;
/// Way from one solution to the next, as a share of that.
/// Ten solutions on the way to each goal.
const CYCLE: f64 = 0.1;
/// Way after which what was learnt is forgotten, in smallest turning radii.
const MEMORY: f64 = 5.0;
/// What is taken for granted before anything is learnt, that nothing more gives way: as firmly as after this way on a
/// slope of 20°, m.
const PRIOR: f64 = 0.02;
/// sin 20°, the slope to which slip is referred.
const SIN_20: f64 = 0.342_020_143_325_668_7;
/// What is near enough to tell how the planned direction turns at a place, m.
const NEAR: f64 = 0.02;
/// Answers longer than the way to the goal by this factor go round in circles.
const LONGEST: f64 = 1.5;

/// An answer that is being driven.
///
/// Driven by the odometer, not by the clock, so that lags of the speed do not matter.
struct Answer {
    segments: SegmentList,
    /// What the odometer says where it begins, m.
    from: f64,
    /// What the direction of travel turns by in it, rad/m.
    turning: f64,
}

/// A coefficient c in off = −c · rise/sin 20° · way, by least squares.
///
/// Without unit: a share of the way, as slip is.
#[derive(Debug, Clone, Copy, Default)]
struct Learnt {
    information: f64,
    moment: f64,
}

/// c = −Σ k off·x/(Σ k x² way + prior), x = rise/sin 20°, weights k falling with the way behind by e per [`MEMORY`]
/// radii.
impl Learnt {
    /// Takes note of `off` (m) on a `way` (m) with `rise` per metre; all before counts `kept` as much.
    fn note(&mut self, off: f64, rise: f64, way: f64, kept: f64) {
        let x = rise / SIN_20;
        self.information = kept * self.information + x * x * way;
        self.moment = kept * self.moment - off * x;
    }

    /// Expected drift per metre where the body rises by `rise` per metre.
    fn drift(&self, rise: f64) -> f64 {
        -self.moment / (self.information + PRIOR) * rise / SIN_20
    }
}

/// What the wheels do for a while.
#[derive(Debug, Clone, Copy)]
struct Rolls {
    /// m, negative in reverse.
    way: f64,
    /// 1/m.
    curvature: f64,
    /// Of travel in the body, rad.
    direction: f64,
}

/// State of a run.
pub(in crate::simulation::ground) struct Predictive<'a> {
    nominal: Rover,
    latency: f64,
    solve: &'a Resolve<'a>,
    pursuit: PurePursuit,
    /// Commands that have not acted to their end, and when they were given, s.
    under_way: VecDeque<(f64, DriveCommand)>,
    answer: Option<Answer>,
    /// Number of the section that the answer belongs to.
    section: Option<usize>,
    /// Way until the next solution, m.
    until_next: f64,
    /// What gives way more than planned, along the way and across it.
    slip: [Learnt; 2],
    before: Option<DriveState>,
    /// Way of the wheels, m.
    odometer: f64,
}

impl<'a> Predictive<'a> {
    /// Knows the vehicle as it was planned with; `latency` in s. Nothing is learnt yet.
    pub(super) fn new(nominal: &Rover, latency: f64, solve: &'a Resolve<'a>) -> Self {
        Self {
            nominal: nominal.clone(),
            latency,
            solve,
            pursuit: PurePursuit::new(nominal),
            under_way: VecDeque::new(),
            answer: None,
            section: None,
            until_next: 0.0,
            slip: [Learnt::default(); 2],
            before: None,
            odometer: 0.0,
        }
    }

    /// Takes note of the command given at `measured.t`, and of how the vehicle drifts.
    ///
    /// Called once a turn, after the command was given.
    pub(super) fn note(&mut self, measured: &DriveState, command: &DriveCommand) {
        self.under_way.push_back((measured.t, *command));
        let oldest = measured.t - self.latency;
        while self.under_way.get(1).is_some_and(|(given, _)| *given <= oldest) {
            self.under_way.pop_front();
        }
        if let Some(before) = self.before.replace(*measured) {
            self.odometer += 0.5 * (before.speed + measured.speed).abs() * (measured.t - before.t);
            self.learn(&before, measured);
        }
    }

    /// What the way from `before` to `now` was beyond what the wheels and the planned slip explain.
    fn learn(&mut self, before: &DriveState, now: &DriveState) {
        let way = before.speed * (now.t - before.t);
        if way == 0.0 || before.speed * now.speed <= 0.0 {
            return;
        }
        let rolls = Rolls { way, curvature: before.at.curvature, direction: before.direction };
        let expected = self.rolled(before, &before.at, &rolls, &[0.0; 2]);
        let (sin, cos) = libm::sincos(before.at.yaw + heading(before.direction, way));
        let (dx, dy) = (now.at.x - expected.x, now.at.y - expected.y);
        let kept = libm::exp(-way.abs() * self.nominal.limits.curvature / MEMORY);
        let rises = rises(before.lean, before.direction, way.signum());
        let offs = [cos * dx + sin * dy, cos * dy - sin * dx];
        for ((slip, off), rise) in self.slip.iter_mut().zip(offs).zip(rises) {
            slip.note(off, rise, way.abs(), kept);
        }
    }

    /// Expected drift per metre beyond what was planned, along the way and to its left.
    fn drift(&self, rises: [f64; 2]) -> [f64; 2] {
        [self.slip[0].drift(rises[0]), self.slip[1].drift(rises[1])]
    }

    /// 1.5 smallest radii + 0.5 s · speed, m.
    fn horizon(&self, speed: f64) -> f64 {
        RADII / self.nominal.limits.curvature + TIME * speed
    }

    /// `from` after what the wheels have rolled, leaning as measured, with `drift` per metre.
    ///
    /// Midpoint rule in one step; the ground is taken to lean all along as it does now.
    fn rolled(&self, lean: &DriveState, from: &Planar, rolls: &Rolls, drift: &[f64; 2]) -> Planar {
        let Rolls { way, curvature, direction } = *rolls;
        let direction = libm::sincos(direction);
        let pose = Settled { roll: lean.lean[0], pitch: lean.lean[1], ..Settled::default() };
        let sign = if way < 0.0 { -1.0 } else { 1.0 };
        let rate = rates(&pose, direction, sign, curvature, &self.nominal.slip);
        let along = [direction.1 * sign, direction.0 * sign];
        let ahead = rate.ahead + drift[0] * along[0] - drift[1] * along[1];
        let left = rate.left + drift[0] * along[1] + drift[1] * along[0];
        let way = way.abs();
        let (sin, cos) = libm::sincos(from.yaw + 0.5 * way * rate.yaw);
        Planar {
            x: from.x + way * (cos * ahead - sin * left),
            y: from.y + way * (sin * ahead + cos * left),
            yaw: from.yaw + way * rate.yaw,
            curvature,
        }
    }

    /// Where the vehicle will be when what is commanded now acts, and how many metres it goes until then.
    ///
    /// Each command under way for the time that it will act: steering and speed follow it with the nominal lags and
    /// bounds.
    fn predicted(&self, measured: &DriveState) -> (Planar, f64) {
        let response = &self.nominal.response;
        let (mut at, mut way, mut speed) = (measured.at, 0.0, measured.speed);
        let acts = |index: usize| self.under_way.get(index).map_or(measured.t, |(given, _)| *given) + self.latency;
        for (index, (_, command)) in self.under_way.iter().enumerate() {
            let (from, to) = (acts(index).max(measured.t), acts(index + 1).min(measured.t + self.latency));
            let time = to - from;
            if time <= 0.0 {
                continue;
            }
            let steering = |bend: f64| libm::atan(bend * response.steered_axle);
            let most = self.nominal.limits.curvature;
            let lag = response.steering_time_constant;
            let share = if lag > 0.0 { -libm::expm1(-time / lag) } else { 1.0 };
            let fastest = response.steering_rate * time;
            let now = steering(at.curvature);
            let then = now + (share * (steering(command.curvature.clamp(-most, most)) - now)).clamp(-fastest, fastest);
            let after = libm::tan(then) / response.steered_axle;
            let most = self.nominal.limits.acceleration * time;
            let after_speed = speed + (command.speed - speed).clamp(-most, most);
            let mean = if most.is_finite() { 0.5 * (speed + after_speed) } else { after_speed };
            let step = mean * time;
            speed = after_speed;
            let bend = if lag > 0.0 || fastest.is_finite() { 0.5 * (at.curvature + after) } else { after };
            let drift = self.drift(rises(measured.lean, command.direction, step.signum()));
            let rolls = Rolls { way: step, curvature: bend, direction: command.direction };
            at = self.rolled(measured, &at, &rolls, &drift);
            at.curvature = after;
            way += step.abs();
        }
        (at, way)
    }

    /// The curvature to command for the next `dt` s.
    ///
    /// 1/m, within the largest curvature: the answer's at the middle of the step that the command will act on, else
    /// pure pursuit's.
    pub(super) fn steer(&mut self, measured: &DriveState, along: &Along, dt: f64) -> f64 {
        if self.section.replace(along.section) != Some(along.section) {
            (self.answer, self.until_next) = (None, 0.0);
        }
        let (from, way) = self.predicted(measured);
        if self.until_next <= 0.0 {
            self.until_next = CYCLE * self.horizon(along.speed);
            self.resolve(&from, way, along);
        }
        let step = along.speed * dt;
        self.until_next -= step;
        let most = self.nominal.limits.curvature;
        if let Some(answer) = &self.answer {
            let s = self.odometer + way - answer.from + 0.5 * step;
            if let Some(curvature) = curvature_at(&answer.segments, s) {
                // The way is to bend as the answer's does, though the planned direction may turn unevenly.
                let turning = answer.turning - turning(along.stations, along.s + way, step.max(f64::MIN_POSITIVE));
                return (curvature + along.sign * turning).clamp(-most, most);
            }
            self.answer = None;
        }
        self.pursuit.steer(measured, along)
    }

    /// Looks for a new answer from `from`, `way` m ahead; without one the last stays.
    fn resolve(&mut self, from: &Planar, way: f64, along: &Along) {
        let end = along.stations[along.stations.len() - 1].s;
        let (start, horizon) = (along.s + way, self.horizon(along.speed));
        let goal_at = (start + horizon).min(end);
        let distance = goal_at - start;
        if distance <= 0.0 {
            return;
        }
        let mut goal = station_at(along.stations, goal_at, along.sign);
        // Against the drift that is to be expected on the way there.
        let mut crab = 0.0;
        for pair in along.stations.windows(2).filter(|pair| pair[1].s > start && pair[0].s < goal_at) {
            let part = pair[1].s.min(goal_at) - pair[0].s.max(start);
            let [ahead, left] = self.drift(pair[0].rises);
            let (sin, cos) = libm::sincos(pair[0].at.yaw + heading(pair[0].direction, along.sign));
            goal.x -= part * (cos * ahead - sin * left);
            goal.y -= part * (sin * ahead + cos * left);
            crab = libm::atan(left);
        }
        if goal_at < end {
            goal.yaw -= crab;
        }
        goal.yaw = from.yaw + wrap(goal.yaw - from.yaw);
        let gear = if along.sign < 0.0 { Gear::Reverse } else { Gear::Forward };
        let [begins, ends] = [start, goal_at].map(|s| direction_at(along.stations, s));
        let direction = Direction { start: begins, end: ends };
        // An answer's direction turns evenly: what the plan's does otherwise at both ends is left to the body.
        let uneven = |s: f64| along.sign * (turning(along.stations, s, NEAR) - direction.rate(distance));
        let from = &Planar { curvature: from.curvature + uneven(start), ..*from };
        goal.curvature += uneven(goal_at - NEAR);
        let Some(segments) = (self.solve)(from, &goal, gear, direction) else { return };
        let drives = |s: &Segment| matches!(s.motion, Motion::Arc { .. }) && s.gear == gear;
        let length: f64 = segments.iter().map(|segment| segment.length_m()).sum();
        if segments.iter().all(drives) && length <= LONGEST * distance {
            self.answer = Some(Answer { segments, from: self.odometer + way, turning: direction.rate(length) });
        }
    }
}

/// Curvature `s` metres along the segments, 1/m; `None` beyond them.
fn curvature_at(segments: &SegmentList, mut s: f64) -> Option<f64> {
    for segment in segments.iter() {
        let length = segment.length_m();
        if s <= length {
            return Some(segment.curvature_at(s));
        }
        s -= length;
    }
    None
}
