//! Hands the written drives to the verification room, as plain numbers.

use std::f64::consts::TAU;

use super::DriveSetup;
use super::site::{drive_piece, ground_vehicle, wheel_rims};
use super::solve::allowed;
use crate::campaign::kind::{Made, Task, flat_places, verify_task};
use crate::campaign::scenario::{DriveEnvironmentSection, DriveTask};
use crate::campaign::{Case, Environment};
use crate::feasibility::reach::drive::{Manoeuvres, Pace};
use crate::trajectory::Drive;
use crate::trajectory::drive::Planar;
use crate::verification::{
    ClearDisc, ClearDrive, ClearGroundClaim, Collector, DriveLegClaim, DriveManoeuvres, DriveTolerances, DrivesClaim,
    Finding, Proof, verify_clear_ground, verify_drives,
};
use crate::world::terrain::Terrain;

/// Replays every leg of `case` on the ground by independent code, to the solver's precision. `None` for a case that
/// claims no witness.
///
/// Tolerances are the scenario's own: positions m, yaw rad, curvatures 1/m, torques N·m, accelerations m/s².
///
/// ```text
/// setup's numbers ─▶ GroundVehicle, DrivesClaim, DriveTolerances ─▶ verify_drives ─▶ Proof
/// ```
///
/// The limits are those of the setup that is asked, not of the case: what was planned under wider ones fails, of speed
/// and rate of turns, gears and turns in place, tilt and joints, and of the world's keep-outs, from which the vehicle's
/// radius is kept to within `generate.solver.position_m`. With a constant pace accelerations are not bounded.
pub(super) fn verify(setup: &DriveSetup, case: &Case, made: Made) -> Option<Proof> {
    let drive = case.commands()?;
    let legs = leg_claims(case, drive);
    let waypoints = waypoints_of(case);
    let places = flat_places(&setup.keep_out);
    let claim = DrivesClaim {
        waypoints: &waypoints,
        legs: &legs,
        speed: drive.speed,
        turn_rate: drive.turn_rate,
        places: &places,
    };
    let (solver, bounds) = (&setup.scenario.generate.solver, setup.bounds());
    let tolerances = DriveTolerances {
        position: solver.position_m,
        yaw: solver.yaw_rad,
        curvature: solver.curvature_1_m,
        most_curvature: bounds.most,
        most_curvature_rate: bounds.most_rate,
        most_tilt: setup.tilt(),
        most_joint: setup.rover.limits.joint,
        most_torque: setup.rover.wheels.torque,
        directions: setup.directions(),
        most_acceleration: match setup.pace() {
            Pace::Constant => f64::INFINITY,
            Pace::Ramp(slopes) | Pace::Trapezoid(slopes) => slopes.acceleration,
        },
        rims: setup.rover.rims.as_ref().map(wheel_rims),
        most_speed: most_speed(setup, made),
        most_turn_rate: setup.turn_rate(),
        manoeuvres: manoeuvres(setup),
        // The motion that is held clear is known to what a leg's end is.
        clearance: setup.radius() - solver.position_m,
    };
    let mut proof = verify_drives(&ground_vehicle(&setup.planner), setup.map.as_ref(), &claim, &tolerances);
    check_heights(setup, case, &mut proof);
    if made == Made::Searched {
        check_task(setup, case, drive, &mut proof);
    }
    Some(proof)
}

/// The highest speed that may be commanded, m/s.
///
/// Searches command one speed; missions made elsewhere may ask for up to the limit where none is given.
fn most_speed(setup: &DriveSetup, made: Made) -> f64 {
    match setup.scenario.generate.limits.speed_m_s {
        None if made == Made::Elsewhere => setup.rover.limits.speed,
        _ => setup.speed(),
    }
}

/// The ways of driving that legs are looked for by: without `reverse` the line between two turns is driven forward.
fn manoeuvres(setup: &DriveSetup) -> DriveManoeuvres {
    let Manoeuvres { forward, reverse, turn_in_place } = allowed(setup);
    DriveManoeuvres { forward: forward || !reverse, reverse, turn_in_place }
}

/// A drive that was searched for begins, ends and is as long as the task has it; with the heading and the curvature at
/// its start, which are the commands'.
fn check_task(setup: &DriveSetup, case: &Case, drive: &Drive, proof: &mut Proof) {
    let DriveTask { start, end_m, length, .. } = &setup.scenario.task;
    let end = end_m.as_ref().map(|end| &end[..]);
    verify_task(&Task { start: &[start.x_m, start.y_m], end, length: *length }, case, proof);
    let Some(first) = drive.legs.first() else { return };
    let yaw = libm::remainder(first.from.yaw - start.yaw_deg.to_radians(), TAU);
    let mut found = Collector::about(&mut proof.findings, "task");
    found.above("start.yaw", yaw.abs(), 1e-9, "rad");
    found.above("start.curvature", (first.from.curvature - start.curvature_1_m).abs(), 1e-9, "1/m");
}

