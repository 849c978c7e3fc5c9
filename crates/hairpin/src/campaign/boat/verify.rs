//! Hands the written witnesses to the verification room, as plain numbers.

use super::BoatSetup;
use crate::campaign::Case;
use crate::campaign::kind::{Made, PlannedRows, Task, flat_places, verify_task, verify_times};
use crate::robot::boat::Boat;
use crate::trajectory::Profile;
use crate::verification::boat::{BoatClaim, BoatHull, BoatLeg, boat_with_lag, verify_boat, verify_boat_rows};
use crate::verification::{Collector, EndError, Finding, Proof, Tolerances};

/// Error of the integrated state, SI: damping has bends, which no order makes smooth.
///
/// It is the tolerance of the proof's own integrator, not that of what is proven.
const ACCURACY: f64 = 1e-8;

/// The proof of the witness of `case`, and its end error with thrusters that lag; `None` for a case that claims none.
/// An environment is found by no search of boats: that it acts, or is clear, is not known.
///
/// Limits are those of the setup that is asked: the share of thrust, the top speed, the waters less their margin.
///
/// What was searched for begins, ends and is as long as the task has it.
pub(super) fn verify(setup: &BoatSetup, case: &Case, made: Made) -> (Option<Proof>, Option<EndError>) {
    let (mut proof, with_lag) = witness(setup, case).unzip();
    if let Some(proof) = proof.as_mut().filter(|_| made == Made::Searched) {
        let task = &setup.scenario.task;
        verify_task(&Task { start: &task.start_m, end: Some(&task.end_m), length: task.length }, case, proof);
    }
    if case.environment.is_some() {
        let findings = &mut proof.get_or_insert_default().findings;
        Collector::about(findings, "environment").unless(false, "given", 1.0, 0.0, "");
    }
    (proof, with_lag.flatten())
}

/// Holds the rows that are kept of the planned motion of `case` to its polynomials by independent code; nothing for a
/// case that claims no witness.
pub(super) fn verify_planned(case: &Case, kept: &PlannedRows) -> Vec<Finding> {
    let Some(profile) = case.profile() else { return Vec::new() };
    verify_boat_rows(&legs_of(profile), &kept.with_middles())
}

fn legs_of(profile: &Profile) -> Vec<BoatLeg> {
    profile.legs.iter().map(|leg| BoatLeg { duration: leg.duration, coefficients: leg.coefficients }).collect()
}

/// Beside what the verification room finds: the case's leg times are the witness's, all within `max_time_s`, and all
/// waypoints lie in z = 0.
fn witness(setup: &BoatSetup, case: &Case) -> Option<(Proof, Option<EndError>)> {
    let profile = case.profile()?;
    let (generate, world) = (&setup.scenario.generate, &setup.scenario.world);
    let waypoints: Vec<[f64; 2]> = case.waypoints.iter().map(|p| [p.x, p.y]).collect();
    let legs = legs_of(profile);
    let places = flat_places(&setup.keep_out);
    let margin = world.keep_in_margin_m;
    let claim = BoatClaim {
        waypoints: &waypoints,
        legs: &legs,
        current: world.current(),
        max_speed: generate.limits.max_speed_m_s.unwrap_or(f64::INFINITY),
        waters: ([margin; 2], world.size_m.map(|side| side - margin)),
        places: &places,
    };
    let hull = hull_of(&setup.boat, generate.limits.thrust_share.unwrap_or(1.0));
    let tolerances = Tolerances { accuracy: ACCURACY, ..Tolerances::default() };
    let mut proof = verify_boat(&hull, &claim, &tolerances);
    verify_times(case, profile, setup.longest(), &mut proof);
    for number in 0..legs.len() {
        let mut found = Collector::on_leg(&mut proof.findings, number, 0.0);
        found.above("height", case.waypoints[number + 1].z.abs(), 0.0, "m");
    }
    Some((proof, boat_with_lag(&hull, &claim)))
}

/// The boat's numbers, its forces to the `share` that plans use.
///
/// Numbers alone: mass is [surge, sway, coupling of sway and yaw, yaw] with the water that moves along; bounds of
/// forces are [least, greatest] of surge (N), sway (N) and yaw (N·m).
fn hull_of(boat: &Boat, share: f64) -> BoatHull {
    let (m, d) = (&boat.inertia, &boat.damping);
    BoatHull {
        mass: [m.surge, m.sway, m.sway_yaw, m.yaw],
        surge: d.surge,
        sway_by_sway: d.sway_by_sway,
        sway_by_yaw: d.sway_by_yaw,
        yaw_by_sway: d.yaw_by_sway,
        yaw_by_yaw: d.yaw_by_yaw,
        forces: boat.thrust.bounds().map(|bounds| bounds.map(|force| share * force)),
        time_constant: boat.thrust_time_constant,
        radius: boat.radius,
    }
}
