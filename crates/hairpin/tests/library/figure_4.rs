//! Algorithms 1 and 2 do on a small plane world, step by step, what figure 4 of the paper shows: six waypoints beside
//! start and end, width 2, length 4.
//!
//! Source: Hildebrandt et al., *Feasible and stressful trajectory generation for mobile robots*, ISSTA 2020, §4.3. The
//! paper gives the steps and three scores (14, 13, 16; 12 is the runner-up), not the coordinates, which are ours.

use hairpin::feasibility::reach::{Leg, LegFeatures, Reach, StepNode};
use hairpin::search::beam::{Ended, Snapshot, beam_observed};
use hairpin::search::{BeamSettings, LegView, Task};
use nalgebra::{Point3, Vector3};

const NAMES: [&str; 8] = ["start", "left", "right", "centre", "low", "east", "south-east", "end"];
const START: u32 = 0;
const LEFT: u32 = 1;
const RIGHT: u32 = 2;
const CENTRE: u32 = 3;
const LOW: u32 = 4;
const EAST: u32 = 5;
const SOUTH_EAST: u32 = 6;
const END: u32 = 7;

/// In the order of the names; "right" lies 170° right of the heading at the start, which is straight up.
fn world() -> Vec<Point3<f64>> {
    [(0.0, 0.0), (-1.4, 4.2), (0.3, -1.5), (1.6, 1.2), (0.8, -4.1), (6.1, 0.5), (4.9, -1.0), (0.5, 6.2)]
        .map(|(x, y)| Point3::new(x, y, 0.0))
        .to_vec()
}

/// A disc of radius 4 around the point 0.6 of the last leg ahead; from rest, facing up, 0.5 ahead.
struct Disc;

impl Reach<StepNode> for Disc {
    fn legs(&self, from: &StepNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<StepNode>>) {
        let (before, now) = (candidates[from.previous as usize], candidates[from.current as usize]);
        let ahead = if before == now { Vector3::new(0.0, 0.5, 0.0) } else { (now - before) * 0.6 };
        for (waypoint, point) in (0..).zip(candidates) {
            if waypoint != from.current && (point - (now + ahead)).norm() <= 4.0 {
                let to = StepNode { previous: from.current, current: waypoint };
                out.push(Leg { to, waypoint, duration: 1.0, features: LegFeatures::default() });
            }
        }
    }
}

fn score(leg: &LegView<'_>) -> f64 {
    match (leg.from, leg.to) {
        (START, RIGHT) => 8.0,
        (START, CENTRE) => 7.0,
        (START, LEFT) => 4.0,
        (RIGHT, CENTRE) => 6.0,
        (CENTRE, EAST) => 6.0,
        (CENTRE, SOUTH_EAST) => 5.0,
        (RIGHT, LOW) => 3.0,
        (CENTRE, END) => 2.0,
        _ => panic!("no such leg is in reach: {} → {}", NAMES[leg.from as usize], NAMES[leg.to as usize]),
    }
}

fn list(entries: &[(&[u32], f64)]) -> Vec<(Vec<u32>, f64)> {
    entries.iter().map(|(waypoints, score)| (waypoints.to_vec(), *score)).collect()
}

#[test]
fn the_steps_are_those_of_the_figure() {
    let points = world();
    let task = Task { start: StepNode { previous: 0, current: 0 }, candidates: &points, reach: &Disc };
    // The figure prunes nothing.
    let settings = BeamSettings { length: 4, width: 2, keep: None, lookahead: 0, ..Default::default() };
    let mut steps: Vec<Snapshot> = Vec::new();
    let outcome = beam_observed(&task, &score, |_, _| true, &settings, |step| steps.push(step.clone()));
    assert_eq!(steps.len(), 4);

    // Three waypoints are in reach of the start.
    assert_eq!(steps[0].selected, list(&[(&[START], 0.0)]));
    let first = [(&[START, RIGHT][..], 8.0), (&[START, CENTRE], 7.0), (&[START, LEFT], 4.0)];
    assert_eq!(steps[0].frontier, list(&first));

    // The two best give four new ones; the most central waypoint has been part of three by then.
    assert_eq!(steps[1].selected, list(&first[..2]));
    let second = [
        (&[START, RIGHT, CENTRE][..], 14.0),
        (&[START, CENTRE, EAST], 13.0),
        (&[START, CENTRE, SOUTH_EAST], 12.0),
        (&[START, RIGHT, LOW], 11.0),
        (&[START, LEFT], 4.0),
    ];
    assert_eq!(steps[1].frontier, list(&second));
    let central = second.iter().filter(|(waypoints, _)| waypoints.contains(&CENTRE)).count();
    assert_eq!(central, 3);

    // The most central waypoint again, with another reach set; what scores 13 has no successor and is gone.
    assert_eq!(steps[2].selected, list(&second[..2]));
    let third = [(&[START, RIGHT, CENTRE, END][..], 16.0), second[2], second[3], second[4]];
    assert_eq!(steps[2].frontier, list(&third));

    // 16 and 12 are chosen; 16 has full length and ends at the end.
    assert_eq!(steps[3].selected, list(&third[..2]));
    assert_eq!(outcome.ended, Ended::Complete);
    assert_eq!(outcome.found.len(), 1);
    assert_eq!((outcome.found[0].waypoints.as_slice(), outcome.found[0].score), (third[0].0, 16.0));
}

#[test]
fn the_waypoint_processed_twice_is_the_most_central_and_reaches_differently() {
    let points = world();
    let mean = points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / 8.0;
    let nearest = (0..8).min_by(|&a, &b| {
        let distance = |i: u32| (points[i as usize].coords - mean).norm();
        distance(a).total_cmp(&distance(b))
    });
    assert_eq!(nearest, Some(CENTRE));
    let reached = |previous, current| {
        let mut legs = Vec::new();
        Disc.legs(&StepNode { previous, current }, &points, &mut legs);
        legs.iter().map(|leg| leg.waypoint).collect::<Vec<_>>()
    };
    assert!(reached(START, CENTRE).contains(&EAST) && !reached(START, CENTRE).contains(&END));
    assert!(reached(RIGHT, CENTRE).contains(&END) && !reached(RIGHT, CENTRE).contains(&EAST));
}
