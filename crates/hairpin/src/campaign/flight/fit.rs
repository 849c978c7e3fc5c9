//! What logs of flights may tell: thrust, drag, rotor lag, and how fast and how late the controller is.
//!
//! θ and bounds: thrust to weight 1.05 … 50, drag 0 … 20 times the given, rotor lag and latency 0 … 0.5 s, bandwidth
//! 0.2 … 5 (a factor of the controller's). Logs need 5 s at 8 Hz; outputs are sampled every 0.1 s, and stretches of 3
//! s count as independent.

use serde_json::Value;

use super::FlightSetup;
use crate::campaign::kind::{Adjustable, Fittable, Output, Sampling};
use crate::math::power::square;
use crate::simulation::{ControllerKind, ControllerSettings};

/// Position, and velocity, thrust axis and the mean of the rotors' squared speeds where there are any.
///
/// The second number is the group of an output: those of one group share the size of their residuals.
const OUTPUTS: [(Output, usize); 9] = [
    (Output::Position(0), 0),
    (Output::Position(1), 0),
    (Output::Position(2), 1),
    (Output::Velocity(0), 2),
    (Output::Velocity(1), 2),
    (Output::Velocity(2), 3),
    (Output::Axis(2, 0), 4),
    (Output::Axis(2, 1), 4),
    (Output::Thrust, 5),
];

/// Drag terms: as the robot has them; where it has none, the linear one, which rotors always have.
///
/// # Errors
/// No controller of ours flies: there is no model of who does. A robot's description that was not resolved.
///
/// ```text
/// thrust to weight   r = T_max/(m g)        T_max = 4 kf ω_max²      kf = r · m g/(4 ω_max²)
/// ```
///
/// r is what is fitted, and the keys that a file has are set from it. A drag that is pinned at 0 stays so.
pub(super) fn fittable(setup: &FlightSetup, controller: &ControllerSettings) -> Result<Fittable, String> {
    let execute = &setup.scenario.execute;
    if setup.controller.is_some() || execute.controller_in_force().is_none() {
        return Err("a controller of ours must fly (`execute.controller`): of others hairpin has no model".into());
    }
    let robot = &setup.robot;
    let description = setup.scenario.robot.resolved().map_err(|mistake| mistake.to_string())?;
    let weight = robot.mass * robot.gravity;
    let per_ratio = weight / (4.0 * square(robot.rotor_speed.1));
    let given = (description.thrust_to_weight.is_some(), description.thrust_coefficient_n_s2.is_some());
    let by_ratio = ("robot.thrust_to_weight".to_owned(), 1.0);
    let by_coefficient = ("robot.thrust_coefficient_n_s2".to_owned(), per_ratio);
    let thrust = match given {
        (true, true) => vec![by_coefficient, by_ratio],
        (true, false) => vec![by_ratio],
        _ => vec![by_coefficient],
    };
    let key = |key: &str| vec![(key.to_owned(), 1.0)];
    let ratio = robot.max_thrust() / weight;
    let (linear, quadratic) = (robot.drag_linear, robot.drag_quadratic);
    // Where the other term alone is in force, this one is pinned: a file without either would have one derived.
    let typical = 0.05 * robot.mass;
    let drag = |field: &'static str, name, unit, value: f64, like: f64| Adjustable {
        name,
        field,
        unit,
        keys: key(&format!("robot.{field}")),
        value,
        bounds: [0.0, 20.0 * like],
        step: 0.05 * like,
        other: 1.5 * like,
        doubt: None,
    };
    let mut numbers = vec![Adjustable {
        name: "thrust to weight",
        field: "thrust_to_weight",
        unit: "",
        keys: thrust,
        value: ratio,
        bounds: [1.05, (4.0 * ratio).min(50.0)],
        step: 0.02 * ratio,
        other: 1.0 + 0.7 * (ratio - 1.0),
        doubt: None,
    }];
    if linear > 0.0 || quadratic == 0.0 {
        let like = if linear > 0.0 { linear } else { typical };
        numbers.push(drag("drag_linear_n_s_m", "linear drag", "N s/m", linear, like));
    }
    if quadratic > 0.0 {
        numbers.push(drag("drag_quadratic_n_s2_m2", "quadratic drag", "N s²/m²", quadratic, quadratic));
    }
    let number = |name, field, unit, key: Vec<(String, f64)>, value, bounds, step, other| Adjustable {
        name,
        field,
        unit,
        keys: key,
        value,
        bounds,
        step,
        other,
        doubt: None,
    };
    numbers.extend([
        number(
            "rotor lag",
            "rotor_time_constant_s",
            "s",
            key("robot.rotor_time_constant_s"),
            robot.rotor_time_constant,
            [0.0, 0.5],
            0.004,
            robot.rotor_time_constant + 0.04,
        ),
        number(
            "latency",
            "latency_s",
            "s",
            key("execute.latency_s"),
            execute.latency_s.unwrap_or(0.0),
            [0.0, 0.5],
            0.008,
            execute.latency_s.unwrap_or(0.0) + 0.08,
        ),
        number(
            "bandwidth",
            "bandwidth",
            "",
            key("execute.bandwidth"),
            controller.bandwidth,
            [0.2, 5.0],
            0.03 * controller.bandwidth,
            0.75 * controller.bandwidth,
        ),
    ]);
    let calm = [("world.gusts", Value::Null), ("world.discrete_gust", Value::Null), ("execute.noise", false.into())];
    Ok(Fittable {
        calm: calm.into_iter().map(|(key, value)| (key.to_owned(), value)).collect(),
        spelt: Vec::new(),
        derives: true,
        numbers,
        outputs: &OUTPUTS,
        axes: 3,
        undescribed: "gusts are between them, or a vehicle, a clock or a mission that none of these numbers describes",
        unit: ("m", 1.0),
        sampling: Sampling { least_s: 5.0, least_hz: 8.0, period: 0.1, stretch: 3.0, whole_legs: true, start_m: None },
        tried: "20 drawn quadrotors, FlightGoggles' file ± 30 %, flown by `stable-waypoint`",
        untried: Some(controller.kind).filter(|kind| *kind != ControllerKind::StableWaypoint).map(ControllerKind::word),
        acceptance: controller.kind.acceptance(),
        timed: matches!(controller.kind, ControllerKind::MinimumSnap | ControllerKind::Geometric),
    })
}
