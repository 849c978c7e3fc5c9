//! How many times faster than real time a flight is simulated, on one core: `cargo bench -p hairpin closed_loop`.
//!
//! Items are simulated milliseconds, which at the default step are physics steps: 12 000 × real time is 12 Mitem/s.

use divan::counter::ItemsCount;
use hairpin::robot::quadrotor::{Quadrotor, QuadrotorDescription};
use hairpin::simulation::{Conditions, ControllerKind, ControllerSettings, FlySettings, Gusts, Sortie, fly};
use hairpin::world::World;
use nalgebra::{Point3, Vector3};

fn flightgoggles() -> Quadrotor {
    let text = include_str!("../../../../data/robots/quadrotor/flightgoggles.toml");
    toml::from_str::<QuadrotorDescription>(text).expect("a shipped file").build().expect("a shipped robot")
}

/// Back and forth for 100 s: the time limit ends the run, so each controller is timed over the same time.
fn bench(bencher: divan::Bencher, kind: ControllerKind, conditions: Conditions) {
    let robot = flightgoggles();
    let world = World::new(Vector3::repeat(30.0), 0.0, vec![]).expect("a world");
    let waypoints: Vec<Point3<f64>> =
        (0..100).map(|i| Point3::new(if i % 2 == 0 { 5.0 } else { 20.0 }, 10.0 + (i % 3) as f64, 10.0)).collect();
    let controller = ControllerSettings { kind, ..Default::default() };
    let settings = FlySettings { time_limit: 100.0, linger: 1000.0, ..Default::default() };
    bencher.counter(ItemsCount::new(100_000usize)).bench_local(|| {
        let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: None };
        let flight = fly(&sortie, &controller, &conditions, &settings, 1).expect("a flight");
        assert!(flight.track.times().last().is_some_and(|end| *end > 99.0));
        flight
    });
}

#[divan::bench]
fn stable_waypoint(bencher: divan::Bencher) {
    bench(bencher, ControllerKind::StableWaypoint, Conditions::default());
}

#[divan::bench]
fn minimum_snap(bencher: divan::Bencher) {
    bench(bencher, ControllerKind::MinimumSnap, Conditions::default());
}

#[divan::bench]
fn geometric(bencher: divan::Bencher) {
    bench(bencher, ControllerKind::Geometric, Conditions::default());
}

#[divan::bench]
fn stable_waypoint_in_gusts_with_noise(bencher: divan::Bencher) {
    let gusts = Some(Gusts { std: 1.0, correlation: 1.0 });
    let conditions = Conditions { wind: Vector3::new(2.0, 0.0, 0.0), gusts, noise: true, ..Default::default() };
    bench(bencher, ControllerKind::StableWaypoint, conditions);
}
