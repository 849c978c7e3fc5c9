//! A run in flight: what is due when, until the run ends or its course halts.

use nalgebra::Point3;

use std::collections::VecDeque;

use super::SimulationError;
use super::close_loop::{ClosedLoop, FlySettings, Sortie};
use super::command::FlightCommand;
use super::controller::{Controlled, Controller, Misbehaviour, OwnController};
use super::controllers::{ControllerSettings, Pilot};
use super::course::Course;
use super::disturbance::Conditions;
use super::hazard::{Hazards, is_lost};
use super::recorder::Recorder;
use crate::robot::quadrotor::Quadrotor;
use crate::trajectory::{Ended, Flight, Profile};
use crate::world::World;

/// Time between two looks at waypoints and hazards, s.
const WATCH_PERIOD: f64 = 0.01;
/// Time between two turns of a controller that has no period of its own, s.
const PERIOD: f64 = 0.01;

/// Flies one run by one of our controllers: the same bytes for the same arguments.
///
/// The run ends `linger` seconds after its course is over, at the time limit, or at a crash: below the ground (z < 0; a
/// take-off from the floor may dip), the robot's clearance radius in an obstacle, body z downwards for more than
/// 0.5 s or a state that is no longer finite (`tumble`), outside the world's sides or ceiling with `walls`. The log has
/// the channels of [`Flight`], and body rates; `saturated` is the share of rotors at a limit since the sample before.
///
/// # Errors
/// Settings out of bounds; fewer than two waypoints or one that is not finite; a profile with another number of legs; a
/// rotor layout that cannot hover; a course without a minimum-snap curve where one is needed.
pub fn fly(
    sortie: &Sortie,
    controller: &ControllerSettings,
    conditions: &Conditions,
    settings: &FlySettings,
    seed: u64,
) -> Result<Flight, SimulationError> {
    let run = Run::through(sortie, conditions, settings, seed)?;
    let mut pilot = Pilot::new(controller, sortie.robot)?;
    run.fly(sortie, controller.kind.word(), &mut pilot)
}

/// [`fly`] by a controller of the caller's own, made afresh for the run; as reproducible as that is.
///
/// # Errors
/// As [`fly`]; a period out of bounds; [`SimulationError::Controller`].
pub fn fly_with(
    sortie: &Sortie,
    controller: &OwnController<Quadrotor>,
    conditions: &Conditions,
    settings: &FlySettings,
    seed: u64,
) -> Result<Flight, SimulationError> {
    let run = Run::through(sortie, conditions, settings, seed)?;
    run.fly(sortie, controller.name(), &mut *controller.make(sortie.robot))
}

/// Loops, course and log of a run, without its controller.
///
/// Copied it flies on alike: everything that the future depends on is in it, but for the controller.
#[derive(Debug, Clone)]
pub(super) struct Run {
    loops: ClosedLoop,
    /// What was reached.
    pub(super) course: Course,
    hazards: Hazards,
    /// The log so far.
    pub(super) recorder: Recorder,
    settings: FlySettings,
    /// Ticks between two looks at the course, two samples of the log, two turns of the outer loop; and those to the
    /// next.
    every: Due,
    to: Due,
    tick: u64,
    /// Commands that do not act yet, and the ticks at which each will, for so many seconds.
    late: VecDeque<(u64, f64, FlightCommand)>,
    /// Why it ended, once it did.
    pub(super) ended: Option<Ended>,
}

/// Ticks.
#[derive(Debug, Clone, Copy)]
struct Due {
    watch: u64,
    log: u64,
    turn: u64,
}

/// Who flies, and by which plan.
///
/// Lent for a call: the controller outlives the run where it is the caller's.
pub(super) struct Hand<'a> {
    /// As errors name it.
    pub(super) name: &'a str,
    pub(super) controller: &'a mut dyn Controller<Quadrotor>,
    /// The planned motion, for those that follow one.
    pub(super) plan: Option<&'a Profile>,
}

impl Hand<'_> {
    fn failed(&self, t: f64, why: impl Into<Misbehaviour>) -> SimulationError {
        SimulationError::Controller { name: self.name.into(), t, why: why.into() }
    }
}

impl Run {
    /// At the start of `sortie`, whose course is known.
    fn through(
        sortie: &Sortie,
        conditions: &Conditions,
        settings: &FlySettings,
        seed: u64,
    ) -> Result<Self, SimulationError> {
        check_course(sortie)?;
        let course = Course::new(sortie.waypoints, settings.accept);
        let recorder = Recorder::new((settings.time_limit / settings.log_period) as usize + 2);
        Self::new(sortie, (course, recorder), conditions, settings, seed)
    }

    /// At the start of `course`, at rest and hovering.
    pub(super) fn new(
        sortie: &Sortie,
        (course, recorder): (Course, Recorder),
        conditions: &Conditions,
        settings: &FlySettings,
        seed: u64,
    ) -> Result<Self, SimulationError> {
        settings.check()?;
        conditions.check()?;
        let loops = ClosedLoop::new(sortie, conditions, settings, seed)?;
        let hazards = Hazards::new(sortie.robot.clearance_radius, settings, &sortie.waypoints[0].coords);
        let to = Due { watch: 0, log: 0, turn: 0 };
        let mut run = Self {
            loops,
            course,
            hazards,
            recorder,
            settings: *settings,
            every: to,
            to,
            tick: 0,
            late: VecDeque::new(),
            ended: None,
        };
        run.every =
            Due { watch: run.ticks(WATCH_PERIOD), log: run.ticks(settings.log_period), turn: run.ticks(PERIOD) };
        Ok(run)
    }

