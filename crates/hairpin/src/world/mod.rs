//! Floor 2: the space that robots move in: a volume, obstacles, and where points may lie. No robots here.
//!
//! World frame: metres, z up, origin at a floor corner of the volume, axes along its edges.
//!
//! Three kinds of surroundings, one for each family of robots, none of which knows a robot; what a body needs of room
//! comes in as a clearance in m:
//!
//! | for | type | frame |
//! | --- | --- | --- |
//! | flights | [`World`]: a box [0, size] with [`Obstacle`]s | x, y along the floor's edges, z up |
//! | drives | [`terrain::Terrain`] and [`terrain::KeepOuts`] | x east, y north, z up; the map's own origin |
//! | arms | [`cell::Cell`]: regions not to be entered | the arm's base |
//!
//! Data flow: plain numbers of a file → checked here, where they become a type → asked for distances and heights by
//! reach sets, limits, plants and the judge alike, so that the claim and the act meet the same obstacle.
//! [`sample_free`] draws the waypoints of a graph.
//!
//! Distances are signed: positive outside, 0 on the border, negative inside, and larger is safer everywhere. A solid
//! counts with its border.

pub mod bounds;
pub mod cell;
mod closed;
mod error;
pub mod obstacle;
pub mod sample;
pub mod solid;
pub mod terrain;

#[cfg(feature = "unit-tests")]
mod tests;

use nalgebra::{Point3, Vector3};

pub use bounds::Bounds;
pub use error::WorldError;
pub use obstacle::{Obstacle, Shape};
pub(crate) use sample::short_way;
pub use sample::{Sampling, SamplingError, sample_free};
pub use solid::Solid;

/// A box-shaped volume [0, size] with obstacles in it.
///
/// Immutable once built; every query is a pure function. Obstacles are held with their boxes, whose distance never
/// exceeds the solid's: a query costs one box for each obstacle and one closed form for each of the few that are near.
/// Obstacles may overlap and may reach out of the volume.
///
/// ```
/// use hairpin::world::{Obstacle, Sampling, Shape, World, sample_free};
/// use nalgebra::{Point3, Vector3};
///
/// let pillar = Obstacle { name: "pillar".into(), shape: Shape::capsule([5.0, 5.0, 0.0], [5.0, 5.0, 4.0], 0.5)? };
/// let cage = World::new(Vector3::new(10.0, 10.0, 4.0), 0.2, vec![pillar])?;
/// assert_eq!(cage.obstacle_distance(&Point3::new(5.0, 7.0, 2.0)), 1.5);
/// let (west, east) = (Point3::new(1.0, 5.0, 2.0), Point3::new(9.0, 5.0, 2.0));
/// assert!(cage.segment_distance(&west, &east) < 0.0); // straight through
///
/// let points = sample_free(&cage, 20, 0.3, Sampling::Uniform, 7)?;
/// assert!(points.iter().all(|p| cage.is_free(p, 0.3)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct World {
    size: Vector3<f64>,
    keep_in_margin: f64,
    obstacles: Vec<Obstacle>,
    bounds: Vec<Bounds>,
}

impl World {
    /// Checks and builds a world of `size` (m, > 0 and finite) whose points stay `keep_in_margin` (m, ≥ 0) inside.
    ///
    /// # Errors
    /// Sizes that are not positive and finite; a margin that leaves no volume; an obstacle whose numbers are no solid.
    pub fn new(size: Vector3<f64>, keep_in_margin: f64, obstacles: Vec<Obstacle>) -> Result<Self, WorldError> {
        if !size.iter().all(|s| s.is_finite() && *s > 0.0) {
            return Err(WorldError::new("size_m", format!("{:?}", size.as_slice()), "three finite numbers > 0"));
        }
        let most = 0.5 * size.min();
        if !(keep_in_margin >= 0.0 && keep_in_margin < most) {
            let bound = format!("≥ 0 and < {most}, half the smallest side");
            return Err(WorldError::new("keep_in_margin_m", format!("{keep_in_margin}"), bound));
        }
        for (index, obstacle) in obstacles.iter().enumerate() {
            obstacle.shape.clone().checked().map_err(|error| error.within(&format!("obstacles[{index}]")))?;
        }
        let bounds = obstacles.iter().map(|obstacle| obstacle.shape.bounds()).collect();
        Ok(Self { size, keep_in_margin, obstacles, bounds })
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
        self.nearest_obstacle(p).map_or(f64::INFINITY, |(_, distance)| distance)
    }

    /// Index of the obstacle nearest to `p` and the signed distance to it, m; the first of equals.
    ///
    /// Linear in the number of obstacles, most of which cost a box. Inside several the one whose surface is farthest is
    /// the nearest: the least signed distance counts.
    pub fn nearest_obstacle(&self, p: &Point3<f64>) -> Option<(usize, f64)> {
        self.least(|bounds| bounds.distance(p), |shape| shape.signed_distance(p))
    }

    /// Smallest distance between the segment `a`–`b` and any obstacle, m; ≤ 0 if it meets one, +∞ without obstacles.
    ///
    /// The bounds of the shapes hold: exact for balls, boxes and capsules; where a hull or mesh is met an upper bound
    /// of the (negative) signed distance.
    pub fn segment_distance(&self, a: &Point3<f64>, b: &Point3<f64>) -> f64 {
        let segment = Bounds { min: a.inf(b), max: a.sup(b) };
        self.least(|bounds| bounds.distance_to(&segment), |shape| shape.segment_distance(a, b))
            .map_or(f64::INFINITY, |(_, distance)| distance)
    }

    /// Whether `p` lies at least the keep-in margin inside the walls and at least `clearance` from every obstacle.
    ///
    /// `clearance` ≥ 0 is the radius of a ball around the robot; a point of the surface is free at clearance 0, a point
    /// inside never.
    pub fn is_free(&self, p: &Point3<f64>, clearance: f64) -> bool {
        self.wall_distance(p) >= self.keep_in_margin
            && self.bounds.iter().zip(&self.obstacles).all(|(bounds, obstacle)| {
                // The box's distance never exceeds the solid's, so most obstacles are dismissed by it.
                bounds.distance(p) >= clearance.max(f64::MIN_POSITIVE) || obstacle.shape.signed_distance(p) >= clearance
            })
    }

    /// The obstacle of least `distance`; those whose box is already farther than the best are not asked.
    fn least(&self, bound: impl Fn(&Bounds) -> f64, distance: impl Fn(&Shape) -> f64) -> Option<(usize, f64)> {
        let mut best: Option<(usize, f64)> = None;
        for (index, (bounds, obstacle)) in self.bounds.iter().zip(&self.obstacles).enumerate() {
            if best.is_some_and(|(_, least)| bound(bounds) > least.max(0.0)) {
                continue;
            }
            let found = distance(&obstacle.shape);
            if best.is_none_or(|(_, least)| found < least) {
                best = Some((index, found));
            }
        }
        best
    }
}
