//! Closes the loop over plant and controller, and drives a plan to its end.
//!
//! ```text
//! each turn (20 … 100 ms):   stand ─▶ ended? ─▶ log ─▶ controller (measured pose) ─▶ commands, latency late ─▶ plant
//! ```
//!
//! The plant is exact between turns: commands that come to act in between split the step.

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::command::{DriveCommand, DriveState};
use super::controllers::{Driver, GroundController, Guided};
use super::guide::Guide;
use super::plan::Plan;
use super::plant::{Lost, Plant, Stands};
use super::recorder::Recorder;
use super::sortie::{DriveSettings, GroundConditions, GroundSortie};
use super::watch::{PROGRESS, Watch};
use crate::math::random::{Stream, named_seed, standard_normals, stream};
use crate::robot::rover::Rover;
use crate::simulation::SimulationError;
use crate::simulation::controller::{Controlled, Controller, Misbehaviour, OwnController};
use crate::trajectory::drive::Planar;
use crate::trajectory::{Direction, Drive, Ended, Flight};

/// Way between two turns of the controller, m, and its shortest and longest period, s.
const TURN: f64 = 0.01;
const PERIODS: [f64; 2] = [0.02, 0.1];
/// Samples of the log for a drive that takes as long as it was planned.
const SAMPLES: f64 = 3000.0;
/// Standard deviations of the measured position, m, and yaw, rad.
const POSITION_NOISE: f64 = 0.01;
const YAW_NOISE: f64 = 0.3 * std::f64::consts::PI / 180.0;
/// Longest latency, s.
const LONGEST_LATENCY: f64 = 60.0;
/// Largest part of a steady force, N.
const MOST_FORCE: f64 = 1e6;

/// The period of controllers that have none of their own, s.
pub(super) fn usual_period(drive: &Drive) -> f64 {
    (TURN / drive.speed).clamp(PERIODS[0], PERIODS[1])
}

/// Drives one run by one of our controllers: the same bytes for the same arguments.
///
/// The run ends `linger` seconds after the plan is over (`done`, or `time` if a waypoint was missed), at the time
/// limit, or where the vehicle tips over (its margin falls below 0), sets its underside on the ground
/// (`belly-contact`), has no ground below it (`off-map`), finds no rest or gets nowhere (`stuck`), or comes within the
/// clearance radius of a place to keep out of (`obstacle`). A waypoint, the end of a leg, is reached if the vehicle
/// comes within `accept` of it while one of its two legs is driven.
///
/// The log has the channels `leg`, `vx_m_s`, `vy_m_s`, `vz_m_s`, `speed_m_s` (of the wheels, negative in reverse),
/// `curvature_1_m` (of the wheels), `commanded_curvature_1_m`, `slip` (share of the wheels' way that is lost), with
/// wheels `tip_over_margin_deg` and `belly_clearance_m` (the least since the sample before), with a rocker-bogie
/// `joint_rocker_rad`, `joint_left_bogie_rad`, `joint_right_bogie_rad`, with a weight `wheel_torque_n_m` (of each
/// wheel), and `travel_direction_rad` where the plan goes in another direction than straight ahead; about 3000 samples.
///
/// # Errors
/// Settings, latency or a drive out of bounds; a plan along which the nominal vehicle cannot stand; a start where the
/// true one cannot.
///
/// `seed` is for noise alone: without noise it changes nothing.
pub fn drive(
    sortie: &GroundSortie,
    controller: &GroundController,
    conditions: &GroundConditions,
    settings: &DriveSettings,
    seed: u64,
) -> Result<Flight, SimulationError> {
    let plan = Plan::new(sortie.nominal, sortie.terrain, sortie.drive)?;
    Checked::new(sortie, &plan, conditions, settings, seed)?.by_ours(controller)
}

/// [`drive`] by a controller of the caller's own, made afresh for the run; as reproducible as that is.
///
/// Without a schedule it goes from waypoint to waypoint, the ends of the plan's legs, and the run ends `linger` seconds
/// after it has reached the last; with one, once that is over and the vehicle stands.
///
/// # Errors
/// As [`drive`]; a period out of bounds; [`SimulationError::Controller`].
pub fn drive_with(
    sortie: &GroundSortie,
    controller: &OwnController<Rover>,
    conditions: &GroundConditions,
    settings: &DriveSettings,
    seed: u64,
) -> Result<Flight, SimulationError> {
    let plan = Plan::new(sortie.nominal, sortie.terrain, sortie.drive)?;
    let run = Checked::new(sortie, &plan, conditions, settings, seed)?;
    run.carry_out(controller.name(), &mut *controller.make(sortie.nominal))
}

/// A run whose settings are within bounds, and its plan.
///
/// `settings` have their time limit and patience filled in.
pub(super) struct Checked<'a> {
    sortie: &'a GroundSortie<'a>,
    conditions: &'a GroundConditions,
    settings: DriveSettings,
    plan: &'a Plan,
    latency: f64,
    /// Steady force as a share of the weight.
    pull: Vector3<f64>,
    seed: u64,
}

