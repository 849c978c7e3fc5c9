//! From a flight scenario's numbers to the robot and the space they describe.

use std::sync::Arc;

use nalgebra::{Point3, Vector3};

use crate::campaign::attachments::Attachments;
use crate::campaign::digits::number;
use crate::campaign::kind::Kind;
use crate::campaign::own_controller::AnyController;
use crate::campaign::scenario::{
    DeviationFrom, FlightScenario, Keys, Mistake, ObstacleSection, RobotSource, WorldSection,
};
use crate::math::simd::Simd;
use crate::robot::quadrotor::{Quadrotor, QuadrotorDescription};
use crate::simulation::{ControllerKind, OwnController};
use crate::world::{Bounds, Obstacle, Shape, World, WorldError};

/// A resolved scenario of flights and what it describes.
///
/// What [`Setup::own`](crate::campaign::setup::Setup::own) gives for quadrotors. Immutable; draws share what they
/// leave as it is.
#[derive(Debug, Clone)]
pub struct FlightSetup {
    /// Every key, the robot's table inline.
    pub scenario: Arc<FlightScenario>,
    /// What its files hold.
    pub attachments: Arc<Attachments>,
    /// The robot of the claim.
    /// With derived numbers filled in; which ones are is in its `estimated`.
    pub robot: Arc<Quadrotor>,
    /// The space.
    /// Without its air: wind and gusts are keys of the scenario, as they are the plant's.
    pub world: Arc<World>,
    /// A controller of the caller's own in the place of the scenario's.
    pub controller: Option<OwnController<Quadrotor>>,
    /// Version of the kernels that generate and fly.
    /// Results are the same at each.
    pub simd: Simd,
}

impl FlightSetup {
    /// The robot of `keys`: that of `known`, if it is described alike.
    ///
    /// # Errors
    /// As [`robot_of`].
    pub(super) fn robot(keys: &FlightScenario, known: Option<&Self>) -> Result<Arc<Quadrotor>, Mistake> {
        match known {
            Some(known) if known.scenario.robot == keys.robot => Ok(known.robot.clone()),
            _ => robot_of(&keys.robot).map(Arc::new),
        }
    }

    /// Whether who flies, or who judges, reads the velocities and times of a plan, not its waypoints alone.
    ///
    /// Where it is not read, velocities and times of a witness change nothing in execution, and a search does not
    /// vary them.
    pub(super) fn reads_the_plan(&self) -> bool {
        let ours = self.scenario.execute.controller_in_force();
        let reads = self.controller.is_some() || ours.is_none_or(|kind| kind == ControllerKind::Geometric);
        reads || self.scenario.head().terms.from == DeviationFrom::Path
    }

    /// The space of `keys`, likewise.
    ///
    /// # Errors
    /// As [`world_of`].
    pub(super) fn world(keys: &FlightScenario, known: Option<&Self>) -> Result<Arc<World>, Mistake> {
        match known {
            Some(known) if same_space(&known.scenario.world, &keys.world) => Ok(known.world.clone()),
            _ => world_of(&keys.world).map(Arc::new),
        }
    }
}

impl Kind for FlightSetup {
    fn with(&self, simd: Simd, controller: Option<&AnyController>) -> Option<Arc<dyn Kind>> {
        let controller = match controller {
            Some(own) => Some(own.of::<Quadrotor>()?),
            None => None,
        };
        Some(Arc::new(Self { simd, controller, ..self.clone() }))
    }
}

/// Whether two sections describe one space; its air is not part of it.
///
/// Size, margin and obstacles.
///
/// Walls, margin and solids alone: only then may a world, with its trees of obstacles, be shared by draws.
fn same_space(a: &WorldSection, b: &WorldSection) -> bool {
    (a.size_m, a.keep_in_margin_m) == (b.size_m, b.keep_in_margin_m) && a.obstacles == b.obstacles
}

/// The robot of a resolved source.
///
/// # Errors
/// The robot's key that is out of bounds; a name that was not resolved before.
fn robot_of(source: &RobotSource<QuadrotorDescription>) -> Result<Quadrotor, Mistake> {
    source.resolved()?.build().map_err(|error| Mistake {
        key: format!("robot.{}", error.field),
        value: error.value,
        bound: error.bound,
    })
}

/// The world of a resolved section.
///
/// Obstacles without a name are called by their number.
///
/// # Errors
/// The world's key that is out of bounds.
fn world_of(section: &WorldSection) -> Result<World, Mistake> {
    let mut obstacles = Vec::with_capacity(section.obstacles.len());
    for (index, obstacle) in section.obstacles.iter().enumerate() {
        let shape = shape_of(obstacle).map_err(|error| mistake(&format!("obstacles[{index}]."), error))?;
        let name = if obstacle.name.is_empty() { format!("obstacle {index}") } else { obstacle.name.clone() };
        obstacles.push(Obstacle { name, shape });
    }
    let Some(size) = section.size_m else {
        return Err(Mistake { key: "world.size_m".into(), value: "missing".into(), bound: "given".into() });
    };
    let margin = section.keep_in_margin_m.unwrap_or(0.0);
    let world = World::new(Vector3::from(size), margin, obstacles).map_err(|error| mistake("", error))?;
    stands_within(&world)?;
    Ok(world)
}

/// A mesh that is so many times as long as the world is in another unit.
///
/// The longest edge of the mesh's box by the longest edge of the world.
const LONGEST_MESH: f64 = 100.0;

/// A solid outside of the walls stands in nobody's way: nothing is ever measured of it, and all that keeps clear of it
/// would pass.
///
/// # Errors
/// The first obstacle of which no part lies within the walls, or whose mesh is far longer than they are.
fn stands_within(world: &World) -> Result<(), Mistake> {
    let walls = Bounds { min: Point3::origin(), max: world.size().into() };
    for (index, Obstacle { name, shape }) in world.obstacles().iter().enumerate() {
        let (bounds, is_mesh) = (shape.bounds(), matches!(shape, Shape::Mesh(_)));
        let is_huge = is_mesh && (bounds.max - bounds.min).max() > LONGEST_MESH * world.size().max();
        if shape.reaches(&walls) && !is_huge {
            continue;
        }
        let asked = if is_huge { "cut to the world" } else { "at least in part inside the world" };
        let units = if is_mesh { "mm? `scale = 0.001` beside its file" } else { "mm? its keys are in m" };
        return Err(Mistake {
            key: format!("world.obstacles[{index}]"),
            value: format!("`{name}`, {}", extent(&bounds)),
            bound: format!("{asked}, {}, or left out; {units}", extent(&walls)),
        });
    }
    Ok(())
}

/// `x 0.00 … 40.00, y 0.00 … 30.00, z 0.00 … 14.00 m`
///
/// Bounds in m, in the cage's frame.
fn extent(bounds: &Bounds) -> String {
    let side = |axis: usize, name: &str| {
        format!("{name} {} … {}", number(Some(bounds.min[axis])), number(Some(bounds.max[axis])))
    };
    format!("{}, {}, {} m", side(0, "x"), side(1, "y"), side(2, "z"))
}

fn mistake(prefix: &str, error: WorldError) -> Mistake {
    Mistake { key: format!("world.{prefix}{}", error.field), value: error.value, bound: error.bound }
}

/// # Errors
/// No shape at all, or numbers that are none: the shape's own field, value and bound.
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
