//! What judging a witness leg costs: candidates as the roadmap meets them, and accepted legs with their full proof.

use hairpin::feasibility::reach::{Roadmap, RoadmapSettings};
use hairpin::feasibility::steering::{LegEnd, LegJudge, ProofSettings};
use hairpin::feasibility::{Infeasible, Limits};
use hairpin::math::random::stream;
use hairpin::robot::quadrotor::{Quadrotor, Rotor};
use hairpin::search::{BeamSettings, Score, Task, beam};
use hairpin::trajectory::ProfileLeg;
use hairpin::world::{Obstacle, Shape, World};
use nalgebra::{Point3, Vector3};
use rand::RngExt;

/// The Anafi stand-in: 0.8 kg, plus layout, FlightGoggles' rotors and drag.
fn anafi() -> Quadrotor {
    let rotor = |x: f64, y: f64, spin: f64| Rotor { x, y, spin };
    Quadrotor {
        name: "anafi".into(),
        mass: 0.8,
        inertia: Vector3::new(2.32e-3, 2.32e-3, 4.0e-3),
        rotors: [rotor(0.2, 0.0, 1.0), rotor(0.0, 0.2, -1.0), rotor(-0.2, 0.0, 1.0), rotor(0.0, -0.2, -1.0)],
        thrust_coefficient: 1.91e-6,
        moment_coefficient: 2.6e-7,
        rotor_speed: (0.0, 2200.0),
        rotor_time_constant: 0.02,
        drag_linear: 0.0,
        drag_quadratic: 0.1,
        aerodynamic_moment: 0.003,
        force_noise: 0.0,
        moment_noise: 0.0,
        max_speed: 15.0,
        clearance_radius: 0.25,
        gravity: 9.81,
        estimated: Vec::new(),
        caveat: String::new(),
    }
}

/// The 30 m cage with a mast.
fn cage() -> World {
    let shape = Shape::Box { center: Point3::new(12.0, 8.0, 5.0), half_extents: Vector3::new(1.0, 1.0, 5.0) };
    World::new(Vector3::repeat(30.0), 2.0, vec![Obstacle { name: "mast".into(), shape }]).expect("a sound world")
}

fn judge() -> LegJudge {
    let limits = Limits { max_speed: 8.0, max_tilt: 35f64.to_radians() };
    LegJudge::new(&anafi(), &cage(), limits, ProofSettings::default()).expect("independent rotors")
}

/// Random pairs of waypoint states no farther apart than the speed limit allows, with a leg time.
fn candidates(judge: &LegJudge, count: usize) -> Vec<(LegEnd, LegEnd, f64)> {
    let mut random = stream(1);
    let mut out = Vec::with_capacity(count);
    while out.len() < count {
        let mut end = || {
            let p = Point3::from(Vector3::from_fn(|_, _| random.random_range(2.0..28.0)));
            let v = Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
            judge.end(p, v.normalize() * random.random_range(0.0..8.0))
        };
        let (from, to) = (end(), end());
        let duration = 0.8 * 5f64.powf(random.random_range(0.0..1.0));
        if (to.position - from.position).norm() <= 8.0 * duration {
            out.push((from, to, duration));
        }
    }
    out
}

fn accepted(judge: &LegJudge, count: usize) -> Vec<ProfileLeg> {
    let mut out = Vec::new();
    let mut more = 200_000;
    while out.len() < count {
        let legs = candidates(judge, more);
        out = legs.iter().filter_map(|(from, to, t)| judge.judge(from, to, *t).ok()).take(count).collect();
        more *= 2;
    }
    out
}

/// Candidates judged, one node, node and time each.
#[divan::bench]
fn judged(bencher: divan::Bencher) {
    let judge = judge();
    let candidates = candidates(&judge, 10_000);
    bencher
        .counter(divan::counter::ItemsCount::new(candidates.len()))
        .bench_local(|| candidates.iter().filter(|(from, to, t)| judge.judge(from, to, *t).is_ok()).count());
}

/// Accepted legs with the full bound between samples.
#[divan::bench]
fn proven(bencher: divan::Bencher) {
    let judge = judge();
    let legs = accepted(&judge, 500);
    bencher
        .counter(divan::counter::ItemsCount::new(legs.len()))
        .bench_local(|| legs.iter().map(|leg| judge.prove(leg)).filter(Result::<(), Infeasible>::is_ok).count());
}

/// One graph of the shipped scenario: 250 waypoints of 8 velocities each, beam of width 5, length 10, from its roadmap
/// to its first trajectory. The roadmap's own necessary test is exact one step from the end, so the beam needs no
/// lookahead.
#[divan::bench(sample_count = 20)]
fn beam_graph(bencher: divan::Bencher) {
    let (judge, world) = (judge(), cage());
    let score = Score::named("high-velocity-90", 1, 8.0).expect("a known score");
    let settings = BeamSettings { lookahead: 0, ..BeamSettings::default() };
    let seed = std::cell::Cell::new(0);
    bencher.bench_local(|| {
        seed.set(seed.get() + 1);
        let mut random = stream(seed.get());
        let mut points = vec![Point3::new(3.0, 3.0, 3.0)];
        while points.len() < 251 {
            let p = Point3::from(Vector3::from_fn(|_, _| random.random_range(2.0..28.0)));
            if world.is_free(&p, anafi().clearance_radius) {
                points.push(p);
            }
        }
        points.push(Point3::new(15.0, 15.0, 15.0));
        let map = Roadmap::new(&judge, &points, &RoadmapSettings { seed: seed.get(), ..RoadmapSettings::default() });
        let task = Task { start: map.start(), candidates: &points, reach: &map };
        let outcome = beam(&task, &score, |node, steps| map.may_arrive(node, steps), &settings);
        assert!(!outcome.found.is_empty(), "graph {} gave nothing: {:?}", seed.get(), outcome.ended);
        outcome
    });
}
