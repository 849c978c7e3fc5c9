//! The arc through three points, as controllers take it.

use nalgebra::{Point3, Vector3};
use thiserror::Error;

use crate::math::rotation::angle_between;
use crate::trajectory::program::Arc;

/// An arc from its start through a point to its end.
///
/// Within 0 … 240°; points at least 0.1 mm apart and at least 1° out of line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    arc: Arc,
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
    /// Distances that are no numbers are `TooNear`. Angles between chords are seen from the start only.
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
        let point = |at: &Vector3<f64>| Point3::from(*at);
        let arc = Arc::through(&point(start), &point(via), &point(end)).ok_or(CircleError::OneDirection(0.0))?;
        let angle = arc.angle;
        if angle >= 240f64.to_radians() {
            return Err(CircleError::TooLong(angle));
        }
        Ok(Self { arc })
    }

    /// The point at `s` in [0, 1].
    ///
    /// Base frame, m; evenly along the arc.
    pub fn at(&self, s: f64) -> Vector3<f64> {
        self.arc.point(s).coords
    }

    /// Length, m.
    pub fn length(&self) -> f64 {
        self.arc.length()
    }

    /// Angle, rad.
    pub fn angle(&self) -> f64 {
        self.arc.angle
    }
}
