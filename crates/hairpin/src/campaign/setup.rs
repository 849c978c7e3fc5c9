//! From a scenario's numbers to the things they describe. Robots are chosen by the one `match` here.

use nalgebra::Vector3;

use super::scenario::{Mistake, ObstacleSection, RobotSource, Scenario, WorldSection};
use crate::math::simd::Simd;
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
    /// Version of the kernels that generate and fly.
    pub simd: Simd,
}

impl Setup {
    /// Builds robot and world of a resolved scenario, and checks every key that has a bound.
    ///
    /// # Errors
    /// The first key whose value is out of bounds.
    pub fn new(scenario: Scenario) -> Result<Self, Mistake> {
        if let Some(mistake) = scenario.check().into_iter().next() {
            return Err(mistake);
        }
        Self::build(scenario, Simd::default())
    }

    /// The same at another version of the kernels.
    pub fn with_simd(self, simd: Simd) -> Self {
        Self { simd, ..self }
    }

    /// The setup of `scenario`, whose keys were checked before `[vary]` drew some of them; the kernels stay these.
    pub(super) fn of_draw(&self, scenario: Scenario) -> Result<Self, Mistake> {
        Self::build(scenario, self.simd)
    }

    fn build(scenario: Scenario, simd: Simd) -> Result<Self, Mistake> {
        let robot = robot_of(&scenario.robot)?;
        let world = world_of(&scenario.world)?;
        Ok(Self { scenario, robot, world, simd })
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
    match obstacle {
        ObstacleSection { cuboid: Some(b), .. } => Shape::cuboid(b.center_m, b.size_m),
        ObstacleSection { sphere: Some(s), .. } => Shape::sphere(s.center_m, s.radius_m),
        ObstacleSection { capsule: Some(c), .. } => Shape::capsule(c.a_m, c.b_m, c.radius_m),
        ObstacleSection { hull: Some(h), .. } => Shape::hull(&h.points_m),
        ObstacleSection { mesh: Some(m), .. } => Shape::mesh(&m.vertices_m, &m.triangles),
        _ => Err(WorldError {
            field: "shape".into(),
            value: "missing".into(),
            bound: "one of box, sphere, capsule, hull, mesh".into(),
        }),
    }
}
