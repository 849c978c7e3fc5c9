use std::f64::consts::PI;

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use rand::RngExt;

use super::*;
use crate::feasibility::reachability::Refusal;
use crate::math::random::{Stream, named_seed, stream, unit};
use crate::math::rotation::from_rotation_vector;
use crate::robot::arm::{Arm, ArmDescription, Configuration, Joints, Kinematics, Tool};
use crate::world::Shape;
use crate::world::cell::{Cell, Part, Region, Words};

fn irb120() -> Arm {
    let path = format!("{}/../../data/robots/arm/irb120.toml", env!("CARGO_MANIFEST_DIR"));
    toml::from_str::<ArmDescription>(&std::fs::read_to_string(path).unwrap()).unwrap().build().unwrap()
}

fn grip() -> Tool {
    Tool::new("tGrip", [0.0, 0.0, 80.0], [1.0, 0.0, 0.0, 0.0], 20.0, 0.8, [0.0, 0.0, 50.0]).unwrap()
}

fn cell(regions: Vec<Region>) -> Cell {
    let parts = regions.into_iter().enumerate().map(|(i, region)| Part { name: format!("part {i}"), region });
    Cell { parts: parts.collect() }
}

/// Tool down.
fn down(x: f64, y: f64, z: f64) -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_axis_angle(&Vector3::y_axis(), PI))
}

fn stations(random: &mut Stream, count: usize) -> Vec<Station> {
    (0..count)
        .map(|_| {
            let (radius, angle) = (0.28 + 0.17 * unit(random), 2.4 * (unit(random) - 0.5));
            let tilt = from_rotation_vector(&Vector3::new(0.3 * unit(random), 0.3 * unit(random), unit(random)));
            let pose = down(radius * angle.cos(), radius * angle.sin(), 0.15 + 0.3 * unit(random));
            Station { pose: pose * tilt, configuration: None }
        })
        .collect()
}

/// Seen independently: joints by closed form or interpolation at 2000 places, distances at each.
fn sampled_clearance(arm: &Arm, tool: &Tool, cell: &Cell, motion: &Motion, start: &Joints) -> Option<f64> {
    let mut last = *start;
    let mut least = f64::INFINITY;
    for i in 0..=2000 {
        let s = f64::from(i) / 2000.0;
        last = match motion {
            Motion::Joint { start, end } => std::array::from_fn(|k| start[k] + s * (end[k] - start[k])),
            _ => arm.inverse_in(&(motion.pose(s)? * tool.tcp.inverse()), arm.branch(start), &last)?.joints,
        };
        if arm.outside_limits(&last).is_some_and(|(_, beyond)| beyond > 1e-9) {
            return None;
        }
        let frames = arm.chain.frames(&last);
        let tip = arm.chain.flange * Point3::from(tool.tcp.translation.vector);
        let tool = (6, arm.chain.flange * Point3::origin(), tip, tool.radius);
        let links = arm.links.iter().enumerate().skip(1);
        let bodies = links.flat_map(|(k, link)| link.capsules.iter().map(move |c| (k, c.a, c.b, c.radius)));
        for (link, a, b, radius) in bodies.chain([tool]) {
            for part in &cell.parts {
                let (a, b) = (frames[link] * a, frames[link] * b);
                let distance = part.region.segment_distance(&a, &b).unwrap_or(f64::INFINITY);
                least = least.min(distance - radius);
            }
        }
    }
    Some(least)
}

fn boxes() -> Cell {
    cell(vec![
        Region::Shape(Shape::cuboid([0.35, 0.25, 0.1], [0.12, 0.12, 0.2]).unwrap()),
        Region::Shape(Shape::cuboid([0.38, -0.05, 0.15], [0.06, 0.06, 0.3]).unwrap()),
    ])
}

