//! Closes the loop over plant and controller, and drives a plan to its end.

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::controllers::{Driver, GroundController};
use super::guide::{Guide, Measured, Task};
use super::plan::Plan;
use super::plant::{Command, Lost, Plant, Stands};
use super::recorder::Recorder;
use crate::math::power::square;
use crate::math::random::{Stream, named_seed, standard_normals, stream};
use crate::robot::rover::Rover;
use crate::simulation::SimulationError;
use crate::trajectory::drive::Planar;
use crate::trajectory::{Direction, Drive, Ended, Flight};
use crate::world::terrain::{ElevationMap, KeepOuts};

/// What drives where.
///
/// `vehicle` and `nominal` are the same type: what the planner was told, and what is true.
#[derive(Debug, Clone, Copy)]
pub struct GroundSortie<'a> {
    /// The vehicle as it is: its slip, its latency and its lags act.
    pub vehicle: &'a Rover,
    /// The vehicle as it was planned with, which is all that controllers know.
    pub nominal: &'a Rover,
    /// The ground.
    pub terrain: &'a ElevationMap,
    /// Where it must not go.
    pub keep_outs: &'a KeepOuts,
    /// The body's origin keeps this far off them, m, ≥ 0.
    pub clearance_radius: f64,
    /// The plan. The run starts at rest at its first pose, or beside it.
    pub drive: &'a Drive,
}

/// What is added to the vehicle's own imperfections.
///
/// The default adds nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GroundConditions {
    /// A command acts this much later, s, on top of the vehicle's own latency.
    pub latency: f64,
    /// Steady force on the vehicle, at its centre of mass, N: east, north, up. The vehicle must have a weight for it.
    pub external_force: [f64; 3],
    /// Whether controllers see a pose with white noise: 1 cm along each axis, 0.3° of yaw, standard deviations.
    pub noise: bool,
    /// Where the run starts, in the frame of the plan's first pose: forward and left, m, and yaw, rad.
    pub start_offset: [f64; 3],
}

/// How a drive is simulated, ended and logged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveSettings {
    /// A waypoint counts as reached inside this distance over the ground plan, m.
    pub accept: f64,
    /// A run ends here, s; `None`: at twice the plan's duration and a minute more.
    pub time_limit: Option<f64>,
    /// Time after the end of the plan that belongs to the run, s.
    pub linger: f64,
    /// A run whose plan is not over ends `stuck` if the body moves less than 1 cm and 1° in this time, s, or in twice the longest that the plan
    /// takes for that, where it is longer.
    pub patience: f64,
}

impl Default for DriveSettings {
    fn default() -> Self {
        Self { accept: 0.25, time_limit: None, linger: 1.0, patience: 30.0 }
    }
}

impl DriveSettings {
    fn check(&self) -> Result<(), SimulationError> {
        let limit = self.time_limit.unwrap_or(1.0);
        for (field, value) in [("accept", self.accept), ("time_limit", limit), ("patience", self.patience)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(SimulationError::new(field, value.to_string(), "finite and > 0"));
            }
        }
        if !(self.linger.is_finite() && self.linger >= 0.0) {
            return Err(SimulationError::new("linger", self.linger.to_string(), "finite and ≥ 0 s"));
        }
        Ok(())
    }
}

/// Way between two turns of the controller, m, and its shortest and longest period, s.
const TURN: f64 = 0.01;
const PERIODS: [f64; 2] = [0.02, 0.1];
/// Samples of the log for a drive that takes as long as it was planned.
const SAMPLES: f64 = 3000.0;
/// Standard deviations of the measured position, m, and yaw, rad.
const POSITION_NOISE: f64 = 0.01;
const YAW_NOISE: f64 = 0.3 * std::f64::consts::PI / 180.0;
/// Less than this is no progress, m and rad.
const PROGRESS: [f64; 2] = [0.01, std::f64::consts::PI / 180.0];
/// Longest latency, s.
const LONGEST_LATENCY: f64 = 60.0;
/// Largest part of a steady force, N.
const MOST_FORCE: f64 = 1e6;

