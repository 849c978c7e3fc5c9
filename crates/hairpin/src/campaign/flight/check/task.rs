//! Bounds of `[task]`: it must be possible to stand at both ends.

use nalgebra::Point3;

use crate::campaign::bounds::MOST_WAYPOINTS;
use crate::campaign::check::Findings;
use crate::campaign::scenario::TaskSection;
use crate::robot::quadrotor::Quadrotor;
use crate::world::World;

/// Without world or robot, which are wrong themselves then, what depends on them is not told.
pub(super) fn check(task: &TaskSection, world: Option<&World>, robot: Option<&Quadrotor>, found: &mut Findings) {
    found.count("task.length", task.length, 2, MOST_WAYPOINTS as u64);
    for (key, p) in [("task.start_m", task.start_m), ("task.end_m", task.end_m)] {
        if let Some(at) = p.iter().position(|x| !x.is_finite()) {
            found.require(false, &format!("{key}[{at}]"), p[at], "finite");
        } else if let Some(world) = world {
            check_end(key, p, world, robot, found);
        }
    }
}

/// Within the walls by the keep-in margin, and the robot's radius from every obstacle; signed distances, m. Outside the
/// walls nothing is said of obstacles.
///
/// One mistake for walls, with the first axis that is off; one for every obstacle that is too near.
fn check_end(key: &str, p: [f64; 3], world: &World, robot: Option<&Quadrotor>, found: &mut Findings) {
    let margin = world.keep_in_margin();
    for (axis, &x) in p.iter().enumerate() {
        let (least, most) = (margin, world.size()[axis] - margin);
        if !(x >= least && x <= most) {
            let why = if margin > 0.0 { " (keep_in_margin_m)" } else { "" };
            let bound = format!("inside the world: {least} … {most} m{why}");
            found.require(false, &format!("{key}[{axis}]"), x, &bound);
            return;
        }
    }
    let point = Point3::from(p);
    let clearance = robot.map_or(0.0, |robot| robot.clearance_radius);
    for obstacle in world.obstacles() {
        let distance = obstacle.shape.signed_distance(&point);
        if distance < clearance {
            let name = &obstacle.name;
            let bound = if distance < 0.0 {
                format!("outside obstacle `{name}`; it is {:.2} m inside", -distance)
            } else {
                format!(
                    "at least {clearance} m, the robot's radius, from obstacle `{name}`; it is {distance:.2} m away"
                )
            };
            found.require(false, key, format!("{p:?}"), &bound);
        }
    }
}