/// Free moves are free at 2000 samples as well, with no joint beyond its bounds; of the refused ones, most have their
/// reason there.
#[test]
fn free_moves_are_free_wherever_they_are_looked_at() {
    let (arm, tool) = (irb120(), grip());
    let chain = Arm { kinematics: Kinematics::Chain, ..arm.clone() };
    let mut random = stream(named_seed(1, "joint", 0));
    let cell = boxes();
    for moves in [MoveKind::Linear, MoveKind::Joint] {
        let all = stations(&mut random, 24);
        let settings = JointSettings { moves, ..Default::default() };
        let found = joint(&arm, &tool, &cell, &all, &settings, &Cost::Distance);
        let (mut free, mut met) = (0, 0);
        for i in 0..all.len() {
            for j in (0..all.len()).filter(|&j| j != i) {
                let (Ok(from), Ok(to)) = (&found.joints[i], &found.joints[j]) else { continue };
                let motion = match moves {
                    MoveKind::Linear => Motion::linear(&all[i].pose, &all[j].pose),
                    MoveKind::Joint => Motion::Joint { start: *from, end: *to },
                };
                let seen = sampled_clearance(&arm, &tool, &cell, &motion, from);
                if found.graph.is_free(i, j) {
                    assert!(seen.is_some_and(|least| least > 0.0), "{moves:?} {i}→{j}: {seen:?}");
                    free += 1;
                } else if let Some(Refusal::Collides { undecided: false, .. }) = found.graph.refusal(i, j) {
                    assert!(seen.is_none_or(|least| least <= 1e-4), "{moves:?} {i}→{j}: {seen:?}");
                    met += 1;
                }
            }
        }
        assert!(free > 60 && met > 10, "{moves:?}: {free} free, {met} met, {:?}", found.joints);
        if moves == MoveKind::Linear {
            // Newton along the chain gives the same moves where both decide.
            let near = JointSettings { home: *found.joints.iter().flatten().next().unwrap(), ..settings };
            let mut same = 0;
            for i in 0..6 {
                for j in (0..6).filter(|&j| j != i) {
                    let Ok(from) = &found.joints[i] else { continue };
                    let bodies = Bodies::new(&chain, &tool, &cell, 0.0);
                    let motion = Motion::linear(&all[i].pose, &all[j].pose);
                    let ours = follow(&chain, &tool, Some(&bodies), &motion, from, &near.follow, &mut 0);
                    if found.graph.is_free(i, j)
                        && let Ok(followed) = ours
                    {
                        let to = found.joints[j].as_ref().unwrap();
                        assert!((0..6).all(|k| (followed.end[k] - to[k]).abs() < 1e-6), "{i}→{j}");
                        same += 1;
                    }
                }
            }
            assert!(same > 3, "{same}");
        }
    }
}

/// A rod 5 mm thick beside a move's samples: every tool move across it is refused, whatever the phase.
#[test]
fn a_thin_rod_between_samples_is_hit() {
    let arm = irb120();
    let tool = Tool { radius: 0.001, ..grip() };
    let from = down(0.35, -0.2, 0.2);
    let to = down(0.35, 0.2, 0.2);
    let start = arm.inverse(&(from * tool.tcp.inverse()), &[0.0, 0.0, 0.0, 0.0, 0.5, 0.0])[0];
    for i in 0..97 {
        let y = -0.15 + 0.3 * f64::from(i) / 97.0;
        let rod = cell(vec![Region::Shape(Shape::capsule([0.35, y, 0.0], [0.35, y, 0.201], 0.0025).unwrap())]);
        let bodies = Bodies::new(&arm, &tool, &rod, 0.0);
        let motion = Motion::linear(&from, &to);
        let refused = follow(&arm, &tool, Some(&bodies), &motion, &start, &FollowSettings::default(), &mut 0);
        let Err(Refusal::Collides { link, part: 0, at, undecided: false }) = refused else {
            panic!("{y}: {refused:?}")
        };
        assert!(link == TOOL && (at - (y + 0.2) / 0.4).abs() < 0.02, "{y}: link {link} at {at}");
        let beside = cell(vec![Region::Shape(Shape::capsule([0.2, y, 0.0], [0.2, y, 0.02], 0.0025).unwrap())]);
        let bodies = Bodies::new(&arm, &tool, &beside, 0.0);
        let free =
            follow(&arm, &tool, Some(&bodies), &Motion::linear(&from, &to), &start, &FollowSettings::default(), &mut 0);
        assert!(free.is_ok(), "{y}: {free:?}");
    }
}

