//! What ends a run early: ground, obstacles, walls, turning over; and the note that the world was left.
//!
//! Looked at every 10 ms: chords between looks, not points, are held against obstacles. What the run is judged by is
//! the judge's; this only ends it.

use nalgebra::{Point3, Vector3};

use super::close_loop::FlySettings;
use crate::trajectory::Ended;
use crate::world::World;

/// Below this height the ground counts only for a robot that has been above it, m.
const AIRBORNE: f64 = 0.3;
/// Body z downwards for longer than this is a tumble, s.
const TUMBLE_TIME: f64 = 0.5;
/// Farther than this from the origin nothing is simulated any more, m.
const FARTHEST: f64 = 1e5;

/// Whether a robot at `position` with its body z axis `up` is where nothing is simulated any more.
///
/// Beyond 100 km, or no number.
pub(crate) fn is_lost(position: &Vector3<f64>, up: f64) -> bool {
    !(position.norm_squared() < FARTHEST * FARTHEST && up.is_finite())
}

/// Watches one run.
#[derive(Debug, Clone)]
pub(crate) struct Hazards {
    clearance: f64,
    walls: bool,
    obstacles: bool,
    airborne: bool,
    before: Point3<f64>,
    /// No obstacle comes within the clearance of any point in this ball.
    safe: Option<(Point3<f64>, f64)>,
    upside_down_since: Option<f64>,
    left_world: Option<f64>,
}

impl Hazards {
    /// Starts at `start`; obstacles are kept off by `clearance` m, and `settings` say what is a crash.
    pub(crate) fn new(clearance: f64, settings: &FlySettings, start: &Vector3<f64>) -> Self {
        Self {
            clearance,
            walls: settings.walls,
            obstacles: settings.obstacles,
            airborne: false,
            before: Point3::from(*start),
            safe: None,
            upside_down_since: None,
            left_world: None,
        }
    }

    /// Whether the run in `world` ends at `t` with the robot at `position`, its body z axis `up` in the world's z.
    ///
    /// Obstacles are tested with the chord from the position noted before, and only once the robot has left the ball
    /// around an earlier position that is known to be clear, so nothing between two notes is missed but the bulge of
    /// the path over its chord (below 1 mm at 10 ms and 8 g). A world is left through its sides and its ceiling.
    pub(crate) fn note(&mut self, world: &World, t: f64, position: &Vector3<f64>, up: f64) -> Option<Ended> {
        if is_lost(position, up) {
            return Some(Ended::Tumble);
        }
        let p = Point3::from(*position);
        let outside = world.wall_distance(&Point3::new(p.x, p.y, p.z.max(0.0))) < 0.0;
        if outside && self.left_world.is_none() {
            self.left_world = Some(t);
        }
        if self.hits_obstacle(world, &p) {
            return Some(Ended::Obstacle);
        }
        self.airborne |= p.z > AIRBORNE;
        // A take-off may dip: only a fall of as much as it should have climbed is a crash then.
        if p.z < if self.airborne { 0.0 } else { -AIRBORNE } {
            return Some(Ended::Ground);
        }
        if outside && self.walls {
            return Some(Ended::Wall);
        }
        if up >= 0.0 {
            self.upside_down_since = None;
        } else if t - *self.upside_down_since.get_or_insert(t) > TUMBLE_TIME {
            return Some(Ended::Tumble);
        }
        None
    }

    /// The ball about `p` has the radius d(p) − clearance, as distance is 1-Lipschitz: most looks cost two
    /// subtractions.
    fn hits_obstacle(&mut self, world: &World, p: &Point3<f64>) -> bool {
        let before = std::mem::replace(&mut self.before, *p);
        if !self.obstacles || world.obstacles().is_empty() {
            return false;
        }
        // The chord lies in the ball if both of its ends do.
        let clear = |(centre, radius): (Point3<f64>, f64), q: &Point3<f64>| (q - centre).norm() < radius;
        if self.safe.is_some_and(|ball| clear(ball, p) && clear(ball, &before)) {
            return false;
        }
        self.safe = Some((*p, world.obstacle_distance(p) - self.clearance));
        world.segment_distance(&before, p) <= self.clearance
    }

    /// First time outside the world, s.
    pub(crate) fn left_world(&self) -> Option<f64> {
        self.left_world
    }
}
