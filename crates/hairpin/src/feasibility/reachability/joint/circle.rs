//! The arc through three points, as controllers take it.

use nalgebra::Vector3;
use thiserror::Error;

use crate::math::rotation::angle_between;

/// An arc from its start through a point to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    centre: Vector3<f64>,
    /// From the centre to the start.
    radius: Vector3<f64>,
    /// At right angles to it, of the same length, forward.
    forward: Vector3<f64>,
    /// rad.
    angle: f64,
}

/// Why three points give no circular move.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum CircleError {
    /// Two points are nearer than 0.1 mm.
    #[error("two of the three points are {0:.2e} m apart, less than 0.1 mm")]
    TooNear(f64),
    /// Seen from the start, the other two are in nearly one direction, or the three lie on a line.
    #[error("seen from the start the other two points are {:.2}° apart, less than 1°", .0.to_degrees())]
    OneDirection(f64),
    /// The arc is too long.
    #[error("an arc of {:.1}°, 240° or more", .0.to_degrees())]
    TooLong(f64),
}

/// Points of an arc lie at least this far apart, m.
const LEAST_DISTANCE: f64 = 1e-4;

impl Circle {
    /// The arc from `start` through `via` to `end`, m.
    ///
    /// # Errors
    /// [`CircleError`]: what ABB's controllers refuse of MoveC.
    pub fn through(start: &Vector3<f64>, via: &Vector3<f64>, end: &Vector3<f64>) -> Result<Self, CircleError> {
        let (u, v) = (via - start, end - start);
        let nearest = u.norm().min(v.norm()).min((end - via).norm());
        if nearest.is_nan() || nearest < LEAST_DISTANCE {
            return Err(CircleError::TooNear(nearest));
        }
        let apart = angle_between(&u, &v);
        let opposite = std::f64::consts::PI - apart;
        if apart.min(opposite) < 1f64.to_radians() {
            return Err(CircleError::OneDirection(apart.min(opposite)));
        }
        // The centre, seen from the start: |w|² ((u × v)-perpendicular combination).
        let normal = u.cross(&v);
        let offset =
            (normal.cross(&u) * v.norm_squared() + v.cross(&normal) * u.norm_squared()) / (2.0 * normal.norm_squared());
        let (centre, radius) = (start + offset, -offset);
        let forward = normal.normalize().cross(&radius);
        let to_end = end - centre;
        let angle = libm::atan2(to_end.dot(&forward), to_end.dot(&radius));
        let angle = if angle <= 0.0 { angle + std::f64::consts::TAU } else { angle };
        if angle >= 240f64.to_radians() {
            return Err(CircleError::TooLong(angle));
        }
        Ok(Self { centre, radius, forward, angle })
    }

    /// The point at `s` in [0, 1].
    pub fn at(&self, s: f64) -> Vector3<f64> {
        let (sin, cos) = libm::sincos(s * self.angle);
        self.centre + self.radius * cos + self.forward * sin
    }

    /// Length, m.
    pub fn length(&self) -> f64 {
        self.angle * self.radius.norm()
    }

    /// Angle, rad.
    pub fn angle(&self) -> f64 {
        self.angle
    }
}
