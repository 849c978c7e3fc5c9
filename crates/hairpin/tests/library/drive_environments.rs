//! Keep-outs searched beside the waypoints of drives: clear of what is planned, in the way of what is driven.

use hairpin::campaign::drive::DriveSetup;
use hairpin::campaign::generate::Known;
use hairpin::campaign::scenario::CircleSection;
use hairpin::campaign::{Case, OwnSimulator, Scenario, Setup, Stop, execute_run, generate, judge, planned, verify};
use hairpin::trajectory::Ended;
use serde_json::{Value, json};

/// What is searched.
#[derive(Clone, Copy)]
struct Asked<'a> {
    robot: &'a str,
    reach: &'a str,
    controller: &'a str,
    cases: u64,
    executions: u64,
}

/// A car with stanley, late by 0.2 s, over legs with commands.
const CAR: Asked = Asked { robot: "car", reach: "witness", controller: "stanley", cases: 2, executions: 14 };

/// Starts in the middle of 30 m of flat ground; two discs are searched in the loop.
fn setup(asked: Asked) -> Setup {
    let path = format!("{}/../../data/robots/ground/{}.toml", env!("CARGO_MANIFEST_DIR"), asked.robot);
    let text = std::fs::read_to_string(path).expect("a shipped robot");
    let robot: Value = toml::from_str(&text).expect("its keys");
    let search = json!({
        "method": "in-loop", "waypoints": 24, "cases": asked.cases, "executions": asked.executions, "stress": "clearance",
    });
    // The wheels of the differential drive go at 0.22 m/s.
    let speed = if asked.robot == "differential-drive" { 0.2 } else { 1.5 };
    let generate = json!({
        "reach": asked.reach, "step_s": 2.0, "headings": 2, "speed": { "profile": "trapezoid" },
        "limits": { "speed_m_s": speed, "curvature_1_m": 1.0, "curvature_rate_1_m2": 1.5 },
        "search": search, "environment": { "obstacles": { "count": 2, "radius_m": 0.3 } },
    });
    let scenario = json!({
        "hairpin": 1, "robot": robot, "seed": 7,
        "world": { "terrain": { "generator": "flat", "size_m": 30, "cell_m": 0.5 } },
        "task": { "start": { "x_m": 15, "y_m": 15 }, "length": 4, "leg_m": [2, 5] },
        "generate": generate,
        "execute": { "controller": asked.controller, "latency_s": 0.2 },
    });
    Setup::new(serde_json::from_value::<Scenario>(scenario).expect("a scenario")).expect("a campaign")
}

fn searched(setup: &Setup) -> Vec<Case> {
    let stop = Stop { cancelled: &|| false, progress: &|_, _| {}, clock: &|| 0.0 };
    let mut cases = Vec::new();
    generate(setup, &Known::default(), &OwnSimulator, &stop, &mut |new, _| cases.extend_from_slice(new));
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
fn what_is_planned_is_clear_of_what_was_placed_and_what_is_driven_comes_nearer() {
    // Along straight legs a differential drive keeps to its plan within millimetres.
    let straight = Asked { robot: "differential-drive", reach: "none", ..CAR };
    for (asked, meets) in [(CAR, true), (straight, false)] {
        let (setup, reach) = (setup(asked), asked.reach);
        let radius = setup.own::<DriveSetup>().expect("a drive").radius();
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
            let free = execute_run(&setup, &Case { environment: None, ..case.clone() }, 0).outcome.expect("a drive");
            let driven = nearest(&discs, &places(&free.track));
            assert!(driven < plan, "{reach}: {driven}, {plan}");
            if meets {
                assert!(driven < radius - 0.1, "{reach}: {driven}, {radius}");
                assert_eq!(run.outcome.expect("a drive").ended, Ended::Obstacle, "{reach}");
            }
            let proof = verify(&setup, case).proof.expect("a proof");
            assert!(proof.ok(), "{reach}: {:?}", proof.findings);
        }
    }
}

/// What controllers see does not hold what they are to be kept from: up to where a drive meets it, it is the drive
/// without.
#[test]
fn a_drive_is_the_same_with_and_without_keep_outs_until_it_meets_one() {
    for controller in ["pure-pursuit", "stanley", "predictive"] {
        let setup = setup(Asked { controller, cases: 1, executions: 4, ..CAR });
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
    let setup = setup(CAR);
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
    let (radius, middle) = (setup.own::<DriveSetup>().expect("a drive").radius(), plan[plan.len() / 2]);
    assert_eq!(fields(&|_| {}), "");
    assert_eq!(fields(&moved(1, middle)), "environment.keep_out[1].clearance");
    // A disc drawn towards the plan is found two millimetres too near, and not two before that.
    let center = discs(&case)[0].center_m;
    let apart = |p: &[f64; 2]| (p[0] - center[0]).hypot(p[1] - center[1]);
    let foot = plan.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))).expect("a plan");
    let drawn = |gap: f64| {
        let share = (0.3 + radius + gap) / apart(foot);
        [0, 1].map(|axis| foot[axis] + share * (center[axis] - foot[axis]))
    };
    assert_eq!(fields(&moved(0, drawn(-0.002))), "environment.keep_out[0].clearance");
    assert_eq!(fields(&moved(0, drawn(0.002))), "");
    assert_eq!(fields(&moved(0, [0.5, 1.0])), "environment.keep_out[0].outside");
    let other =
        |case: &mut Case| case.environment.as_mut().expect("an environment").external_force_n = Some([0.0, 0.0, 1.0]);
    assert_eq!(fields(&other), "environment.external_force_n[2]");
    let windy = |case: &mut Case| case.environment.as_mut().expect("an environment").wind_m_s = Some([1.0, 0.0, 0.0]);
    assert_eq!(fields(&windy), "environment.wind_m_s");
    // Two of 0.3 m were asked for: none may be larger, and there may be no third.
    let sized = |radius_m: f64| {
        move |case: &mut Case| {
            let place = &mut case.environment.as_mut().expect("an environment").keep_out[0];
            place.circle.as_mut().expect("a disc").radius_m = radius_m;
        }
    };
    assert_eq!(fields(&sized(0.3f64.next_down())), "");
    assert!(fields(&sized(0.3f64.next_up())).starts_with("environment.keep_out[0].radius_m"));
    let third = |case: &mut Case| {
        let places = &mut case.environment.as_mut().expect("an environment").keep_out;
        places.push(places[0].clone());
    };
    assert_eq!(fields(&third), "environment.keep_out");
}

#[test]
fn threads_change_nothing() {
    let setup = setup(CAR);
    let [one, two] = [1, 2].map(|threads| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool").install(|| searched(&setup))
    });
    assert_eq!(one, two);
}
