//! The waters as they are drawn.

use std::f64::consts::TAU;

use nalgebra::{Point3, Vector3};

use super::BoatSetup;
use crate::campaign::kind::{Drawing, Surface};
use crate::world::terrain::{KeepOut, KeepOutShape};

/// Corners of a drawn disc.
const AROUND: usize = 32;
/// Height of the drawn box and of what stands in it, m.
const HEIGHT: f64 = 0.5;

/// All of the waters.
pub(super) fn waters(setup: &BoatSetup) -> Drawing {
    let [x, y] = setup.scenario.world.size_m;
    Drawing {
        low: Point3::origin(),
        size: Vector3::new(x, y, HEIGHT),
        obstacles: setup.keep_out.list().iter().map(keep_out).collect(),
        rotors: Vec::new(),
        wheels: Vec::new(),
        radius: setup.boat.radius,
        relief: None,
    }
}

/// A keep-out as a flat shape; a fan, exact for convex ones.
fn keep_out(place: &KeepOut) -> Surface {
    let vertices: Vec<Point3<f64>> = match &place.shape {
        KeepOutShape::Circle { center_m: [x, y], radius_m } => (0..AROUND)
            .map(|i| {
                let (sin, cos) = libm::sincos(TAU * i as f64 / AROUND as f64);
                Point3::new(x + radius_m * cos, y + radius_m * sin, 0.0)
            })
            .collect(),
        KeepOutShape::Polygon { points_m } => points_m.iter().map(|[x, y]| Point3::new(*x, *y, 0.0)).collect(),
    };
    let triangles = (1..vertices.len().saturating_sub(1) as u32).map(|i| [0, i, i + 1]).collect();
    Surface { name: place.name.clone(), vertices, triangles }
}
