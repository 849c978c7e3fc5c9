//! Hands the written drives to the verification room, as plain numbers.

use super::DriveSetup;
use super::site::{drive_piece, ground_vehicle};
use crate::campaign::Case;
use crate::feasibility::reach::drive::Pace;
use crate::trajectory::drive::Planar;
use crate::verification::{DriveLegClaim, DriveTolerances, DrivesClaim, Proof, verify_drives};

/// Replays every leg of `case` on the ground by independent code, to the solver's precision. `None` for a case that claims no
/// witness.
pub(in crate::campaign) fn verify(setup: &DriveSetup, case: &Case) -> Option<Proof> {
    let drive = case.drive.as_ref()?;
    let end = |at: &Planar| [at.x, at.y, at.yaw, at.curvature];
    let legs: Vec<DriveLegClaim> = (drive.legs.iter().enumerate())
        .map(|(number, leg)| DriveLegClaim {
            from: end(&leg.from),
            to: end(&leg.to),
            pieces: leg.segments.iter().map(drive_piece).collect(),
            speed: leg.timing().knots(),
            direction: [leg.direction.start, leg.direction.end],
            // What the case says, which others read.
            duration: case.leg_times.get(number).copied().unwrap_or_else(|| drive.leg_time(number)),
        })
        .collect();
    let waypoints: Vec<[f64; 2]> = case.waypoints.iter().map(|p| [p.x, p.y]).collect();
    let claim = DrivesClaim { waypoints: &waypoints, legs: &legs, speed: drive.speed, turn_rate: drive.turn_rate };
    let (solver, bounds) = (&setup.scenario.generate.solver, setup.bounds());
    let tolerances = DriveTolerances {
        position: solver.position_m,
        yaw: solver.yaw_rad,
        curvature: solver.curvature_1_m,
        most_curvature: bounds.most,
        most_curvature_rate: bounds.most_rate,
        most_tilt: setup.tilt(),
        most_torque: setup.rover.wheels.torque,
        directions: setup.directions(),
        most_acceleration: match setup.pace() {
            Pace::Constant => f64::INFINITY,
            Pace::Ramp(slopes) | Pace::Trapezoid(slopes) => slopes.acceleration,
        },
    };
    Some(verify_drives(&ground_vehicle(setup.planner), setup.map.as_ref(), &claim, &tolerances))
}
