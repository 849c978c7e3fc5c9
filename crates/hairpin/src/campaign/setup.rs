//! From a scenario's numbers to the things they describe. Robots are chosen by the one `match` here.

use nalgebra::{Point3, Vector3};

use super::scenario::{Mistake, ObstacleSection, RobotSource, Scenario, WorldSection};
use crate::robot::quadrotor::Quadrotor;
use crate::world::{Obstacle, Shape, World, WorldError};

/// A resolved scenario and what it describes.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Every key, the robot's table inline.
    pub scenario: Scenario,
    /// The robot of the claim.
    pub robot: Quadrotor,
    /// The space.
    pub world: World,
}

impl Setup {
    /// Builds robot and world of a resolved scenario, and checks every key that has a bound.
    ///
    /// # Errors
    /// The first key whose value is out of bounds.
    pub fn new(scenario: Scenario) -> Result<Self, Mistake> {
        let robot = robot_of(&scenario.robot)?;
        let world = world_of(&scenario.world)?;
        Ok(Self { scenario, robot, world })
    }
}

/// The robot of a resolved source.
///
/// # Errors
/// The robot's key that is out of bounds; a name that was not resolved before.
pub fn robot_of(source: &RobotSource) -> Result<Quadrotor, Mistake> {
    match source {
        RobotSource::Inline(description) => description.build().map_err(|error| Mistake {
            key: format!("robot.{}", error.field),
            value: error.value,
            bound: error.bound,
        }),
        RobotSource::Name(name) => Err(Mistake {
            key: "robot".into(),
            value: format!("\"{name}\""),
            bound: "resolved to its numbers first".into(),
        }),
    }
}

/// The world of a resolved section.
///
/// # Errors
/// The world's key that is out of bounds.
pub fn world_of(section: &WorldSection) -> Result<World, Mistake> {
    let mut obstacles = Vec::with_capacity(section.obstacles.len());
    for (index, obstacle) in section.obstacles.iter().enumerate() {
        let shape = shape_of(obstacle).map_err(|error| mistake(&format!("obstacles[{index}]."), error))?;
        let name = if obstacle.name.is_empty() { format!("obstacle {index}") } else { obstacle.name.clone() };
        obstacles.push(Obstacle { name, shape });
    }
    let Some(size) = section.size_m else {
        return Err(Mistake { key: "world.size_m".into(), value: "missing".into(), bound: "given".into() });
    };
    World::new(Vector3::from(size), section.keep_in_margin_m.unwrap_or(0.0), obstacles).map_err(|e| mistake("", e))
}

fn mistake(prefix: &str, error: WorldError) -> Mistake {
    Mistake { key: format!("world.{prefix}{}", error.field), value: error.value, bound: error.bound }
}

fn shape_of(obstacle: &ObstacleSection) -> Result<Shape, WorldError> {
    let given = [
        obstacle
            .cuboid
            .map(|b| Shape::Box { center: Point3::from(b.center_m), half_extents: Vector3::from(b.size_m) * 0.5 }),
        obstacle.sphere.map(|s| Shape::Sphere { center: Point3::from(s.center_m), radius: s.radius_m }),
        obstacle.capsule.map(|c| Shape::Capsule { a: Point3::from(c.a_m), b: Point3::from(c.b_m), radius: c.radius_m }),
    ];
    let mut shapes = given.into_iter().flatten();
    shapes.next().ok_or_else(|| WorldError {
        field: "shape".into(),
        value: "missing".into(),
        bound: "one of box, sphere, capsule, hull, mesh".into(),
    })
}
