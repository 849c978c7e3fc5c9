use super::*;
use crate::feasibility::steering::shooting::query::{Curvatures, Goal, Query};
use crate::feasibility::steering::shooting::solve::{Choices, Outcome};
use crate::math::random::hashed_unit;
use crate::trajectory::drive::{Gear, Motion, Planar, Segment, SegmentList};
use crate::world::terrain::{KeepOut, KeepOutShape, KeepOuts};

const BOUNDS: Curvatures = Curvatures { most: 1.0, most_rate: 1.0 };

fn circle(x: f64, y: f64, radius_m: f64) -> KeepOut {
    KeepOut { name: format!("rock {x} {y}"), shape: KeepOutShape::Circle { center_m: [x, y], radius_m } }
}

fn wall(points: &[[f64; 2]]) -> KeepOut {
    KeepOut { name: "wall".into(), shape: KeepOutShape::Polygon { points_m: points.to_vec() } }
}

fn hazards(keep_outs: &KeepOuts) -> Hazards<'_> {
    Hazards { keep_outs, start: Planar::default(), direction: 0.0, radius: 0.3 }
}

fn query(x: f64, y: f64, yaw: f64) -> Query {
    Query { start_curvature: 0.0, goal: Goal { x, y, yaw, curvature: 0.0 } }
}

/// Where a drive leads, and the least distance to what is kept out of, by many small steps of another integration.
fn traced(segments: &[Segment], hazards: &Hazards<'_>) -> (Planar, f64) {
    let Planar { mut x, mut y, mut yaw, .. } = hazards.start;
    let mut least = hazards.keep_outs.distance(x, y);
    for segment in segments {
        match segment.motion {
            Motion::Turn { angle_rad } => yaw += angle_rad,
            Motion::Arc { length_m, .. } => {
                let count = (length_m / 1e-3).ceil().max(1.0);
                let h = segment.gear.sign() * length_m / count;
                for i in 0..count as u64 {
                    let bend = segment.curvature_at((i as f64 + 0.5) * h.abs());
                    let middle = yaw + hazards.direction + 0.5 * h * bend;
                    x += h * middle.cos();
                    y += h * middle.sin();
                    yaw += h * bend;
                    least = least.min(hazards.keep_outs.distance(x, y));
                }
            }
        }
    }
    (Planar { x, y, yaw, curvature: 0.0 }, least)
}

#[test]
fn nothing_hides_between_two_looks() {
    let (mut clear, mut met) = (0, 0);
    for seed in 0..400 {
        let unit = |i: u64| 2.0 * hashed_unit(seed, &[i]) - 1.0;
        let small =
            (0..12).map(|i| circle(4.0 * unit(3 * i), 4.0 * unit(3 * i + 1), 0.02 + 0.02 * unit(3 * i + 2).abs()));
        let keep_outs = KeepOuts::new(small.collect()).expect("places");
        let start = Planar { x: unit(50), y: unit(51), yaw: 3.0 * unit(52), curvature: 0.0 };
        let hazards = Hazards { keep_outs: &keep_outs, start, direction: 0.4 * unit(53), radius: 0.1 };
        let arc = |k: u64, gear| {
            let curvature = [unit(k), unit(k + 1), unit(k + 2) - 0.3, 0.2 * unit(k + 3), 0.0, 0.0];
            Segment { motion: Motion::Arc { length_m: 1.5, curvature }, gear }
        };
        let turn = Segment { motion: Motion::Turn { angle_rad: unit(90) }, gear: Gear::Forward };
        let drive = [arc(60, Gear::Forward), arc(65, Gear::Reverse), turn, arc(70, Gear::Forward)];
        let (_, least) = traced(&drive, &hazards);
        let depth = hazards.intrusion(&drive).map_or(0.0, |intrusion| intrusion.depth);
        let expected = (0.1 - least).max(0.0);
        assert!(depth >= expected - 1e-6 && depth <= expected + 2e-3, "seed {seed}: {depth}, not {expected}");
        if depth > 0.0 { met += 1 } else { clear += 1 }
    }
    assert!(clear > 50 && met > 50, "{clear} clear, {met} not");
}

#[test]
fn a_rock_in_the_way_is_gone_around() {
    let keep_outs = KeepOuts::new(vec![circle(3.0, 0.05, 0.4)]).expect("a place");
    let hazards = hazards(&keep_outs);
    let answer = solve(&query(6.0, 0.0, 0.0), &BOUNDS, &Choices::default(), &hazards, || false);
    assert_eq!((answer.intrusion, answer.solution.outcome), (None, Outcome::Solved));
    let (end, least) = traced(&answer.solution.segments, &hazards);
    assert!((end.x - 6.0).hypot(end.y) < 1e-2 && least >= 0.3 - 1e-9, "{end:?} {least}");
    let length: f64 = answer.solution.segments.iter().map(Segment::length_m).sum();
    assert!(length < 7.0, "{length} m");
    // Where it is not in the way, it changes nothing.
    let aside = KeepOuts::new(vec![circle(3.0, 2.0, 0.4)]).expect("a place");
    let plain = crate::feasibility::steering::shooting::solve::solve(
        &query(6.0, 0.0, 0.0),
        &BOUNDS,
        &Choices::default(),
        || false,
    );
    let answer = solve(&query(6.0, 0.0, 0.0), &BOUNDS, &Choices::default(), &super::tests::hazards(&aside), || false);
    assert_eq!(answer, Cleared { solution: plain, intrusion: None });
}

