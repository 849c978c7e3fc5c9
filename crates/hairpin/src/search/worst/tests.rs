use std::sync::atomic::{AtomicU64, Ordering};

use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::*;
use crate::math::random::{Stream, named_seed, standard_normals, stream};

/// Ways of six waypoints in a room of 20 m with steps of 9 m at most, stressed where two long legs meet sharply.
struct Room {
    executed: AtomicU64,
    moves: bool,
    /// Who comes higher crashes, having strayed by a hundredth.
    wall: f64,
}

const ENDS: [[f64; 3]; 2] = [[1.0, 10.0, 10.0], [19.0, 10.0, 10.0]];
const LONGEST: f64 = 9.0;

impl Room {
    fn new(moves: bool) -> Self {
        Self { executed: AtomicU64::new(0), moves, wall: f64::INFINITY }
    }

    fn feasible(points: &[Point3<f64>]) -> bool {
        let inside = |p: &Point3<f64>| p.iter().all(|x| (0.0..=20.0).contains(x));
        let ends = [points[0], points[points.len() - 1]] == ENDS.map(Point3::from);
        ends && points.iter().all(inside) && points.windows(2).all(|pair| (pair[1] - pair[0]).norm() <= LONGEST)
    }

    fn stress(points: &[Point3<f64>]) -> Trial {
        let mut trial = Trial { stress: 0.0, fails: false, worst_leg: 0, executions: 1 };
        for (k, triple) in points.windows(3).enumerate() {
            let (before, after) = (triple[1] - triple[0], triple[2] - triple[1]);
            let stress = before.norm() * after.norm() - before.dot(&after);
            if stress > trial.stress {
                trial = Trial { stress, worst_leg: k + 1, ..trial };
            }
        }
        trial
    }
}

impl Field for Room {
    type Plan = Vec<Point3<f64>>;

    fn draw(&self, number: u64) -> Result<Self::Plan, Option<String>> {
        let mut random = stream(named_seed(7, "room", number));
        let points = std::iter::once(Point3::from(ENDS[0]))
            .chain((0..4).map(|k| {
                Point3::from(Vector3::from_fn(|axis, _| match axis {
                    0 => 3.0 + 3.6 * f64::from(k) + random.random_range(0.0..3.0),
                    _ => random.random_range(6.0..14.0),
                }))
            }))
            .chain([Point3::from(ENDS[1])])
            .collect::<Vec<_>>();
        Self::feasible(&points).then_some(points).ok_or_else(|| Some("a leg is too long".into()))
    }

    fn seeds(&self) -> Vec<Self::Plan> {
        Vec::new()
    }

    fn points<'p>(&self, plan: &'p Self::Plan) -> &'p [Point3<f64>] {
        plan
    }

    fn fingerprint(&self, plan: &Self::Plan) -> [u8; 16] {
        let words = plan.iter().flat_map(|p| p.iter().map(|x| x.to_bits()).collect::<Vec<_>>());
        let sum = words.fold(0u128, |sum, word| sum.wrapping_mul(0x1_0000_0000_01b3).wrapping_add(u128::from(word)));
        sum.to_le_bytes()
    }

    fn moves(&self) -> bool {
        self.moves
    }

    fn over(&self, _: &Self::Plan, points: &[Point3<f64>]) -> Option<Self::Plan> {
        Self::feasible(points).then(|| points.to_vec())
    }

    fn elsewhere(&self, _: &Self::Plan, random: &mut Stream) -> Option<Point3<f64>> {
        Some(Point3::from(Vector3::repeat(10.0) + Vector3::from(standard_normals::<3>(random)) * 4.0))
    }

    fn crossed(&self, plan: &Self::Plan, other: &Self::Plan, leg: usize, _: &mut Stream) -> Option<Self::Plan> {
        let points = [&plan[..=leg], &other[leg + 1..]].concat();
        Self::feasible(&points).then_some(points)
    }

    fn altered(&self, _: &Self::Plan, _: usize, _: &mut Stream) -> Option<Self::Plan> {
        None
    }

    fn run(&self, plan: &Self::Plan, _: &[f64]) -> Option<Ran> {
        assert!(Self::feasible(plan));
        self.executed.fetch_add(1, Ordering::Relaxed);
        // What fails counts and is survived; it fails whenever it is run, on any thread.
        let fails = self.moves && u128::from_le_bytes(self.fingerprint(plan)) % 11 == 10;
        (!fails).then(|| {
            let own = Self::stress(plan);
            let crashes = plan.iter().any(|point| point.z > self.wall);
            let trial = if crashes { Trial { stress: 0.01 * own.stress, fails: true, ..own } } else { own };
            Ran { trials: vec![trial], behaviour: vec![trial.stress] }
        })
    }
}

