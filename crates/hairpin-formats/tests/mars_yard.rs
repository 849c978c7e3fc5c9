//! Drives on a real elevation map: the Mars Yard 2021 of the European Rover Challenge, where the machine has it.

use std::path::Path;
use std::time::{Duration, Instant};

use hairpin::campaign::drive::Site;
use hairpin::campaign::goals::ground_goals;
use hairpin::feasibility::steering::shooting::rough::{Settings, Status};
use hairpin::math::random::stream;
use hairpin::robot::rover::{Response, Rover, RoverDescription, Slip};
use hairpin::world::terrain::{ElevationMap, Rocks, Terrain, add_rocks};
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

/// The map with rocks on it as they lie where the first Viking landed (k = 0.07), from two cells upwards, and their number.
fn rocky_yard() -> Option<(ElevationMap, usize)> {
    let yard = yard()?;
    let (low, high) = yard.extent();
    let rocks = Rocks { cover: 0.07, least_m: 2.0 * yard.grid().cell[0], most_m: 1.5, seed: 2021 };
    let rocks = rocks.scatter(low, high).expect("rocks");
    Some((add_rocks(&yard, &rocks), rocks.len()))
}

fn rocky8() -> Rover {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/robots/rover/rocky8.toml");
    let text = std::fs::read_to_string(path).expect("a shipped rover");
    toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers")
}

/// Solves `count` goals that were driven before and checks every answer by the replay: asked, solved.
fn tally(rover: &Rover, yard: &ElevationMap, count: usize) -> (usize, usize) {
    let site = Site::straight(rover, yard);
    let (mut solved, mut times) = (0, Vec::new());
    let goals = ground_goals(&site, count, &mut stream(50));
    for (index, (start, goal)) in goals.iter().enumerate() {
        let begun = Instant::now();
        let answer = site.drive(start, goal, &Settings::default());
        times.push(begun.elapsed());
        if answer.status != Status::Ok {
            eprintln!("goal {index}: {:?} after {} predictions", answer.status, answer.iterations);
            continue;
        }
        let replay = match site.replay(start, goal, &answer.segments) {
            Ok(replay) => replay,
            Err(stopped) => {
                eprintln!("goal {index}: {stopped:?}");
                continue;
            }
        };
        let met = replay.error[0].hypot(replay.error[1]) <= 0.01
            && replay.error[2].abs() <= 0.01
            && replay.error_curvature.abs() <= 0.01;
        if met { solved += 1 } else { eprintln!("goal {index}: {replay:?}") }
    }
    times.sort();
    let mean = times.iter().sum::<Duration>() / times.len() as u32;
    eprintln!("{solved} of {}, mean {mean:?}, p99 {:?}", goals.len(), times[times.len() * 99 / 100]);
    (goals.len(), solved)
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
    let (asked, solved) = tally(&rocky8(), &yard, 400);
    assert!(asked == 400 && 1000 * solved >= 999 * asked, "{solved} of {asked}");
}

/// What the planner of the acceptance row knows: slip, drift, delay and a slow steering.
fn late_and_slipping() -> Rover {
    Rover {
        slip: Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 },
        response: Response {
            latency: 0.2,
            steering_time_constant: 0.2,
            steering_rate: 30.0_f64.to_radians(),
            ..rocky8().response
        },
        default_speed: 0.3,
        ..rocky8()
    }
}

#[test]
fn slip_delay_and_lag_are_met_as_well() {
    let Some(yard) = yard() else { return };
    let (asked, solved) = tally(&late_and_slipping(), &yard, 200);
    assert!(asked == 200 && 1000 * solved >= 995 * asked, "{solved} of {asked}");
}

#[test]
fn slip_delay_and_lag_are_met_among_rocks() {
    let Some((yard, rocks)) = rocky_yard() else { return };
    assert!((200..4000).contains(&rocks), "{rocks} rocks");
    let (asked, solved) = tally(&late_and_slipping(), &yard, 200);
    assert!(asked == 200 && 1000 * solved >= 995 * asked, "{solved} of {asked}");
}
