//! The roadmap against judging every pair by hand, and its necessary test against exhaustive search.

use std::collections::BTreeSet;

use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::*;
use crate::feasibility::limits::Limits;
use crate::feasibility::steering::ProofSettings;
use crate::feasibility::steering::tests::plus;
use crate::math::random::stream;
use crate::world::{Obstacle, Shape, World};

fn judge() -> LegJudge {
    let shape = Shape::Sphere { center: Point3::new(6.0, 6.0, 6.0), radius: 1.0 };
    let world = World::new(Vector3::repeat(12.0), 1.0, vec![Obstacle { name: "ball".into(), shape }]).unwrap();
    LegJudge::new(&plus(), &world, Limits { max_speed: 5.0, max_tilt: 0.6 }, ProofSettings::default()).unwrap()
}

fn graph(seed: u64, count: usize) -> Vec<Point3<f64>> {
    let mut random = stream(seed);
    (0..count).map(|_| Point3::from(Vector3::from_fn(|_, _| random.random_range(1.5..10.5)))).collect()
}

fn settings(seed: u64) -> RoadmapSettings {
    RoadmapSettings { velocities: 3, timing: LegTiming::ladder(0.8, 3.0), seed }
}

#[test]
fn legs_are_those_of_the_judge_and_the_shortest_of_the_ladder() {
    let judge = judge();
    let mut found = 0;
    for seed in 0..4 {
        let points = graph(seed, 12);
        let map = Roadmap::new(&judge, &points, &settings(seed));
        let rungs = settings(seed).timing.rungs();
        let mut expected = Vec::new();
        let places: Vec<(u32, u32)> =
            (0..12).flat_map(|w| (0..if w == 0 || w == 11 { 1 } else { 3 }).map(move |k| (w, k))).collect();
        let end = |(w, k): (u32, u32)| {
            judge.end(points[w as usize], map.velocity(&WitnessNode { previous: w, waypoint: w, velocity: k }))
        };
        for from in &places {
            for to in places.iter().filter(|to| to.0 != from.0) {
                let duration = rungs.iter().find(|rung| judge.judge(&end(*from), &end(*to), **rung).is_ok());
                expected.extend(duration.map(|duration| RoadmapLeg { from: *from, to: *to, duration: *duration }));
            }
        }
        assert_eq!(map.all_legs(), expected, "seed {seed}");
        assert_eq!(map.legs_count(), expected.len());
        found += expected.len();
    }
    assert!(found > 100, "{found} legs");
}

/// All legs are among those that may be, in their order, and what is none is said to be.
#[test]
fn legs_that_may_be_are_proven_to_be_those_that_are() {
    let judge = judge();
    let (mut many, mut none, mut longer) = (0, 0, 0);
    for seed in 0..6 {
        let points = graph(seed, 30);
        let map = Roadmap::new(&judge, &points, &settings(seed));
        let mut open = vec![map.start()];
        for step in 0..40 {
            let Some(&from) = open.get(step) else { break };
            let (mut legs, mut possible) = (Vec::new(), Vec::new());
            map.legs(&from, &points, &mut legs);
            map.possible(&from, &points, &mut possible);
            open.extend(legs.iter().map(|leg| leg.to));
            many += legs.len();
            let proven: Vec<_> = possible
                .iter()
                .filter_map(|leg| {
                    let duration = map.proven(&from, &leg.to, leg.duration);
                    none += usize::from(duration.is_none());
                    longer += usize::from(duration > Some(leg.duration));
                    assert!(duration.is_none_or(|duration| duration >= leg.duration), "seed {seed}");
                    Some(Leg { duration: duration?, ..*leg })
                })
                .collect();
            assert_eq!(proven, legs, "seed {seed}");
            // Asked alone, of a roadmap that knows all of them and of one that knows none.
            let new = Roadmap::new(&judge, &points, &settings(seed));
            for leg in &possible {
                let known = legs.iter().find(|known| known.to == leg.to);
                assert!(
                    [&map, &new].iter().all(|map| map.leg(&from, &leg.to, &points).as_ref() == known),
                    "seed {seed}"
                );
            }
        }
    }
    assert!(many > 1_000 && none > 10 && longer > 10, "{many} legs, {none} none, {longer} longer");
}

