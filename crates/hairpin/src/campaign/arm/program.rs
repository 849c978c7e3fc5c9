//! From a path through the cloud to the program that an arm runs, and from a program to what the virtual controller is
//! told.

use nalgebra::Isometry3;

use super::ArmSetup;
use super::graph::configuration;
use crate::campaign::CaseNumber;
use crate::campaign::scenario::MoveName;
use crate::math::random::{Stream, unit};
use crate::robot::arm::Configuration;
use crate::simulation::SimulationError;
use crate::simulation::arm::{Order, Target};
use crate::trajectory::program::{
    JointTarget, Motion, Move, NO_EXTERNAL, PoseTarget, Program, Speed, Tool, WorkObject, Zone,
};

/// A point of a way through the cloud, and how it is met.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Met {
    /// Row of the cloud.
    pub(super) row: usize,
    /// `None` in Cartesian mode, which knows no joints.
    pub(super) configuration: Option<Configuration>,
    /// Of the move that leads to it.
    pub(super) speed: Speed,
    /// How its corner is to be cut, where it may be.
    pub(super) zone: Zone,
    /// Whether an arc passes it, in place of two straight moves; no two such points are beside each other.
    pub(super) passed: bool,
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
    ///
    /// p_object = `object_from_base` · p_base.
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

    /// Speeds and zones of the moves to so many points, drawn from the scenario's lists.
    /// Each pair alike, with repetition.
    pub(super) fn drawn_moves(&self, count: usize, random: &mut Stream) -> Vec<(Speed, Zone)> {
        let moves = &self.scenario.generate.moves;
        let mut pick = |names: &[String]| names[(unit(random) * names.len() as f64) as usize].clone();
        let mut drawn = || {
            let (speed, zone) = (pick(&moves.speeds), pick(&moves.zones));
            (Speed::predefined(&speed).unwrap_or_else(slow), Zone::predefined(&zone).unwrap_or_else(Zone::stop))
        };
        (0..count).map(|_| drawn()).collect()
    }

    /// The program along `way`: home, joints to the first point, on through the others, home. `blends(k)` says whether
    /// the corner at the way's k-th point may be cut by a zone (m).
    ///
    /// The first move is joint to the first point, the last joint back home, both slow; every other one as
    /// `generate.moves.kind`. A zone that `blends` refuses becomes fine. All with the digits that a module has: what is
    /// planned is what is kept, handed over and verified.
    pub(super) fn program(&self, way: &[Met], number: usize, blends: impl Fn(usize, f64) -> bool) -> Program {
        let (tool, object) = self.frames();
        let object_from_base = object.base_from_object().inverse();
        let moves = &self.scenario.generate.moves;
        let mut program = Program::new(&CaseNumber(number).of_program(), &moves.procedure, tool, object);
        let home = || Move::new(Motion::AbsoluteJoint(self.home()), slow(), Zone::stop());
        let target = |met: &Met| self.target(&object_from_base, met.row, met.configuration);
        program.moves.push(home());
        for (k, met) in way.iter().enumerate().filter(|(_, met)| !met.passed) {
            // Blends beside an arc lie in no triangle that is proven.
            let straight = k > 0 && k + 1 < way.len() && !way[k - 1].passed && !way[k + 1].passed;
            let cut = straight && !met.zone.fine && blends(k, met.zone.tcp);
            let zone = if cut { met.zone.clone() } else { Zone::stop() };
            let motion = match moves.kind {
                MoveName::Linear if k > 0 && way[k - 1].passed => {
                    Motion::Circular { via: target(&way[k - 1]), to: target(met) }
                }
                MoveName::Linear if k > 0 => Motion::Linear(target(met)),
                MoveName::Linear | MoveName::Joint => Motion::Joint(target(met)),
            };
            program.moves.push(Move::new(motion, met.speed.clone(), zone));
        }
        program.moves.push(home());
        program.in_digits()
    }

    /// The way that `program` takes through the cloud; `None` where it is none from home and back. Points that arcs
    /// pass have the speed of their arc.
    pub(super) fn way_of(&self, program: &Program) -> Option<Vec<Met>> {
        let between = program.moves.get(1..program.moves.len().checked_sub(1)?)?;
        let mut way = Vec::with_capacity(between.len());
        for one in between {
            let met = |to: &PoseTarget, passed: bool| {
                let configuration = to.configuration.and_then(configuration);
                let row = self.row_of(to.name.as_deref()?)?;
                let zone = if passed { Zone::stop() } else { one.zone.clone() };
                Some(Met { row, configuration, speed: one.speed.clone(), zone, passed })
            };
            match &one.motion {
                Motion::Circular { via, to } => way.extend([met(via, true)?, met(to, false)?]),
                Motion::Joint(to) | Motion::Linear(to) => way.push(met(to, false)?),
                Motion::AbsoluteJoint(_) => return None,
            }
        }
        Some(way)
    }

    /// The row of the point that is called `name`.
    pub(super) fn row_of(&self, name: &str) -> Option<usize> {
        let row = name.strip_prefix('p')?.parse().ok()?;
        (row < self.station.points.len() && self.point_name(row) == name).then_some(row)
    }

    /// What the virtual controller is told of `program`: its moves after the first, which starts at home, in base
    /// coordinates.
    ///
    /// Moves in joints of an arm whose configurations tell no controller the turns of its axes, the one from home
    /// among them, go to the angles that are proven and handed over: on the turn nearest to home, not to the move
    /// before.
    ///
    /// # Errors
    /// As [`Order::all_of`].
    pub(super) fn orders(&self, program: &Program) -> Result<Vec<Order>, SimulationError> {
        let mut orders = Self::as_written(program)?;
        if !self.tells_configurations() {
            for order in &mut orders {
                let Target::Joint(pose, Some(wanted)) = &order.target else { continue };
                if let Some(joints) = self.posture(pose, wanted) {
                    order.target = Target::Joints(joints);
                }
            }
        }
        Ok(orders)
    }

    /// The same moves with poses wherever the program has them.
    ///
    /// # Errors
    /// As [`Order::all_of`].
    pub(super) fn as_written(program: &Program) -> Result<Vec<Order>, SimulationError> {
        Ok(Order::all_of(program)?.split_off(program.moves.len().min(1)))
    }
}

/// Moves from and to home.
///
/// 200 mm/s at the tool's point. The fallback (0.2 m/s, 1 rad/s) is for a table of names without `v200`.
pub(super) fn slow() -> Speed {
    Speed::predefined("v200").unwrap_or(Speed {
        name: None,
        tcp: 0.2,
        orientation: 1.0,
        linear_external: 0.0,
        rotating_external: 0.0,
    })
}
