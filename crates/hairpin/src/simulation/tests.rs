//! The act against closed forms, other integrators and its own promises.

use nalgebra::{Point3, Vector3};

use super::*;
use crate::robot::quadrotor::{Quadrotor, QuadrotorDescription};
use crate::trajectory::{Ended, Flight};
use crate::world::World;

/// The shipped robots, FlightGoggles first.
pub(crate) fn shipped() -> Vec<Quadrotor> {
    [
        include_str!("../../../../data/robots/quadrotor/flightgoggles.toml"),
        include_str!("../../../../data/robots/quadrotor/paper-flightgoggles.toml"),
        include_str!("../../../../data/robots/quadrotor/anafi.toml"),
        include_str!("../../../../data/robots/quadrotor/anafi-real.toml"),
        include_str!("../../../../data/robots/quadrotor/crazyflie.toml"),
    ]
    .map(|text| toml::from_str::<QuadrotorDescription>(text).unwrap().build().unwrap())
    .to_vec()
}

pub(crate) fn flightgoggles() -> Quadrotor {
    shipped().remove(0)
}

fn cage() -> World {
    World::new(Vector3::repeat(30.0), 0.0, vec![]).unwrap()
}

fn fly_with(robot: &Quadrotor, world: &World, points: &[[f64; 3]], conditions: &Conditions, seed: u64) -> Flight {
    let waypoints: Vec<Point3<f64>> = points.iter().copied().map(Point3::from).collect();
    let sortie = Sortie { robot, world, waypoints: &waypoints, profile: None };
    let settings = FlySettings { time_limit: 30.0, ..Default::default() };
    fly(&sortie, &ControllerSettings::default(), conditions, &settings, seed).unwrap()
}

#[test]
fn hover_is_held() {
    for robot in shipped() {
        let point = [10.0, 10.0, 10.0];
        let flight = fly_with(&robot, &cage(), &[point, point], &Conditions::default(), 1);
        assert_eq!(flight.ended, Ended::Done, "{}", robot.name);
        assert!((flight.track.times().last().unwrap() - 2.0).abs() < 1e-9);
        let farthest = (0..flight.track.len()).map(|i| (flight.track.position(i) - Point3::from(point)).norm());
        assert!(farthest.fold(0.0, f64::max) < 1e-9, "{}", robot.name);
    }
}