impl<'a> Checked<'a> {
    /// Errors name `latency`, `noise`, `start_offset`, `external_force` or `clearance_radius`.
    pub(super) fn new(
        sortie: &'a GroundSortie,
        plan: &'a Plan,
        conditions: &'a GroundConditions,
        settings: &DriveSettings,
        seed: u64,
    ) -> Result<Self, SimulationError> {
        settings.check()?;
        let latency = sortie.vehicle.response.latency + conditions.latency;
        if !(conditions.latency >= 0.0 && latency <= LONGEST_LATENCY) {
            return Err(SimulationError::new("latency", latency.to_string(), "from 0 to 60 s"));
        }
        if !(0.0..=1e3).contains(&conditions.noise) {
            return Err(SimulationError::new("noise", conditions.noise.to_string(), "from 0 to 1000"));
        }
        if let Some(off) = conditions.start_offset.iter().find(|off| off.is_nan() || off.abs() > 1e3) {
            return Err(SimulationError::new("start_offset", off.to_string(), "within ±1000"));
        }
        let pull = pull(sortie.vehicle, &conditions.external_force)?;
        if !(sortie.clearance_radius >= 0.0 && sortie.clearance_radius.is_finite()) {
            let value = sortie.clearance_radius.to_string();
            return Err(SimulationError::new("clearance_radius", value, "finite and ≥ 0 m"));
        }
        let patience = settings.patience.max(2.0 * plan.longest_rest(PROGRESS));
        let time_limit = settings.time_limit.unwrap_or(2.0 * plan.duration + 60.0);
        let settings = DriveSettings { patience, time_limit: Some(time_limit), ..*settings };
        Ok(Self { sortie, conditions, settings, plan, latency, pull, seed })
    }

    /// Drives to the end by one of our controllers.
    pub(super) fn by_ours(&self, controller: &GroundController) -> Result<Flight, SimulationError> {
        self.carry_out(controller.word(), &mut self.guided(controller))
    }

    /// One of our controllers, at the plan's begin.
    fn guided<'b>(&'b self, controller: &GroundController<'b>) -> Guided<'b> {
        let Self { sortie: GroundSortie { nominal, drive, .. }, plan, latency, .. } = self;
        Guided {
            guide: Guide::new(plan, nominal, *latency, [drive.speed, drive.turn_rate]),
            driver: Driver::new(controller, nominal, *latency),
        }
    }

    /// Drives to the end.
    ///
    /// Each turn: how it stands, whether the run ends, a sample if one is due, the controller's command, the plant
    /// until the next.
    fn carry_out(&self, name: &str, controller: &mut dyn Controller<Rover>) -> Result<Flight, SimulationError> {
        let mut run = Run::new(self, name, controller)?;
        let log_every = ((self.plan.duration / SAMPLES / run.period).round() as u64).max(1);
        let crabs = self.sortie.drive.legs.iter().any(|leg| leg.direction != Direction::default());
        let mut recorder = Recorder::new(self.sortie.vehicle, crabs);
        for tick in 0.. {
            let t = tick as f64 * run.period;
            let stands = run.plant.stands();
            if let Ok(stands) = &stands {
                run.watch.least = run.watch.least.least(stands);
            }
            run.watch.heed(run.controller.schedule());
            let ended = stands.map_or_else(|lost| Some(word(lost)), |_| run.note(t));
            if let Some(ended) = ended {
                // A body that hangs over the map's edge has no clearance to tell.
                let _ = run.record(&mut recorder, t);
                let reached = run.watch.into_reached();
                return Ok(Flight { track: recorder.into_track(), ended, left_world: None, reached });
            }
            if tick % log_every == 0 {
                match run.record(&mut recorder, t) {
                    Ok(()) => run.watch.least = Stands::FREE,
                    Err(lost) => run.lost = Some(lost),
                }
            }
            run.turn(t)?;
        }
        unreachable!("the time limit ends every run")
    }
}

/// `force` (N, world axes) as a share of the vehicle's weight.
///
/// Without unit; world axes east, north, up.
fn pull(vehicle: &Rover, force: &[f64; 3]) -> Result<Vector3<f64>, SimulationError> {
    let told = || format!("{force:?}");
    if force.iter().any(|part| part.is_nan() || part.abs() > MOST_FORCE) {
        return Err(SimulationError::new("external_force", told(), "within ±1e6 N"));
    }
    match &vehicle.weight {
        Some(weight) => Ok(Vector3::from(*force) / weight.newtons()),
        None if *force == [0.0; 3] => Ok(Vector3::zeros()),
        None => Err(SimulationError::new("external_force", told(), "on a vehicle with a weight (forces)")),
    }
}

/// `off-map` without ground, `stuck` without rest.
fn word(lost: Lost) -> Ended {
    match lost {
        Lost::NoGround => Ended::OffMap,
        Lost::NoRest => Ended::Stuck,
    }
}

/// Plant, controller and commands of one run.
///
/// `coming` holds commands that do not act yet, in the order in which they do.
struct Run<'a> {
    plant: Plant<'a>,
    name: &'a str,
    controller: &'a mut dyn Controller<Rover>,
    watch: Watch<'a>,
    /// And how much of it.
    noise: Option<(Stream, f64)>,
    latency: f64,
    period: f64,
    /// What acts, and what will: when it does, s.
    acting: DriveCommand,
    coming: VecDeque<(f64, DriveCommand)>,
    lost: Option<Lost>,
}

