//! Obstacles as triangles, to be drawn.

use std::f64::consts::{PI, TAU};

use nalgebra::{Point3, UnitQuaternion, Vector3};

use crate::world::{Obstacle, Shape};

/// A named surface. Vertices in m, world frame; triangles index into them.
///
/// Triangles made here are counter-clockwise seen from outside; those of hulls and meshes are as these have them.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Name of the obstacle.
    pub name: String,
    /// Corners.
    pub vertices: Vec<Point3<f64>>,
    /// Three corners each.
    pub triangles: Vec<[u32; 3]>,
}

/// Steps around the axis of a drawn sphere or capsule, and from pole to pole.
const AROUND: u32 = 24;
const DOWN: u32 = 12;

/// The surface of an obstacle: exact for boxes, hulls and meshes, faceted for spheres and capsules.
///
/// 24 steps around and 12 from pole to pole of what is round: for drawings, never for tests of collision.
pub fn surface(obstacle: &Obstacle) -> Surface {
    let (vertices, triangles) = match &obstacle.shape {
        Shape::Box { center, half_extents } => cuboid(center, half_extents),
        Shape::Sphere { center, radius } => round(center, center, *radius),
        Shape::Capsule { a, b, radius } => round(a, b, *radius),
        Shape::Hull(solid) | Shape::Mesh(solid) => (solid.vertices(), solid.triangles().to_vec()),
    };
    Surface { name: obstacle.name.clone(), vertices, triangles }
}

pub(super) type Triangles = (Vec<Point3<f64>>, Vec<[u32; 3]>);

/// Triangles with a name.
pub(super) fn named(name: &str, (vertices, triangles): Triangles) -> Surface {
    Surface { name: name.into(), vertices, triangles }
}

/// A cylinder with flat ends.
///
/// 2 + 2 · 24 vertices; `a` = `b` gives a disc about z without height.
pub(super) fn cylinder(a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> Triangles {
    let turn = UnitQuaternion::rotation_between(&Vector3::z(), &(b - a)).unwrap_or_else(UnitQuaternion::identity);
    let around = |i: u32| {
        let angle = TAU * f64::from(i) / f64::from(AROUND);
        turn * Vector3::new(angle.cos(), angle.sin(), 0.0) * radius
    };
    let mut vertices = vec![*a, *b];
    vertices.extend((0..AROUND).flat_map(|i| [a + around(i), b + around(i)]));
    let side = |i: u32| {
        let (p, q) = (2 + 2 * i, 2 + 2 * ((i + 1) % AROUND));
        [[0, q, p], [1, p + 1, q + 1], [p, q, p + 1], [q, q + 1, p + 1]]
    };
    (vertices, (0..AROUND).flat_map(side).collect())
}

/// Axis-aligned: `center` ± `half`, 8 vertices and 12 triangles.
pub(super) fn cuboid(center: &Point3<f64>, half: &Vector3<f64>) -> Triangles {
    let sign = |corner: usize, bit: usize| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
    let corner = |c: usize| center + Vector3::new(sign(c, 0), sign(c, 1), sign(c, 2)).component_mul(half);
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    ((0..8).map(corner).collect(), triangles)
}

/// A capsule, or a sphere where `a` is `b`: rings of vertices from the pole beyond `b` to the pole beyond `a`.
pub(super) fn round(a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> Triangles {
    let axis = b - a;
    let turn = UnitQuaternion::rotation_between(&Vector3::z(), &axis).unwrap_or_else(|| {
        if axis.z < 0.0 { UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI) } else { UnitQuaternion::identity() }
    });
    let mut vertices = Vec::new();
    // The equator is there twice, once around each end.
    for ring in 0..=DOWN + 1 {
        let (end, step) = if ring <= DOWN / 2 { (b, ring) } else { (a, ring - 1) };
        let polar = PI * f64::from(step) / f64::from(DOWN);
        for i in 0..AROUND {
            let azimuth = TAU * f64::from(i) / f64::from(AROUND);
            let direction = Vector3::new(polar.sin() * azimuth.cos(), polar.sin() * azimuth.sin(), polar.cos());
            vertices.push(end + turn * direction * radius);
        }
    }
    let mut triangles = Vec::new();
    for ring in 0..=DOWN {
        for i in 0..AROUND {
            let (p, q) = (ring * AROUND + i, ring * AROUND + (i + 1) % AROUND);
            triangles.extend([[p, p + AROUND, q], [q, p + AROUND, q + AROUND]]);
        }
    }
    (vertices, triangles)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    /// Volume by the divergence theorem: positive if the triangles face outwards.
    fn volume(surface: &Surface) -> f64 {
        let v = |i: u32| surface.vertices[i as usize].coords;
        surface.triangles.iter().map(|[a, b, c]| v(*a).dot(&v(*b).cross(&v(*c))) / 6.0).sum()
    }

    #[test]
    fn surfaces_enclose_their_solids() {
        let (a, b) = ([1.0, 2.0, 3.0], [2.0, 4.0, 5.0]);
        let sphere = 4.0 / 3.0 * PI * 0.5f64.powi(3);
        for (shape, expected, tolerance) in [
            (Shape::cuboid(a, b), 40.0, 1e-9),
            (Shape::sphere(a, 0.5), sphere, 0.04 * sphere),
            (Shape::capsule(a, b, 0.5), sphere + 0.75 * PI, 0.04 * 3.0),
            (Shape::capsule(b, [2.0, 4.0, 1.0], 0.5), sphere + PI, 0.04 * 4.0),
            (Shape::hull(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]), 1.0 / 6.0, 1e-9),
        ] {
            let drawn = surface(&Obstacle { name: "o".into(), shape: shape.unwrap() });
            assert!((volume(&drawn) - expected).abs() < tolerance, "{} for {expected}", volume(&drawn));
        }
        let drum = named("drum", cylinder(&Point3::new(1.0, 0.0, 0.0), &Point3::new(1.0, 2.0, 0.0), 0.5));
        assert!((volume(&drum) - 0.5 * PI).abs() < 0.02 * PI, "{}", volume(&drum));
    }
}
