//! What one question may write beside its answer: the path of states, the wheels, and what the answer's JSON says of speeds,
//! direction and controls.

use hairpin::campaign::states::{States, VehicleState};
use hairpin::feasibility::steering::shooting::families::Parameters;
use hairpin::feasibility::steering::shooting::rough::GroundCost;
use hairpin::robot::rover::{Effort, Weight};
use hairpin::trajectory::{SpeedProfile, Timing};
use hairpin_formats::atomic;
use hairpin_formats::steering::{Asked, path_table, wheel_table};
use serde_json::{Value, json};

use super::answered::Answered;
use super::pace::{Rows, direction};
use super::vehicle::Vehicle;
use crate::args::Steer;
use crate::console;
use crate::problem::Problem;

/// Moments of the wheels in JSON at most.
const MOMENTS: usize = 50;

/// Writes --path and --wheels; a question without a drive writes neither.
pub(super) fn write(steer: &Steer, vehicle: &Vehicle, asked: &Asked, answered: &Answered) -> Result<(), Problem> {
    if steer.wheels.is_some() && vehicle.rover.wheel_names().is_empty() {
        return Err(Problem::input(format!("--wheels: `{}` has no wheels (suspension)", vehicle.rover.name)));
    }
    if steer.path.is_none() && steer.wheels.is_none() {
        return Ok(());
    }
    let Some(states) = vehicle.follow(asked, answered, Rows::AsAsked) else {
        console::warn("without a drive there is nothing to write to --path and --wheels");
        return Ok(());
    };
    if let Some(path) = &steer.path {
        atomic::write(path, &path_table(&states, asked.frame).map_err(Problem::input)?)?;
    }
    if let Some(path) = &steer.wheels {
        let table = wheel_table(&states, vehicle.rover.wheel_names(), asked.frame);
        atomic::write(path, &table.map_err(Problem::input)?)?;
    }
    Ok(())
}

/// Adds speeds, direction of travel, controls, wheels, what the body comes to, and forces to the object of an answer.
pub(super) fn add(object: &mut Value, vehicle: &Vehicle, asked: &Asked, answered: &Answered) {
    let left = asked.frame.left();
    let direction = direction(asked);
    object["control"] = vehicle.pace.control.name().into();
    object["direction"] = json!({ "start_rad": left * direction.start, "end_rad": left * direction.end });
    let Some((solution, _)) = &answered.drive else { return };
    if let Some(profile) = &answered.profile {
        let timing = Timing::new(profile, &solution.segments);
        let kind = match profile {
            SpeedProfile::Constant { .. } => "constant",
            SpeedProfile::Ramp { .. } => "ramp",
            SpeedProfile::Trapezoid { .. } => "trapezoid",
        };
        let finite = |value: f64| value.is_finite().then_some(value);
        object["profile"] = json!({
            "kind": kind,
            "v0_m_s": profile.start(),
            "cruise_m_s": profile.top(),
            "vf_m_s": profile.end(),
            "end_m_s": finite(timing.end_speed()),
            "driving_s": finite(timing.time_at(timing.length())),
            "max_acceleration_m_s2": finite(timing.hardest()),
        });
    }
    if vehicle.means.ground.cost != GroundCost::Any {
        object["cost"] = json!({ "name": vehicle.means.ground.cost.name(), "value": answered.cost });
    }
    if let Some((parameters, fit_error)) = &answered.parameters {
        object["parameters"] = named(parameters, left);
        object["fit_error_1_m"] = (*fit_error).into();
    }
    if !vehicle.rover.wheel_names().is_empty()
        && let Some(states) = vehicle.follow(asked, answered, Rows::Few)
    {
        object["wheels"] = wheels(&states, vehicle.rover.wheel_names(), left);
        object["body"] = body(&states);
        if let Some(weight) = &vehicle.rover.weight {
            object["forces"] = forces(&states, weight, vehicle.rover.wheels.torque);
        }
    }
}

fn named(parameters: &Parameters, left: f64) -> Value {
    let turned = |values: &[f64]| -> Vec<f64> { values.iter().map(|value| left * value).collect() };
    match parameters {
        Parameters::ArcLength { curvature, length } => {
            json!({ "curvature_of_s": turned(curvature), "length_m": length })
        }
        Parameters::Time { curvature, duration } => {
            json!({ "curvature_of_t": turned(curvature), "duration_s": duration })
        }
        Parameters::Knots { curvature, length } => {
            json!({ "curvature_at_knots": turned(curvature), "length_m": length })
        }
        Parameters::Velocity { linear, angular, duration } => {
            json!({ "v_of_t": linear, "yaw_rate_of_t": turned(angular), "duration_s": duration })
        }
    }
}

/// The worst that the body comes to; no number where it is not known.
fn body(states: &States) -> Value {
    let worst = |of: fn(&VehicleState) -> f64, than: fn(f64, f64) -> f64| {
        states.states.iter().map(of).reduce(than).filter(|value| value.is_finite())
    };
    let degrees = |value: Option<f64>| value.map(f64::to_degrees);
    json!({
        "max_tilt_deg": degrees(worst(|state| state.tilt, f64::max)),
        "max_roll_deg": degrees(worst(|state| state.settled.roll.abs(), f64::max)),
        "max_pitch_deg": degrees(worst(|state| state.settled.pitch.abs(), f64::max)),
        "min_clearance_m": worst(|state| state.clearance, f64::min),
        "min_tip_over_margin_deg": degrees(worst(|state| state.tip_over_margin, f64::min)),
    })
}

/// What the wheels push and brake with at most, and where.
fn forces(states: &States, weight: &Weight, limit: f64) -> Value {
    let torque = |state: &VehicleState| state.effort.map_or(0.0, |effort| effort.torque.abs());
    let hardest = states.states.iter().max_by(|a, b| torque(a).total_cmp(&torque(b)));
    let most = |of: fn(&Effort) -> f64| {
        let values = states.states.iter().filter_map(|state| state.effort.as_ref()).map(of);
        values.fold(0.0, f64::max)
    };
    json!({
        "mass_kg": weight.mass,
        "gravity_m_s2": weight.gravity,
        "max_traction_n": most(|effort| effort.traction),
        "max_braking_n": most(|effort| -effort.traction),
        "max_wheel_torque_n_m": states.peaks.torque,
        "at_m": hardest.map(|state| state.s),
        "wheel_torque_limit_n_m": limit.is_finite().then_some(limit),
    })
}

fn wheels(states: &States, names: &[&str], left: f64) -> Value {
    let every = states.states.len().div_ceil(MOMENTS).max(1);
    let last = states.states.len().saturating_sub(1);
    let moments: Vec<Value> = states
        .states
        .iter()
        .enumerate()
        .filter(|(i, _)| i % every == 0 || *i == last)
        .map(|(_, state)| {
            let wheels = state.wheels.iter().take(names.len());
            let steer: Vec<f64> = wheels.clone().map(|wheel| left * wheel.steer.to_degrees()).collect();
            let speed: Vec<f64> = wheels.map(|wheel| wheel.speed).collect();
            json!({ "t_s": state.time, "steer_deg": steer, "speed_rad_s": speed })
        })
        .collect();
    json!({
        "names": names,
        "max_steer_deg": states.peaks.steer.to_degrees(),
        "max_steer_rate_deg_s": states.peaks.steer_rate.to_degrees(),
        "max_speed_rad_s": states.peaks.speed,
        "max_acceleration_rad_s2": states.peaks.acceleration,
        "moments": moments,
    })
}
