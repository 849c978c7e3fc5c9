//! What a drive comes to beside its segments: speeds, controls, wheels, body and forces, as plain data.

use hairpin::campaign::states::{States, VehicleState};
use hairpin::feasibility::steering::shooting::families::Parameters;
use hairpin::feasibility::steering::shooting::rough::GroundCost;
use hairpin::robot::rover::{Effort, Weight};
use hairpin::trajectory::{SpeedProfile, Timing};
use hairpin_formats::steering::Asked;
use serde::Serialize;

use super::answered::Answered;
use super::pace::{Rows, direction};
use super::vehicle::Vehicle;

/// Moments of the wheels at most.
const MOMENTS: usize = 50;

/// What a drive comes to, in the frame and with the signs of its question.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Family of controls.
    pub control: &'static str,
    /// Direction of travel in the body.
    pub direction: Directions,
    /// Its speeds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub profile: Option<Speeds>,
    /// What it costs by the measure that was asked for, if one was.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cost: Option<CostOf>,
    /// The controls' own parameters.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parameters: Option<ControlParameters>,
    /// By how much the segments differ from them in curvature, 1/m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fit_error_1_m: Option<f64>,
    /// Of vehicles with wheels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wheels: Option<Wheels>,
    /// Of vehicles with wheels, what the body comes to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub body: Option<Body>,
    /// Of vehicles with wheels and a weight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub forces: Option<Forces>,
}

/// Directions of travel in the body at both ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[expect(missing_docs, reason = "units are in the names")]
pub struct Directions {
    pub start_rad: f64,
    pub end_rad: f64,
}

/// Speeds along a drive; no number where there is none that is finite.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[expect(missing_docs, reason = "units are in the names")]
pub struct Speeds {
    /// `constant`, `ramp` or `trapezoid`.
    pub kind: &'static str,
    pub v0_m_s: f64,
    pub cruise_m_s: f64,
    pub vf_m_s: f64,
    /// What it ends with.
    pub end_m_s: Option<f64>,
    /// Without turns in place.
    pub driving_s: Option<f64>,
    pub max_acceleration_m_s2: Option<f64>,
}

/// A cost by its name; without a value where it is not known.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[expect(missing_docs, reason = "said above")]
pub struct CostOf {
    pub name: &'static str,
    pub value: Option<f64>,
}

/// Parameters of a family of controls: coefficients from the constant one on, SI.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
#[expect(missing_docs, reason = "said above")]
pub enum ControlParameters {
    /// Curvature as a polynomial of arc length.
    ArcLength { curvature_of_s: Vec<f64>, length_m: f64 },
    /// Curvature as a polynomial of time.
    Time { curvature_of_t: Vec<f64>, duration_s: f64 },
    /// Curvature at evenly spaced knots.
    Knots { curvature_at_knots: Vec<f64>, length_m: f64 },
    /// Linear and angular velocity as polynomials of time.
    Velocity { v_of_t: Vec<f64>, yaw_rate_of_t: Vec<f64>, duration_s: f64 },
}

/// What the wheels are asked for at most, and at some moments.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[expect(missing_docs, reason = "units are in the names")]
pub struct Wheels {
    pub names: Vec<String>,
    pub max_steer_deg: f64,
    pub max_steer_rate_deg_s: f64,
    pub max_speed_rad_s: f64,
    pub max_acceleration_rad_s2: f64,
    pub moments: Vec<Moment>,
}

/// The wheels at one moment, in the order of their names.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[expect(missing_docs, reason = "units are in the names")]
pub struct Moment {
    pub t_s: f64,
    pub steer_deg: Vec<f64>,
    pub speed_rad_s: Vec<f64>,
}

/// The worst that the body comes to; no number where it is not known.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[expect(missing_docs, reason = "units are in the names")]
pub struct Body {
    pub max_tilt_deg: Option<f64>,
    pub max_roll_deg: Option<f64>,
    pub max_pitch_deg: Option<f64>,
    pub min_clearance_m: Option<f64>,
    pub min_tip_over_margin_deg: Option<f64>,
}

/// What the wheels push and brake with at most.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[expect(missing_docs, reason = "units are in the names")]
pub struct Forces {
    pub mass_kg: f64,
    pub gravity_m_s2: f64,
    pub max_traction_n: f64,
    pub max_braking_n: f64,
    pub max_wheel_torque_n_m: f64,
    /// Where that is, from the start along the drive.
    pub at_m: Option<f64>,
    pub wheel_torque_limit_n_m: Option<f64>,
}

