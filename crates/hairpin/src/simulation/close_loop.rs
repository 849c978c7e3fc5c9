//! Closes the loop over plant and controller.
//!
//! Three clocks, all whole multiples of the physics' step: physics, rate loop (about 1 ms), outer loop (the
//! controller's own). Looks at waypoints and hazards and the log have theirs.
//!
//! ```text
//! physics   h            plant: rigid body, rotors, drag                         FlySettings::step
//! rates     ≈ 1 ms       body rates → moments → mixer → rotor speeds              whole multiple of h
//! outer     controller   waypoints or plan → command                             the controller's own period
//! ```

use multiversion::multiversion;
use nalgebra::{Point3, Quaternion, UnitQuaternion, Vector3};
use wide::f64x4;

use super::SimulationError;
use super::command::{FlightCommand, FlightState};
use super::disturbance::{Conditions, Disturbances};
use super::inner_loop::InnerLoop;
use super::lanes::vector;
use super::plant::Plant;
use super::recorder::Recorder;
use super::step::{Motion, Stepper};
use crate::math::simd::Simd;
use crate::robot::quadrotor::Quadrotor;
use crate::trajectory::Profile;
use crate::world::World;

/// Nominal period of the rate loop, s (FlightGoggles: 960 Hz).
const INNER_PERIOD: f64 = 0.001;

/// What flies where.
///
/// `profile`, where there is one, has one leg fewer than `waypoints` has points.
#[derive(Debug, Clone, Copy)]
pub struct Sortie<'a> {
    /// The robot.
    pub robot: &'a Quadrotor,
    /// The space.
    pub world: &'a World,
    /// Both ends included, m, at least two. The run starts at the first, at rest and hovering.
    pub waypoints: &'a [Point3<f64>],
    /// The planned motion through them, one leg between each two, for controllers that track it.
    pub profile: Option<&'a Profile>,
}

/// How a run is simulated, ended and logged.
///
/// Numbers out of bounds are an error that names the field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlySettings {
    /// Step of the physics, s: 1e-5 … 1e-3.
    pub step: f64,
    /// Time between two samples of the log, s, rounded to whole milliseconds.
    pub log_period: f64,
    /// A waypoint counts as reached inside this radius, m.
    pub accept: f64,
    /// A run ends here, s.
    pub time_limit: f64,
    /// Time after the last waypoint that belongs to the run, s.
    pub linger: f64,
    /// Whether leaving the world is a crash.
    pub walls: bool,
    /// Whether an obstacle that is touched is one.
    pub obstacles: bool,
    /// Time from what a controller is told to its command in force, s, rounded to ticks of the rate loop.
    pub latency: f64,
    /// Version of the ticks to run.
    pub simd: Simd,
}

impl Default for FlySettings {
    fn default() -> Self {
        Self {
            step: 0.001,
            log_period: 0.01,
            accept: 1.0,
            time_limit: 90.0,
            linger: 2.0,
            walls: false,
            obstacles: true,
            latency: 0.0,
            simd: Simd::default(),
        }
    }
}

impl FlySettings {
    /// Ranges as the fields say.
    pub(super) fn check(&self) -> Result<(), SimulationError> {
        if !(1e-5..=1e-3).contains(&self.step) {
            return Err(SimulationError::new("step", self.step.to_string(), "from 1e-5 to 1e-3 s"));
        }
        if !(0.0..=1.0).contains(&self.latency) {
            return Err(SimulationError::new("latency", self.latency.to_string(), "from 0 to 1 s"));
        }
        let positive = [("log_period", self.log_period), ("accept", self.accept), ("time_limit", self.time_limit)];
        SimulationError::unless_timed(&positive, self.linger)
    }
}

/// Ticks of the rate loop until something else is due. Three-operand instructions save a quarter of them; nothing is
/// contracted or reordered, so the bits are the same at either level.
#[multiversion(targets("x86_64+avx"))]
fn fly_on(run: &mut ClosedLoop, ticks: u64) {
    run.fly_on(ticks);
}

/// Plant, disturbances and loops of one run.
#[derive(Debug, Clone)]
pub(super) struct ClosedLoop {
    plant: Plant,
    stepper: Stepper,
    motion: Motion,
    disturbances: Disturbances,
    inner: InnerLoop,
    /// Time between two ticks of the rate loop, s, and physics steps in it.
    pub(super) period: f64,
    steps: u32,
    /// Rotors at a limit since the last sample, summed over ticks, and those ticks.
    at_limit: u64,
    ticks: u64,
}

impl ClosedLoop {
    /// Errors: a robot whose rotors cannot hover and turn about every axis.
    pub(super) fn new(
        sortie: &Sortie,
        conditions: &Conditions,
        settings: &FlySettings,
        seed: u64,
    ) -> Result<Self, SimulationError> {
        let robot = sortie.robot;
        let steps = ((INNER_PERIOD / settings.step).round() as u32).max(1);
        let period = steps as f64 * settings.step;
        let inner = InnerLoop::new(robot, period).ok_or_else(|| {
            SimulationError::new(
                "robot.rotors",
                robot.name.clone(),
                "a layout that can hover and turn about every axis",
            )
        })?;
        let plant = Plant::new(robot);
        let start = Plant::at_rest(&sortie.waypoints[0].coords, &inner.hover(robot));
        Ok(Self {
            stepper: Stepper::new(&plant, settings.step),
            motion: Motion::new(&plant, &start),
            disturbances: Disturbances::new(robot, conditions, settings.step, seed),
            plant,
            inner,
            period,
            steps,
            at_limit: 0,
            ticks: 0,
        })
    }

