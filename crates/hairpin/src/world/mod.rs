//! Floor 2: the space that robots move in: a volume, obstacles, and where points may lie. No robots here.
//!
//! World frame: metres, z up, origin at a floor corner of the volume, axes along its edges.

pub mod obstacle;

use nalgebra::{Point3, Vector3};
use thiserror::Error;

pub use obstacle::{Obstacle, Shape};

/// A box-shaped volume [0, size] with obstacles in it.
#[derive(Debug, Clone)]
pub struct World {
    size: Vector3<f64>,
    keep_in_margin: f64,
    obstacles: Vec<Obstacle>,
}

/// Why numbers make no world. `field` is the key below `[world]`.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{field} = {value}: must be {bound}")]
pub struct WorldError {
    /// Key below `world`, such as `obstacles[2].box.size_m`.
    pub field: String,
    /// The offending value as it was given.
    pub value: String,
    /// What it must be.
    pub bound: String,
}

impl World {
    /// Checks and builds a world of `size` (m, > 0 and finite) whose points stay `keep_in_margin` (m, ≥ 0) inside.
    ///
    /// # Errors
    /// Sizes that are not positive and finite; a margin that leaves no volume.
    pub fn new(size: Vector3<f64>, keep_in_margin: f64, obstacles: Vec<Obstacle>) -> Result<Self, WorldError> {
        let refuse = |field: &str, value: String, bound: String| Err(WorldError { field: field.into(), value, bound });
        if !size.iter().all(|s| s.is_finite() && *s > 0.0) {
            return refuse("size_m", format!("{:?}", size.as_slice()), "three finite numbers > 0".into());
        }
        let most = 0.5 * size.min();
        if !(keep_in_margin >= 0.0 && keep_in_margin < most) {
            return refuse(
                "keep_in_margin_m",
                format!("{keep_in_margin}"),
                format!("≥ 0 and < {most}, half the smallest side"),
            );
        }
        Ok(Self { size, keep_in_margin, obstacles })
    }

    /// Edge lengths, m.
    pub fn size(&self) -> Vector3<f64> {
        self.size
    }

    /// How far inside the walls points and predicted paths stay, m.
    pub fn keep_in_margin(&self) -> f64 {
        self.keep_in_margin
    }

    /// The obstacles.
    pub fn obstacles(&self) -> &[Obstacle] {
        &self.obstacles
    }

    /// Distance of `p` to the nearest wall of the volume, m; negative outside.
    pub fn wall_distance(&self, p: &Point3<f64>) -> f64 {
        (0..3).map(|i| p[i].min(self.size[i] - p[i])).fold(f64::INFINITY, f64::min)
    }

    /// Distance of `p` to the nearest obstacle, m; negative inside one, +∞ without obstacles.
    pub fn obstacle_distance(&self, p: &Point3<f64>) -> f64 {
        self.obstacles.iter().map(|obstacle| obstacle.shape.signed_distance(p)).fold(f64::INFINITY, f64::min)
    }

    /// Smallest distance between the segment `a`–`b` and any obstacle, m; ≤ 0 if it meets one, +∞ without obstacles.
    pub fn segment_distance(&self, a: &Point3<f64>, b: &Point3<f64>) -> f64 {
        self.obstacles.iter().map(|obstacle| obstacle.shape.segment_distance(a, b)).fold(f64::INFINITY, f64::min)
    }

    /// Whether `p` lies at least the keep-in margin inside the walls and at least `clearance` from every obstacle.
    pub fn is_free(&self, p: &Point3<f64>, clearance: f64) -> bool {
        self.wall_distance(p) >= self.keep_in_margin && self.obstacle_distance(p) >= clearance
    }
}
