//! Exact kinematics: where they are the source's, where they are not, and that a rigid body agrees.

use hairpin::campaign::drive::Site;
use hairpin::feasibility::steering::shooting::rough::{Course, Settings, Status, Steps, predict};
use hairpin::math::random::hashed_unit;
use hairpin::robot::rover::{Kinematics, Response, Rover, RoverDescription, Settled, Slip};
use hairpin::trajectory::drive::{Gear, Motion, Planar, Segment};
use hairpin::world::terrain::generate::{Recipe, generate};
use hairpin::world::terrain::{ElevationMap, Function, Patch};
use nalgebra::{Rotation3, Vector3};

fn shipped(name: &str, kinematics: Kinematics) -> Rover {
    let path = format!("{}/../../data/robots/rover/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped rover");
    let rover = toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers");
    Rover { kinematics, ..rover }
}

fn slipping(rover: Rover) -> Rover {
    Rover { slip: Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 }, ..rover }
}

/// Ground with craters, or without.
fn yard(relief_m: f64, least_crater_m: f64) -> ElevationMap {
    let crater_area_m2 = 40.0;
    let recipe = Recipe {
        size_m: 30.0,
        relief_m,
        rock_cover: 0.0,
        crater_area_m2,
        least_crater_m,
        seed: 3,
        ..Recipe::default()
    };
    generate(&recipe).expect("a yard")
}

fn cratered() -> ElevationMap {
    yard(0.5, Recipe::default().least_crater_m)
}

fn drive() -> Vec<Segment> {
    vec![
        Segment::clothoid(1.5, 0.0, 0.8, Gear::Forward),
        Segment { motion: Motion::Turn { angle_rad: -0.9 }, gear: Gear::Forward },
        Segment::clothoid(1.0, 0.5, -0.6, Gear::Reverse),
    ]
}

fn apart(a: &Planar, b: &Planar) -> f64 {
    (a.x - b.x).hypot(a.y - b.y).max((a.yaw - b.yaw).abs())
}

#[test]
fn on_planes_of_any_tilt_exact_rates_are_the_sources() {
    for (a, b) in [(0.0, 0.0), (0.4, 0.0), (0.0, -0.5), (0.35, 0.45), (-0.6, 0.2)] {
        let plane = Function(move |x: f64, y: f64| Patch { height: a * x + b * y, slope: [a, b], bend: [0.0; 3] });
        for name in ["generic", "rocky7", "rocky8", "four-wheel"] {
            for direction in [0.0, 0.4] {
                let end = |kinematics| {
                    let rover = slipping(shipped(name, kinematics));
                    let speed = rover.default_speed.into();
                    // Exact ones take three steps for one.
                    let length = if kinematics == Kinematics::Exact { 0.18 } else { 0.06 };
                    let steps = Steps { length, ..Steps::default() };
                    let course = Course { rover: &rover, terrain: &plane, speed, direction: direction.into(), steps };
                    let start = Planar { x: 1.0, y: 2.0, yaw: 0.7, curvature: 0.0 };
                    predict(&course, &start, &drive(), |_| {}).expect("a way").end
                };
                let off = apart(&end(Kinematics::Exact), &end(Kinematics::Source));
                assert!(off < 1e-4, "{name} on ({a}, {b}) towards {direction}: {off}");
            }
        }
    }
}

/// A pose of the whole body.
fn pose(at: &Planar, settled: &Settled) -> (Vector3<f64>, Rotation3<f64>) {
    let attitude = Rotation3::from_euler_angles(settled.roll, settled.pitch, at.yaw);
    (Vector3::new(at.x, at.y, settled.z), attitude)
}

#[test]
fn the_bodys_twist_between_two_moments_is_what_is_commanded_and_the_sources_is_not() {
    let yard = cratered();
    let start = Planar { x: 12.0, y: 14.0, yaw: 0.4, curvature: 0.0 };
    for direction in [0.0, 0.3] {
        let worst = |kinematics| {
            let rover = shipped("rocky8", kinematics);
            let steps = Steps { length: 0.001, angle: 0.001, least: 16 };
            let site = Site { direction: f64::into(direction), ..Site::straight(&rover, &yard) };
            let (mut before, mut squares, mut aside, mut count) = (None, 0.0_f64, 0.0_f64, 0.0);
            site.trace(&start, &drive(), steps, |driven| {
                let now = (pose(&driven.at, &driven.settled), driven.s, driven.turned, driven.step, driven.in_place);
                let Some((place, s, turned, step, in_place)) = before.replace(now) else { return };
                if in_place != driven.in_place || step.signum() != driven.step.signum() {
                    return;
                }
                let way = (driven.s - s + driven.turned - turned) * step.signum();
                let (moved, rotated) = (now.0.0 - place.0, place.1.inverse() * now.0.1);
                let moved = place.1.inverse() * moved / way;
                // The antisymmetric part of a small rotation is its axis times its sine.
                let odd = 0.5 * (rotated.matrix() - rotated.matrix().transpose());
                let spin = Vector3::new(odd[(2, 1)], odd[(0, 2)], odd[(1, 0)]) / way;
                let bend = if in_place { 1.0 } else { driven.at.curvature * step.signum() };
                let travel: [f64; 2] = if in_place { [0.0; 2] } else { [f64::cos(direction), f64::sin(direction)] };
                // κ is by metres of travel, which are negative in reverse.
                let bend = if in_place { bend } else { bend * step.signum() };
                for off in [moved.x - travel[0], moved.y - travel[1], spin.z - bend] {
                    squares += off * off;
                }
                aside += moved.z.powi(2) + spin.x.powi(2) + spin.y.powi(2);
                count += 1.0;
            })
            .expect("a way");
            ((squares / count).sqrt(), (aside / count).sqrt())
        };
        let ((exact, beside), (source, _)) = (worst(Kinematics::Exact), worst(Kinematics::Source));
        println!("{direction}: exact {exact}, source {source}, beside {beside}");
        assert!(beside > 0.1, "the ground turns the body: {beside}");
        assert!(exact < 0.01 && source > 5.0 * exact, "exact {exact}, source {source}");
    }
}

