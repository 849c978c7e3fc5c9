//! Fits to flights of our own simulator with other numbers, in gusts and with an estimator's noise that the fit knows
//! nothing of.

mod draws;

use std::collections::BTreeMap;

use super::*;
use draws::{Truth, flown, scenario};

/// A number from the environment.
fn asked<T: std::str::FromStr>(name: &str, otherwise: T) -> T {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(otherwise)
}

/// The experiment of docs/fit.md: `DRAWS` vehicles from number `FROM` on, of whose numbers each lies within its
/// interval in nine of ten draws. With `HELD_OUT` logs kept from the fit there is one fit a draw, else one for each log
/// besides.
#[test]
#[ignore = "minutes: cargo test --release -p hairpin --lib -- --ignored --nocapture numbers_lie_within_their_intervals"]
fn numbers_lie_within_their_intervals() {
    let (draws, from, count) = (asked("DRAWS", 20u64), asked("FROM", 0u64), asked("LOGS", 5usize));
    let robot = asked("ROBOT", "flightgoggles".to_owned());
    let controller = asked("CONTROLLER", "stable-waypoint".to_owned());
    let setup = scenario(&robot, &controller);
    let mut tally: BTreeMap<&str, [u64; 3]> = BTreeMap::new();
    let mut better = 0;
    for seed in from..from + draws {
        let truth = Truth::draw(&setup, seed);
        let logs = flown(&setup, &truth, seed, (count, asked("ROTORS", false)));
        let settings = FitSettings { held_out: asked("HELD_OUT", 0) };
        let found = fit(&setup, &logs, &settings, &|| false).unwrap();
        let [before, after] = found.unseen.unwrap();
        better += u64::from(after < before);
        println!(
            "draw {seed}: unseen {before:.3} m, then {after:.3} m; inflation {:.1}, {} stretches",
            found.inflation, found.stretches
        );
        for estimate in &found.estimates {
            let truth = truth.of(estimate.number.field);
            let held = estimate.interval.is_none_or(|[low, high]| low <= truth && truth <= high);
            let told = estimate.is_told();
            let (field, reading) = (estimate.number.field, estimate.reading);
            println!(
                "  {field:24} {reading:9?} true {truth:.4} best {:.4} written {:.4} within {:.4?} {}",
                estimate.best,
                estimate.value,
                estimate.interval,
                if held { "" } else { "MISSED" }
            );
            let entry = tally.entry(field).or_default();
            *entry = [entry[0] + u64::from(held), entry[1] + u64::from(told), entry[2] + u64::from(told && held)];
        }
    }
    println!("of {draws} draws within, told, told and within: {tally:?}; better on unseen logs {better}");
    assert!(tally.values().all(|[held, ..]| 10 * held >= 9 * draws), "{tally:?}");
}