impl Vehicle {
    /// What the drive of `answered` comes to; without a drive, only what was asked for.
    pub fn summary(&self, asked: &Asked, answered: &Answered) -> Summary {
        let left = asked.frame.left();
        let direction = direction(asked);
        let mut summary = Summary {
            control: self.pace.control.name(),
            direction: Directions { start_rad: left * direction.start, end_rad: left * direction.end },
            profile: None,
            cost: None,
            parameters: None,
            fit_error_1_m: None,
            wheels: None,
            body: None,
            forces: None,
        };
        let Some((solution, _)) = &answered.drive else { return summary };
        summary.profile = answered.profile.map(|profile| speeds(&profile, &Timing::new(&profile, &solution.segments)));
        let cost = self.solver().ground.cost;
        summary.cost = (cost != GroundCost::Any).then(|| CostOf { name: cost.name(), value: answered.cost });
        if let Some((parameters, fit_error)) = &answered.parameters {
            summary.parameters = Some(controls(parameters, left));
            summary.fit_error_1_m = Some(*fit_error);
        }
        let names = self.rover.wheel_names();
        if !names.is_empty()
            && let Some(states) = self.follow(asked, answered, Rows::Few)
        {
            summary.wheels = Some(wheels(&states, names, left));
            summary.body = Some(body(&states));
            summary.forces = self.rover.weight.as_ref().map(|weight| forces(&states, weight, self.rover.wheels.torque));
        }
        summary
    }
}

fn speeds(profile: &SpeedProfile, timing: &Timing) -> Speeds {
    let finite = |value: f64| value.is_finite().then_some(value);
    Speeds {
        kind: match profile {
            SpeedProfile::Constant { .. } => "constant",
            SpeedProfile::Ramp { .. } => "ramp",
            SpeedProfile::Trapezoid { .. } => "trapezoid",
        },
        v0_m_s: profile.start(),
        cruise_m_s: profile.top(),
        vf_m_s: profile.end(),
        end_m_s: finite(timing.end_speed()),
        driving_s: finite(timing.time_at(timing.length())),
        max_acceleration_m_s2: finite(timing.hardest()),
    }
}

fn controls(parameters: &Parameters, left: f64) -> ControlParameters {
    let turned = |values: &[f64]| -> Vec<f64> { values.iter().map(|value| left * value).collect() };
    match parameters {
        Parameters::ArcLength { curvature, length } => {
            ControlParameters::ArcLength { curvature_of_s: turned(curvature), length_m: *length }
        }
        Parameters::Time { curvature, duration } => {
            ControlParameters::Time { curvature_of_t: turned(curvature), duration_s: *duration }
        }
        Parameters::Knots { curvature, length } => {
            ControlParameters::Knots { curvature_at_knots: turned(curvature), length_m: *length }
        }
        Parameters::Velocity { linear, angular, duration } => ControlParameters::Velocity {
            v_of_t: linear.to_vec(),
            yaw_rate_of_t: turned(angular),
            duration_s: *duration,
        },
    }
}

fn body(states: &States) -> Body {
    let worst = |of: fn(&VehicleState) -> f64, than: fn(f64, f64) -> f64| {
        states.states.iter().map(of).reduce(than).filter(|value| value.is_finite())
    };
    let degrees = |value: Option<f64>| value.map(f64::to_degrees);
    Body {
        max_tilt_deg: degrees(worst(|state| state.tilt, f64::max)),
        max_roll_deg: degrees(worst(|state| state.settled.roll.abs(), f64::max)),
        max_pitch_deg: degrees(worst(|state| state.settled.pitch.abs(), f64::max)),
        min_clearance_m: worst(|state| state.clearance, f64::min),
        min_tip_over_margin_deg: degrees(worst(|state| state.tip_over_margin, f64::min)),
    }
}

fn forces(states: &States, weight: &Weight, limit: f64) -> Forces {
    let torque = |state: &VehicleState| state.effort.map_or(0.0, |effort| effort.torque.abs());
    let hardest = states.states.iter().max_by(|a, b| torque(a).total_cmp(&torque(b)));
    let most = |of: fn(&Effort) -> f64| {
        let values = states.states.iter().filter_map(|state| state.effort.as_ref()).map(of);
        values.fold(0.0, f64::max)
    };
    Forces {
        mass_kg: weight.mass,
        gravity_m_s2: weight.gravity,
        max_traction_n: most(|effort| effort.traction),
        max_braking_n: most(|effort| -effort.traction),
        max_wheel_torque_n_m: states.peaks.torque,
        at_m: hardest.map(|state| state.s),
        wheel_torque_limit_n_m: limit.is_finite().then_some(limit),
    }
}

fn wheels(states: &States, names: &[&str], left: f64) -> Wheels {
    let every = states.states.len().div_ceil(MOMENTS).max(1);
    let last = states.states.len().saturating_sub(1);
    let moments = states.states.iter().enumerate().filter(|(i, _)| i % every == 0 || *i == last).map(|(_, state)| {
        let wheels = state.wheels.iter().take(names.len());
        Moment {
            t_s: state.time,
            steer_deg: wheels.clone().map(|wheel| left * wheel.steer.to_degrees()).collect(),
            speed_rad_s: wheels.map(|wheel| wheel.speed).collect(),
        }
    });
    Wheels {
        moments: moments.collect(),
        names: names.iter().map(|name| (*name).to_owned()).collect(),
        max_steer_deg: states.peaks.steer.to_degrees(),
        max_steer_rate_deg_s: states.peaks.steer_rate.to_degrees(),
        max_speed_rad_s: states.peaks.speed,
        max_acceleration_rad_s2: states.peaks.acceleration,
    }
}
