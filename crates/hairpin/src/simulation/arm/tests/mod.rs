//! Closed forms, limits by independent differentiation, and every fault by its own mark.

mod faults;
mod paths;
mod programs;
mod time;

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

use super::*;
use crate::math::random::{Stream, unit};
use crate::robot::arm::{Arm, JointLimit, Joints, Kinematics, Opw};
use crate::trajectory::Track;

/// A small arm of 0.58 m.
fn arm() -> Arm {
    let opw = Opw {
        a1: 0.0,
        a2: -0.07,
        b: 0.0,
        c1: 0.29,
        c2: 0.27,
        c3: 0.302,
        c4: 0.072,
        offsets: [0.0, 0.0, -FRAC_PI_2, 0.0, 0.0, 0.0],
        signs: [1.0; 6],
    };
    let bounds: [[f64; 3]; 6] = [
        [165.0, 165.0, 250.0],
        [110.0, 110.0, 250.0],
        [110.0, 70.0, 250.0],
        [160.0, 160.0, 320.0],
        [120.0, 120.0, 320.0],
        [400.0, 400.0, 420.0],
    ];
    Arm {
        name: "small".into(),
        caveat: String::new(),
        source: String::new(),
        up: Vector3::z(),
        base_from_controller: Isometry3::identity(),
        chain: opw.chain(),
        kinematics: Kinematics::Opw(opw),
        limits: bounds.map(|[lower, upper, speed]| JointLimit {
            lower: -lower.to_radians(),
            upper: upper.to_radians(),
            speed: speed.to_radians(),
            acceleration: 6.0 * speed.to_radians(),
        }),
        coupling: Default::default(),
        lags: None,
        joint_names: Default::default(),
        links: Default::default(),
        estimated: Vec::new(),
        excluded: Vec::new(),
    }
}

/// Tool down.
fn down() -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector3::y_axis(), std::f64::consts::PI)
}

fn pose(x: f64, y: f64, z: f64) -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::new(x, y, z), down())
}

/// Joint angles over the place (m) with the tool down, elbow up.
fn stand(arm: &Arm, x: f64, y: f64, z: f64) -> Joints {
    let near = [0.0, 0.0, 0.0, 0.0, 0.5, 0.0];
    let upright = |q: &Joints| q[3].abs() + q[1].abs();
    let all = arm.inverse(&pose(x, y, z), &near).into_iter().filter(|q| arm.outside_limits(q).is_none());
    all.min_by(|a, b| upright(a).total_cmp(&upright(b))).unwrap()
}

fn order(target: Target, tcp: f64, zone: Zone) -> Order {
    let speed = Speed { tcp, turn: 500f64.to_radians() };
    Order { name: "p".into(), target, speed, duration: None, zone, tool: Isometry3::identity() }
}

fn line(x: f64, y: f64, z: f64, tcp: f64, zone: Zone) -> Order {
    order(Target::Line(pose(x, y, z), None), tcp, zone)
}

fn joints(q: Joints) -> Order {
    order(Target::Joints(q), f64::INFINITY, Zone::Fine)
}

fn exact() -> RunSettings {
    RunSettings { lags: [0.0; 6], ..RunSettings::default() }
}

/// Distance of `p` from the segment a–b.
fn from_segment(p: &Point3<f64>, a: &Point3<f64>, b: &Point3<f64>) -> f64 {
    let along = b - a;
    let share = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (p - (a + along * share)).norm()
}

/// A random program over a patch in front of the arm, every kind of move, fine or zoned.
fn random_program(arm: &Arm, random: &mut Stream, moves: usize) -> (Joints, Vec<Order>) {
    let place = |random: &mut Stream| {
        let between = |low: f64, high: f64, random: &mut Stream| low + (high - low) * unit(random);
        [between(0.25, 0.42, random), between(-0.22, 0.22, random), between(0.1, 0.35, random)]
    };
    let [x, y, z] = place(random);
    let start = stand(arm, x, y, z);
    let mut orders = Vec::new();
    for _ in 0..moves {
        let zone = [Zone::Fine, Zone::Radius(0.01), Zone::Radius(0.05)][(3.0 * unit(random)) as usize];
        let speed = [0.2, 1.0, f64::INFINITY][(3.0 * unit(random)) as usize];
        let [x, y, z] = place(random);
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 1.2 * (unit(random) - 0.5));
        let to = Isometry3::from_parts(Translation3::new(x, y, z), turn * down());
        let target = match (4.0 * unit(random)) as usize {
            0 => Target::Joints(stand(arm, x, y, z)),
            1 => Target::Joint(to, None),
            2 => Target::Arc(Point3::from(place(random)), to, None),
            _ => Target::Line(to, None),
        };
        orders.push(order(target, speed, zone));
    }
    (start, orders)
}

fn places(track: &Track) -> Vec<Point3<f64>> {
    (0..track.len()).map(|i| track.position(i)).collect()
}
