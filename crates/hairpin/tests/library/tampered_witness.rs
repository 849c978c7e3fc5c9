//! A witness is proof only if a wrong one is found out: on every shipped robot, one coefficient after the other.

use crate::campaigns::{asked, of, run, scenario, setup};
use hairpin::campaign::generate::Known;
use hairpin::campaign::{Case, Evidence, Witness, verify, verify_mission};
use hairpin::trajectory::Profile;
use hairpin::verification::Finding;
use serde_json::json;

fn profile_of(case: &mut Case) -> &mut Profile {
    match &mut case.witness {
        Some(Witness::Profile(profile)) => profile,
        other => panic!("not a profile: {other:?}"),
    }
}

#[test]
fn any_coefficient_off_by_a_percent_is_found() {
    for name in ["anafi", "anafi-real", "crazyflie", "flightgoggles", "iris", "paper-flightgoggles", "x500"] {
        let setup = setup(name, 4, asked("witness", "beam", 1));
        let (cases, tally) = run(&setup, &Known::default());
        let case = cases.first().unwrap_or_else(|| panic!("{name}: {tally:?}"));
        assert_eq!(case.evidence, Evidence::Witnessed, "{name}");
        let proof = verify(&setup, case).proof.expect("a proof");
        assert!(proof.findings.is_empty(), "{name}, untouched: {:?}", proof.findings);

        let legs = case.profile().expect("a witness").legs.len();
        let mut tampered = [0; 3];
        for (leg, axis, power) in (0..legs).flat_map(|l| (0..3).flat_map(move |a| (0..8).map(move |p| (l, a, p)))) {
            let mut wrong = case.clone();
            let coefficient = &mut profile_of(&mut wrong).legs[leg].coefficients[axis][power];
            if *coefficient == 0.0 {
                continue;
            }
            *coefficient *= 1.01;
            let proof = verify(&setup, &wrong).proof.expect("a proof");
            assert!(!proof.findings.is_empty(), "{name}: leg {leg}, axis {axis}, power {power} passes");
            tampered[axis] += 1;
        }
        // A septic has four coefficients beside those that rest and level at its start make zero.
        assert!(tampered.iter().all(|count| *count >= 4 * legs), "{name}: {tampered:?} is too few to tell");
    }
}

/// What was planned by wider limits, or in another world, is found by those that are asked.
#[test]
fn flights_are_held_to_the_limits_and_the_world_that_are_asked() {
    let wide = asked("witness", "beam", 1);
    let (cases, tally) = run(&setup("flightgoggles", 4, wide.clone()), &Known::default());
    let mut case = cases.first().unwrap_or_else(|| panic!("{tally:?}")).clone();
    // As where `worst` moved its waypoints: no search saw those legs, and it was searched for all the same.
    case.seen.clear();
    let case = &case;
    let [x, y, z] = [case.waypoints[1].x, case.waypoints[1].y, case.waypoints[1].z];
    let ball = json!({ "name": "ball", "sphere": { "center_m": [x, y, z], "radius_m": 0.1 } });
    let cuboid = json!({ "name": "box", "box": { "center_m": [x, y, z], "size_m": [0.1, 0.1, 0.1] } });
    let capsule = json!({ "a_m": [x, y, z - 0.1], "b_m": [x, y, z + 0.1], "radius_m": 0.05 });
    let capsule = json!({ "name": "capsule", "capsule": capsule });
    let corners = [[x - 0.1, y - 0.1, z - 0.1], [x + 0.2, y, z], [x, y + 0.2, z], [x, y, z + 0.2]];
    let hull = json!({ "name": "hull", "hull": { "points_m": corners } });
    for (key, value, told) in [
        ("/generate/limits/max_speed_m_s", json!(0.1), ".speed"),
        ("/generate/limits/max_tilt_deg", json!(0.1), ".tilt"),
        ("/world/obstacles", json!([ball]), "world.obstacles[0].clearance"),
        ("/world/obstacles", json!([cuboid]), "world.obstacles[0].clearance"),
        ("/world/obstacles", json!([capsule]), "world.obstacles[0].clearance"),
        ("/world/obstacles", json!([hull]), "world.obstacles[0].clearance"),
        ("/task/length", json!(11), "task.length"),
        ("/task/end_m/0", json!(18.0), "task.end"),
    ] {
        let mut other = scenario("flightgoggles", 4, wide.clone());
        *other.pointer_mut(key).expect(key) = value;
        let asked_for = other.clone();
        let findings = verify(&of(other), case).proof.expect("a proof").findings;
        let fits = |told_of: &str| told_of.ends_with(told);
        assert!(!findings.is_empty() && findings.iter().all(|one| fits(&one.field)), "{key}: {findings:?}");
        let elsewhere = verify_mission(&of(asked_for), case).proof.expect("a proof");
        assert_eq!(elsewhere.ok(), told.starts_with("task."), "{key}: missions have tasks of their own");
    }
    // Flown alike, and 10 m farther along x: beyond the wall's margin at 19 m.
    let mut aside = case.clone();
    aside.waypoints.iter_mut().for_each(|p| p.x += 10.0);
    profile_of(&mut aside).legs.iter_mut().for_each(|leg| leg.coefficients[0][0] += 10.0);
    let findings = verify(&setup("flightgoggles", 4, wide), &aside).proof.expect("a proof").findings;
    assert!(findings.iter().any(|one| one.field == "world.walls[0].high.clearance"), "{findings:?}");
    let is_of = |one: &Finding| one.field.starts_with("world.") || ["task.start", "task.end"].contains(&&*one.field);
    assert!(findings.iter().all(is_of), "{findings:?}");
}