#[test]
fn refusals_name_axis_value_and_bound() {
    let (arm, tool) = (irb120(), Tool::flange());
    let home: Joints = [0.0, 0.0, 0.0, 0.0, 0.5, 0.0];
    let told = |motion: &Motion, start: &Joints| {
        let refused = follow(&arm, &tool, None, motion, start, &FollowSettings::default(), &mut 0).unwrap_err();
        refused.in_words(&[]).to_string()
    };
    let end = [0.0, 0.0, 0.0, 170f64.to_radians(), 0.5, 0.0];
    let sentence = told(&Motion::Joint { start: home, end }, &home);
    assert!(sentence.starts_with("axis 4 at 16") && sentence.contains("° > 160.0° at 9"), "{sentence}");
    // Beyond it on the last half piece alone; on it is not beyond.
    let turned = |axis_4: f64| Motion::Joint { start: home, end: [0.0, 0.0, 0.0, axis_4, 0.5, 0.0] };
    let sentence = told(&turned(161f64.to_radians()), &home);
    assert!(sentence.starts_with("axis 4 at 161.0° > 160.0°"), "{sentence}");
    let bound = turned(arm.limits[3].upper);
    assert!(follow(&arm, &tool, None, &bound, &home, &FollowSettings::default(), &mut 0).is_ok());
    // Straight out beyond the reach, and through the wrist's singularity.
    let flange = arm.forward(&home);
    let mut far = flange;
    far.translation.vector.x += 0.5;
    let sentence = told(&Motion::linear(&flange, &far), &home);
    assert!(sentence.contains("singularity: ") || sentence.starts_with("out of reach at "), "{sentence}");
    let bent = [0.0, 0.0, 0.0, 0.0, -0.5, 0.0];
    let sentence = told(&Motion::linear(&flange, &arm.forward(&bent)), &home);
    assert!(sentence.starts_with("wrist singularity: |sin axis 5| 0.0") && sentence.contains("< 0.030"), "{sentence}");
    // Joint moves pass it.
    let moved =
        follow(&arm, &tool, None, &Motion::Joint { start: home, end: bent }, &home, &FollowSettings::default(), &mut 0);
    assert_eq!(moved.unwrap().end, bent);
    // Folded so far that links meet: seen from afar, the two are too near.
    let cell = Cell::default();
    let bodies = Bodies::new(&arm, &tool, &cell, 0.0);
    let (mut random, mut folded) = (stream(named_seed(3, "joint", 2)), 0);
    for _ in 0..3000 {
        let q: Joints = std::array::from_fn(|k| {
            arm.limits[k].lower + (arm.limits[k].upper - arm.limits[k].lower) * unit(&mut random)
        });
        let Some(refusal) = bodies.standing(&q, 0.0) else { continue };
        let Refusal::SelfCollides { links: [a, b], undecided: false, .. } = refusal else { panic!("{refusal:?}") };
        let frames = arm.chain.frames(&q);
        let near = arm.links[a].capsules.iter().flat_map(|c| arm.links[b].capsules.iter().map(move |d| (c, d))).any(
            |(c, d)| {
                (0..=60).any(|i| {
                    let p = frames[a] * (c.a + (c.b - c.a) * (f64::from(i) / 60.0));
                    let (from, to) = (frames[b] * d.a, frames[b] * d.b);
                    crate::math::segment::point_distance(&p, &from, &to) < c.radius + d.radius + 1e-3
                })
            },
        );
        assert!(near && b >= a + 3, "{q:?}: {a} {b}");
        folded += 1;
    }
    assert!(folded > 20, "{folded}");
    assert!(bodies.standing(&home, 0.0).is_none());
}