    /// What is measured at `t`.
    #[inline]
    pub(super) fn state(&self, t: f64) -> FlightState {
        let [w, x, y, z] = self.motion.quaternion();
        FlightState {
            t,
            position: self.position(),
            velocity: vector(self.motion.velocity),
            attitude: UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z)),
            rates: vector(self.motion.rates),
        }
    }

    /// The outer loop's command, given in `state` for `dt` s.
    pub(super) fn follow(&mut self, dt: f64, state: &FlightState, command: &FlightCommand) {
        self.inner.follow(dt, state, command);
    }

    /// `ticks` of the rate loop, the last command held.
    pub(super) fn fly_at(&mut self, simd: Simd, ticks: u64) {
        match simd {
            Simd::Widest => fly_on(self, ticks),
            Simd::Portable => self.fly_on(ticks),
        }
    }

    #[inline(always)]
    fn fly_on(&mut self, ticks: u64) {
        self.ticks += ticks;
        // No closures here: they would be compiled for the least of machines.
        if self.disturbances.none() {
            for _ in 0..ticks {
                self.tick::<false>();
            }
        } else {
            for _ in 0..ticks {
                self.tick::<true>();
            }
        }
    }

    /// One tick of the rate loop, and the physics until the next.
    #[inline(always)]
    fn tick<const DISTURBED: bool>(&mut self) {
        let mixed = self.inner.command(&self.motion);
        if mixed.at_limit > 0 {
            self.at_limit += u64::from(mixed.at_limit);
        }
        self.step::<DISTURBED>(mixed.speeds);
        if self.steps > 1 {
            self.finer_steps::<DISTURBED>(mixed.speeds);
        }
    }

    #[inline(always)]
    fn step<const DISTURBED: bool>(&mut self, speeds: f64x4) {
        if DISTURBED {
            self.disturbances.act_on(&mut self.plant);
        }
        self.stepper.step::<DISTURBED>(&self.plant, &mut self.motion, speeds);
    }

    /// The rest of the steps of a tick, apart, so that a tick of one step is straight code.
    #[inline(never)]
    fn finer_steps<const DISTURBED: bool>(&mut self, speeds: f64x4) {
        (1..self.steps).for_each(|_| self.step::<DISTURBED>(speeds));
    }

    /// m, world frame.
    pub(super) fn position(&self) -> Vector3<f64> {
        vector(self.motion.position)
    }

    /// The body z axis's part along the world's; NaN for a state that is not finite.
    pub(super) fn up(&self) -> f64 {
        if self.motion.is_finite() { self.motion.up.to_array()[2] } else { f64::NAN }
    }

    /// A sample at `t` s on leg `leg`, with the share of (rotor, tick) pairs at a limit since the last sample; counts
    /// begin anew.
    pub(super) fn record(&mut self, recorder: &mut Recorder, t: f64, leg: usize) {
        let saturated = if self.ticks > 0 { self.at_limit as f64 / (4 * self.ticks) as f64 } else { 0.0 };
        (self.at_limit, self.ticks) = (0, 0);
        recorder.push(t, &self.motion, leg, saturated);
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::simulation::controllers::Pilot;
    use crate::simulation::tests::{KINDS, cage, shipped};
    use crate::simulation::{Controller, ControllerSettings, DiscreteGust, Gusts, Reference};

    /// The dispatched ticks against the same ticks compiled for the least of machines, under each of our controllers.
    #[test]
    fn wider_instructions_give_the_same_bits() {
        let (world, settings) = (cage(), FlySettings::default());
        let waypoints = [Point3::new(5.0, 5.0, 5.0), Point3::new(15.0, 9.0, 8.0)];
        let gusts = Some(Gusts { std: 1.0, correlation: 1.0 });
        let gust = DiscreteGust { velocity: Vector3::y(), start: 0.1, duration: 1.0 };
        let stormy = Conditions { wind: Vector3::x(), gusts, discrete_gust: Some(gust), noise: true };
        for robot in shipped() {
            let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: None };
            for (kind, conditions) in KINDS.into_iter().flat_map(|kind| [(kind, Conditions::default()), (kind, stormy)])
            {
                let reference = Reference { waypoints: &waypoints, next: 1, accept: 1.0, plan: None };
                let start = || {
                    let mut pilot = Pilot::new(&ControllerSettings { kind, ..Default::default() }, &robot).unwrap();
                    pilot.reset(&reference).unwrap();
                    (ClosedLoop::new(&sortie, &conditions, &settings, 1).unwrap(), pilot)
                };
                let ((mut dispatched, mut ours), (mut plain, mut theirs)) = (start(), start());
                for turn in 0..300 {
                    for (run, pilot) in [(&mut dispatched, &mut ours), (&mut plain, &mut theirs)] {
                        let state = run.state(0.01 * f64::from(turn));
                        run.follow(0.01, &state, &pilot.control(0.01, &state, &reference).unwrap());
                    }
                    dispatched.fly_at(Simd::Widest, 10);
                    plain.fly_at(Simd::Portable, 10);
                    assert_eq!(dispatched.motion, plain.motion, "{kind:?} {} at turn {turn}", robot.name);
                }
                assert!((dispatched.position() - waypoints[0].coords).norm() > 0.01, "{kind:?} {} flew", robot.name);
            }
        }
    }
}
