//! What logs of drives may tell: how late and how lazily wheels follow, and how the ground answers them.
//!
//! θ and bounds: latency and lags 0 … 3 s, scales of speed and turn 0.3 … 3, slips at 20° below 0.95. Logs need 5 s
//! at 8 Hz; outputs are sampled every 0.1 s, and stretches of 2 s count as independent.

use serde_json::json;

use super::DriveSetup;
use crate::campaign::kind::{Adjustable, Fittable, Output, Sampling};
use crate::campaign::scenario::GroundDescription;
use crate::simulation::Acceptance;
use crate::simulation::ground::GroundControllerKind;

/// Place, and heading where it is known. Odometry's speeds are the wheels', not the vehicle's.
const OUTPUTS: [(Output, usize); 4] =
    [(Output::Position(0), 0), (Output::Position(1), 0), (Output::Axis(0, 0), 1), (Output::Axis(0, 1), 1)];

/// What intervals were found to hold on (docs/fit.md).
const TRIED: &str = "20 drawn differential drives of 0.5 m/s on a plain, steered by `pure-pursuit`";
/// Who steered these.
const TRIED_WITH: GroundControllerKind = GroundControllerKind::PurePursuit;
/// Of cars and rovers.
const DOUBT: &str = "intervals are shown to hold on differential drives alone";

/// Slips by slope are of rovers alone.
///
/// # Errors
/// No controller of ours drives: there is no model of who does. A robot's description that was not resolved.
///
/// Latency is `execute.latency_s` where the scenario has one, else the robot's. A slip's bound keeps what a load makes
/// of it below 0.95 as well. `step` is half the width of differences.
pub(super) fn fittable(setup: &DriveSetup) -> Result<Fittable, String> {
    let execute = &setup.scenario.execute;
    let Some(steers) = execute.controller_in_force().filter(|_| setup.controller.is_none()) else {
        return Err("a controller of ours must drive (`execute.controller`): of others hairpin has no model".into());
    };
    let (response, slip) = (&setup.rover.response, &setup.rover.slip);
    let described = setup.scenario.robot.resolved().map_err(|mistake| mistake.to_string())?;
    let doubt = (!matches!(described, GroundDescription::DifferentialDrive(_))).then_some(DOUBT);
    let number = |name, field: &'static str, unit, value, bounds, step, other| Adjustable {
        name,
        field,
        unit,
        keys: vec![(format!("robot.response.{field}"), 1.0)],
        value,
        bounds,
        step,
        other,
        doubt,
    };
    let lag = |name, field, value: f64| number(name, field, "s", value, [0.0, 3.0], 0.03, value + 0.2);
    let scale = |name, field, value: f64| number(name, field, "", value, [0.3, 3.0], 0.02, 0.9 * value);
    let late = execute.latency_s.unwrap_or(response.latency);
    let mut latency = number("latency", "latency_s", "s", late, [0.0, 3.0], 0.02, late + 0.15);
    if execute.latency_s.is_some() {
        latency.keys = vec![("execute.latency_s".into(), 1.0)];
    }
    let mut numbers = vec![
        latency,
        lag("steering lag", "steering_time_constant_s", response.steering_time_constant),
        lag("speed lag", "speed_time_constant_s", response.speed_time_constant),
        scale("speed scale", "speed_scale", response.speed_scale),
        scale("turn scale", "turn_scale", response.turn_scale),
    ];
    let given = match described {
        GroundDescription::Rover(rover) => json!(rover.response),
        GroundDescription::Car(car) => json!(car.response.unwrap_or_default()),
        GroundDescription::DifferentialDrive(drive) => json!(drive.response.unwrap_or_default()),
    };
    if let GroundDescription::Rover(rover) = described {
        let loaded = |unloaded: f64, loaded: f64| if unloaded > 0.0 { loaded / unloaded } else { 1.0 };
        for (name, field, given, now) in [
            ("slip", "slip_at_20_deg", rover.slip_at_20_deg, slip.at_20_deg),
            ("side slip", "side_slip_at_20_deg", rover.side_slip_at_20_deg, slip.side_at_20_deg),
        ] {
            let most = 0.95 / loaded(given, now).max(1.0);
            numbers.push(Adjustable {
                keys: vec![(format!("robot.{field}"), 1.0)],
                ..number(name, field, "", given, [0.0, most], 0.02, (given + 0.1).min(most))
            });
        }
    }
    Ok(Fittable {
        calm: vec![("execute.noise".into(), false.into())],
        spelt: vec![("robot.response".into(), given)],
        derives: false,
        numbers,
        outputs: &OUTPUTS,
        axes: 2,
        undescribed: "a vehicle or a clock is between them that none of these numbers describes",
        unit: ("m", 1.0),
        sampling: Sampling { least_s: 5.0, least_hz: 8.0, period: 0.1, stretch: 2.0, whole_legs: false, start_m: None },
        tried: TRIED,
        untried: Some(steers).filter(|steers| *steers != TRIED_WITH).map(GroundControllerKind::word),
        acceptance: Acceptance::Cylinder { height: f64::INFINITY },
        timed: false,
    })
}
