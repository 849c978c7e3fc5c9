//! Keep-outs searched beside the waypoints of drives: clear of what is planned, in the way of what is driven.

use hairpin::campaign::generate::Known;
use hairpin::campaign::scenario::CircleSection;
use hairpin::campaign::{Case, Scenario, Setup, Stop, execute_run, generate, judge, planned, verify};
use hairpin::trajectory::Ended;
use serde_json::{Value, json};

/// A car that starts in the middle of 30 m of flat ground, searched in the loop; `reach` and what is searched beside the waypoints are put in.
fn setup(reach: &str, environment: &Value) -> Setup {
    with_controller("stanley", reach, environment)
}

fn with_controller(controller: &str, reach: &str, environment: &Value) -> Setup {
    let path = format!("{}/../../data/robots/ground/car.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped car");
    let robot: Value = toml::from_str(&text).expect("its keys");
    let search = json!({ "method": "in-loop", "waypoints": 24, "cases": 2, "executions": 14, "stress": "clearance" });
    let generate = json!({
        "reach": reach, "step_s": 2.0, "headings": 2, "speed": { "profile": "trapezoid" },
        "limits": { "speed_m_s": 1.5, "curvature_1_m": 1.0, "curvature_rate_1_m2": 1.5 },
        "search": search, "environment": environment,
    });
    let scenario = json!({
        "hairpin": 1, "robot": robot, "seed": 7,
        "world": { "terrain": { "generator": "flat", "size_m": 30, "cell_m": 0.5 } },
        "task": { "start": { "x_m": 15, "y_m": 15 }, "length": 4, "leg_m": [2, 5] },
        "generate": generate,
        "execute": { "controller": controller },
    });
    Setup::new(serde_json::from_value::<Scenario>(scenario).expect("a scenario")).expect("a campaign")
}

fn searched(setup: &Setup) -> Vec<Case> {
    let stop = Stop { cancelled: &|| false, progress: &|_, _| {}, clock: &|| 0.0 };
    let mut cases = Vec::new();
    generate(setup, &Known::default(), &stop, &mut |new, _| cases.extend_from_slice(new));
    cases
}

fn discs(case: &Case) -> Vec<CircleSection> {
    let found = case.environment.as_ref().expect("an environment");
    found.keep_out.iter().map(|place| place.circle.expect("a disc")).collect()
}

/// Least distance between the rims of `discs` and the places of a track, straight from one to the next.
fn nearest(discs: &[CircleSection], places: &[[f64; 2]]) -> f64 {
    let mut least = f64::INFINITY;
    for disc in discs {
        for pair in places.windows(2) {
            for part in 0..8 {
                let at = |axis: usize| pair[0][axis] + f64::from(part) / 8.0 * (pair[1][axis] - pair[0][axis]);
                least = least.min((at(0) - disc.center_m[0]).hypot(at(1) - disc.center_m[1]) - disc.radius_m);
            }
        }
    }
    least
}

fn places(track: &hairpin::trajectory::Track) -> Vec<[f64; 2]> {
    (0..track.len()).map(|index| track.position(index)).map(|p| [p.x, p.y]).collect()
}

#[test]
fn what_is_planned_is_clear_of_what_was_placed_and_what_is_driven_is_not() {
    let obstacles = json!({ "obstacles": { "count": 2, "radius_m": 0.3 } });
    for reach in ["witness", "none"] {
        let setup = setup(reach, &obstacles);
        let radius = setup.drive().expect("a drive").radius();
        let cases = searched(&setup);
        assert_eq!(cases.len(), 2, "{reach}");
        for case in &cases {
            let discs = discs(case);
            assert_eq!(discs.len(), 2, "{reach}");
            let on_map = |disc: &CircleSection| disc.center_m.iter().all(|x| (0.25 + 0.3..=29.75 - 0.3).contains(x));
            assert!(discs.iter().all(on_map), "{reach}: {discs:?}");
            let plan = nearest(&discs, &places(&planned(&setup, case).expect("a plan")));
            assert!(plan >= radius, "{reach}: {plan}, {radius}");
            // The judge's own number, among them, and the distance kept without them.
            let run = execute_run(&setup, case, 0);
            let among = judge(&setup, case, std::slice::from_ref(&run)).expect("a verdict").measures.expect("measures");
            assert!((case.score + among.min_clearance.expect("a clearance")).abs() < 1e-12, "{reach}");
            assert_eq!(run.outcome.expect("a drive").ended, Ended::Obstacle, "{reach}");
            let free = execute_run(&setup, &Case { environment: None, ..case.clone() }, 0).outcome.expect("a drive");
            let driven = nearest(&discs, &places(&free.track));
            assert!(driven < radius && driven < plan, "{reach}: {driven}, {plan}");
            let proof = verify(&setup, case).proof.expect("a proof");
            assert!(proof.ok(), "{reach}: {:?}", proof.findings);
        }
    }
}