/// A cloud point in another configuration, a shift by whole turns, and what would help.
#[test]
fn configurations_are_kept_and_alternatives_told() {
    let (arm, tool, cell) = (irb120(), Tool::flange(), Cell::default());
    let settings = JointSettings::default();
    let q = |deg: [f64; 6]| deg.map(f64::to_radians);
    let poses: Vec<Joints> = vec![q([0.0, 10.0, 10.0, 0.0, 40.0, 0.0]), q([20.0, 15.0, 5.0, 10.0, 45.0, -20.0])];
    let mut all: Vec<Station> = poses.iter().map(|q| Station { pose: arm.forward(q), configuration: None }).collect();
    let found = joint(&arm, &tool, &cell, &all, &settings, &Cost::Distance);
    assert_eq!(found.graph.density(), 1.0, "{:?}", found.graph.refusal(0, 1));
    assert!(
        found.joints.iter().zip(&poses).all(|(a, b)| a
            .as_ref()
            .unwrap()
            .iter()
            .zip(b)
            .all(|(x, y)| (x - y).abs() < 1e-9))
    );
    assert!(found.from_home.iter().chain(&found.to_home).all(Option::is_none));
    let micrometres = found.graph.cost(0, 1).unwrap() as f64;
    assert!(
        (micrometres - 1e6 * (all[1].pose.translation.vector - all[0].pose.translation.vector).norm()).abs() <= 0.5
    );
    // The second point, one turn of axis 6 on: its configuration says so, and a straight move does not get there.
    let mut turned = poses[1];
    turned[5] += 2.0 * PI;
    all[1].configuration = Some(arm.configuration(&turned));
    let found = joint(&arm, &tool, &cell, &all, &settings, &Cost::Distance);
    assert!(
        matches!(found.graph.refusal(0, 1), Some(Refusal::Configuration { axis: 5, .. })),
        "{:?}",
        found.graph.refusal(0, 1)
    );
    let told = found.graph.refusal(0, 1).unwrap().in_words(&[]).to_string();
    assert!(told.starts_with("configuration change: axis 6 arrives at -20.0°, not 340.0°"), "{told}");
    let helps = JointGraph::alternative(&arm, &tool, &cell, &all[0], &all[1], &settings).unwrap();
    assert!(helps.margin > 0.5 && helps.configuration.cfx < 8);
    let other =
        Alternative { configuration: Configuration { cf4: -1, ..helps.configuration }, margin: 9.4f64.to_radians() };
    assert_eq!(other.in_words(&Configuration { cf4: 0, ..helps.configuration }), "with cf4 = -1 it fits by 9.4°");
    let far = Station { pose: down(2.0, 0.0, 0.0), configuration: None };
    let found = joint(&arm, &tool, &cell, &[all[0], far], &settings, &Cost::Distance);
    assert_eq!(found.joints[1], Err(Refusal::OutOfReach { at: 0.0 }));
    assert_eq!(found.graph.refusal(0, 1), Some(&Refusal::OutOfReach { at: 1.0 }));
    assert_eq!((found.graph.density(), found.graph.matrix()), (0.0, vec![None; 4]));
}

#[test]
fn arcs_pass_their_three_points_or_are_refused() {
    let mut random = stream(named_seed(2, "joint", 1));
    let mut made = 0;
    for _ in 0..2000 {
        let mut point = || Vector3::from_fn(|_, _| random.random_range(-1.0..1.0f64));
        let (a, b, c) = (point(), point(), point());
        let Ok(circle) = Circle::through(&a, &b, &c) else { continue };
        made += 1;
        assert!((circle.at(0.0) - a).norm() < 1e-9 && (circle.at(1.0) - c).norm() < 1e-9);
        let nearest = (0..=2000).map(|i| (circle.at(f64::from(i) / 2000.0) - b).norm()).fold(f64::INFINITY, f64::min);
        assert!(nearest < circle.length() / 2000.0, "{nearest}");
        let polygon: f64 =
            (0..2000).map(|i| (circle.at(f64::from(i + 1) / 2000.0) - circle.at(f64::from(i) / 2000.0)).norm()).sum();
        assert!((polygon / circle.length() - 1.0).abs() < 1e-5);
    }
    assert!(made > 600, "{made}");
    let at = |x: f64, y: f64| Vector3::new(x, y, 0.0);
    assert!(matches!(Circle::through(&at(0.0, 0.0), &at(1.0, 0.0), &at(2.0, 0.0)), Err(CircleError::OneDirection(_))));
    assert!(matches!(Circle::through(&at(0.0, 0.0), &at(0.0, 5e-5), &at(1.0, 0.0)), Err(CircleError::TooNear(_))));
    assert!(matches!(
        Circle::through(&at(1.0, 0.0), &at(-1.0, 0.0), &at(0.5, -0.75f64.sqrt())),
        Err(CircleError::TooLong(_))
    ));
    let quarter = Circle::through(&at(1.0, 0.0), &at(0.5f64.sqrt(), 0.5f64.sqrt()), &at(0.0, 1.0)).unwrap();
    assert!((quarter.angle() - PI / 2.0).abs() < 1e-12);
    // An arm follows one, and a rod on the arc is met.
    let (arm, tool) = (irb120(), Tool { radius: 0.001, ..grip() });
    let (from, via, to) = (down(0.35, -0.15, 0.2), Vector3::new(0.42, 0.0, 0.2), down(0.35, 0.15, 0.2));
    let circle = Circle::through(&from.translation.vector, &via, &to.translation.vector).unwrap();
    let motion = Motion::circular(&from, circle, &to.rotation);
    let start = arm.inverse(&(from * tool.tcp.inverse()), &[0.0, 0.0, 0.0, 0.0, 0.5, 0.0])[0];
    let rods = |x: f64| cell(vec![Region::Shape(Shape::capsule([x, 0.0, 0.0], [x, 0.0, 0.201], 0.0025).unwrap())]);
    let (on, off) = (rods(0.42), rods(0.35));
    let run = |cell: &Cell| {
        let bodies = Bodies::new(&arm, &tool, cell, 0.0);
        follow(&arm, &tool, Some(&bodies), &motion, &start, &FollowSettings::default(), &mut 0)
    };
    assert!(matches!(run(&on), Err(Refusal::Collides { link: TOOL, .. })) && run(&off).is_ok(), "{:?}", run(&off));
}