#[test]
fn walks_become_continuous_profiles_with_their_features() {
    let judge = judge();
    let mut walked = 0;
    for seed in 0..20 {
        let points = graph(seed, 30);
        let map = Roadmap::new(&judge, &points, &settings(seed));
        let (mut nodes, mut times, mut random) = (vec![map.start()], Vec::new(), stream(seed));
        for _ in 0..6 {
            let (mut legs, from) = (Vec::new(), nodes[nodes.len() - 1]);
            map.legs(&from, &points, &mut legs);
            if legs.is_empty() {
                break;
            }
            assert!(legs.windows(2).all(|w| w[0].waypoint <= w[1].waypoint));
            assert!(legs.iter().all(|leg| leg.waypoint != from.waypoint));
            let leg = legs[random.random_range(0..legs.len())];
            let [a, b] = [from.waypoint, leg.waypoint].map(|w| points[w as usize]);
            assert_eq!(leg.features.v_in, map.velocity(&from).norm());
            assert_eq!(leg.features.v_out, map.velocity(&leg.to).norm());
            let turn = if nodes.len() == 1 { 0.0 } else { (a - points[from.previous as usize]).angle(&(b - a)) };
            // The arc cosine loses half the digits near a straight line.
            assert!((leg.features.turn - turn).abs() < 1e-6 && leg.features.climb == b.z - a.z);
            let before = a - points[from.previous as usize];
            let slope_in = if nodes.len() == 1 { 0.0 } else { before.z / before.norm() };
            assert_eq!(leg.features.slope_in, slope_in);
            nodes.push(leg.to);
            times.push(leg.duration);
        }
        let profile = map.profile(&nodes).unwrap();
        walked += profile.legs.len();
        for (k, leg) in profile.legs.iter().enumerate() {
            assert_eq!(leg.duration, times[k], "seed {seed}");
            assert!((leg.position(leg.duration) - points[nodes[k + 1].waypoint as usize]).norm() < 1e-9);
            if let Some(next) = profile.legs.get(k + 1) {
                for order in 0..4 {
                    let jump = leg.derivative(leg.duration, order) - next.derivative(0.0, order);
                    assert!(jump.norm() < 1e-8, "seed {seed}, leg {k}, order {order}: {jump}");
                }
            }
        }
    }
    assert!(walked > 60, "{walked} legs");
}

#[test]
fn the_necessary_test_never_cuts_off_a_way_to_the_end() {
    let judge = judge();
    let (mut exact, mut cut) = (0, 0);
    for seed in 0..6 {
        let points = graph(seed, 10);
        let map = Roadmap::new(&judge, &points, &settings(seed));
        let legs = map.all_legs();
        let mut arriving: BTreeSet<(u32, u32)> = BTreeSet::from([(9, 0)]);
        for steps in 0..4 {
            for waypoint in 0..10u32 {
                for velocity in 0..if waypoint == 0 || waypoint == 9 { 1 } else { 3 } {
                    let may = map.may_arrive(&WitnessNode { previous: waypoint, waypoint, velocity }, steps);
                    let does = arriving.contains(&(waypoint, velocity));
                    assert!(may || !does, "seed {seed}: {steps} steps from {waypoint}");
                    assert!(steps > 1 || may == does, "seed {seed}: one step is exact");
                    exact += usize::from(does);
                    cut += usize::from(!may);
                }
            }
            arriving = legs.iter().filter(|leg| arriving.contains(&leg.to)).map(|leg| leg.from).collect();
        }
    }
    assert!(exact > 50 && cut > 50, "{exact} arrive, {cut} cut off");
}

#[test]
fn velocities_point_at_waypoints_and_depend_on_the_seed_alone() {
    let judge = judge();
    let points = graph(3, 20);
    let (map, again) = (Roadmap::new(&judge, &points, &settings(1)), Roadmap::new(&judge, &points, &settings(1)));
    let other = Roadmap::new(&judge, &points, &settings(2));
    assert_eq!(map.states(), 2 + 18 * 3);
    assert_eq!(map.states.all(), again.states.all());
    assert_ne!(map.states.all(), other.states.all());
    for state in map.states.all() {
        let speed = state.velocity.norm();
        assert!(speed <= 5.0);
        let aims = |p: &Point3<f64>| (p - state.position).angle(&state.velocity) < 1e-6;
        assert!(speed == 0.0 || points.iter().any(aims));
    }
    assert_eq!((map.states.all()[0].velocity, map.states.all()[55].velocity), (Vector3::zeros(), Vector3::zeros()));
}
