//! Vehicles on wheels that are not as their file says, logged by a localisation.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use serde_json::{Value, json};

use super::super::Flown;
use super::draws::Truth;
use crate::campaign::kind::{Adjustable, Order};
use crate::campaign::{Scenario, Setup, Stop};
use crate::math::random::{named_seed, standard_normals, stream};
use crate::trajectory::Track;

/// A vehicle of 0.5 m/s on a plain: `differential-drive`, `car` or `skid`.
pub(super) fn scenario(robot: &str, controller: &str) -> Setup {
    let robot: Value = match robot {
        "car" => json!({ "kind": "car", "name": "cart", "wheelbase_m": 0.5, "speed_m_s": 0.5, "limits":
            { "steering_deg": 30, "steering_rate_deg_s": 90, "speed_m_s": 1.0, "acceleration_m_s2": 1.0 } }),
        "skid" => json!({ "kind": "rover", "name": "skid", "steering": "skid", "speed_m_s": 0.5,
            "suspension": { "kind": "four-wheel", "wheel_radius_m": 0.1, "front_m": [0.25, 0.25, 0], "rear_m": [-0.25, 0.25, 0] },
            "slip_at_20_deg": 0.3, "side_slip_at_20_deg": 0.2,
            "limits": { "curvature_1_m": 1.5, "curvature_rate_1_m2": 3.0, "acceleration_m_s2": 1.0 } }),
        _ => json!({ "kind": "differential-drive", "name": "base", "track_m": 0.45, "radius_m": 0.35,
            "limits": { "wheel_speed_m_s": 1.0, "wheel_acceleration_m_s2": 1.5 } }),
    };
    let scenario: Scenario = serde_json::from_value(json!({
        "hairpin": 1, "robot": robot, "spec": "none",
        "world": { "terrain": { "generator": "fractal", "size_m": 30, "cell_m": 0.1, "relief_m": 0.0, "seed": 3 } },
        "task": { "start": { "x_m": 15, "y_m": 15, "yaw_deg": 0 }, "length": 6, "leg_m": [1.5, 4] },
        "generate": { "manoeuvres": ["forward"], "search": { "waypoints": 60 } },
        "execute": { "controller": controller },
    }))
    .unwrap();
    Setup::new(scenario).unwrap()
}

/// Latency and lags of up to 0.4 s, a way of 0.85 to 1.1 and a curvature of 0.75 to 1.1 of the wheels', slips of half
/// to one and a half of the file's.
pub(super) fn drawn(number: &Adjustable, share: f64) -> f64 {
    match number.field {
        "speed_scale" => 0.85 + 0.25 * share,
        "turn_scale" => 0.75 + 0.35 * share,
        "slip_at_20_deg" | "side_slip_at_20_deg" => number.value * (0.5 + share),
        _ => 0.4 * share,
    }
}

/// `count` logs of the vehicle `truth`, each of a drive of its own. Its controller knows the file's numbers, sees its
/// pose with noise, and goes over bumps of `bumps_m` that the map does not have. Logs are poses, 20 a second, off by a
/// slow drift of 1 cm and 0.2°, and by 5 mm and 0.1° from sample to sample.
pub(super) fn flown(setup: &Setup, truth: &Truth, seed: u64, (count, bumps_m): (usize, f64)) -> Vec<Flown> {
    let disturbed = [("execute.noise", json!(true)), ("world.terrain.relief_m", json!(bumps_m))];
    let vehicle = truth.setup(setup, &disturbed);
    let solver = setup.kind().solver().unwrap();
    let drive = |number: usize| {
        let plan = solver.draw(100 * seed + number as u64, &Stop::never()).unwrap();
        let case = plan.case(seed, 0, number);
        let order =
            Order { waypoints: &case.waypoints, accept: 0.5, time_limit: 240.0, seed: case.seed, obstacles: true };
        let track = vehicle.kind().run(setup.kind().same(), &case, &order).unwrap().track;
        let mut noise = stream(named_seed(seed, "localisation", number as u64));
        let mut next = 0.0;
        let which: Vec<usize> = (0..track.len())
            .filter(|&i| {
                let due = track.times()[i] >= next;
                next += if due { 0.05 } else { 0.0 };
                due
            })
            .collect();
        let keep = (-0.05f64 / 0.5).exp();
        let scale = |[x, y, yaw]: [f64; 3]| Vector3::new(0.01 * x, 0.01 * y, 0.0035 * yaw);
        let mut drift = scale(standard_normals(&mut noise));
        let poses = which.iter().map(|&i| {
            drift = drift * keep + scale(standard_normals(&mut noise)) * (1.0 - keep * keep).sqrt();
            let off = drift + 0.5 * scale(standard_normals(&mut noise));
            let pose = &track.poses()[i];
            let turned = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), off.z) * pose.rotation;
            Isometry3::from_parts((pose.translation.vector + Vector3::new(off.x, off.y, 0.0)).into(), turned)
        });
        let poses = poses.collect();
        let times = which.iter().map(|&i| track.times()[i]).collect();
        Flown {
            log: format!("log {number}"),
            mission: case.id(),
            case,
            track: Track::new(times, poses, vec![]).unwrap(),
        }
    };
    (0..count).map(drive).collect()
}
