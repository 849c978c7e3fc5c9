//! The simulator: seconds of flight per second.

use hairpin::simulation::{Conditions, ControllerKind, ControllerSettings, FlySettings, Sortie, fly};
use hairpin::world::World;
use hairpin_jobs::Problem;
use nalgebra::{Point3, Vector3};

use super::flyer::robot;
use super::row::Row;
use crate::clock::median_time;

/// Length of the flight that is timed, s.
const FLOWN_S: f64 = 100.0;

pub(super) fn rows() -> Vec<Row> {
    vec![Row::at_least("closed-loop", "× real time", 12_000.0, |_| stable_waypoint())]
}

/// Back and forth until the time limit, so that every machine flies the same.
fn stable_waypoint() -> Result<f64, Problem> {
    let robot = robot("flightgoggles")?;
    let world = World::new(Vector3::repeat(30.0), 0.0, Vec::new()).map_err(Problem::input)?;
    let side = |i: usize| if i.is_multiple_of(2) { 5.0 } else { 20.0 };
    let waypoints: Vec<Point3<f64>> = (0..100).map(|i| Point3::new(side(i), 10.0 + (i % 3) as f64, 10.0)).collect();
    let controller = ControllerSettings { kind: ControllerKind::StableWaypoint, ..Default::default() };
    let settings = FlySettings { time_limit: FLOWN_S, linger: 1000.0, ..Default::default() };
    let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: None };
    let once = || fly(&sortie, &controller, &Conditions::default(), &settings, 1);
    once().map_err(Problem::input)?;
    Ok(FLOWN_S / median_time(9, once))
}