#[test]
fn among_rocks_drives_end_in_their_goals_and_touch_nothing() {
    let all = [
        Choices::default(),
        Choices { gear: Gear::Reverse, ..Choices::default() },
        Choices { reversals: true, ..Choices::default() },
        Choices { turns: true, ..Choices::default() },
    ];
    for choices in all {
        let (mut asked, mut plain, mut found) = (0, 0, 0);
        for seed in 0..60 {
            let unit = |i: u64| hashed_unit(seed, &[i]);
            let rocks = (0..25)
                .map(|i| circle(12.0 * unit(3 * i) - 2.0, 10.0 * unit(3 * i + 1) - 5.0, 0.1 + 0.3 * unit(3 * i + 2)));
            let keep_outs = KeepOuts::new(rocks.collect()).expect("places");
            let start = Planar { x: 0.3, y: -0.2, yaw: 0.3, curvature: 0.0 };
            let hazards = Hazards { keep_outs: &keep_outs, start, direction: 0.0, radius: 0.3 };
            let asked_for = query(8.0, 2.0 * unit(99) - 1.0, unit(98) - 0.5);
            if hazards.room(0.0, 0.0) < 0.1 || hazards.room(8.0, asked_for.goal.y) < 0.1 {
                continue;
            }
            asked += 1;
            let answer = solve(&asked_for, &BOUNDS, &choices, &hazards, || false);
            let (end, least) = traced(&answer.solution.segments, &hazards);
            let [gx, gy] = [asked_for.goal.x, asked_for.goal.y];
            let (sin, cos) = start.yaw.sin_cos();
            let miss = (end.x - start.x - cos * gx + sin * gy).hypot(end.y - start.y - sin * gx - cos * gy);
            assert!(miss < 1.1e-2, "seed {seed}: {miss} m off");
            match answer.intrusion {
                None => {
                    found += 1;
                    assert!(least >= 0.3 - 1e-6, "seed {seed}: {least} m from a rock");
                    plain += usize::from(answer.solution.iterations < 10);
                }
                Some(intrusion) => {
                    assert!((intrusion.depth - (0.3 - least)).abs() < 2e-3, "seed {seed}: {intrusion:?}")
                }
            }
        }
        println!("{choices:?}: {found} of {asked}, {plain} at once");
        assert!(asked >= 30 && found * 100 >= asked * 50, "{choices:?}: {found} of {asked}");
    }
}

#[test]
fn where_nothing_is_clear_the_depth_is_told() {
    // Walled in.
    let ring = [
        wall(&[[-3.0, 2.0], [3.0, 2.0], [3.0, 2.2], [-3.0, 2.2]]),
        wall(&[[-3.0, -2.2], [3.0, -2.2], [3.0, -2.0], [-3.0, -2.0]]),
        wall(&[[3.0, -2.2], [3.2, -2.2], [3.2, 2.2], [3.0, 2.2]]),
        wall(&[[-3.2, -2.2], [-3.0, -2.2], [-3.0, 2.2], [-3.2, 2.2]]),
    ];
    let keep_outs = KeepOuts::new(ring.to_vec()).expect("places");
    let hazards = hazards(&keep_outs);
    let answer = solve(&query(6.0, 0.0, 0.0), &BOUNDS, &Choices::default(), &hazards, || false);
    let intrusion = answer.intrusion.expect("walls");
    assert!(intrusion.depth > 0.3 && intrusion.depth < 0.41, "{intrusion:?}");
    // A goal in a rock: by how much, and of which.
    let rock = KeepOuts::new(vec![circle(2.0, 9.0, 1.0), circle(4.0, 0.0, 0.5)]).expect("places");
    let at = super::tests::hazards(&rock);
    let answer = solve(&query(4.0, 0.1, 0.0), &BOUNDS, &Choices::default(), &at, || false);
    let intrusion = answer.intrusion.expect("a rock");
    assert!(intrusion.place == 1 && intrusion.depth > 0.69 && intrusion.depth < 0.81, "{intrusion:?}");
    let mut asked = 0;
    let stopped = solve(&query(6.0, 0.0, 0.0), &BOUNDS, &Choices::default(), &hazards, || {
        asked += 1;
        asked > 3
    });
    assert!(stopped.solution.outcome == Outcome::Stopped && stopped.intrusion.is_some(), "{stopped:?}");
}

#[test]
fn ways_of_one_length_stand_in_the_order_of_their_turning() {
    let choices = Choices { reversals: true, turns: true, arcs: false, ..Choices::default() };
    for ahead in [-2.0, 2.0] {
        let asked = query(ahead, 0.0, 0.0);
        let ways = super::ways::every(&asked, &BOUNDS, &choices);
        let turns = |segment: &Segment| matches!(segment.motion, Motion::Turn { .. });
        let first = &ways[0];
        assert!((first.length - 2.0).abs() < 1e-9 && !first.segments.iter().any(turns), "{first:?}");
        assert!(super::ways::shortest(&asked, &BOUNDS, &choices).is_some_and(|way| way.segments.len() == 1));
    }
}

#[test]
fn motions_are_looked_along_as_drives_are() {
    let keep_outs = KeepOuts::new(vec![circle(2.0, 0.35, 0.1)]).expect("a place");
    let mut check = MotionCheck::new(&keep_outs, 0.3);
    for i in 0..=40 {
        check.see(&Planar { x: 0.1 * f64::from(i), ..Planar::default() });
    }
    let depth = check.worst().expect("a rock").depth;
    assert!((depth - 0.05).abs() < 1e-12, "{depth}");
    let mut drive = SegmentList::EMPTY;
    drive.add(Segment::straight(4.0, Gear::Forward));
    let found = hazards(&keep_outs).intrusion(&drive).expect("a rock");
    assert!((found.depth - 0.05).abs() < 1e-9 && found.place == 0 && (found.after_m - 2.0).abs() < 0.5, "{found:?}");
}