    /// The whole run.
    fn fly(
        mut self,
        sortie: &Sortie,
        name: &str,
        controller: &mut dyn Controller<Quadrotor>,
    ) -> Result<Flight, SimulationError> {
        let mut hand = Hand { name, controller, plan: sortie.profile };
        self.begin(&mut hand)?;
        self.fly_on(&mut hand, sortie.world)?;
        Ok(self.into_flight())
    }

    /// Hands the course over.
    pub(super) fn begin(&mut self, hand: &mut Hand) -> Result<(), SimulationError> {
        let period = hand.controller.period().unwrap_or(PERIOD);
        if !(0.001..=1.0).contains(&period) {
            let value = format!("{period} ({})", hand.name);
            return Err(SimulationError::new("controller.period", value, "from 0.001 to 1 s"));
        }
        self.every.turn = self.ticks(period);
        self.course.accept_as(hand.controller.acceptance());
        let begun = hand.controller.reset(&self.course.reference(hand.plan));
        begun.map_err(|fault| hand.failed(0.0, fault))
    }

    /// Flies until the run ends or its course halts.
    pub(super) fn fly_on(&mut self, hand: &mut Hand, world: &World) -> Result<(), SimulationError> {
        while self.ended.is_none() {
            let t = self.tick as f64 * self.loops.period;
            if self.to.watch == 0 {
                let position = self.loops.position();
                self.course.note(t, &position, hand.controller.schedule());
                if self.course.halts() {
                    return Ok(());
                }
                self.to.watch = self.every.watch;
                self.ended = self.hazards.note(world, t, &position, self.loops.up()).or(self.end_of_time(t));
                if self.ended.is_some() {
                    self.loops.record(&mut self.recorder, t, self.course.leg());
                    return Ok(());
                }
            }
            if self.to.log == 0 {
                self.to.log = self.every.log;
                self.loops.record(&mut self.recorder, t, self.course.leg());
            }
            if self.to.turn == 0 {
                self.to.turn = self.every.turn;
                self.turn(hand, t)?;
            }
            let late = self.act();
            let ticks = self.to.watch.min(self.to.log).min(self.to.turn).min(late);
            self.to = Due { watch: self.to.watch - ticks, log: self.to.log - ticks, turn: self.to.turn - ticks };
            self.tick += ticks;
            self.loops.fly_at(self.settings.simd, ticks);
        }
        Ok(())
    }

    /// The controller's turn.
    ///
    /// A command that is not finite is an error, unless the state itself was lost already.
    fn turn(&mut self, hand: &mut Hand, t: f64) -> Result<(), SimulationError> {
        let dt = self.every.turn as f64 * self.loops.period;
        let state = self.loops.state(t);
        match hand.controller.control(dt, &state, &self.course.reference(hand.plan)) {
            Err(fault) => return Err(hand.failed(t, fault)),
            // Who is told what is no number, or next to none, may answer alike: the next look ends that run.
            Ok(ref command) if !Quadrotor::is_finite(command) && !is_lost(&state.position, self.loops.up()) => {
                return Err(hand.failed(t, Misbehaviour::NotFinite { command: format!("{command:?}") }));
            }
            Ok(ref command) if self.settings.latency == 0.0 => self.loops.follow(dt, &state, command),
            Ok(command) => {
                let latency = (self.settings.latency / self.loops.period).round() as u64;
                self.late.push_back((self.tick + latency, dt, command));
            }
        }
        Ok(())
    }

    /// Has the commands act whose time has come; ticks to the next.
    fn act(&mut self) -> u64 {
        while let Some(&(due, dt, command)) = self.late.front() {
            if due > self.tick {
                return due - self.tick;
            }
            self.late.pop_front();
            let state = self.loops.state(self.tick as f64 * self.loops.period);
            self.loops.follow(dt, &state, &command);
        }
        u64::MAX
    }

    /// The course's own end and what lingers after it, else the time limit.
    fn end_of_time(&self, t: f64) -> Option<Ended> {
        let rounding = 1e-9;
        if self.course.over().is_some_and(|over| t >= over + self.settings.linger - rounding) {
            return Some(self.course.outcome());
        }
        (t >= self.settings.time_limit - rounding).then_some(Ended::Time)
    }

    /// Whole ticks of the rate loop nearest to `period` s, at least one.
    fn ticks(&self, period: f64) -> u64 {
        ((period / self.loops.period).round() as u64).max(1)
    }

    /// The flight so far; one that was halted counts as done.
    pub(super) fn into_flight(self) -> Flight {
        Flight {
            track: self.recorder.into_track(),
            ended: self.ended.unwrap_or(Ended::Done),
            left_world: self.hazards.left_world(),
            reached: self.course.into_reached(),
        }
    }
}

/// Two waypoints or more, all finite, and one leg of the profile between each two.
fn check_course(sortie: &Sortie) -> Result<(), SimulationError> {
    let points = sortie.waypoints;
    if points.len() < 2 {
        return Err(SimulationError::new("waypoints", points.len().to_string(), "at least two"));
    }
    check_finite(points)?;
    match sortie.profile {
        Some(profile) if profile.legs.len() + 1 != points.len() => {
            let found = format!("{} legs for {} waypoints", profile.legs.len(), points.len());
            Err(SimulationError::new("profile", found, "one leg between each two waypoints"))
        }
        _ => Ok(()),
    }
}

/// Whether waypoints can be flown to.
pub(super) fn check_finite(points: &[Point3<f64>]) -> Result<(), SimulationError> {
    match points.iter().find(|point| !point.iter().all(|c| c.is_finite())) {
        Some(point) => Err(SimulationError::new("waypoints", format!("{:?}", point.coords.as_slice()), "finite")),
        None => Ok(()),
    }
}
