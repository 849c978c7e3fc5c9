//! The bits that one machine gave, which every other must give: hulls, witness legs, flights and the functions below
//! them.
//!
//! A change of the numerics moves them, and then puts the new ones here; a change of the machine must not.

use hairpin::feasibility::limits::Limits;
use hairpin::feasibility::reach::{Hull, HullSettings};
use hairpin::feasibility::steering::{LegJudge, LegTiming, ProofSettings};
use hairpin::math::random::{standard_normals, stream};
use hairpin::math::rotation::{angle_between, euler_from_quaternion, quaternion_from_euler};
use hairpin::robot::quadrotor::{Quadrotor, QuadrotorDescription};
use hairpin::simulation::{Conditions, ControllerSettings, FlySettings, Gusts, Sortie, fly};
use hairpin::world::World;
use nalgebra::{Point3, Vector3};

fn robot() -> Quadrotor {
    let text = include_str!("../../../../data/robots/quadrotor/flightgoggles.toml");
    toml::from_str::<QuadrotorDescription>(text).expect("a robot file").build().expect("a robot")
}

fn world() -> World {
    World::new(Vector3::repeat(20.0), 0.0, Vec::new()).expect("a world")
}

/// BLAKE3 of the numbers' bits, its first eight bytes.
fn fingerprint(numbers: impl IntoIterator<Item = f64>) -> u64 {
    let mut hasher = blake3::Hasher::new();
    for number in numbers {
        hasher.update(&number.to_bits().to_le_bytes());
    }
    hasher.finalize().as_bytes()[..8].iter().fold(0, |all, byte| all << 8 | u64::from(*byte))
}

fn functions() -> Vec<f64> {
    let mut random = stream(5);
    let mut out = Vec::new();
    for _ in 0..2000 {
        let [a, b, c, d, e, f] = standard_normals(&mut random);
        out.extend(euler_from_quaternion(&quaternion_from_euler(a, 0.5 * b, 3.0 * c)));
        out.push(angle_between(&Vector3::new(a, b, c), &Vector3::new(d, e, f)));
    }
    out
}

fn hull() -> Vec<f64> {
    let hull = Hull::new(&robot(), &HullSettings::default()).expect("a hull");
    let planes = hull.polytope().planes().flat_map(|(n, b)| [n.x, n.y, n.z, b]);
    hull.samples().iter().flat_map(|p| [p.x, p.y, p.z]).chain(planes).collect()
}

fn legs() -> Vec<f64> {
    let limits = Limits { max_speed: 8.0, max_tilt: 0.6 };
    let judge = LegJudge::new(&robot(), &world(), limits, ProofSettings::default()).expect("a judge");
    let mut random = stream(9);
    let mut out = Vec::new();
    for duration in LegTiming::ladder(0.8, 4.0).rungs() {
        for _ in 0..50 {
            let [a, b] = [(); 2].map(|()| Vector3::from(standard_normals::<3>(&mut random)));
            let end = |v: Vector3<f64>| judge.end(Point3::from(Vector3::repeat(10.0) + 2.0 * v), 0.5 * v);
            let Ok(leg) = judge.judge(&end(a), &end(b), duration) else { continue };
            let state = judge.flatness().body_state(&leg, 0.3 * duration);
            out.extend(leg.coefficients.into_iter().flatten());
            out.extend([state.attitude.w, state.attitude.i, state.attitude.j, state.attitude.k]);
            out.extend(state.rates.iter().chain(&state.rotors));
        }
    }
    out
}

fn flight() -> Vec<f64> {
    let waypoints = [[5.0, 5.0, 5.0], [14.0, 9.0, 8.0], [6.0, 12.0, 4.0]].map(Point3::from);
    let gusts = Some(Gusts { std: 1.0, correlation: 1.0 });
    let conditions = Conditions { wind: Vector3::x(), gusts, noise: true, ..Conditions::default() };
    let (robot, world) = (robot(), world());
    let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: None };
    let flight = fly(&sortie, &ControllerSettings::default(), &conditions, &FlySettings::default(), 3);
    let track = flight.expect("a flight").track;
    assert!((track.position(track.len() - 1) - waypoints[2]).norm() < 2.0, "it flew there");
    track
        .poses()
        .iter()
        .flat_map(|pose| {
            let (p, q) = (pose.translation.vector, pose.rotation);
            [p.x, p.y, p.z, q.w, q.i, q.j, q.k]
        })
        .collect()
}

#[test]
fn every_machine_gives_these_bits() {
    let found = [("functions", functions()), ("hull", hull()), ("legs", legs()), ("flight", flight())];
    for (what, numbers) in &found {
        assert!(numbers.len() > 1000 && numbers.iter().all(|x| x.is_finite()), "{what}: {} numbers", numbers.len());
    }
    let found = found.map(|(what, numbers)| format!("{what} {:016x}", fingerprint(numbers)));
    assert_eq!(
        found,
        ["functions 51cf726c2e0c46e4", "hull 1bcd1b2662c34b8f", "legs 3c9086304691bae9", "flight ce7ea1d4303f88c6",]
    );
}
