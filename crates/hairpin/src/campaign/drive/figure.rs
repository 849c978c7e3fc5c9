//! A wheeled vehicle as it is drawn: wheels where its suspension has them, and a body over its underside.
//!
//! Body frame: x ahead, y left, z up, origin that of the vehicle's pose; m. Links are moved by the channels that runs
//! record: `rolled` (m), `joint_rocker_rad`, `joint_left_bogie_rad`, `joint_right_bogie_rad` (rad).

use nalgebra::Vector3;

use crate::campaign::kind::{FigureLink, Look, RobotFigure, Turned, block, rod, wheel};
use crate::robot::rover::{RockerBogie, Rover, Steering, Suspension};

/// Turned about y, as a wheel that rolls and a link of the suspension are.
fn about_y(link: FigureLink, parent: Option<usize>, turned: Turned) -> FigureLink {
    FigureLink { parent, axis: Vector3::y(), turned, ..link }
}

/// Wheels and the links of a rocker-bogie are the robot's own; the body's height is a stand-in, as is its underside
/// where no file gives one.
///
/// The body is a box from the rear to the front of the underside, as tall as a wheel's radius, and a quarter of its
/// length where no wheels are known; on its front quarter lies a nose half as wide. The radius is the larger of the
/// wheels' and the body's circle about the origin, and a wheel's radius more.
pub(super) fn figure(rover: &Rover) -> RobotFigure {
    let (wheels, count, radius) = rover.suspension.wheels(&[0.0; 3]);
    let belly = rover.body.belly;
    let (length, half_width) = ((belly.front - belly.rear).max(1e-3), belly.half_width.max(1e-3));
    let estimated = count == 0 || rover.estimated.contains(&"belly");
    let tall = if count > 0 { radius } else { 0.25 * length };
    let bottom = if count > 0 { belly.height } else { 0.1 * length };
    let body = block([belly.rear, -half_width, bottom], [belly.front, half_width, bottom + tall]);
    let middle = 0.5 * (belly.front + belly.rear);
    let nose = block(
        [middle + 0.25 * length, -0.5 * half_width, bottom + tall],
        [belly.front, 0.5 * half_width, bottom + 1.35 * tall],
    );
    let mut links =
        vec![FigureLink::still(Look::Body, estimated, vec![body]), FigureLink::still(Look::Nose, true, vec![nose])];
    match &rover.suspension {
        Suspension::RockerBogie(bogie) => rocker_bogie(&mut links, bogie, rover.wheels.steering),
        _ if count > 0 => {
            for place in &wheels[..count] {
                roll(
                    &mut links,
                    None,
                    *place,
                    *place,
                    radius,
                    steers(rover.wheels.steering, place.x, &wheels[..count]),
                );
            }
        }
        // No wheels are known: as many as stand under such a body.
        _ => {
            let size = 0.1 * length;
            let rows = if rover.limits.turns_in_place { vec![0.0] } else { vec![0.0, belly.front + belly.rear] };
            for x in rows {
                for y in [-half_width, half_width] {
                    let at = Vector3::new(x, 0.94 * y, size);
                    roll(&mut links, None, at, at, size, x != 0.0);
                }
            }
            links.iter_mut().for_each(|link| link.stand_in = true);
        }
    }
    let told = match (count, estimated) {
        (0, _) => "the vehicle's body and wheels (hatched) are stand-ins of its length and width",
        (_, true) => "wheels are the robot's own; its body (hatched) is a stand-in",
        _ => "wheels and underside are the robot's own; how high its body is, is a stand-in",
    };
    RobotFigure {
        links,
        fixed: false,
        radius: rover.suspension.outer_radius().max(0.5 * libm::hypot(length, 2.0 * half_width)) + radius,
        lift: rover.suspension.ride_height(),
        told: told.into(),
    }
}

/// Whether a wheel at `x` of `wheels` steers.
///
/// Front and rear are the rows farthest ahead and farthest back; within 1e-9 m a wheel is of a row.
fn steers(steering: Steering, x: f64, wheels: &[Vector3<f64>]) -> bool {
    let (front, rear) = wheels.iter().fold((f64::MIN, f64::MAX), |(f, r), w| (f.max(w.x), r.min(w.x)));
    let near = |end: f64| (x - end).abs() < 1e-9;
    match steering {
        Steering::Skid => false,
        Steering::AllWheel => true,
        Steering::Front => near(front),
        Steering::Corner => near(front) || near(rear),
    }
}