impl<'a> Run<'a> {
    /// Errors name the leg's start where the vehicle cannot stand there, and periods out of 0.001 … 1 s.
    fn new(
        checked: &'a Checked,
        name: &'a str,
        controller: &'a mut dyn Controller<Rover>,
    ) -> Result<Self, SimulationError> {
        let Checked { sortie, conditions, settings, plan, latency, pull, seed } = checked;
        let first = &sortie.drive.legs[0];
        let direction = first.direction.start;
        let start = beside(&first.from, &conditions.start_offset);
        let mut plant = Plant::new(sortie.vehicle, sortie.terrain, direction, &start).map_err(|_| {
            let value = format!("({}, {})", start.x, start.y);
            SimulationError::new("drive.legs[0].from", value, "a place where the vehicle can stand")
        })?;
        plant.pull = *pull;
        let period = controller.period().unwrap_or_else(|| usual_period(sortie.drive));
        if !(0.001..=1.0).contains(&period) {
            let value = format!("{period} ({name})");
            return Err(SimulationError::new("controller.period", value, "from 0.001 to 1 s"));
        }
        let watch = Watch::new(sortie, settings, &plan.track, [plant.x, plant.y, plant.yaw]);
        let run = Self {
            plant,
            name,
            controller,
            watch,
            noise: (conditions.noise > 0.0).then(|| (stream(named_seed(*seed, "pose", 0)), conditions.noise)),
            latency: *latency,
            period,
            acting: DriveCommand { curvature: start.curvature, direction, ..DriveCommand::default() },
            coming: VecDeque::new(),
            lost: None,
        };
        let begun = run.controller.reset(&run.watch.reference());
        begun.map_err(|fault| run.failed(0.0, fault))?;
        Ok(run)
    }

    /// The controller by name, when (s), and why.
    fn failed(&self, t: f64, why: impl Into<Misbehaviour>) -> SimulationError {
        SimulationError::Controller { name: self.name.into(), t, why: why.into() }
    }

    /// The controller's turn at `t`, and the plant until the next.
    ///
    /// A command acts `latency` s after it was given, also between turns: the plant is advanced from one such moment to
    /// the next.
    fn turn(&mut self, t: f64) -> Result<(), SimulationError> {
        let measured = self.measure(t);
        let asked = self.controller.control(self.period, &measured, &self.watch.reference());
        let command = asked.map_err(|fault| self.failed(t, fault))?;
        if !Rover::is_finite(&command) {
            return Err(self.failed(t, Misbehaviour::NotFinite { command: format!("{command:?}") }));
        }
        self.coming.push_back((t + self.latency, command));
        let (mut now, end) = (t, t + self.period);
        while now < end && self.lost.is_none() {
            while self.coming.front().is_some_and(|(acts, _)| *acts <= now) {
                self.acting = self.coming.pop_front().map_or(self.acting, |(_, command)| command);
            }
            let until = self.coming.front().map_or(end, |(acts, _)| acts.min(end));
            self.lost = self.plant.advance(&self.acting, until - now).err();
            now = until;
        }
        Ok(())
    }

    /// The plant's state, with white noise on x, y (1 cm) and ψ (0.3°) by as much as the run has: three normals a turn.
    fn measure(&mut self, t: f64) -> DriveState {
        let plant = &self.plant;
        let mut at = Planar { x: plant.x, y: plant.y, yaw: plant.yaw, curvature: plant.curvature() };
        if let Some((noise, share)) = &mut self.noise {
            let [x, y, yaw] = standard_normals(noise);
            let (position, turn) = (*share * POSITION_NOISE, *share * YAW_NOISE);
            (at.x, at.y, at.yaw) = (at.x + position * x, at.y + position * y, at.yaw + turn * yaw);
        }
        DriveState {
            t,
            at,
            height: plant.pose.z,
            speed: plant.speed,
            turn_rate: plant.turn_rate,
            lean: [plant.pose.roll, plant.pose.pitch],
            direction: plant.direction,
        }
    }

    /// Whether the run ends at `t`.
    fn note(&mut self, t: f64) -> Option<Ended> {
        self.lost.map(word).or_else(|| self.watch.note(t, &self.plant))
    }

    /// A sample with the least margins since the one before.
    fn record(&self, recorder: &mut Recorder, t: f64) -> Result<(), Lost> {
        recorder.push(t, &self.plant, self.watch.leg(), self.acting.curvature, &self.watch.least)
    }
}

/// `pose` moved in its own frame, m and rad.
fn beside(pose: &Planar, [forward, left, yaw]: &[f64; 3]) -> Planar {
    let (sin, cos) = libm::sincos(pose.yaw);
    Planar {
        x: pose.x + cos * forward - sin * left,
        y: pose.y + sin * forward + cos * left,
        yaw: pose.yaw + yaw,
        ..*pose
    }
}
