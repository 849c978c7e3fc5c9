//! From a path through the cloud to the program that an arm runs, and from a program to what the virtual controller is
//! told.

use nalgebra::Isometry3;

use super::ArmSetup;
use crate::campaign::CaseNumber;
use crate::campaign::scenario::MoveName;
use crate::math::random::{named_seed, stream, unit};
use crate::robot::arm::Configuration;
use crate::simulation::SimulationError;
use crate::simulation::arm::Order;
use crate::trajectory::program::{
    JointTarget, Motion, Move, NO_EXTERNAL, PoseTarget, Program, Speed, Tool, WorkObject, Zone,
};

/// A way through the cloud.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Way {
    /// Rows of the cloud, in order.
    pub(super) rows: Vec<usize>,
    /// Configuration at each of them; `None` in Cartesian mode, which knows no joints.
    pub(super) configurations: Vec<Option<Configuration>>,
    /// Places of points that arcs pass instead of two straight moves, no two beside each other.
    pub(super) arcs: Vec<usize>,
}

/// Name of the home posture in programs.
const HOME: &str = "pHome";

impl ArmSetup {
    /// Name of the point of row `row`: digits enough that names sort like rows.
    pub fn point_name(&self, row: usize) -> String {
        let digits = self.station.points.len().saturating_sub(1).to_string().len().max(2);
        format!("p{row:0digits$}")
    }

    /// Tool and work object of programs.
    pub(super) fn frames(&self) -> (Tool, WorkObject) {
        self.scenario.in_programs(&self.station.tool, &self.station.work_object)
    }

    /// The posture that programs start and end at.
    pub(super) fn home(&self) -> JointTarget {
        JointTarget { name: Some(HOME.into()), joints: self.station.home, external: NO_EXTERNAL }
    }

    /// The point of row `row` in the work object.
    pub(super) fn target(
        &self,
        object_from_base: &Isometry3<f64>,
        row: usize,
        configuration: Option<Configuration>,
    ) -> PoseTarget {
        PoseTarget {
            configuration: configuration.map(|configuration| configuration.numbers()),
            ..PoseTarget::unnamed(object_from_base * self.station.points[row].pose).named(&self.point_name(row))
        }
    }

    /// The program along `way`: home, joints to the first point, on through the others, home. Speeds and zones are
    /// drawn from the scenario's lists; `blends(k)` says whether the corner at the way's k-th point may be cut by a
    /// zone (m).
    pub(super) fn program(&self, way: &Way, number: usize, blends: impl Fn(usize, f64) -> bool) -> Program {
        let (tool, object) = self.frames();
        let object_from_base = object.base_from_object().inverse();
        let procedure = &self.scenario.generate.moves.procedure;
        let mut program = Program::new(&format!("hairpin_{}", CaseNumber(number)), procedure, tool, object);
        let moves = &self.scenario.generate.moves;
        let mut random = stream(named_seed(self.scenario.seed, "moves", number as u64));
        let mut pick = |names: &[String]| names[(unit(&mut random) * names.len() as f64) as usize].clone();
        let home = || Move::new(Motion::AbsoluteJoint(self.home()), slow(), Zone::stop());
        program.moves.push(home());
        let passed = |k: usize| way.arcs.contains(&k);
        for (k, (row, configuration)) in way.rows.iter().zip(&way.configurations).enumerate() {
            let target = self.target(&object_from_base, *row, *configuration);
            let (speed, zone) = (pick(&moves.speeds), pick(&moves.zones));
            let speed = Speed::predefined(&speed).unwrap_or_else(slow);
            if passed(k) {
                continue;
            }
            // Blends beside an arc lie in no triangle that is proven.
            let straight = k > 0 && k + 1 < way.rows.len() && !passed(k - 1) && !passed(k + 1);
            let zone = Zone::predefined(&zone).filter(|zone| straight && !zone.fine && blends(k, zone.tcp));
            let motion = match moves.kind {
                MoveName::Linear if k > 0 && passed(k - 1) => Motion::Circular {
                    via: self.target(&object_from_base, way.rows[k - 1], way.configurations[k - 1]),
                    to: target,
                },
                MoveName::Linear if k > 0 => Motion::Linear(target),
                MoveName::Linear | MoveName::Joint => Motion::Joint(target),
            };
            program.moves.push(Move::new(motion, speed, zone.unwrap_or_else(Zone::stop)));
        }
        program.moves.push(home());
        program
    }

    /// What the virtual controller is told of `program`: its moves after the first, which starts at home, in base
    /// coordinates.
    ///
    /// # Errors
    /// As [`Order::all_of`].
    pub(super) fn orders(&self, program: &Program) -> Result<Vec<Order>, SimulationError> {
        Ok(Order::all_of(program)?.split_off(program.moves.len().min(1)))
    }
}

/// Moves from and to home.
fn slow() -> Speed {
    Speed::predefined("v200").unwrap_or(Speed {
        name: None,
        tcp: 0.2,
        orientation: 1.0,
        linear_external: 0.0,
        rotating_external: 0.0,
    })
}
