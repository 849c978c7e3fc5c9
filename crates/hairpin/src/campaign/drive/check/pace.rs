//! Bounds of speeds, and of the limits of a drive.

use crate::campaign::check::Findings;
use crate::campaign::scenario::{DriveGenerate, DriveLimits, ProfileName};
use crate::robot::rover::{MOST_SPEED, Rims, Rover};

/// Limits within what is meant by them; those of speed leave driven wheels room to turn.
///
/// | key | bound |
/// | --- | --- |
/// | `curvature_1_m` | (0, 1e3] 1/m |
/// | `curvature_rate_1_m2` | (0, 1e6] 1/m² |
/// | `tilt_deg` | (0, 89]° |
/// | `speed_m_s` | from 1e-3 m/s to `MOST_SPEED`, and 0.99 of the rims' speed at most |
/// | `belly_clearance_m` | [0, 10] m |
///
/// They are bounds beside the robot's own: where a limit here is wider, the robot's holds. Tilt and underside are for
/// what has a suspension.
pub(super) fn check_limits(limits: &DriveLimits, rover: Option<&Rover>, found: &mut Findings) {
    for (key, value, most, unit) in [
        ("curvature_1_m", limits.curvature_1_m, 1e3, " 1/m"),
        ("curvature_rate_1_m2", limits.curvature_rate_1_m2, 1e6, " 1/m²"),
        ("tilt_deg", limits.tilt_deg, 89.0, "°"),
    ] {
        if let Some(value) = value {
            found.above(&format!("generate.limits.{key}"), value, 0.0, most, unit);
        }
    }
    if let Some(speed) = limits.speed_m_s {
        // Beside the robot's own, which holds where this is higher. Slower, and a drive would be days of samples.
        found.from("generate.limits.speed_m_s", speed, 1e-3, MOST_SPEED, " m/s");
        if let Some(rims) = rover.and_then(|rover| rover.rims) {
            let most = Rims::MOST_SHARE * rims.speed;
            let bound = format!(
                "at most {most} m/s, 0.99 of robot.limits.wheel_speed_m_s: a wheel at its limit leaves nothing to turn \
             with"
            );
            found.require(speed <= most, "generate.limits.speed_m_s", speed, &bound);
        }
    }
    if let Some(clearance) = limits.belly_clearance_m {
        found.from("generate.limits.belly_clearance_m", clearance, 0.0, 10.0, " m");
    }
}

/// Profiles that change speed need an acceleration, the robot's or the scenario's, which is no larger than the robot's.
///
/// Of a differential drive the acceleration leaves a tenth of its rims' for steering on the sharpest bend at the
/// commanded speed. Waypoints' speeds say nothing where the speed is constant, and are refused there.
pub(super) fn check_speed(generate: &DriveGenerate, rover: Option<&Rover>, found: &mut Findings) {
    let speed = &generate.speed;
    if let Some([low, high]) = speed.waypoint_m_s {
        found.from("generate.speed.waypoint_m_s[0]", low, 0.0, MOST_SPEED, " m/s");
        found.above("generate.speed.waypoint_m_s[1]", high, 0.0, MOST_SPEED, " m/s");
        found.require(
            low <= high,
            "generate.speed.waypoint_m_s",
            format!("[{low}, {high}]"),
            "rising: [least, greatest]",
        );
    }
    let Some(rover) = rover else { return };
    let own = rover.limits.acceleration;
    if let Some(acceleration) = speed.acceleration_m_s2 {
        // On the sharpest bend of a differential drive the outer rim must steer beside it.
        let commanded = generate.limits.speed_m_s.unwrap_or(rover.default_speed).min(rover.limits.speed);
        let most = rover.most_planned_acceleration(commanded);
        found.above("generate.speed.acceleration_m_s2", acceleration, 0.0, most.min(1e3), " m/s²");
    }
    let bounded = own.is_finite() || speed.acceleration_m_s2.is_some();
    let changes = matches!(speed.profile, Some(ProfileName::Ramp | ProfileName::Trapezoid));
    let bound = "given: the robot's own acceleration is not bounded";
    found.require(!changes || bounded, "generate.speed.acceleration_m_s2", "left out", bound);
    let idle = !matches!(speed.profile, Some(ProfileName::Constant)) && bounded;
    let given = speed.waypoint_m_s.is_some();
    found.require(idle || !given, "generate.speed.waypoint_m_s", "given", "left out where the speed is constant");
}
