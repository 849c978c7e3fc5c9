//! Runs a program on the virtual controller.
//!
//! The run's random stream is that of its order, so that run k of a case is the same whichever thread runs it.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::{ArmSetup, fit, idle};
use crate::campaign::Case;
use crate::campaign::kind::{Act, Fittable, Order, PassedOver, Same};
use crate::campaign::placement::Placement;
use crate::campaign::scenario::TimeLawName;
use crate::judgement::moves::{MeasureSettings, measure_moves};
use crate::robot::arm::{AXES, Joints};
use crate::simulation::SimulationError;
use crate::simulation::arm::{Fault, Noise, Plan, PlanSettings, RunSettings, Shape, Steering};
use crate::trajectory::program::Program;
use crate::trajectory::{Channel, Ended, Flight, PlannedPath, Track};

/// Time over which an s-curve averages the progress of a trapezoid, s: a usual one of controllers of this size.
const S_CURVE: f64 = 0.04;
/// Jitter of fine points beside that of positions, s per mm of noise.
///
/// So one key, the noise in mm, makes both repeats that differ in place and repeats that differ in time.
const PAUSE_PER_MM: f64 = 0.05;

impl ArmSetup {
    /// How the virtual controller plans.
    pub(super) fn plan_settings(&self) -> PlanSettings {
        let shape = match self.scenario.execute.profile {
            TimeLawName::Trapezoid => Shape::Trapezoid,
            TimeLawName::SCurve => Shape::SCurve(S_CURVE),
        };
        PlanSettings { shape, ..PlanSettings::default() }
    }

    /// How its servos follow.
    fn run_settings(&self) -> RunSettings {
        let execute = &self.scenario.execute;
        let noise =
            Noise { position: execute.noise_mm * 1e-3, pause: execute.noise_mm * PAUSE_PER_MM, ..Noise::default() };
        RunSettings { lags: self.lags(), noise, ..RunSettings::default() }
    }

    /// Of the servos, s: the arm's own, or the scenario's for all axes.
    ///
    /// The first-order time constant τ of q̇ = (u − q)/τ, one per axis.
    pub(super) fn lags(&self) -> Joints {
        self.station.arm.lags.unwrap_or([self.scenario.execute.servo_lag_s; AXES])
    }

    /// What is wrong with the arm.
    ///
    /// Degrees and mm of the keys become rad and m; `slower` s is an axis that has the share 1 − s of its speed; axes
    /// stay counted from 1. A delayed start is one of move 0.
    fn faults(&self) -> Vec<Fault> {
        let faults = &self.scenario.execute.faults;
        let mut all = Vec::new();
        if let Some(axis) = faults.axis {
            let axis = axis as usize;
            if faults.backlash_deg > 0.0 {
                all.push(Fault::Backlash { axis, width: faults.backlash_deg.to_radians() });
            }
            if faults.slower > 0.0 {
                all.push(Fault::SlowAxis { axis, share: 1.0 - faults.slower });
            }
        }
        let offset = Vector3::from(faults.tool_offset_mm) * 1e-3;
        if offset != Vector3::zeros() {
            all.push(Fault::ToolOffset(Isometry3::from_parts(Translation3::from(offset), UnitQuaternion::identity())));
        }
        if faults.start_delay_s > 0.0 {
            all.push(Fault::DelayedStart { order: 0, delay: faults.start_delay_s });
        }
        all
    }
}

impl Act for ArmSetup {
    /// Runs the program, which was made with `nominal`, on the virtual controller as this setup has it, or by the
    /// caller's on its servos.
    fn run(&self, nominal: Same, case: &Case, order: &Order) -> Result<Flight, SimulationError> {
        let nominal: &Self = nominal.setup();
        if let Some(logs) = &nominal.scenario.execute.logs {
            return Err(SimulationError::new(
                "execute.logs",
                logs.clone(),
                "left out where the virtual controller is to run the program",
            ));
        }
        let program = program_of(case)?;
        let orders = nominal.orders(program)?;
        let plan = Plan::new(&self.station.arm, &nominal.station.home, &orders, &self.plan_settings())?;
        let steering = self.controller.as_ref().map(|controller| Steering { controller, waypoints: order.waypoints });
        let run = plan.execute_by(&self.run_settings(), &self.faults(), order.seed, steering)?;
        let track = legs_of(&run.recording)?;
        let waypoints = case.waypoints.len();
        let (ended, reached) = match (run.stop, run.arrived) {
            (None, false) => (Ended::Time, arrived(&plan.path(), &track, waypoints)?),
            (None, true) => (Ended::Done, reached(&track, waypoints, Ended::Done)),
            (Some(_), _) => (Ended::Halted, reached(&track, waypoints, Ended::Halted)),
        };
        Ok(Flight { track, ended, left_world: None, reached })
    }

    fn passed_over(&self) -> Vec<PassedOver> {
        idle::passed_over(self)
    }

    fn fittable(&self) -> Result<Fittable, String> {
        fit::fittable(self)
    }

    /// Cells stay as they are.
    fn place(&self, _: &Case, _: &Track) -> Option<Placement> {
        None
    }
}

/// The program of a case.
///
/// # Errors
/// There is none, as in a folder that was edited.
pub(super) fn program_of(case: &Case) -> Result<&Program, SimulationError> {
    case.program().ok_or_else(|| SimulationError::new("program", "none".into(), "the program of the case"))
}

/// `recording` as flights are kept: the channel `move` called `leg`, and with the velocities of
/// [`Track::with_velocities`]. All other channels stay.
pub(super) fn legs_of(recording: &Track) -> Result<Track, SimulationError> {
    let renamed = recording.channels().iter().map(|channel| match channel.name.as_str() {
        "move" => Channel { name: "leg".into(), values: channel.values.clone() },
        _ => channel.clone(),
    });
    Track::new(recording.times().to_vec(), recording.poses().to_vec(), renamed.collect())
        .map(Track::with_velocities)
        .map_err(|error| SimulationError::new("recording", error.to_string(), "a track"))
}

/// When each waypoint was reached by an arm that did not come to its program's end, whatever its schedule says: when it
/// arrived there on its way along `path`; `None` of those that it did not come to. What arcs only pass is told by the
/// moves before and behind it, as programs have fewer moves then.
fn arrived(path: &PlannedPath, track: &Track, waypoints: usize) -> Result<Vec<Option<f64>>, SimulationError> {
    let measured = measure_moves(path, track, &MeasureSettings::default())
        .map_err(|error| SimulationError::new("recording", error.to_string(), "one that moves are measured of"))?;
    let arrivals = measured.moves.iter().map(|one| one.arrived);
    let mut reached: Vec<Option<f64>> = std::iter::once(Some(0.0)).chain(arrivals).take(waypoints).collect();
    reached.resize(waypoints, None);
    if let Some(last) = reached.last_mut() {
        *last = None;
    }
    Ok(reached)
}

/// When each waypoint was reached: when the next move began, and the last at the end.
///
/// `None` of a waypoint that no sample is beyond, and of the last where the arm halted. Stamps are those of samples:
/// late by a sample's period at most.
fn reached(track: &Track, waypoints: usize, ended: Ended) -> Vec<Option<f64>> {
    let legs = track.channel("leg").unwrap_or_default();
    let begins = |leg: usize| legs.iter().position(|at| *at >= leg as f64).map(|i| track.times()[i]);
    (0..waypoints)
        .map(|waypoint| match waypoint {
            0 => Some(0.0),
            last if last + 1 == waypoints => (ended == Ended::Done).then(|| track.times().last().copied()).flatten(),
            other => begins(other),
        })
        .collect()
}
