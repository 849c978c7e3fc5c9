//! Drives on a real elevation map: the Mars Yard 2021 of the European Rover Challenge, where the machine has it.

use std::path::Path;
use std::time::{Duration, Instant};

use hairpin::campaign::ground::Site;
use hairpin::feasibility::steering::shooting::rough::{Settings, Status, Steps};
use hairpin::feasibility::steering::shooting::{Curvatures, Precision, Query, flat};
use hairpin::math::random::hashed_unit;
use hairpin::robot::rover::{Response, Rover, RoverDescription, Slip};
use hairpin::trajectory::drive::{Gear, Motion, Planar, Segment, SegmentList};
use hairpin::world::terrain::{ElevationMap, Terrain};
use hairpin_formats::terrain::{Georeference, read_terrain};

/// The map, read where it lies beside the project; `None` where it does not.
fn yard() -> Option<ElevationMap> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/terrain/erc_marsyard2021_500x500_f32.tif");
    let Ok(bytes) = std::fs::read(&path) else {
        eprintln!("skipped: the Mars Yard's elevation map is not on this machine");
        return None;
    };
    Some(read_terrain(&bytes, "marsyard.tif", &Georeference::default()).expect("a map"))
}

fn rocky8() -> Rover {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/robots/rover/rocky8.toml");
    let text = std::fs::read_to_string(path).expect("a shipped rover");
    toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers")
}

fn bounds(rover: &Rover) -> Curvatures {
    Curvatures { most: rover.limits.curvature, most_rate: rover.limits.curvature_rate }
}

fn flat_solver(rover: &Rover) -> impl FnMut(&Query) -> Option<SegmentList> {
    let bounds = bounds(rover);
    let precision = Precision { position: 1e-5, yaw: 1e-5, curvature: 1e-5 };
    let settings = flat::Settings { precision, ..flat::Settings::default() };
    move |query| {
        let query = Query::new(query.start_curvature, query.goal, &bounds).ok()?;
        let answer = flat::forward(&query, &bounds, &settings);
        (answer.status == flat::Status::Ok).then_some(answer.segments)
    }
}

/// Random controls within |κ| ≤ 1 1/m and |κ′| ≤ 1 1/m², up to 6 m: a cubic through random values.
fn random_drive(seed: u64) -> Segment {
    let unit = |i: u64| 2.0 * hashed_unit(seed, &[i]) - 1.0;
    let length_m = 1.0 + 2.5 * (unit(9) + 1.0);
    let mut scale = 1.0;
    loop {
        let curvature = [
            unit(0) * scale,
            2.0 * unit(1) * scale / length_m,
            3.0 * unit(2) * scale / length_m.powi(2),
            2.0 * unit(3) * scale / length_m.powi(3),
            0.0,
            0.0,
        ];
        let segment = Segment { motion: Motion::Arc { length_m, curvature }, gear: Gear::Forward };
        let at = |i: i32| segment.curvature_at(length_m * f64::from(i) / 200.0);
        let step = length_m / 200.0;
        if (0..=200).all(|i| at(i).abs() <= 0.999) && (0..200).all(|i| (at(i + 1) - at(i)).abs() <= 0.999 * step) {
            return segment;
        }
        scale *= 0.8;
    }
}

/// Solves `count` goals that were driven before and checks every answer by the replay: asked, solved, times.
fn tally(rover: &Rover, yard: &ElevationMap, count: usize) -> (usize, usize, Vec<Duration>) {
    let site = Site { rover, map: yard, speed: rover.default_speed, direction: 0.0 };
    let fine = Steps { length: 0.003, angle: 0.005, least: 100 };
    let (mut asked, mut solved, mut times) = (0, 0, Vec::new());
    let (low, high) = yard.extent();
    for seed in 0.. {
        if asked == count {
            break;
        }
        let unit = |i: u64| hashed_unit(seed, &[50 + i]);
        let drive = random_drive(seed);
        let inside = |i: usize, u: f64| low[i] + 2.0 + u * (high[i] - low[i] - 4.0);
        let start = Planar {
            x: inside(0, unit(0)),
            y: inside(1, unit(1)),
            yaw: 6.3 * unit(2),
            curvature: drive.curvature_at(0.0),
        };
        let Ok(driven) = site.predict(&start, &[drive], fine) else { continue };
        let end = driven.end;
        let near_edge = |i: usize, at: f64| at < low[i] + 2.0 || at > high[i] - 2.0;
        if driven.tilt.0 > 30.0_f64.to_radians() || near_edge(0, end.x) || near_edge(1, end.y) {
            continue;
        }
        asked += 1;
        let begun = Instant::now();
        let answer = site.solve(&start, &end, &bounds(rover), &Settings::default(), &mut flat_solver(rover));
        times.push(begun.elapsed());
        if answer.status != Status::Ok {
            eprintln!("seed {seed}: {:?} after {} predictions", answer.status, answer.iterations);
            continue;
        }
        let replay = match site.replay(&start, &end, &answer.segments) {
            Ok(replay) => replay,
            Err(stopped) => {
                eprintln!("seed {seed}: {stopped:?}");
                continue;
            }
        };
        let met = replay.error[0].hypot(replay.error[1]) <= 0.01
            && replay.error[2].abs() <= 0.01
            && replay.error_curvature.abs() <= 0.01;
        if met { solved += 1 } else { eprintln!("seed {seed}: {replay:?}") }
    }
    times.sort();
    let mean = times.iter().sum::<Duration>() / times.len() as u32;
    eprintln!("{solved} of {asked}, mean {mean:?}, p99 {:?}", times[times.len() * 99 / 100]);
    (asked, solved, times)
}

#[test]
fn the_map_lies_where_its_tags_say() {
    let Some(yard) = yard() else { return };
    let (low, high) = yard.extent();
    for (found, expected) in low.iter().chain(&high).zip([-23.453, -25.453, 23.453, 21.453]) {
        assert!((found - expected).abs() < 1e-9, "{low:?} {high:?}");
    }
    assert_eq!((yard.grid().columns, yard.grid().rows, yard.holes()), (500, 500, 0));
    assert!((yard.patch(0.0, 0.0).expect("ground").height).abs() < 6.0);
}

#[test]
fn goals_that_were_driven_are_met_within_a_centimetre() {
    let Some(yard) = yard() else { return };
    let (asked, solved, _) = tally(&rocky8(), &yard, 400);
    assert!(1000 * solved >= 999 * asked, "{solved} of {asked}");
}

#[test]
fn slip_delay_and_lag_are_met_as_well() {
    let Some(yard) = yard() else { return };
    let rover = Rover {
        slip: Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 },
        response: Response {
            latency: 0.2,
            steering_time_constant: 0.2,
            steering_rate: 30.0_f64.to_radians(),
            ..rocky8().response
        },
        default_speed: 0.3,
        ..rocky8()
    };
    let (asked, solved, _) = tally(&rover, &yard, 200);
    assert!(1000 * solved >= 995 * asked, "{solved} of {asked}");
}
