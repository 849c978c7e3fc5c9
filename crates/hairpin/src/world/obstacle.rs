//! Solid shapes, built from plain numbers, and their distances to points and segments.
//!
//! Keys are those of the world's file, with the unit in the name; inside everything is m. Balls, boxes and capsules
//! have closed forms; hulls and meshes go through [`super::solid`].

use nalgebra::{Point3, Vector3};

use super::bounds::Bounds;
use super::closed;
use super::error::WorldError;
use super::solid::Solid;
use crate::math::segment;

/// A named solid in the world.
#[derive(Debug, Clone)]
pub struct Obstacle {
    /// Name for reports.
    pub name: String,
    /// The solid, world frame.
    pub shape: Shape,
}

/// The kinds of solid, world frame, m.
///
/// Variants are public for `match`; [`Shape::sphere`] and its siblings check, and [`super::World::new`] checks again.
/// Coordinates and sizes beyond 10⁷ m are refused.
///
/// ```
/// use hairpin::world::Shape;
/// use nalgebra::Point3;
///
/// let cube = Shape::cuboid([0.0, 0.0, 0.0], [2.0, 2.0, 2.0])?;
/// assert_eq!(cube.signed_distance(&Point3::new(4.0, 5.0, 0.0)), 5.0); // 3-4-5 from the edge
/// assert_eq!(cube.signed_distance(&Point3::new(0.5, 0.0, 0.0)), -0.5);
/// assert_eq!(Shape::sphere([0.0; 3], -1.0).unwrap_err().field, "sphere.radius_m");
/// # Ok::<(), hairpin::world::WorldError>(())
/// ```
#[derive(Debug, Clone)]
pub enum Shape {
    /// A ball.
    Sphere {
        /// Centre.
        center: Point3<f64>,
        /// Radius, > 0.
        radius: f64,
    },
    /// An axis-aligned box.
    Box {
        /// Centre.
        center: Point3<f64>,
        /// Half the edge lengths, > 0.
        half_extents: Vector3<f64>,
    },
    /// All points within `radius` of the segment a–b.
    Capsule {
        /// One end of the axis.
        a: Point3<f64>,
        /// The other end.
        b: Point3<f64>,
        /// Radius, > 0.
        radius: f64,
    },
    /// A convex hull.
    Hull(Solid),
    /// The inside of a closed triangle mesh.
    Mesh(Solid),
}

/// Coordinates beyond this (m) are refused: squares and cubes of them would lose all digits.
const LARGEST: f64 = 1e7;

impl Shape {
    /// The ball around `center_m`.
    ///
    /// # Errors
    /// `sphere.center_m`, `sphere.radius_m`.
    pub fn sphere(center_m: [f64; 3], radius_m: f64) -> Result<Self, WorldError> {
        Self::Sphere { center: center_m.into(), radius: radius_m }.checked()
    }

    /// The axis-aligned box with edge lengths `size_m`.
    ///
    /// # Errors
    /// `box.center_m`, `box.size_m`.
    pub fn cuboid(center_m: [f64; 3], size_m: [f64; 3]) -> Result<Self, WorldError> {
        Self::Box { center: center_m.into(), half_extents: Vector3::from(size_m) * 0.5 }.checked()
    }

    /// All points within `radius_m` of the segment a–b; a = b is a ball.
    ///
    /// # Errors
    /// `capsule.a_m`, `capsule.b_m`, `capsule.radius_m`.
    pub fn capsule(a_m: [f64; 3], b_m: [f64; 3], radius_m: f64) -> Result<Self, WorldError> {
        Self::Capsule { a: a_m.into(), b: b_m.into(), radius: radius_m }.checked()
    }

    /// The convex hull of points.
    ///
    /// Points inside the hull are dropped. Quickhull in floating point: a hull that leaves a given point more than 1e-7
    /// of its size outside is refused, not returned.
    ///
    /// # Errors
    /// `hull.points_m`: fewer than four, not finite, in one plane.
    pub fn hull(points_m: &[[f64; 3]]) -> Result<Self, WorldError> {
        let points = finite("hull.points_m", points_m)?;
        Solid::hull(&points).map(Self::Hull).map_err(|(value, bound)| WorldError::new("hull.points_m", value, bound))
    }