/// Drives one run: the same bytes for the same arguments.
///
/// The run ends `linger` seconds after the plan is over (`done`, or `time` if a waypoint was missed), at the time limit, or
/// where the vehicle tips over (its margin falls below 0), sets its underside on the ground (`belly-contact`), has no ground below
/// it (`off-map`), finds no rest or gets nowhere
/// (`stuck`), or comes within the clearance radius of a place to keep out of (`obstacle`). A waypoint, the end of a leg, is
/// reached if the vehicle comes within `accept` of it while one of its two legs is driven.
///
/// The log has the channels `leg`, `vx_m_s`, `vy_m_s`, `vz_m_s`, `speed_m_s` (of the wheels, negative in reverse),
/// `curvature_1_m` (of the wheels), `commanded_curvature_1_m`, `slip` (share of the wheels' way that is lost), with wheels
/// `tip_over_margin_deg` and `belly_clearance_m` (the least since the sample before), with a rocker-bogie `joint_rocker_rad`,
/// `joint_left_bogie_rad`, `joint_right_bogie_rad`, with a weight `wheel_torque_n_m` (of each wheel), and `travel_direction_rad` where the
/// plan goes in another direction than straight ahead; about 3000 samples.
///
/// # Errors
/// Settings, latency or a drive out of bounds; a plan along which the nominal vehicle cannot stand; a start where the true
/// one cannot.
pub fn drive(
    sortie: &GroundSortie,
    controller: &GroundController,
    conditions: &GroundConditions,
    settings: &DriveSettings,
    seed: u64,
) -> Result<Flight, SimulationError> {
    settings.check()?;
    let latency = sortie.vehicle.response.latency + conditions.latency;
    if !(conditions.latency >= 0.0 && latency <= LONGEST_LATENCY) {
        return Err(SimulationError::new("latency", latency.to_string(), "from 0 to 60 s"));
    }
    if let Some(off) = conditions.start_offset.iter().find(|off| off.is_nan() || off.abs() > 1e3) {
        return Err(SimulationError::new("start_offset", off.to_string(), "within ±1000"));
    }
    let pull = pull(sortie.vehicle, &conditions.external_force)?;
    if !(sortie.clearance_radius >= 0.0 && sortie.clearance_radius.is_finite()) {
        let value = sortie.clearance_radius.to_string();
        return Err(SimulationError::new("clearance_radius", value, "finite and ≥ 0 m"));
    }
    let plan = Plan::new(sortie.nominal, sortie.terrain, sortie.drive)?;
    let mut run = Run::new(sortie, controller, conditions, &plan, latency, seed)?;
    run.plant.pull = pull;
    let log_every = ((plan.duration / SAMPLES / run.period).round() as u64).max(1);
    let time_limit = settings.time_limit.unwrap_or(2.0 * plan.duration + 60.0);
    let crabs = sortie.drive.legs.iter().any(|leg| leg.direction != Direction::default());
    let mut recorder = Recorder::new(sortie.vehicle, crabs);
    let patience = settings.patience.max(2.0 * plan.longest_rest(PROGRESS));
    let settings = &DriveSettings { patience, ..*settings };
    let mut watch = Watch::new(sortie, settings, time_limit, [run.plant.x, run.plant.y, run.plant.yaw]);
    for tick in 0.. {
        let t = tick as f64 * run.period;
        let stands = run.plant.stands();
        if let Ok(stands) = &stands {
            watch.least = watch.least.least(stands);
        }
        let ended = stands.map_or_else(|lost| Some(word(lost)), |_| watch.note(t, &run));
        if let Some(ended) = ended {
            // A body that hangs over the map's edge has no clearance to tell.
            let _ = run.record(&mut recorder, t, &watch.least);
            return Ok(Flight { track: recorder.into_track(), ended, left_world: None, reached: watch.reached });
        }
        if tick % log_every == 0 {
            match run.record(&mut recorder, t, &watch.least) {
                Ok(()) => watch.least = Stands::FREE,
                Err(lost) => run.lost = Some(lost),
            }
        }
        run.turn(t);
    }
    unreachable!("the time limit ends every run")
}

/// `force` (N, world axes) as a share of the vehicle's weight.
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

fn word(lost: Lost) -> Ended {
    match lost {
        Lost::NoGround => Ended::OffMap,
        Lost::NoRest => Ended::Stuck,
    }
}

/// Plant, controller and commands of one run.
struct Run<'a> {
    plant: Plant<'a>,
    guide: Guide<'a>,
    driver: Driver<'a>,
    noise: Option<Stream>,
    latency: f64,
    period: f64,
    /// What acts, and what will: when it does, s.
    acting: Command,
    coming: VecDeque<(f64, Command)>,
    lost: Option<Lost>,
}

impl<'a> Run<'a> {
    fn new(
        sortie: &GroundSortie<'a>,
        controller: &GroundController<'a>,
        conditions: &GroundConditions,
        plan: &'a Plan,
        latency: f64,
        seed: u64,
    ) -> Result<Self, SimulationError> {
        let Drive { legs, speed, turn_rate } = sortie.drive;
        let direction = legs[0].direction.start;
        let start = beside(&legs[0].from, &conditions.start_offset);
        let plant = Plant::new(sortie.vehicle, sortie.terrain, direction, &start).map_err(|_| {
            let value = format!("({}, {})", start.x, start.y);
            SimulationError::new("drive.legs[0].from", value, "a place where the vehicle can stand")
        })?;
        Ok(Self {
            plant,
            guide: Guide::new(plan, sortie.nominal, latency, [*speed, *turn_rate]),
            driver: Driver::new(controller, sortie.nominal, latency),
            noise: conditions.noise.then(|| stream(named_seed(seed, "pose", 0))),
            latency,
            period: (TURN / speed).clamp(PERIODS[0], PERIODS[1]),
            acting: Command { curvature: start.curvature, direction, ..Command::default() },
            coming: VecDeque::new(),
            lost: None,
        })
    }

