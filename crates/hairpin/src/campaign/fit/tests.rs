//! Fits to flights of our own simulator with other numbers, in gusts and with an estimator's noise that the fit knows nothing
//! of.

mod draws;

use super::*;
use draws::{Truth, flown, scenario};

#[test]
#[ignore = "for development"]
fn develop() {
    let draws: u64 = std::env::var("DRAWS").map_or(4, |text| text.parse().unwrap());
    let from: u64 = std::env::var("FROM").map_or(1000, |text| text.parse().unwrap());
    let logs: usize = std::env::var("LOGS").map_or(5, |text| text.parse().unwrap());
    let robot = std::env::var("ROBOT").unwrap_or("flightgoggles".into());
    let controller = std::env::var("CONTROLLER").unwrap_or("stable-waypoint".into());
    let setup = scenario(&robot, &controller);
    let mut tally = std::collections::BTreeMap::new();
    for seed in from..from + draws {
        let truth = Truth::draw(&setup, seed);
        let logs = flown(&setup, &truth, seed, logs);
        let begun = std::time::Instant::now();
        let found = fit(&setup, &logs, &FitSettings::default(), &|| false).unwrap();
        println!("seed {seed}: {:.1} s, residual {:.3} m, inflation {:.1}, {} stretches of {} samples, {:.1} s of logs, unseen {:?}", begun.elapsed().as_secs_f64(), found.residual_m, found.inflation, found.stretches, found.samples, logs.iter().map(|l| l.track.times().last().unwrap()).sum::<f64>(), found.unseen);
        for estimate in &found.estimates {
            let truth = truth.of(estimate.number.field);
            let held = estimate.interval.map(|[low, high]| low <= truth && truth <= high);
            println!("   {:24} {:?} true {truth:.4} best {:.4} written {:.4} {:.4?} {}", estimate.number.field, estimate.reading, estimate.best, estimate.value, estimate.interval, if held == Some(false) { "MISSED" } else { "" });
            let entry = tally.entry(estimate.number.field).or_insert([0, 0, 0]);
            entry[0] += usize::from(held != Some(false));
            entry[1] += usize::from(estimate.is_told());
            entry[2] += usize::from(estimate.is_told() && held == Some(true));
        }
        println!("   {:?}", found.confounded);
    }
    println!("held, told, told and held: {tally:?} of {draws}");
}
