//! Whole campaigns through the library: what a case claims is checked again by equations written here.

use crate::campaigns::{ENDLESS, asked, check_witness, distance_to_hull, from_mast, run, setup};
use hairpin::campaign::flight::FlightSetup;
use hairpin::campaign::generate::Known;
use hairpin::campaign::{Case, Curve, Evidence, OwnSimulator, Scenario, Setup, Stop, Tally, generate, optima, verdict};
use hairpin::feasibility::reach::sampling;
use hairpin::math::simd::Simd;
use hairpin::robot::quadrotor::Quadrotor;
use nalgebra::{Point3, Vector3};
use serde_json::json;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What holds for every case of every reach set.
fn check_common(setup: &Setup, case: &Case, what: &str) {
    let w = &case.waypoints;
    assert_eq!(w.len() as u64, setup.scenario.length().expect("a length"), "{what}");
    assert_eq!((w[0], w[w.len() - 1]), (Point3::new(3.0, 3.0, 3.0), Point3::new(12.0, 12.0, 12.0)), "{what}");
    assert_eq!(case.leg_times.len(), w.len() - 1, "{what}");
    assert!(case.leg_times.iter().sum::<f64>() <= 60.0, "{what}");
    assert!(w.iter().all(|p| p.iter().all(|c| (1.0..=19.0).contains(c))), "{what}");
    for (i, p) in w.iter().enumerate() {
        assert!(!w[..i].contains(p), "{what}: waypoint {i} is visited twice");
    }
    for (leg, time) in w.windows(2).zip(&case.leg_times) {
        assert!((leg[1] - leg[0]).norm() <= 8.0 * time * (1.0 + 1e-9), "{what}: faster than 8 m/s");
    }
}

/// Straight steps stay clear of the mast by the robot's radius.
fn check_straight(robot: &Quadrotor, case: &Case, what: &str) {
    for leg in case.waypoints.windows(2) {
        for k in 0..=400 {
            let p = leg[0] + (leg[1] - leg[0]) * (f64::from(k) / 400.0);
            assert!(from_mast(&p) >= robot.clearance_radius - 1e-9, "{what}: {p}");
        }
    }
}

#[test]
fn every_reach_set_by_every_search_gives_what_it_claims() {
    for reach in ["none", "sphere", "hull", "witness"] {
        for method in ["beam", "exact", "uniform"] {
            let length = if reach == "witness" { 5 } else { 7 };
            let setup = setup("flightgoggles", length, asked(reach, method, 3));
            let (cases, tally) = run(&setup, &Known::default());
            assert_eq!(cases.len(), 3, "{reach}, {method}: {tally:?}");
            for case in &cases {
                let what = format!("{reach}, {method}, case {}", case.number);
                check_common(&setup, case, &what);
                let claimed = match reach {
                    "witness" => Evidence::Witnessed,
                    "hull" => Evidence::HullFeasible,
                    _ => Evidence::Unchecked,
                };
                assert_eq!(case.evidence, claimed, "{what}");
                if reach == "witness" {
                    check_witness(&setup, case, &what);
                } else {
                    check_straight(&setup.own::<FlightSetup>().expect("a flight").robot, case, &what);
                }
                if reach == "hull" {
                    check_hull(&setup.own::<FlightSetup>().expect("a flight").robot, case, &what);
                }
            }
        }
    }
}

/// Every second difference lies in the hull of simulated ends; the robot has no linear drag, so velocity is carried
/// whole.
fn check_hull(robot: &Quadrotor, case: &Case, what: &str) {
    assert_eq!(robot.drag_linear, 0.0);
    let speeds = sampling::constant_speeds(robot, 3);
    let ends = sampling::end_points(Simd::default(), robot, &speeds, 1.0, 2 * sampling::steps(robot, 1.0));
    let mut before = Vector3::zeros();
    for leg in case.waypoints.windows(2) {
        let difference = (leg[1] - leg[0]) - before;
        let off = distance_to_hull(&ends, &difference);
        assert!(off < 0.02, "{what}: {off} m outside the hull");
        before = leg[1] - leg[0];
    }
    assert!(distance_to_hull(&ends, &Vector3::new(0.0, 0.0, 500.0)) > 100.0, "the oracle can say no");
}

