//! What a scenario of an arm describes: the arm with its tool, the cell around it, and the points of the cloud.

use nalgebra::{Isometry3, Vector3};

use super::cell::cell_of;
use super::frame::{frame_of, mistake};
use super::graph::stands;
use super::points::{CellPoint, points_of};
use crate::campaign::scenario::{ArmScenario, Mistake};
use crate::robot::arm::{Arm, Joints, Tool, WorkObject};
use crate::world::cell::{Cell, Part, Region};

/// An arm in its cell.
#[derive(Debug, Clone)]
pub struct Station {
    /// The arm.
    pub arm: Arm,
    /// What its flange carries.
    pub tool: Tool,
    /// What programs are given in.
    pub work_object: WorkObject,
    /// What is in the way, base frame.
    pub cell: Cell,
    /// The cloud.
    pub points: Vec<CellPoint>,
    /// Where programs start and end, rad.
    pub home: Joints,
}

/// A scenario of an arm and what it describes.
#[derive(Debug, Clone, Copy)]
pub struct ArmSetup<'a> {
    /// Every key.
    pub scenario: &'a ArmScenario,
    /// Arm, cell and points.
    pub station: &'a Station,
    /// Version of the kernels.
    pub simd: crate::math::simd::Simd,
}

/// Builds what a resolved scenario describes.
///
/// # Errors
/// The key whose value makes no arm, tool, work object, obstacle or point.
pub(in crate::campaign) fn station_of(scenario: &ArmScenario) -> Result<Station, Mistake> {
    let arm = scenario.robot.resolved()?.build().map_err(|error| mistake("robot", error))?;
    let tool = &scenario.world.tool;
    let tool = Tool::new(&tool.name, tool.tcp_mm, tool.q1_q4, tool.radius_mm, tool.mass_kg, tool.cog_mm)
        .map_err(|error| mistake("world.tool", error))?;
    let object = &scenario.world.wobj;
    let object =
        WorkObject::new(&object.name, (object.uframe_mm, object.uframe_q1_q4), (object.oframe_mm, object.oframe_q1_q4))
            .map_err(|error| mistake("world.wobj", error))?;
    // User frames stand in the world; the arm's programs are in its base.
    let world_from_base = frame_of("world.base_frame", &scenario.world.base_frame)?;
    let work_object = WorkObject { user: world_from_base.inverse() * object.user, ..object };
    let cell = cell_of(&scenario.world)?;
    let home = scenario.task.home_deg.map(f64::to_radians);
    if let Some((axis, _)) = arm.outside_limits(&home) {
        let limit = &arm.limits[axis];
        return Err(Mistake {
            key: format!("task.home_deg[{axis}]"),
            value: scenario.task.home_deg[axis].to_string(),
            bound: format!(
                "within axis {}'s bounds, {:.1} … {:.1}°",
                axis + 1,
                limit.lower.to_degrees(),
                limit.upper.to_degrees()
            ),
        });
    }
    let mut station = Station { arm, tool, work_object, cell, points: Vec::new(), home };
    let reach = station.reach();
    station.points = points_of(scenario, &station.work_object, reach, |pose| stands(&station, scenario, pose))?;
    Ok(station)
}

impl Station {
    /// `flange_from_tcp⁻¹`: the flange of a tool's pose.
    pub(super) fn flange(&self, tcp: &Isometry3<f64>) -> Isometry3<f64> {
        tcp * self.tool.tcp.inverse()
    }

    /// `base_from_tcp` at joint angles, rad.
    pub(super) fn tool_at(&self, joints: &Joints) -> Isometry3<f64> {
        self.arm.forward(joints) * self.tool.tcp
    }

    /// The cell and the sphere that the tool's point must stay in.
    pub(super) fn cell_within_reach(&self) -> Cell {
        let (center, radius) = self.reach();
        let mut cell = self.cell.clone();
        cell.parts.push(Part { name: "reach".into(), region: Region::Beyond { center: center.into(), radius } });
        cell
    }

    /// A ball (centre and radius, m) that holds every place the tool's point can be at: around the second joint at
    /// rest, as far as all lengths after it add up to, and what the first joint carries it around.
    fn reach(&self) -> (Vector3<f64>, f64) {
        let chain = &self.arm.chain;
        let shoulder = (chain.joints[0].origin * chain.joints[1].origin).translation.vector;
        let links: f64 = chain.joints[2..].iter().map(|joint| joint.origin.translation.vector.norm()).sum();
        let last = chain.flange.translation.vector.norm() + self.tool.tcp.translation.vector.norm();
        (Vector3::new(0.0, 0.0, shoulder.z), libm::hypot(shoulder.x, shoulder.y) + links + last)
    }
}
