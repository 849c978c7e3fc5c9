//! Solid shapes and their distances to points and segments.

use nalgebra::{Point3, Vector3};

/// A named solid in the world.
#[derive(Debug, Clone)]
pub struct Obstacle {
    /// Name for reports.
    pub name: String,
    /// The solid, world frame.
    pub shape: Shape,
}

/// The kinds of solid, world frame, m.
#[derive(Debug, Clone)]
pub enum Shape {
    /// A ball.
    Sphere { center: Point3<f64>, radius: f64 },
    /// An axis-aligned box.
    Box { center: Point3<f64>, half_extents: Vector3<f64> },
    /// All points within `radius` of the segment a–b.
    Capsule { a: Point3<f64>, b: Point3<f64>, radius: f64 },
}

impl Shape {
    /// Distance of `p` to the solid, m; negative inside.
    pub fn signed_distance(&self, p: &Point3<f64>) -> f64 {
        match self {
            Shape::Sphere { center, radius } => (p - center).norm() - radius,
            Shape::Box { center, half_extents } => {
                let q = (p - center).abs() - half_extents;
                q.sup(&Vector3::zeros()).norm() + q.max().min(0.0)
            }
            Shape::Capsule { a, b, radius } => {
                let d = b - a;
                let t = if d.norm_squared() > 0.0 { ((p - a).dot(&d) / d.norm_squared()).clamp(0.0, 1.0) } else { 0.0 };
                (p - (a + d * t)).norm() - radius
            }
        }
    }

    /// Smallest distance between the segment `a`–`b` and the solid, m; ≤ 0 if they meet.
    pub fn segment_distance(&self, a: &Point3<f64>, b: &Point3<f64>) -> f64 {
        // Every shape is convex, so the distance along a segment is convex in its parameter: golden-section search.
        let (mut lo, mut hi) = (0.0, 1.0);
        for _ in 0..64 {
            let (m1, m2) = (lo + (hi - lo) * 0.382, lo + (hi - lo) * 0.618);
            if self.signed_distance(&(a + (b - a) * m1)) < self.signed_distance(&(a + (b - a) * m2)) {
                hi = m2
            } else {
                lo = m1
            }
        }
        self.signed_distance(&(a + (b - a) * (0.5 * (lo + hi))))
    }
}