#[test]
fn corners_are_covered_by_their_triangle() {
    let arm = irb120();
    let ball = cell(vec![Region::Shape(Shape::sphere([0.1, 0.1, 0.0], 0.02).unwrap())]);
    let bodies = Bodies::new(&arm, &Tool::flange(), &ball, 0.0);
    let triangle = |s: f64| [Vector3::new(s, 0.0, 0.0), Vector3::zeros(), Vector3::new(0.0, s, 0.0)];
    // The hypotenuse of 0.2 passes through the ball's centre; that of 0.16 misses it by 8 mm, less 5 mm of room.
    assert_eq!(bodies.corner(&triangle(0.2), 0.0, 0.0), Some(0));
    assert_eq!(bodies.corner(&triangle(0.16), 0.005, 0.0), None);
    assert_eq!(bodies.corner(&triangle(0.16), 0.005, 0.004), Some(0));
    let inside = cell(vec![Region::Shape(Shape::sphere([0.1, 0.1, 0.0], 0.002).unwrap())]);
    assert_eq!(
        Bodies::new(&arm, &Tool::flange(), &inside, 0.0).corner(&triangle(0.5), 0.0, 0.0),
        Some(0),
        "in the middle of it"
    );
    let words = cell(vec![Region::Words(Words::parse("x > 170", 1000.0).unwrap())]);
    assert_eq!(Bodies::new(&arm, &Tool::flange(), &words, 0.0).corner(&triangle(0.16), 0.005, 0.0), None);
}

/// Costs against what can be told by hand.
#[test]
fn costs_are_those_of_closed_forms() {
    let (arm, tool) = (irb120(), Tool::flange());
    let start: Joints = [0.0, 0.0, 0.0, 0.0, 0.5, 0.0];
    let turned = |angle: f64| Motion::Joint { start, end: [angle, 0.0, 0.0, 0.0, 0.5, 0.0] };
    // Axis 1: 250°/s, 1250°/s². 100° take 100/250 + 250/1250 s; 10° are all ramp: 2 √(10/1250) s.
    for (degrees, seconds) in [(100.0, 0.6), (10.0, 2.0 * (10.0f64 / 1250.0).sqrt()), (-100.0, 0.6)] {
        let motion = turned(f64::to_radians(degrees));
        let law = time_law(&arm, &tool, &motion, &start);
        assert!((law.time - seconds).abs() < 1e-9, "{degrees}: {law:?}");
        assert_eq!(Cost::Time.of_move(&arm, &tool, &motion, &start, 0), (1e6 * seconds).round() as i64);
    }
    // ∫ q̈² dt over both ramps: 2 · (1250°/s²)² · 0.2 s, up to where samples fall on the ramps.
    let effort = Cost::JointEffort.of_move(&arm, &tool, &turned(100f64.to_radians()), &start, 0) as f64 / 1e3;
    let expected = 2.0 * 1250f64.to_radians().powi(2) * 0.2;
    assert!((effort / expected - 1.0).abs() < 0.1, "{effort} {expected}");
    let radius = arm.forward(&start).translation.vector.xy().norm();
    let way = Cost::Distance.of_move(&arm, &tool, &turned(1.0), &start, 0) as f64 * 1e-6;
    assert!((way / radius - 1.0).abs() < 1e-3, "{way} {radius}");
    // 0.6 s are 150 steps of 4 ms; moves in joints need no inverse.
    let load = |motion: &Motion| Cost::ControllerLoad.of_move(&arm, &tool, motion, &start, 0);
    assert!((150..=151).contains(&load(&turned(100f64.to_radians()))));
    let flange = arm.forward(&start);
    let mut beside = flange;
    beside.translation.vector.y += 0.1;
    let line = Motion::linear(&flange, &beside);
    let steps = (time_law(&arm, &tool, &line, &start).time / 0.004).ceil() as i64;
    assert!(load(&line) >= 2 * steps && load(&line) <= 6 * steps, "{} {steps}", load(&line));
    assert_eq!(Cost::Distance.of_move(&arm, &tool, &line, &start, 0), 100_000);
    let sum = Cost::Sum(vec![(2.0, Cost::Distance), (-0.5, Cost::Table(vec![0, 100])), (1.0, Cost::Time)]);
    let time = Cost::Time.of_move(&arm, &tool, &line, &start, 1);
    assert!((sum.of_move(&arm, &tool, &line, &start, 1) - (200_000 - 50 + time)).abs() <= 1);
    // No joint exceeds what it may along the law.
    let law = time_law(&arm, &tool, &line, &start);
    let at = |s: f64| arm.inverse_in(&line.pose(s).unwrap(), arm.branch(&start), &start).unwrap().joints;
    let h = 1e-5;
    for i in 1..100 {
        let s = f64::from(i) / 100.0;
        for k in 0..6 {
            let first = (at(s + h)[k] - at(s - h)[k]) / (2.0 * h);
            let second = (at(s + h)[k] - 2.0 * at(s)[k] + at(s - h)[k]) / (h * h);
            assert!(first.abs() * law.speed <= arm.limits[k].speed * 1.02);
            let hardest = first.abs() * law.acceleration + second.abs() * law.speed * law.speed;
            assert!(hardest <= arm.limits[k].acceleration * 1.1, "axis {k} at {s}: {hardest}");
        }
    }
}

