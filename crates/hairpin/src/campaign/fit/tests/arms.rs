//! Arms whose servos are not as their scenario says, logged by their encoders.

use serde_json::{Value, json};

use super::super::Flown;
use super::draws::Truth;
use crate::campaign::kind::{Adjustable, Order};
use crate::campaign::{Scenario, Setup, Stop};
use crate::math::random::{named_seed, standard_normals, stream, unit};
use crate::trajectory::{Channel, Track};

/// An IRB 120 with some points.
pub(super) fn scenario() -> Setup {
    let path = format!("{}/../../data/robots/arm/irb120.toml", env!("CARGO_MANIFEST_DIR"));
    let robot: Value = toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let scenario: Scenario = serde_json::from_value(json!({
        "hairpin": 1, "robot": robot, "seed": 7, "spec": "none",
        "world": { "tool": { "tcp_mm": [0, 0, 100], "radius_mm": 20 } },
        "task": { "points": { "count": 9 } },
        "generate": { "moves": { "speeds": ["v500", "v1000"], "zones": ["fine", "z10"] },
            "search": { "method": "worst", "programs": 3, "points": 6 } },
        "execute": { "controller": "virtual", "servo_lag_s": 0.02 },
    }))
    .unwrap();
    Setup::new(scenario).unwrap()
}

/// Lags of 10 to 60 ms, a delay of up to 0.1 s.
pub(super) fn drawn(number: &Adjustable, share: f64) -> f64 {
    match number.field {
        "start_delay_s" => 0.1 * share,
        _ => 0.01 + 0.05 * share,
    }
}

/// `count` logs of the arm `truth`, each of a program of its own, 100 samples a second. Stops at fine points last up to
/// 1 ms longer, one axis has 0.02° of backlash, encoders are off by 0.01° from sample to sample, and stamps by up to
/// 1 ms.
pub(super) fn flown(setup: &Setup, truth: &Truth, seed: u64, count: usize) -> Vec<Flown> {
    let disturbed = [
        ("execute.noise_mm", json!(0.02)),
        ("execute.faults.axis", json!(1 + seed % 6)),
        ("execute.faults.backlash_deg", json!(0.02)),
    ];
    let arm = truth.setup(setup, &disturbed);
    let solver = setup.kind().solver().unwrap();
    let run = |number: usize| {
        let plan = solver.draw(100 * seed + number as u64, &Stop::never()).unwrap();
        let case = plan.case(seed, 0, number);
        let order =
            Order { waypoints: &case.waypoints, accept: 1e-3, time_limit: 240.0, seed: case.seed, obstacles: true };
        let track = arm.kind().run(setup.kind().same(), &case, &order).unwrap().track;
        let mut noise = stream(named_seed(seed, "encoders", number as u64));
        let times = track.times().iter().map(|t| t + 1e-3 * unit(&mut noise)).collect();
        let channels = (1..=6).map(|axis| {
            let name = format!("q{axis}_rad");
            let values = track.channel(&name).unwrap().iter();
            let values = values.map(|q| q + 1.745e-4 * standard_normals::<1>(&mut noise)[0]).collect();
            Channel { name, values }
        });
        let channels = channels.collect();
        let track = Track::new(times, track.poses().to_vec(), channels).unwrap();
        Flown { log: format!("log {number}"), mission: case.id(), case, track }
    };
    (0..count).map(run).collect()
}

/// The same, standing still from half of its samples on.
pub(super) fn frozen(track: &Track) -> Track {
    let half = track.len() / 2;
    let poses = (0..track.len()).map(|i| track.poses()[i.min(half)]).collect();
    let channels = track.channels().iter().map(|channel| Channel {
        name: channel.name.clone(),
        values: (0..track.len()).map(|i| channel.values[i.min(half)]).collect(),
    });
    Track::new(track.times().to_vec(), poses, channels.collect()).unwrap()
}
