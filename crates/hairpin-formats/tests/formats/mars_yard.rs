//! Drives on a real elevation map: the Mars Yard 2021 of the European Rover Challenge, where the machine has it.

use std::path::Path;
use std::time::{Duration, Instant};

use hairpin::campaign::drive::Site;
use hairpin::campaign::goals::ground_goals;
use hairpin::feasibility::steering::shooting::rough::{GroundCost, Settings, Status};
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome, solve};
use hairpin::feasibility::steering::shooting::{Precision, Query, flat};
use hairpin::math::random::stream;
use hairpin::robot::rover::{Response, Rover, RoverDescription, Slip};
use hairpin::trajectory::drive::{Planar, SegmentList};
use hairpin::world::terrain::{ElevationMap, Rocks, Terrain, add_rocks};
use hairpin_formats::terrain::{Georeference, Sidecars, read_terrain};

/// The map, read where it lies beside the project; `None` where it does not.
fn yard() -> Option<ElevationMap> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/terrain/erc_marsyard2021_500x500_f32.tif");
    let Ok(bytes) = std::fs::read(&path) else {
        eprintln!("skipped: the Mars Yard's elevation map is not on this machine");
        return None;
    };
    Some(read_terrain(&bytes, "marsyard.tif", &Sidecars::default(), &Georeference::default()).expect("a map").map)
}

/// The map with rocks on it as they lie where the first Viking landed (k = 0.07), from two cells upwards, and their
/// number.
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

/// What 100 drives cost before and after, in the median of the ratios; begun from closed forms or from the arcs that
/// drives begin with.
fn lowered(site: &Site<'_>, cost: GroundCost, arcs: bool) -> Vec<[f64; 2]> {
    let bounds = site.bounds();
    let precision = Precision { position: 1e-5, yaw: 1e-5, curvature: 1e-5 };
    let flat = flat::Settings { precision, ..flat::Settings::default() };
    let mut steer = |query: &Query| -> Option<SegmentList> {
        let query = Query::new(query.start_curvature, query.goal, &bounds).ok()?;
        let solution = solve(&query, &bounds, &Choices { arcs, flat, ..Choices::default() }, || false);
        (solution.outcome == Outcome::Solved).then_some(solution.segments)
    };
    let mut costs = |start: &Planar, goal: &Planar, lowered: GroundCost| {
        let settings = Settings { cost: lowered, ..Settings::default() };
        let answer = site.solve(start, goal, &bounds, &settings, &mut steer);
        assert_eq!(answer.status, Status::Ok);
        cost.of_commands(&answer.segments)
    };
    let goals = ground_goals(site, 100, &mut stream(50));
    goals.iter().map(|(start, goal)| [GroundCost::Any, cost].map(|lowered| costs(start, goal, lowered))).collect()
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

#[test]
fn costs_fall_to_the_same_from_wherever_they_begin() {
    let Some(yard) = yard() else { return };
    let rover = rocky8();
    let site = Site::straight(&rover, &yard);
    for (cost, share) in [(GroundCost::Curvature, 0.75), (GroundCost::Rate, 0.2)] {
        let (arcs, clothoids) = (lowered(&site, cost, true), lowered(&site, cost, false));
        let fell = |of: &[[f64; 2]]| median(of.iter().map(|[before, after]| after / before));
        let apart = median(arcs.iter().zip(&clothoids).map(|([_, arc], [_, clothoid])| clothoid / arc));
        eprintln!("{cost:?}: arcs to {:.3}, clothoids to {:.3}, apart {apart:.3}", fell(&arcs), fell(&clothoids));
        // Arcs begin near the least: the flat solver's descent minimises what bends them. Clothoids come down to it.
        assert!(fell(&arcs) <= 1.0 && fell(&arcs) > 0.95 && fell(&clothoids) < share, "{cost:?}");
        assert!((apart - 1.0).abs() < 0.02, "{cost:?}: {apart}");
        let highest = |of: &[[f64; 2]]| of.iter().map(|[before, after]| after / before).fold(0.0, f64::max);
        assert!(highest(&arcs) <= 1.0 + 1e-9 && highest(&clothoids) <= 1.0 + 1e-9, "{cost:?}");
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