    /// The inside of a closed triangle mesh; `triangles` are vertex indices from 0, wound either way round.
    ///
    /// Vertices with equal coordinates are merged; a surface wound inside out is turned. Self-intersections are the
    /// caller's to see to. The inside counts: a segment wholly within a mesh is met by it.
    ///
    /// # Errors
    /// `mesh.vertices_m`: not finite. `mesh.triangles`: an index out of range, an open or inconsistently wound
    /// surface, a triangle without area, no volume.
    pub fn mesh(vertices_m: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Self, WorldError> {
        let vertices = finite("mesh.vertices_m", vertices_m)?;
        Solid::mesh(&vertices, triangles)
            .map(Self::Mesh)
            .map_err(|(value, bound)| WorldError::new("mesh.triangles", value, bound))
    }

    /// Distance of `p` to the solid, m; negative inside.
    ///
    /// ```text
    /// ball ‖p − c‖ − r      capsule dist(p, ab) − r      box ‖max(|p − c| − h, 0)‖ + min(max_i(|p − c| − h)_i, 0)
    /// ```
    ///
    /// 1-Lipschitz in `p`, so that a clearance at a sample bounds it around the sample.
    pub fn signed_distance(&self, p: &Point3<f64>) -> f64 {
        match self {
            Shape::Sphere { center, radius } => (p - center).norm() - radius,
            Shape::Box { center, half_extents } => closed::point_to_box(&(p - center), half_extents),
            Shape::Capsule { a, b, radius } => segment::point_distance(p, a, b) - radius,
            Shape::Hull(solid) | Shape::Mesh(solid) => solid.signed_distance(p),
        }
    }

    /// Smallest signed distance of the points of the segment `a`–`b` to the solid, m; ≤ 0 if they meet. For hulls
    /// and meshes that are met the value is an upper bound (the deeper end's, or 0).
    ///
    /// min over t in [0, 1] of the signed distance of a + t (b − a). Never the line's: what lies beyond an end does not
    /// count.
    pub fn segment_distance(&self, a: &Point3<f64>, b: &Point3<f64>) -> f64 {
        match self {
            Shape::Sphere { center, radius } => segment::point_distance(center, a, b) - radius,
            Shape::Box { center, half_extents } => closed::segment_to_box(&(a - center), &(b - a), half_extents),
            Shape::Capsule { a: from, b: to, radius } => segment::segment_distance(a, b, from, to) - radius,
            Shape::Hull(solid) | Shape::Mesh(solid) => solid.segment_distance(a, b),
        }
    }

    /// The smallest axis-aligned box around the solid.
    pub fn bounds(&self) -> Bounds {
        match self {
            Shape::Sphere { center, radius } => Bounds { min: *center, max: *center }.grown(*radius),
            Shape::Box { center, half_extents } => Bounds { min: center - half_extents, max: center + half_extents },
            Shape::Capsule { a, b, radius } => Bounds { min: a.inf(b), max: a.sup(b) }.grown(*radius),
            Shape::Hull(solid) | Shape::Mesh(solid) => solid.bounds(),
        }
    }

    /// Whether some part of the solid lies within the box `walls`, its border included.
    ///
    /// Exact for balls, boxes and capsules. Of hulls and meshes the boxes around their triangles count, and whether the
    /// middle of `walls` is inside: what is far from the walls is never within them.
    pub fn reaches(&self, walls: &Bounds) -> bool {
        let middle = nalgebra::center(&walls.min, &walls.max);
        match self {
            Shape::Sphere { center, radius } => walls.distance(center) <= *radius,
            Shape::Box { .. } => self.bounds().distance_to(walls) <= 0.0,
            Shape::Capsule { a, b, radius } => {
                let half = (walls.max - walls.min) * 0.5;
                closed::segment_to_box(&(a - middle), &(b - a), &half) <= *radius
            }
            Shape::Hull(solid) | Shape::Mesh(solid) => {
                let vertices = solid.vertices();
                let around = |t: &[u32; 3]| Bounds::around(t.iter().map(|&at| &vertices[at as usize]));
                let mut triangles = solid.triangles().iter().filter_map(around);
                triangles.any(|triangle| triangle.distance_to(walls) <= 0.0) || solid.signed_distance(&middle) <= 0.0
            }
        }
    }

    /// The shape itself if its numbers are a solid's. The variants are public, so [`super::World::new`] asks again.
    pub(super) fn checked(self) -> Result<Self, WorldError> {
        match &self {
            Shape::Sphere { center, radius } => {
                place("sphere.center_m", center)?;
                positive("sphere.radius_m", *radius)?;
            }
            Shape::Box { center, half_extents } => {
                place("box.center_m", center)?;
                if !half_extents.iter().all(|h| *h > 0.0 && *h < LARGEST) {
                    let size = half_extents * 2.0;
                    let bound = format!("three numbers > 0 and < {}", 2.0 * LARGEST);
                    return Err(WorldError::new("box.size_m", format!("{:?}", size.as_slice()), bound));
                }
            }
            Shape::Capsule { a, b, radius } => {
                place("capsule.a_m", a)?;
                place("capsule.b_m", b)?;
                positive("capsule.radius_m", *radius)?;
            }
            // Their fields are private: they cannot exist unchecked.
            Shape::Hull(_) | Shape::Mesh(_) => {}
        }
        Ok(self)
    }
}

fn place(field: &str, p: &Point3<f64>) -> Result<(), WorldError> {
    if p.iter().all(|c| c.abs() < LARGEST) {
        return Ok(());
    }
    let value = format!("{:?}", p.coords.as_slice());
    Err(WorldError::new(field, value, format!("three numbers between ±{LARGEST}")))
}

fn positive(field: &str, value: f64) -> Result<(), WorldError> {
    if value > 0.0 && value < LARGEST {
        return Ok(());
    }
    Err(WorldError::new(field, format!("{value}"), format!("> 0 and < {LARGEST}")))
}

fn finite(field: &str, points: &[[f64; 3]]) -> Result<Vec<Point3<f64>>, WorldError> {
    let points: Vec<Point3<f64>> = points.iter().map(|&p| p.into()).collect();
    for (index, p) in points.iter().enumerate() {
        place(&format!("{field}[{index}]"), p)?;
    }
    Ok(points)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn what_lies_wholly_outside_of_walls_does_not_reach_them() {
        let walls = Bounds { min: Point3::origin(), max: Point3::new(10.0, 10.0, 10.0) };
        let cube = |low: f64, high: f64| {
            let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { high } else { low });
            Shape::hull(&(0..8).map(corner).collect::<Vec<_>>())
        };
        for (shape, reaches) in [
            // The corner is √3 away.
            (Shape::sphere([-1.0; 3], 1.7), false),
            (Shape::sphere([-1.0; 3], 1.8), true),
            (Shape::cuboid([5.0, 5.0, -0.5], [9.0, 9.0, 1.0]), true),
            (Shape::cuboid([5.0, 5.0, -0.6], [9.0, 9.0, 1.0]), false),
            (Shape::capsule([-5.0, 5.0, 5.0], [15.0, 5.0, 5.0], 0.1), true),
            // Past an edge, whose box it crosses.
            (Shape::capsule([-5.0, 4.0, 5.0], [4.0, -5.0, 5.0], 0.1), false),
            (Shape::capsule([-5.0, 4.0, 5.0], [4.0, -5.0, 5.0], 0.8), true),
            (cube(-100.0, 100.0), true),
            (cube(9.0, 11.0), true),
            (cube(9000.0, 11_000.0), false),
        ] {
            let shape = shape.unwrap();
            assert_eq!(shape.reaches(&walls), reaches, "{shape:?}");
        }
    }
}