    /// The controller's turn at `t`, and the plant until the next.
    fn turn(&mut self, t: f64) {
        let measured = self.measure(t);
        let command = match self.guide.task(&measured, self.period) {
            Task::Hold(command) => command,
            Task::Follow(along) => {
                let curvature = self.driver.steer(&measured, &along, self.period);
                Command { speed: along.sign * along.speed, curvature, turn_rate: 0.0, direction: along.direction }
            }
        };
        self.driver.note(&measured, &command);
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
    }

    fn measure(&mut self, t: f64) -> Measured {
        let plant = &self.plant;
        let mut at = Planar { x: plant.x, y: plant.y, yaw: plant.yaw, curvature: plant.curvature() };
        if let Some(noise) = &mut self.noise {
            let [x, y, yaw] = standard_normals(noise);
            (at.x, at.y, at.yaw) = (at.x + POSITION_NOISE * x, at.y + POSITION_NOISE * y, at.yaw + YAW_NOISE * yaw);
        }
        let lean = [plant.pose.roll, plant.pose.pitch];
        Measured { t, at, speed: plant.speed, lean, direction: plant.direction }
    }

    fn record(&self, recorder: &mut Recorder, t: f64, least: &Stands) -> Result<(), Lost> {
        recorder.push(t, &self.plant, self.guide.leg(), self.acting.curvature, least)
    }
}

fn beside(pose: &Planar, [forward, left, yaw]: &[f64; 3]) -> Planar {
    let (sin, cos) = libm::sincos(pose.yaw);
    Planar {
        x: pose.x + cos * forward - sin * left,
        y: pose.y + sin * forward + cos * left,
        yaw: pose.yaw + yaw,
        ..*pose
    }
}

/// Waypoints reached, and what ends a run.
struct Watch<'a> {
    sortie: &'a GroundSortie<'a>,
    settings: &'a DriveSettings,
    time_limit: f64,
    waypoints: Vec<[f64; 2]>,
    reached: Vec<Option<f64>>,
    over: Option<f64>,
    /// Where the body was when it last moved on: s; x, y, ψ.
    moved: (f64, [f64; 3]),
    before: [f64; 2],
    /// How it stood at its worst since the last sample.
    least: Stands,
}

impl<'a> Watch<'a> {
    fn new(sortie: &'a GroundSortie<'a>, settings: &'a DriveSettings, time_limit: f64, place: [f64; 3]) -> Self {
        let legs = &sortie.drive.legs;
        let ends = legs.iter().map(|leg| [leg.to.x, leg.to.y]);
        let start = legs[0].from;
        let waypoints: Vec<[f64; 2]> = std::iter::once([start.x, start.y]).chain(ends).collect();
        let mut reached = vec![None; waypoints.len()];
        reached[0] = Some(0.0);
        Self {
            sortie,
            settings,
            time_limit,
            waypoints,
            reached,
            over: None,
            moved: (0.0, place),
            before: [place[0], place[1]],
            least: Stands::FREE,
        }
    }

    /// Takes note of the run at `t`, and says whether it ends there.
    fn note(&mut self, t: f64, run: &Run) -> Option<Ended> {
        if let Some(lost) = run.lost {
            return Some(word(lost));
        }
        if self.least.margin < 0.0 {
            return Some(Ended::TipOver);
        }
        if self.least.clearance < 0.0 {
            return Some(Ended::BellyContact);
        }
        let at = [run.plant.x, run.plant.y];
        let before = std::mem::replace(&mut self.before, at);
        if self.sortie.keep_outs.segment_distance(before, at) <= self.sortie.clearance_radius {
            return Some(Ended::Obstacle);
        }
        let leg = run.guide.leg();
        for k in leg..=leg + 1 {
            let off = square(self.waypoints[k][0] - at[0]) + square(self.waypoints[k][1] - at[1]);
            if self.reached[k].is_none() && off <= square(self.settings.accept) {
                self.reached[k] = Some(t);
            }
        }
        if run.guide.over() && run.plant.speed == 0.0 && self.over.is_none() {
            self.over = Some(t);
        }
        let rounding = 1e-9;
        if self.over.is_some_and(|over| t >= over + self.settings.linger - rounding) {
            return Some(if self.reached.iter().all(Option::is_some) { Ended::Done } else { Ended::Time });
        }
        if t >= self.time_limit - rounding {
            return Some(Ended::Time);
        }
        let place = [at[0], at[1], run.plant.yaw];
        let way = (square(place[0] - self.moved.1[0]) + square(place[1] - self.moved.1[1])).sqrt();
        if way > PROGRESS[0] || (place[2] - self.moved.1[2]).abs() > PROGRESS[1] || self.over.is_some() {
            self.moved = (t, place);
        }
        (t - self.moved.0 > self.settings.patience).then_some(Ended::Stuck)
    }
}