#[test]
fn the_exact_search_is_never_beaten_on_the_same_graph() {
    for reach in ["hull", "witness"] {
        let best = |method: &str| run(&setup("flightgoggles", 5, asked(reach, method, 4)), &Known::default()).0;
        let (exact, beam) = (best("exact"), best("beam"));
        let mut compared = 0;
        for case in &beam {
            if let Some(optimum) = exact.iter().find(|other| other.graph == case.graph) {
                assert!(optimum.score >= case.score - 1e-9, "{reach}: {} < {}", optimum.score, case.score);
                compared += 1;
            }
        }
        assert!(compared > 0, "{reach}");
    }
}

#[test]
fn optima_of_several_scores_are_those_of_one_search_each() {
    let names = ["high-velocity", "crest"];
    let shared = optima(&setup("flightgoggles", 6, asked("hull", "beam", 3)), &names, &ENDLESS).expect("optima");
    assert_eq!(shared.len(), 4);
    for optimum in &shared {
        let mut alone = asked("hull", "exact", 3);
        alone["score"] = json!(names[optimum.score]);
        alone["search"]["aggregate"] = json!(optimum.aggregate);
        let (cases, _) = run(&setup("flightgoggles", 6, alone.clone()), &Known::default());
        assert_eq!(optimum.cases, cases, "{alone}");
        let own = optima(&setup("flightgoggles", 6, alone), &[], &ENDLESS).expect("optima");
        let own = own.iter().find(|own| own.aggregate == optimum.aggregate).expect("both aggregates");
        assert_eq!(own.cases, cases, "the scenario's own");
    }
    assert_ne!(shared[0].cases, shared[2].cases, "the scores differ");
    let unknown = optima(&setup("flightgoggles", 6, asked("hull", "beam", 3)), &["fast"], &ENDLESS);
    assert!(unknown.is_err_and(|error| error.contains("`fast`")));
}

#[test]
fn interruptions_and_threads_change_nothing() {
    let setup = setup("flightgoggles", 6, asked("hull", "beam", 4));
    let mut prefixes = vec![Known::default()];
    let mut cases = Vec::new();
    let tally = generate(&setup, &Known::default(), &OwnSimulator, &ENDLESS, &mut |new, tally| {
        cases.extend_from_slice(new);
        prefixes.push(Known { cases: cases.clone(), tally: tally.clone() });
    });
    assert!(prefixes.len() > 4 && tally.complete);
    for known in &prefixes {
        assert_eq!(run(&setup, known), (cases.clone(), tally.clone()), "from {:?}", known.tally);
    }
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        assert_eq!(pool.install(|| run(&setup, &Known::default())), (cases.clone(), tally.clone()), "{threads}");
    }
}

/// Wherever a search that executes is stopped, it goes on to where it would have come without.
#[test]
fn a_graph_whose_executions_were_cut_off_is_searched_again() {
    let mut wanted = asked("hull", "in-loop", 3);
    wanted["search"]["executions"] = json!(40);
    let mut scenario = crate::campaigns::scenario("flightgoggles", 6, wanted);
    scenario["execute"] = json!({ "controller": "stable-waypoint" });
    let setup = crate::campaigns::of(scenario);
    let (calm, whole) = run(&setup, &Known::default());
    assert_eq!(calm.len(), 3);
    let looks = AtomicUsize::new(0);
    let looking = || looks.fetch_add(1, Ordering::Relaxed) == usize::MAX;
    generate(&setup, &Known::default(), &OwnSimulator, &Stop { cancelled: &looking, ..ENDLESS }, &mut |_, _| {});
    // Asked for the n-th time, the caller wants to stop: before, within and behind graphs, and before the last one that
    // is needed.
    for share in [0, 1, 2, 3, 4, 5, 6] {
        let patience = looks.load(Ordering::Relaxed) * share / 10;
        let looks = AtomicUsize::new(0);
        let cancelled = || looks.fetch_add(1, Ordering::Relaxed) >= patience;
        let mut kept = Vec::new();
        let stop = Stop { cancelled: &cancelled, ..ENDLESS };
        let tally =
            generate(&setup, &Known::default(), &OwnSimulator, &stop, &mut |new, _| kept.extend_from_slice(new));
        assert!(tally.stopped && kept.len() < calm.len(), "not stopped at look {patience}");
        assert!(kept[..] == calm[..kept.len()], "stopped at look {patience}");
        let (cases, resumed) = run(&setup, &Known { cases: kept, tally });
        assert!(cases == calm && resumed.curves == whole.curves, "resumed from look {patience}");
    }
}

