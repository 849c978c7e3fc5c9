//! `certify = true`: yes comes with a witness within every limit, no with a proof, and everything else is unknown.

use crate::campaigns::{asked, check_witness, of, run, scenario};
use hairpin::campaign::generate::Known;
use hairpin::campaign::{Case, Evidence, Setup};
use serde_json::{Value, json};

/// The cases of a campaign of this length whose `generate` has `limits` and whose plans are certified.
fn certified(reach: &str, length: usize, step_s: f64, limits: Value) -> (Setup, Vec<Case>) {
    let mut generate = asked(reach, "beam", 4);
    generate["certify"] = json!(true);
    generate["timing"] = json!({ "step_s": step_s });
    generate["limits"] = limits;
    let setup = of(scenario("flightgoggles", length, generate));
    let (cases, tally) = run(&setup, &Known::default());
    assert_eq!(cases.len(), 4, "{tally:?}");
    (setup, cases)
}

/// What a case without a witness is: as it was before it was asked about.
fn check_unwitnessed(case: &Case, claimed: Evidence, step_s: f64) {
    assert_eq!((case.evidence, &case.witness), (claimed, &None), "case {}", case.number);
    assert!(case.leg_times.iter().all(|time| *time == step_s), "case {}: {:?}", case.number, case.leg_times);
}

#[test]
fn yes_where_there_is_time_and_thrust() {
    let limits = json!({ "max_speed_m_s": 8.0, "max_tilt_deg": 45, "max_flight_time_s": 60 });
    let (setup, cases) = certified("hull", 6, 1.0, limits);
    for case in &cases {
        let what = format!("case {}", case.number);
        assert_eq!((case.certified, case.evidence), (Some("yes"), Evidence::Witnessed), "{what}");
        check_witness(&setup, case, &what);
        let legs = &case.profile().expect("a witness").legs;
        assert!(legs.iter().map(|leg| leg.duration).eq(case.leg_times.iter().copied()), "{what}: other leg times");
    }
}

#[test]
fn no_where_nothing_could_accelerate_so_fast() {
    // Two legs of 0.1 s across the cage: even at the 37 N of full thrust on 1 kg it is 0.7 m from rest in 0.2 s.
    let limits = json!({ "max_tilt_deg": 45, "max_flight_time_s": 0.2 });
    for case in certified("none", 3, 0.1, limits).1 {
        assert_eq!(case.certified, Some("no"), "case {}", case.number);
        check_unwitnessed(&case, Evidence::Unchecked, 0.1);
    }
}

#[test]
fn unknown_where_the_search_gives_up_without_a_proof() {
    // Tilted by 0.1°, 0.017 m/s² are left to move along: a leg takes more than the 10 s tried, but nothing forbids it.
    let limits = json!({ "max_speed_m_s": 8.0, "max_tilt_deg": 0.1, "max_flight_time_s": 60 });
    for case in certified("hull", 6, 1.0, limits).1 {
        assert_eq!(case.certified, Some("unknown"), "case {}", case.number);
        check_unwitnessed(&case, Evidence::HullFeasible, 1.0);
    }
}

#[test]
fn a_witness_that_flies_longer_than_allowed_is_none() {
    let limits = |longest: f64| json!({ "max_speed_m_s": 8.0, "max_tilt_deg": 45, "max_flight_time_s": longest });
    let duration = |case: &Case| case.leg_times.iter().sum::<f64>();
    let free = certified("hull", 6, 1.0, limits(60.0)).1;
    let slowest = free.iter().map(duration).fold(0.0, f64::max);
    assert!(slowest > 5.0, "the plans take 5 s: {slowest} s should be longer");
    let (setup, tight) = certified("hull", 6, 1.0, limits(0.5 * (slowest + 5.0)));
    for (before, case) in free.iter().zip(&tight) {
        assert_eq!(before.waypoints, case.waypoints, "the limit lies beyond every plan");
        if duration(before) <= 0.5 * (slowest + 5.0) {
            assert_eq!(case.certified, Some("yes"), "case {}", case.number);
            check_witness(&setup, case, "certified");
        } else {
            assert_eq!(case.certified, Some("unknown"), "case {}", case.number);
            check_unwitnessed(case, Evidence::HullFeasible, 1.0);
        }
    }
    assert!(tight.iter().any(|case| case.certified == Some("unknown")), "none was cut off");
}
