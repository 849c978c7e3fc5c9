//! Fits to motions of our own simulator with other numbers, disturbed and logged by what the fit knows nothing of.

mod arms;
mod draws;
mod drives;

use std::collections::BTreeMap;

use super::*;
use crate::campaign::Setup;
use draws::Truth;

/// A number from the environment.
fn asked<T: std::str::FromStr>(name: &str, otherwise: T) -> T {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(otherwise)
}

/// The experiment of docs/fit.md: `DRAWS` robots from number `FROM` on, of whose numbers each lies within its interval
/// in nine of ten draws. One whose logs are refused, as it misses a waypoint, gives its place to the next. With
/// `HELD_OUT` logs kept from the fit there is one fit a draw, else one for each log besides.
fn numbers_lie(setup: &Setup, draw: &dyn Fn(u64) -> (Truth, Vec<Flown>)) {
    let (draws, from) = (asked("DRAWS", 20u64), asked("FROM", 0u64));
    let mut tally: BTreeMap<&str, [u64; 3]> = BTreeMap::new();
    let mut halves: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    let (mut better, mut gaps) = (0, [0.0; 2]);
    let fitted = |seed: u64| {
        let (truth, logs) = draw(seed);
        match fit(setup, &logs, &FitSettings { held_out: asked("HELD_OUT", 0) }, &|| false) {
            Err(refused @ FitError::Missed { .. }) => {
                println!("draw {seed}: refused, {refused}");
                None
            }
            found => Some((seed, truth, found.unwrap())),
        }
    };
    for (seed, truth, found) in (from..).filter_map(fitted).take(draws as usize) {
        let [before, after] = found.unseen.unwrap();
        better += u64::from(after < before);
        gaps = [gaps[0] + before / draws as f64, gaps[1] + after / draws as f64];
        println!(
            "draw {seed}: unseen {before:.4} m, then {after:.4} m; inflation {:.1}, {} stretches",
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
            if let (true, Some([low, high])) = (told, estimate.interval) {
                halves.entry(field).or_default().push(0.5 * (high - low) / estimate.best.abs());
            }
        }
    }
    println!("of {draws} draws within, told, told and within: {tally:?}; better on unseen logs {better}: {gaps:.4?} m");
    for (field, mut halves) in halves {
        halves.sort_by(f64::total_cmp);
        println!(
            "  {field:24} half of the interval: {:.3} in the median, {:.3} at most",
            halves[halves.len() / 2],
            halves[halves.len() - 1]
        );
    }
    assert!(tally.values().all(|[held, ..]| 10 * held >= 9 * draws), "{tally:?}");
}

#[test]
fn who_steered_and_was_never_tried_is_named() {
    let untried = |setup: Setup| setup.kind().fittable().unwrap().untried;
    assert_eq!(untried(draws::scenario("flightgoggles", "stable-waypoint")), None);
    assert_eq!(untried(draws::scenario("flightgoggles", "px4-mission")), Some("px4-mission"));
    assert_eq!(untried(drives::scenario("differential-drive", "pure-pursuit")), None);
    assert_eq!(untried(drives::scenario("differential-drive", "stanley")), Some("stanley"));
}

/// A delay is known and not told: neither the lags nor what is said of unseen logs may make up for it.
#[test]
fn what_is_written_was_found_and_unseen_logs_are_held_to_it() {
    let setup = arms::scenario();
    let truth = Truth::draw(&setup, 2, &|number, _| if number.field == "start_delay_s" { 0.08 } else { 0.05 });
    let logs = arms::flown(&setup, &truth, 2, 3);
    let found = fit(&setup, &logs, &FitSettings::default(), &|| false).unwrap();
    let told: Vec<_> = found.estimates.iter().filter(|estimate| estimate.is_told()).collect();
    assert!(told.len() >= 4);
    for estimate in told {
        assert_eq!(estimate.value, estimate.best);
        assert!((estimate.value - 0.05).abs() < 0.002, "{estimate:?}");
    }
    for Gap { before, after, unseen, log, .. } in &found.gaps {
        let unseen = unseen.unwrap().rmse_m;
        assert!((unseen / after.rmse_m - 1.0).abs() < 0.1 && unseen < before.rmse_m, "{log}: {unseen} {after:?}");
    }
    assert!(found.residual_m > 20.0 * found.scatter_m.unwrap(), "{found:?}");

    let missed = |logs: &[Flown]| match fit(&setup, logs, &FitSettings::default(), &|| false) {
        Err(FitError::Missed { waypoint, nearest, within, .. }) => (waypoint > 0, nearest > within),
        other => panic!("{other:?}"),
    };
    let mut exchanged = logs.clone();
    (exchanged[0].track, exchanged[1].track) = (logs[1].track.clone(), logs[0].track.clone());
    assert_eq!(missed(&exchanged), (true, true));
    let mut frozen = logs;
    frozen[2].track = arms::frozen(&frozen[2].track);
    assert_eq!(missed(&frozen), (true, true));
}

/// Its simulation is cut off some seconds after the log's end: that it is slow is the reason, no waypoint.
#[test]
fn a_robot_that_is_slower_than_its_logs_is_told_to_be() {
    let setup = drives::scenario("differential-drive", "pure-pursuit");
    let truth = Truth::draw(&setup, 1, &|number, _| if number.field == "speed_scale" { 1.4 } else { number.value });
    let logs = drives::flown(&setup, &truth, 1, (2, 0.0));
    let refused = fit(&setup, &logs, &FitSettings::default(), &|| false).unwrap_err().to_string();
    let told = "5 s later: it is slower than what was logged), so nothing can be compared";
    assert!(refused.contains("(log 0 is at its end after ") && refused.ends_with(told), "{refused}");
}

#[test]
#[ignore = "minutes: cargo test --release -p hairpin --test unit -- --ignored --nocapture numbers_lie_within_their_intervals"]
fn numbers_lie_within_their_intervals() {
    let setup = draws::scenario(
        &asked("ROBOT", "flightgoggles".to_owned()),
        &asked("CONTROLLER", "stable-waypoint".to_owned()),
    );
    let shape = (asked("LOGS", 5), asked("ROTORS", false));
    numbers_lie(&setup, &|seed| {
        let truth = Truth::draw(&setup, seed, &Truth::of_flights);
        let logs = draws::flown(&setup, &truth, seed, shape);
        (truth, logs)
    });
}

#[test]
#[ignore = "minutes: cargo test --release -p hairpin --test unit -- --ignored --nocapture numbers_of_drives_lie"]
fn numbers_of_drives_lie_within_their_intervals() {
    let setup = drives::scenario(
        &asked("ROBOT", "differential-drive".to_owned()),
        &asked("CONTROLLER", "pure-pursuit".to_owned()),
    );
    let shape = (asked("LOGS", 6), asked("BUMPS", 0.1));
    numbers_lie(&setup, &|seed| {
        let truth = Truth::draw(&setup, seed, &drives::drawn);
        let logs = drives::flown(&setup, &truth, seed, shape);
        (truth, logs)
    });
}

#[test]
#[ignore = "minutes: cargo test --release -p hairpin --test unit -- --ignored --nocapture numbers_of_arms_lie"]
fn numbers_of_arms_lie_within_their_intervals() {
    let setup = arms::scenario();
    numbers_lie(&setup, &|seed| {
        let truth = Truth::draw(&setup, seed, &arms::drawn);
        let logs = arms::flown(&setup, &truth, seed, asked("LOGS", 4));
        (truth, logs)
    });
}
