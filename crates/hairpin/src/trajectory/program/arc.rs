//! The arc through three points, as circular moves follow it.

use std::f64::consts::TAU;

use nalgebra::{Point3, Vector3};

/// An arc: p(s) = centre + cos(s·angle)·u + sin(s·angle)·(n × u), s ∈ [0, 1].
///
/// Orientation along it is the controller's to interpolate from start to end; the point on the way fixes the circle
/// alone. Three points on a line within 1e-12 (the sine of their angle) have none.
///
/// ```
/// use hairpin::trajectory::program::Arc;
/// use nalgebra::Point3;
///
/// let [start, via, end] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]].map(Point3::from);
/// let arc = Arc::through(&start, &via, &end).expect("not in line");
/// assert!((arc.radius() - 1.0).abs() < 1e-12 && (arc.length() - std::f64::consts::PI).abs() < 1e-12);
/// assert!((arc.point(0.5) - via).norm() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// The circle's centre, m.
    pub centre: Point3<f64>,
    /// u: from the centre to the start, m.
    pub to_start: Vector3<f64>,
    /// n: the axis that it turns about, right-handed, of length 1.
    pub axis: Vector3<f64>,
    /// From the start to the end, rad in (0, 2π).
    pub angle: f64,
}

impl Arc {
    /// The arc from `start` through `via` to `end`; `None` where the three lie on a line.
    ///
    /// With a = via − start, b = end − start, n = a × b the centre is start + (|a|² b − |b|² a) × n / 2|n|².
    pub fn through(start: &Point3<f64>, via: &Point3<f64>, end: &Point3<f64>) -> Option<Self> {
        let (a, b) = (via - start, end - start);
        let normal = a.cross(&b);
        let square = normal.norm_squared();
        if square.is_nan() || square <= 1e-24 * a.norm_squared() * b.norm_squared() || square == 0.0 {
            return None;
        }
        let to_centre = (a.norm_squared() * b - b.norm_squared() * a).cross(&normal) / (2.0 * square);
        let (to_start, axis) = (-to_centre, normal / square.sqrt());
        let to_end = b - to_centre;
        let turned = libm::atan2(axis.dot(&to_start.cross(&to_end)), to_start.dot(&to_end));
        let angle = if turned > 0.0 { turned } else { turned + TAU };
        Some(Self { centre: start + to_centre, to_start, axis, angle })
    }

    /// Radius, m.
    pub fn radius(&self) -> f64 {
        self.to_start.norm()
    }

    /// Length, m.
    pub fn length(&self) -> f64 {
        self.radius() * self.angle
    }

    /// The point at the share `s` of the angle.
    pub fn point(&self, s: f64) -> Point3<f64> {
        let (sin, cos) = libm::sincos(s * self.angle);
        self.centre + self.to_start * cos + self.axis.cross(&self.to_start) * sin
    }
}