/// Adds a wheel at `place` of its parent, which is at `at` in the body.
///
/// Three links: a post without a shape, which steers, and on it the wheel, 0.6 radii wide, and its hub, which roll by
/// rolled/radius.
fn roll(
    links: &mut Vec<FigureLink>,
    parent: Option<usize>,
    place: Vector3<f64>,
    at: Vector3<f64>,
    radius: f64,
    steers: bool,
) {
    let rolls = Turned::By { channel: "rolled".into(), factor: 1.0 / radius.max(1e-6) };
    let hub = block([-0.8 * radius, -0.31 * radius, -0.12 * radius], [0.8 * radius, 0.31 * radius, 0.12 * radius]);
    let turned = if steers { Turned::Steers { at: [at.x, at.y] } } else { Turned::Never };
    let post = links.len();
    links.push(FigureLink { parent, turned, ..FigureLink::still(Look::Wheel, false, Vec::new()).at(place) });
    links.push(about_y(
        FigureLink::still(Look::Wheel, false, vec![wheel(radius, 0.6 * radius, false)]),
        Some(post),
        rolls.clone(),
    ));
    links.push(about_y(FigureLink::still(Look::Body, false, vec![hub]), Some(post), rolls));
}

/// Rockers and bogies on both sides, each with its wheels.
///
/// The left side is the robot's own, the right one its mirror image in y; the differential turns the right rocker
/// against the left one, hence the channel's factor ± 1.
fn rocker_bogie(links: &mut Vec<FigureLink>, of: &RockerBogie, steering: Steering) {
    let all = of.wheels(&[0.0; 3]);
    let thin = 0.15 * of.wheel_radius;
    for (s, bogie_channel) in [(1.0, "joint_left_bogie_rad"), (-1.0, "joint_right_bogie_rad")] {
        let mirror = |v: &Vector3<f64>| Vector3::new(v.x, s * v.y, v.z);
        let [pivot, own, joint] = [&of.pivot, &of.rocker_wheel, &of.bogie_joint].map(mirror);
        let between = |a: Vector3<f64>, b: Vector3<f64>| rod(&a.into(), &b.into(), thin);
        let rocker = links.len();
        let shape = vec![between(Vector3::zeros(), own), between(Vector3::zeros(), joint)];
        let by = Turned::By { channel: "joint_rocker_rad".into(), factor: s };
        links.push(about_y(FigureLink::still(Look::Body, false, shape).at(pivot), None, by));
        let bogie = links.len();
        let ends = of.bogie_wheels.map(|wheel| mirror(&wheel));
        let shape = ends.iter().map(|end| between(Vector3::zeros(), *end)).collect();
        let by = Turned::By { channel: bogie_channel.into(), factor: 1.0 };
        links.push(about_y(FigureLink::still(Look::Body, false, shape).at(joint), Some(rocker), by));
        let r = of.wheel_radius;
        roll(links, Some(rocker), own, pivot + own, r, steers(steering, (pivot + own).x, &all));
        for end in ends {
            let at = pivot + joint + end;
            roll(links, Some(bogie), end, at, r, steers(steering, at.x, &all));
        }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::campaign::scenario::GroundDescription;

    /// Wheels of the figure at joint angles, by its links alone.
    fn wheels(figure: &RobotFigure, joints: [f64; 3]) -> Vec<Vector3<f64>> {
        let mut frames = Vec::new();
        for link in &figure.links {
            let angle = match &link.turned {
                Turned::By { channel, factor } => match channel.as_str() {
                    "joint_rocker_rad" => factor * joints[0],
                    "joint_left_bogie_rad" => factor * joints[1],
                    "joint_right_bogie_rad" => factor * joints[2],
                    _ => 0.0,
                },
                _ => 0.0,
            };
            let base = link.parent.map_or(nalgebra::Isometry3::identity(), |parent| frames[parent]);
            let turn = nalgebra::UnitQuaternion::from_axis_angle(&nalgebra::Unit::new_normalize(link.axis), angle);
            frames.push(base * link.place * turn);
        }
        let is_post = |link: &&FigureLink| link.look == Look::Wheel && link.surfaces.is_empty();
        figure.links.iter().zip(&frames).filter(|(link, _)| is_post(link)).map(|(_, f)| f.translation.vector).collect()
    }

    #[test]
    fn a_drawn_rocker_bogie_has_its_wheels_where_the_suspension_has_them() {
        let file = include_str!("../../../../../data/robots/rover/rocky8.toml");
        let rover = toml::from_str::<GroundDescription>(file).unwrap().build().unwrap();
        let joints = [0.2, -0.15, 0.3];
        let (expected, count, _) = rover.suspension.wheels(&joints);
        let drawn = wheels(&figure(&rover), joints);
        assert_eq!(drawn.len(), count);
        for (a, b) in drawn.iter().zip(&expected[..count]) {
            assert!((a - b).norm() < 1e-12, "{a} {b}");
        }
    }
}