/// Wherever a search is stopped in a graph, nothing is claimed of that graph, and it is searched again.
#[test]
fn a_graph_whose_legs_were_kept_back_is_searched_again() {
    for (reach, method) in [("hull", "beam"), ("witness", "exact"), ("hull", "uniform")] {
        let setup = setup("flightgoggles", 6, asked(reach, method, 3));
        let looks = AtomicUsize::new(0);
        let looking = || looks.fetch_add(1, Ordering::Relaxed) == usize::MAX;
        let mut calm = Vec::new();
        let looked = Stop { cancelled: &looking, ..ENDLESS };
        let whole =
            generate(&setup, &Known::default(), &OwnSimulator, &looked, &mut |new, _| calm.extend_from_slice(new));
        assert_eq!(calm.len(), 3, "{method}");
        assert!(looks.load(Ordering::Relaxed) > 20, "{method}: asked within graphs");
        for share in [0, 1, 3, 5] {
            let patience = looks.load(Ordering::Relaxed) * share / 10;
            let looks = AtomicUsize::new(0);
            let cancelled = || looks.fetch_add(1, Ordering::Relaxed) >= patience;
            let (mut kept, stop) = (Vec::new(), Stop { cancelled: &cancelled, ..ENDLESS });
            let tally =
                generate(&setup, &Known::default(), &OwnSimulator, &stop, &mut |new, _| kept.extend_from_slice(new));
            let proven = tally.proven_empty <= whole.proven_empty;
            assert!(tally.stopped && proven, "{method} at look {patience}: {tally:?}");
            assert!(kept[..] == calm[..kept.len()], "{method} at look {patience}");
            assert!(run(&setup, &Known { cases: kept, tally }).0 == calm, "{method} resumed from look {patience}");
        }
    }
}

#[test]
fn nothing_feasible_is_told_with_its_proof() {
    let setup = setup("flightgoggles", 2, asked("hull", "beam", 2));
    let (cases, tally) = run(&setup, &Known::default());
    assert!(cases.is_empty() && tally.proven_empty == tally.graphs && tally.graphs > 0, "{tally:?}");
    let verdict = verdict(&setup, &[], (&[], None), &tally);
    assert_eq!(verdict.exit_code, 3);
    assert!(verdict.sentence.starts_with("NOTHING FEASIBLE (proof, hull)"), "{}", verdict.sentence);
}

/// What was executed was feasible: that nothing of it was measured is no proof of anything.
#[test]
fn nothing_measured_is_not_nothing_feasible() {
    let setup = setup("flightgoggles", 2, asked("hull", "beam", 2));
    let why = "no execution came to a measure of what is searched for";
    let curves = vec![Curve { executions: 30, ..Default::default() }];
    let tally = Tally { graphs: 30, nothing: Some(why.into()), curves, ..Tally::default() };
    let verdict = verdict(&setup, &[], (&[], None), &tally);
    assert_eq!(verdict.exit_code, 5);
    assert_eq!(verdict.sentence, format!("INCONCLUSIVE 0/2 (30 executed, hull): {why}"));
}

#[test]
fn lengths_that_vary_are_drawn_per_case() {
    let scenario = setup("flightgoggles", 6, asked("hull", "beam", 6)).scenario;
    let mut scenario = serde_json::to_value(scenario).expect("plain data");
    scenario["vary"]["task.length"] = json!({ "uniform": [5, 9] });
    let setup = Setup::new(serde_json::from_value::<Scenario>(scenario).expect("a scenario")).expect("a campaign");
    let (cases, _) = run(&setup, &Known::default());
    assert_eq!(cases.first().map(|case| case.waypoints.len()), Some(6), "case 0 is nominal");
    assert!(cases.iter().all(|case| (5..=9).contains(&case.waypoints.len())));
    assert!(cases.iter().any(|case| case.waypoints.len() != 6), "something varies");
}