/// Heights of waypoints are the ground's, which others read; to a micrometre.
fn check_heights(setup: &DriveSetup, case: &Case, proof: &mut Proof) {
    for (number, p) in case.waypoints.iter().enumerate() {
        // Where the map has no ground the replay ends.
        let Ok(patch) = setup.map.patch(p.x, p.y) else { continue };
        let mut found = Collector::on_leg(&mut proof.findings, number.saturating_sub(1), 0.0);
        found.above("height", (p.z - patch.height).abs(), 1e-6, "m");
    }
}

/// What does not hold of the environment of `case`: its keep-outs are discs on the map that the plan keeps the
/// vehicle's radius from, everywhere, no more and no larger ones than were `asked` for; the force is horizontal and no
/// larger than was asked for; and there is nothing else. Where nothing was asked for, as with missions from elsewhere,
/// any force and disc is as good as another. Nothing for a case without one.
///
/// A force at its bound may exceed it by a share of 10⁻¹², which is rounding.
///
/// Clearances of discs are proven by the verification room's own replay of the legs on the map, or along straight legs
/// where the case claims no more.
pub(super) fn verify_environment(
    setup: &DriveSetup,
    asked: Option<DriveEnvironmentSection>,
    case: &Case,
) -> Vec<Finding> {
    let Some(environment) = &case.environment else { return Vec::new() };
    let Environment { wind_m_s, discrete_gust, obstacles, keep_out, external_force_n } = environment;
    let circles = keep_out.iter().filter(|place| place.polygon.is_none()).filter_map(|place| place.circle);
    let discs: Vec<ClearDisc> =
        circles.map(|circle| ClearDisc { center: circle.center_m, radius: circle.radius_m }).collect();
    let mut findings = Vec::new();
    let mut found = Collector::about(&mut findings, "environment");
    // What has no size is met by nothing.
    for (number, disc) in discs.iter().enumerate() {
        found.unless(disc.radius > 0.0, format_args!("keep_out[{number}].radius_m"), disc.radius, 0.0, "m");
    }
    // What no search of drives finds is not known to be clear, or to act at all.
    let others = keep_out.len() - discs.len() + obstacles.len();
    found.above("obstacles", others as f64, 0.0, "");
    found.above("wind_m_s", f64::from(u8::from(wind_m_s.is_some() || discrete_gust.is_some())), 0.0, "");
    let [east, north, up] = external_force_n.unwrap_or_default();
    // A vector at its bound may be rounded beyond it; what was not asked for among other things is not there.
    let most = asked.map_or(f64::INFINITY, |asked| asked.external_force_n.unwrap_or_default() * (1.0 + 1e-12));
    found.above("external_force_n", libm::hypot(east, north), most, "N");
    found.above("external_force_n[2]", up.abs(), 0.0, "N");
    let count = |asked: DriveEnvironmentSection| asked.obstacles.map_or(0, |placed| placed.count);
    found.above("keep_out", discs.len() as f64, asked.map_or(f64::INFINITY, |asked| count(asked) as f64), "");
    if let Some(placed) = asked.and_then(|asked| asked.obstacles) {
        for (number, disc) in discs.iter().enumerate() {
            found.above(format_args!("keep_out[{number}].radius_m"), disc.radius, placed.radius_m, "m");
        }
    }
    let legs = case.commands().map(|drive| leg_claims(case, drive));
    let waypoints = waypoints_of(case);
    let claim = ClearGroundClaim {
        drive: legs.as_deref().map_or(ClearDrive::Straight(&waypoints), ClearDrive::Legs),
        discs: &discs,
        clearance: setup.radius(),
        extent: setup.map.extent(),
    };
    findings.extend(verify_clear_ground(&ground_vehicle(&setup.planner), setup.map.as_ref(), &claim));
    findings
}

/// Poses as [x, y, yaw, curvature]; durations those of the case, or where it has none those that follow from the
/// speeds.
///
/// In the order of the legs; directions of travel are [start, end] in the body, rad; knots of speed are those of the
/// leg's own timing.
fn leg_claims(case: &Case, drive: &Drive) -> Vec<DriveLegClaim> {
    let end = |at: &Planar| [at.x, at.y, at.yaw, at.curvature];
    (drive.legs.iter().enumerate())
        .map(|(number, leg)| DriveLegClaim {
            from: end(&leg.from),
            to: end(&leg.to),
            pieces: leg.segments.iter().map(drive_piece).collect(),
            speed: leg.timing().knots(),
            direction: [leg.direction.start, leg.direction.end],
            // What the case says, which others read.
            duration: case.leg_times.get(number).copied().unwrap_or_else(|| drive.leg_time(number)),
        })
        .collect()
}

fn waypoints_of(case: &Case) -> Vec<[f64; 2]> {
    case.waypoints.iter().map(|p| [p.x, p.y]).collect()
}