fn settings(cases: usize, executions: u64) -> WorstSettings {
    WorstSettings { cases, targets: 1, executions, sized_for: executions, per_trial: 1, seed: 3 }
}

fn search(room: &Room, settings: &WorstSettings) -> Worst<Vec<Point3<f64>>> {
    worst(room, settings, &|| false, &|_| {})
}

#[test]
fn the_worst_is_far_beyond_chance_and_its_cases_differ() {
    let room = Room::new(false);
    let chance = (0..4_000).filter_map(|number| room.draw(number).ok()).map(|points| Room::stress(&points).stress);
    let chance = chance.fold(0.0, f64::max);
    let room = Room { moves: true, ..Room::new(true) };
    let Worst { found, stresses, apart, .. } = search(&room, &settings(6, 1_200));
    assert_eq!((found.len(), stresses.len(), room.executed.load(Ordering::Relaxed)), (6, 1_200, 1_200));
    // Two legs of 9 m straight back come to 2 · 81; ten times as many by chance come nowhere near.
    assert!(found[0].trial.stress > 150.0 && found[5].trial.stress > chance, "{chance}: {:?}", found[5].trial);
    assert!(found.is_sorted_by(|a, b| a.trial.stress >= b.trial.stress) && apart > 0.0);
    for (k, one) in found.iter().enumerate() {
        assert_eq!(Room::stress(&one.plan), one.trial);
        assert!(found[..k].iter().all(|other| other.plan != one.plan));
    }
    assert!(stresses.iter().any(Option::is_none));
}

#[test]
fn the_answer_is_the_same_on_any_number_of_threads() {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let found = pool.install(|| search(&Room::new(false), &settings(4, 300)));
        (found.found.into_iter().map(|found| found.plan).collect::<Vec<_>>(), found.stresses)
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn what_cannot_be_drawn_says_why_and_what_is_stopped_keeps_what_it_has() {
    struct Nothing(Room);
    impl Field for Nothing {
        type Plan = Vec<Point3<f64>>;
        fn draw(&self, number: u64) -> Result<Self::Plan, Option<String>> {
            Err(number.is_multiple_of(2).then(|| "no room".into())) // the others were stopped
        }
        fn seeds(&self) -> Vec<Self::Plan> {
            Vec::new()
        }
        fn points<'p>(&self, plan: &'p Self::Plan) -> &'p [Point3<f64>] {
            plan
        }
        fn fingerprint(&self, plan: &Self::Plan) -> [u8; 16] {
            self.0.fingerprint(plan)
        }
        fn moves(&self) -> bool {
            true
        }
        fn over(&self, _: &Self::Plan, _: &[Point3<f64>]) -> Option<Self::Plan> {
            None
        }
        fn elsewhere(&self, _: &Self::Plan, _: &mut Stream) -> Option<Point3<f64>> {
            None
        }
        fn crossed(&self, _: &Self::Plan, _: &Self::Plan, _: usize, _: &mut Stream) -> Option<Self::Plan> {
            None
        }
        fn altered(&self, _: &Self::Plan, _: usize, _: &mut Stream) -> Option<Self::Plan> {
            None
        }
        fn run(&self, _: &Self::Plan, _: &[f64]) -> Option<Ran> {
            None
        }
    }
    let nothing = worst(&Nothing(Room::new(true)), &settings(3, 100), &|| false, &|_| {});
    assert_eq!((nothing.found.len(), nothing.stresses.len(), nothing.nothing.as_deref()), (0, 0, Some("no room")));
    let room = Room::new(false);
    let stopped = || room.executed.load(Ordering::Relaxed) >= 60;
    let kept = worst(&room, &settings(3, 10_000), &stopped, &|_| {});
    assert!(kept.found.len() == 3 && kept.stresses.len() < 400, "{}", kept.stresses.len());
}

/// What crashes early strays little: neither is there one case alone, nor are all of them crashes.
#[test]
fn what_fails_and_what_is_stressed_most_are_found_beside_each_other() {
    let room = Room { wall: 13.0, ..Room::new(true) };
    let Worst { found, .. } = search(&room, &settings(6, 1_200));
    let [failing, flown]: [Vec<f64>; 2] = [true, false].map(|fails| {
        found.iter().map(|found| found.trial).filter(|trial| trial.fails == fails).map(|t| t.stress).collect()
    });
    assert!(found[0].trial.fails && failing.len() == 3, "{failing:?} {flown:?}");
    assert!(flown.is_sorted_by(|a, b| a >= b) && flown[2] > 120.0, "{flown:?}");
}
