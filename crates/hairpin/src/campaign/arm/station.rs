//! What a scenario of an arm describes: the arm with its tool, the cell around it, and the points of the cloud.

use std::sync::{Arc, OnceLock};

use nalgebra::{Isometry3, Vector3};

use super::arm_graph::ArmGraph;
use super::points::{CellPoint, count};
use crate::campaign::attachments::Attachments;
use crate::campaign::kind::Kind;
use crate::campaign::own_controller::AnyController;
use crate::campaign::scenario::ArmScenario;
use crate::math::simd::Simd;
use crate::robot::arm::{Arm, Joints, Tool, WorkObject};
use crate::simulation::OwnController;
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
    /// Its parts' numbers are those that refusals tell.
    pub cell: Cell,
    /// The cloud.
    /// Programs' rows count in it, from 0.
    pub points: Vec<CellPoint>,
    /// Where programs start and end, rad.
    pub home: Joints,
}

/// A scenario of an arm and what it describes.
#[derive(Debug, Clone)]
pub struct ArmSetup {
    /// Every key.
    pub scenario: Arc<ArmScenario>,
    /// What its files hold.
    pub attachments: Arc<Attachments>,
    /// Arm, cell and points.
    pub station: Arc<Station>,
    /// Version of the kernels.
    pub simd: Simd,
    /// Who gives the servos their set points, where that is a controller of the caller's.
    pub(super) controller: Option<OwnController<Arm>>,
    /// Its graph, once it was asked for: search, random programs and proof have the same.
    pub(super) graph: Arc<OnceLock<Result<Arc<ArmGraph>, String>>>,
}

impl ArmSetup {
    /// How many points the scenario asks for: where none of those to be drawn fits there are fewer.
    ///
    /// 0 where they are in a file that was not read.
    pub fn asked_points(&self) -> u64 {
        count(&self.scenario.task, &self.attachments)
    }
}

impl Kind for ArmSetup {
    fn with(&self, simd: Simd, controller: Option<&AnyController>) -> Option<Arc<dyn Kind>> {
        let controller = match controller {
            Some(own) => Some(own.of::<Arm>()?),
            None => None,
        };
        // What other kernels make is compared with it.
        let graph = if simd == self.simd { self.graph.clone() } else { Arc::default() };
        Some(Arc::new(Self { simd, controller, graph, ..self.clone() }))
    }
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
    ///
    /// That part comes last, so that the others keep their numbers; it is none of the scenario's, and what meets it is
    /// told as out of reach.
    pub(super) fn cell_within_reach(&self) -> Cell {
        let (center, radius) = self.reach();
        let mut cell = self.cell.clone();
        cell.parts.push(Part { name: "reach".into(), region: Region::Beyond { center: center.into(), radius } });
        cell
    }

    /// A ball (centre and radius, m) that holds every place the tool's point can be at: around the foot of the second
    /// joint on the first axis, as far as all lengths after it add up to, and what the first joint carries it around.
    ///
    /// ```text
    /// radius = r₂ + Σ_{k=3…6} |origin_k| + |flange| + |tcp|,   r₂ how far the second joint is from the first axis
    /// ```
    ///
    /// Lengths add up as if the arm were straight: larger than what the arm reaches, and never smaller.
    pub(super) fn reach(&self) -> (Vector3<f64>, f64) {
        let chain = &self.arm.chain;
        let (centre, around) = chain.shoulder();
        let links: f64 = chain.joints[2..].iter().map(|joint| joint.origin.translation.vector.norm()).sum();
        let last = chain.flange.translation.vector.norm() + self.tool.tcp.translation.vector.norm();
        (centre.coords, around + links + last)
    }
}