#[test]
fn arcs_that_are_free_are_clear_wherever_they_are_looked_at_and_others_say_why() {
    let (arm, tool) = (irb120(), grip());
    let (mut free, mut looked) = (0, [0; 4]);
    for seed in 0..3 {
        let mut random = stream(named_seed(9, "arcs", seed));
        let mut points = stations(&mut random, 6);
        // One orientation but for the last, which no arc can have.
        let turn = points[0].pose.rotation;
        points[..5].iter_mut().for_each(|point| point.pose.rotation = turn);
        let ball = Shape::Sphere { center: Point3::new(0.38, 0.0, 0.3), radius: 0.05 };
        let cell = cell(vec![Region::Shape(ball)]);
        let settings = JointSettings { clearance: 0.005, ..JointSettings::default() };
        let graph = joint(&arm, &tool, &cell, &points, &settings, &Cost::Distance);
        let arcs = arcs(&arm, &tool, &cell, &points, &graph.joints, &settings, &Cost::Distance);
        assert_eq!(arcs.free.len() + arcs.refused.len(), 6 * 5 * 4);
        for ([a, b, c], cost) in &arcs.free {
            let at = |k: usize| points[k].pose.translation.vector;
            let circle = Circle::through(&at(*a), &at(*b), &at(*c)).unwrap();
            assert_eq!(*cost, (1e6 * circle.length()).round() as i64);
            let motion = Motion::circular(&points[*a].pose, circle, &points[*c].pose.rotation);
            let start = graph.joints[*a].as_ref().unwrap();
            let clearance = sampled_clearance(&arm, &tool, &cell, &motion, start);
            assert!(clearance.is_some_and(|clearance| clearance >= 0.005 - 1e-9), "{a} {b} {c}: {clearance:?}");
            // The way back is the same way.
            assert!(arcs.free.iter().any(|(back, same)| *back == [*c, *b, *a] && (same - cost).abs() <= 1));
            free += 1;
        }
        for (points, refusal) in &arcs.refused {
            let reason = match refusal {
                Refusal::Turned { .. } => 0,
                Refusal::NoArc(_) => 1,
                Refusal::Collides { .. } => 2,
                _ => 3,
            };
            looked[reason] += 1;
            assert!(!matches!(refusal, Refusal::Turned { .. }) || points.contains(&5));
            assert!(
                refusal.in_words(&["ball".into()]).to_string().chars().any(char::is_numeric),
                "{refusal:?} has no number"
            );
        }
    }
    assert!(free > 20 && looked[..3].iter().all(|count| *count > 0), "{free} {looked:?}");
}