/// What controllers see does not hold what they are to be kept from: up to where a drive meets it, it is the drive without.
#[test]
fn a_drive_is_the_same_with_and_without_keep_outs_until_it_meets_one() {
    let obstacles = json!({ "obstacles": { "count": 2, "radius_m": 0.3 } });
    for controller in ["pure-pursuit", "stanley", "predictive"] {
        let setup = with_controller(controller, "witness", &obstacles);
        for case in searched(&setup) {
            let drive = |case: &Case| execute_run(&setup, case, 0).outcome.expect("a drive");
            let (among, free) = (drive(&case), drive(&Case { environment: None, ..case.clone() }));
            assert!(among.track.len() > 20 && among.track.len() < free.track.len(), "{controller}");
            // The last sample is that of the moment at which it was met.
            let common = among.track.len() - 1;
            assert_eq!(among.track.times()[..common], free.track.times()[..common], "{controller}");
            assert_eq!(among.track.poses()[..common], free.track.poses()[..common], "{controller}");
        }
    }
}

#[test]
fn a_disc_in_the_way_of_the_plan_or_off_the_map_is_refused() {
    let setup = setup("witness", &json!({ "obstacles": { "count": 2, "radius_m": 0.3 } }));
    let case = searched(&setup).remove(0);
    let fields = |change: &dyn Fn(&mut Case)| {
        let mut forged = case.clone();
        change(&mut forged);
        let findings = verify(&setup, &forged).proof.expect("a proof").findings;
        findings.into_iter().map(|finding| finding.field).collect::<Vec<_>>().join(" ")
    };
    let moved = |number: usize, center_m: [f64; 2]| {
        move |case: &mut Case| {
            let place = &mut case.environment.as_mut().expect("an environment").keep_out[number];
            place.circle.as_mut().expect("a disc").center_m = center_m;
        }
    };
    let plan = places(&planned(&setup, &case).expect("a plan"));
    let (radius, middle) = (setup.drive().expect("a drive").radius(), plan[plan.len() / 2]);
    assert_eq!(fields(&|_| {}), "");
    assert_eq!(fields(&moved(1, middle)), "environment.keep_out[1].clearance");
    // A millimetre less than the vehicle's radius from the goal, on the far side of it.
    let (goal, before) = (plan[plan.len() - 1], plan[plan.len() - 2]);
    let way = [goal[0] - before[0], goal[1] - before[1]].map(|d| d / (goal[0] - before[0]).hypot(goal[1] - before[1]));
    let beyond = |gap: f64| [0, 1].map(|axis| goal[axis] + way[axis] * (0.3 + radius + gap));
    assert_eq!(fields(&moved(0, beyond(-0.002))), "environment.keep_out[0].clearance");
    assert_eq!(fields(&moved(0, beyond(0.002))), "");
    assert_eq!(fields(&moved(0, [0.5, 1.0])), "environment.keep_out[0].outside");
    let other = |case: &mut Case| case.environment.as_mut().expect("an environment").external_force_n = Some([0.0, 0.0, 1.0]);
    assert_eq!(fields(&other), "environment.external_force_n[2]");
    let windy = |case: &mut Case| case.environment.as_mut().expect("an environment").wind_m_s = Some([1.0, 0.0, 0.0]);
    assert_eq!(fields(&windy), "environment.wind_m_s");
}

#[test]
fn threads_change_nothing() {
    let setup = setup("witness", &json!({ "obstacles": { "count": 2, "radius_m": 0.3 } }));
    let [one, two] = [1, 2].map(|threads| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool").install(|| searched(&setup))
    });
    assert_eq!(one, two);
}