#[test]
fn on_rough_ground_drives_end_elsewhere_and_where_the_replay_says() {
    let (craters, rolling) = (cratered(), yard(0.3, f64::INFINITY));
    let lagging =
        Response { steering_time_constant: 0.2, steering_rate: 0.5, steered_axle: 0.5, ..Response::default() };
    // Four wheels on one body stand on three where the ground is broken, and rests are then not unique.
    for (name, yard, response, bounds) in [
        ("rocky8", &craters, None, [5e-3, 1e-3]),
        ("rocky7", &craters, None, [5e-3, 1e-3]),
        ("four-wheel", &rolling, None, [3e-3, 2e-3]),
        ("rocky8", &craters, Some(lagging), [5e-3, 1e-3]),
    ] {
        let (mut offs, mut differs) = ([Vec::new(), Vec::new()], 0.0_f64);
        for seed in 0..30 {
            let unit = |i: u64| hashed_unit(seed, &[i]);
            let start = Planar { x: 8.0 + 14.0 * unit(0), y: 8.0 + 14.0 * unit(1), yaw: 6.0 * unit(2), curvature: 0.0 };
            let (a, b) = (1.0 + 2.5 * unit(3), unit(4) - 0.5);
            let drive = [Segment::clothoid(a, 0.0, b, Gear::Forward), Segment::clothoid(a, b, 0.0, Gear::Forward)];
            let with = |kinematics| {
                let rover = slipping(shipped(name, kinematics));
                Rover { response: response.unwrap_or(rover.response), ..rover }
            };
            let (exact, source) = (with(Kinematics::Exact), with(Kinematics::Source));
            let end = |rover, length| {
                let steps = Steps { length, ..Steps::default() };
                Site::straight(rover, yard).predict(&start, &drive, steps).map(|prediction| prediction.end)
            };
            let (Ok(usual), Ok(fine), Ok(other)) = (end(&exact, 0.06), end(&exact, 0.015), end(&source, 0.06)) else {
                continue;
            };
            differs = differs.max(apart(&usual, &other));
            let replay = Site::straight(&exact, yard).replay(&start, &usual, &drive).expect("a replay");
            let replayed = Planar {
                x: usual.x + replay.error[0],
                y: usual.y + replay.error[1],
                yaw: usual.yaw + replay.error[2],
                ..usual
            };
            for (offs, end) in offs.iter_mut().zip([usual, fine]) {
                offs.push(apart(&end, &replayed));
            }
        }
        let count = offs[0].len();
        let worst = offs.map(|offs| offs.into_iter().fold(0.0, f64::max));
        println!("{name}: replay {worst:.5?}, source {differs:.3}, {count}");
        let agrees = worst[0] < bounds[0] && worst[1] < bounds[1];
        assert!(count >= 20 && agrees && differs > 0.02, "{name}: replay {worst:?}, source {differs}, {count} drives");
    }
}

#[test]
fn goals_of_exact_drives_are_found_and_replayed() {
    let (yard, rover) = (cratered(), shipped("rocky8", Kinematics::Exact));
    let site = Site::straight(&rover, &yard);
    let (mut asked, mut met) = (0, 0);
    for seed in 100..140 {
        let unit = |i: u64| hashed_unit(seed, &[i]);
        let start = Planar { x: 8.0 + 14.0 * unit(0), y: 8.0 + 14.0 * unit(1), yaw: 6.0 * unit(2), curvature: 0.0 };
        let (a, b) = (1.0 + 2.0 * unit(3), unit(4) - 0.5);
        let drive = [Segment::clothoid(a, 0.0, b, Gear::Forward), Segment::clothoid(a, b, 0.0, Gear::Forward)];
        let steps = Steps { length: 0.01, ..Steps::default() };
        let Ok(driven) = site.predict(&start, &drive, steps) else { continue };
        if driven.tilt.0 > 0.5 {
            continue;
        }
        asked += 1;
        let answer = site.drive(&start, &driven.end, &Settings::default());
        if answer.status != Status::Ok {
            continue;
        }
        let replay = site.replay(&start, &driven.end, &answer.segments).expect("a replay");
        let off = replay.error[0].hypot(replay.error[1]).max(replay.error[2].abs()).max(replay.error_curvature.abs());
        assert!(off < 0.01, "seed {seed}: {off}");
        met += 1;
    }
    assert!(asked >= 30 && met >= asked - 1, "{met} of {asked}");
}
