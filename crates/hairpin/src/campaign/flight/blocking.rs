//! Which obstacle is in the way.

use nalgebra::Point3;

use crate::campaign::graph::Stage;
use crate::world::World;

/// The name of obstacle number `index`.
pub(super) fn obstacle(world: &World, index: usize) -> String {
    world.obstacles().get(index).map_or_else(|| "an obstacle".into(), |obstacle| obstacle.name.clone())
}

/// The first obstacle that a robot of this `radius` (m) does not pass on the way from `a` to `b`.
///
/// In the order of the world's list, not by distance; `None`: the way is clear. O(obstacles), each a distance from
/// segment to solid.
pub(super) fn blocking(world: &World, radius: f64, a: &Point3<f64>, b: &Point3<f64>) -> Option<(Stage, String)> {
    let blocked = |index: &usize| world.obstacles()[*index].shape.segment_distance(a, b) < radius;
    let index = (0..world.obstacles().len()).find(blocked)?;
    Some((Stage::Obstacle, obstacle(world, index)))
}
