//! A quadrotor as it is drawn: its rotors where they are, on arms from a hub.

use nalgebra::{Point3, Vector3};

use crate::campaign::kind::{FigureLink, Look, RobotFigure, block, rod, wheel};
use crate::robot::quadrotor::Quadrotor;

/// Rotors of half the distance to the nearest one, less a little; the hub is a stand-in.
///
/// Reach is the distance of the farthest rotor from the origin; arms are 0.05 and the hub 0.28 of it. A rotor's arrow
/// is (ω/ω_max)², of its column `rotorN_rad_s`. Rotors stand 2 arms' radii over their arms.
pub(super) fn figure(robot: &Quadrotor) -> RobotFigure {
    let places: Vec<Vector3<f64>> = robot.rotors.iter().map(|r| Vector3::new(r.x, r.y, 0.0)).collect();
    let reach = places.iter().map(Vector3::norm).fold(0.0, f64::max).max(1e-3);
    let apart = |i: usize| (0..places.len()).filter(move |j| *j != i).map(move |j| (i, j));
    let nearest = (0..places.len()).flat_map(apart).map(|(i, j)| (places[i] - places[j]).norm());
    let disc = 0.46 * nearest.fold(2.0 * reach, f64::min);
    let thin = 0.05 * reach;
    let arms = places.iter().map(|place| rod(&Point3::origin(), &Point3::from(*place), thin)).collect();
    let (hub, high) = (0.28 * reach, 0.12 * reach);
    let nose = block([hub, -0.4 * hub, -high], [1.7 * hub, 0.4 * hub, 0.4 * high]);
    let mut links = vec![
        FigureLink::still(Look::Body, false, arms),
        FigureLink::still(Look::Body, true, vec![block([-1.2 * hub, -0.7 * hub, -high], [hub, 0.7 * hub, high])]),
        FigureLink::still(Look::Nose, false, vec![nose]),
    ];
    let fastest = robot.rotor_speed.1;
    links.extend(places.iter().enumerate().map(|(i, place)| {
        FigureLink {
            thrust: Some((format!("rotor{}_rad_s", i + 1), 1.0 / (fastest * fastest))),
            ..FigureLink::still(Look::Wheel, false, vec![wheel(disc, 0.4 * thin, true)])
                .at(place + Vector3::z() * 2.0 * thin)
        }
    }));
    RobotFigure {
        links,
        fixed: false,
        radius: reach + disc,
        lift: 0.0,
        told: "quadrotor drawn from its rotors' places, arrows are their thrust; the hub (hatched) is a stand-in"
            .into(),
    }
}
