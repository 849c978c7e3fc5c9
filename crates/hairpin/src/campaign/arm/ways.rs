//! What programs may be made of: the moves of the graph, and those between the other postures of its points, which are
//! followed when they are first asked for.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::ArmSetup;
use super::arm_graph::ArmGraph;
use super::graph::{configuration, joint_settings};
use super::program::Met;
use crate::campaign::scenario::{ArmMode, MoveName};
use crate::feasibility::reachability::joint::{
    Bodies, JointSettings, Motion, Station as Stand, follow, moved, postures,
};
use crate::robot::arm::{Configuration, Joints, Kinematics};

/// A posture that a point can be met in.
#[derive(Debug, Clone, Copy)]
struct Posture {
    /// `None` in Cartesian mode.
    configuration: Option<Configuration>,
    /// Where it is not the graph's: the angles, rad.
    other: Option<Joints>,
}

/// A point of the cloud in one of its postures, by their numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Standing {
    /// Row of the cloud.
    pub(super) row: usize,
    /// Number of its posture.
    pub(super) posture: usize,
}

/// One end of a move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Place {
    /// Where programs begin and end.
    Home,
    /// At a point.
    At(Standing),
}

/// A graph's moves, and those between postures that the graph does not have.
///
/// The graph meets every point in one posture. A point whose configuration the cloud does not give has others, one a
/// branch, in which moves are possible or not for reasons of their own: those are followed by the same code, once.
pub(super) struct Ways<'a> {
    pub(super) setup: &'a ArmSetup,
    pub(super) graph: Arc<ArmGraph>,
    settings: JointSettings,
    bodies: Bodies<'a>,
    /// By row: the graph's posture first, where it has one.
    postures: Vec<Vec<Posture>>,
    /// Moves between postures of which one is not the graph's.
    followed: Mutex<HashMap<[Place; 2], bool>>,
}

impl<'a> Ways<'a> {
    /// Looks which postures the points of `graph` have.
    ///
    /// Asks the inverse kinematics once per point in joint mode with an arm of closed inverse; nothing is followed
    /// yet.
    pub(super) fn new(setup: &'a ArmSetup, graph: Arc<ArmGraph>) -> Self {
        Self::of(setup, graph, |_| true)
    }

    /// The same for programs through the points of `rows` alone: others have no posture but the graph's.
    pub(super) fn through(setup: &'a ArmSetup, graph: Arc<ArmGraph>, rows: &[usize]) -> Self {
        Self::of(setup, graph, |row| rows.contains(&row))
    }

    fn of(setup: &'a ArmSetup, graph: Arc<ArmGraph>, is_asked: impl Fn(usize) -> bool) -> Self {
        let station = &setup.station;
        let settings = joint_settings(station, &setup.scenario);
        let bodies = Bodies::new(&station.arm, &station.tool, &station.cell, settings.clearance);
        // What a program says of a posture tells the angles of arms with a closed inverse alone.
        let tells =
            setup.scenario.generate.mode == ArmMode::Joint && matches!(station.arm.kinematics, Kinematics::Opw(_));
        let of_row = |row: usize| {
            let own = match &graph.postures {
                Some(postures) => postures[row].as_ref().ok().map(|q| station.arm.configuration(q)),
                None => graph.configuration(setup, row),
            };
            let met = graph.postures.as_ref().is_none_or(|postures| postures[row].is_ok());
            let first = met.then_some(Posture { configuration: own, other: None });
            let point = &station.points[row];
            let stand = Stand { pose: point.pose, configuration: point.configuration.and_then(configuration) };
            let all = match tells && is_asked(row) {
                true => postures(&station.arm, &station.tool, &bodies, &stand, &settings),
                false => Vec::new(),
            };
            let others = all.into_iter().map(|(_, q)| (station.arm.configuration(&q), q));
            let others = others.filter(|(configuration, _)| Some(*configuration) != own);
            let others =
                others.map(|(configuration, q)| Posture { configuration: Some(configuration), other: Some(q) });
            first.into_iter().chain(others).collect()
        };
        let of_rows = (0..graph.points()).map(of_row).collect();
        Self { setup, settings, bodies, postures: of_rows, followed: Mutex::default(), graph }
    }

    /// Points of the cloud.
    pub(super) fn points(&self) -> usize {
        self.graph.points()
    }

    /// Every posture that the point of row `row` can be met in.
    /// In order of their numbers: the graph's own is 0 where it has one.
    pub(super) fn standings(&self, row: usize) -> impl Iterator<Item = Standing> + use<> {
        (0..self.postures[row].len()).map(move |posture| Standing { row, posture })
    }

    /// Whether points have more than one.
    pub(super) fn has_choice(&self) -> bool {
        self.postures.iter().any(|postures| postures.len() > 1)
    }

    /// The configuration of a posture.
    pub(super) fn configuration(&self, at: Standing) -> Option<Configuration> {
        self.postures[at.row][at.posture].configuration
    }

    /// Where a program stands that meets a point as `met` says.
    pub(super) fn standing(&self, met: &Met) -> Option<Standing> {
        self.standings(met.row).find(|at| self.configuration(*at) == met.configuration)
    }

    /// Whether straight moves may lead from one posture to another: they change no branch.
    pub(super) fn may_follow(&self, from: Standing, to: Standing) -> bool {
        let branch = |at: Standing| self.configuration(at).map(|configuration| configuration.cfx);
        self.setup.scenario.generate.moves.kind == MoveName::Joint || branch(from) == branch(to)
    }

    /// Whether the move from one place to another is possible: by the graph, or followed by the same code.
    ///
    /// An answer that must be followed for is remembered.
    pub(super) fn leads(&self, from: Place, to: Place) -> bool {
        self.of_graph(from, to).unwrap_or_else(|| self.is_followed(from, to))
    }

    /// What the graph says of a move; `None` where one end is in a posture that it does not have.
    pub(super) fn of_graph(&self, from: Place, to: Place) -> Option<bool> {
        let other = |place: Place| matches!(place, Place::At(at) if self.angles(at).is_some());
        if other(from) || other(to) {
            return None;
        }
        Some(match (from, to) {
            (Place::Home, Place::Home) => false,
            (Place::Home, Place::At(to)) => self.graph.from_home[to.row],
            (Place::At(from), Place::Home) => self.graph.to_home[from.row],
            (Place::At(from), Place::At(to)) => self.graph.costs[from.row * self.points() + to.row].is_some(),
        })
    }

    /// Whether an arc leads through the middle one of three points, all met in the graph's postures.
    pub(super) fn has_arc(&self, [start, via, end]: [Standing; 3]) -> bool {
        let Some(arcs) = &self.graph.arcs else { return false };
        let of_graph = [start, via, end].into_iter().all(|at| self.angles(at).is_none());
        let triple = [start.row, via.row, end.row];
        of_graph && arcs.free.binary_search_by(|(free, _)| free.cmp(&triple)).is_ok()
    }

    /// The angles of a posture that the graph does not have, rad.
    fn angles(&self, at: Standing) -> Option<&Joints> {
        self.postures[at.row][at.posture].other.as_ref()
    }

    /// The angles of a posture, rad.
    fn joints(&self, at: Standing) -> Option<&Joints> {
        self.angles(at).or_else(|| self.graph.postures.as_ref()?[at.row].as_ref().ok())
    }

    /// The memory grows with the pairs asked for, never shrinks, and holds answers alone: the order of asking changes
    /// nothing.
    fn is_followed(&self, from: Place, to: Place) -> bool {
        let known = || self.followed.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(leads) = known().get(&[from, to]) {
            return *leads;
        }
        // Nothing is locked meanwhile: what two threads ask at once comes to the same.
        let leads = self.follow(from, to).is_some();
        known().insert([from, to], leads);
        leads
    }

    /// Moves from and to home go in joints, which are not held to singularities; moves between points are those of
    /// the scenario's kind and must arrive within 10⁻³ rad of the angles asked for. `None`: not possible, or one end
    /// has no angles.
    fn follow(&self, from: Place, to: Place) -> Option<()> {
        let station = &self.setup.station;
        let (arm, tool, settings) = (&station.arm, &station.tool, &self.settings);
        let angles = |place: Place| match place {
            Place::Home => Some(&station.home),
            Place::At(at) => self.joints(at),
        };
        let (start, end) = (angles(from)?, angles(to)?);
        let in_joints = Motion::Joint { start: *start, end: *end };
        let bodies = &self.bodies;
        let (Place::At(a), Place::At(b)) = (from, to) else {
            return follow(arm, tool, Some(bodies), &in_joints, start, &settings.follow, &mut 0).ok().map(drop);
        };
        if a.row == b.row || !self.may_follow(a, b) || !self.is_in_table(a.row, b.row) {
            return None;
        }
        let motion = match self.setup.scenario.generate.moves.kind {
            MoveName::Linear => Motion::linear(&station.points[a.row].pose, &station.points[b.row].pose),
            MoveName::Joint => in_joints,
        };
        moved(arm, tool, bodies, &motion, [start, end], &settings.follow, &mut 0).ok().map(drop)
    }

    /// Whether a table of costs, where there is one, has a move.
    fn is_in_table(&self, from: usize, to: usize) -> bool {
        self.setup.measured_cost(from, to).is_none_or(|cost| cost.is_some())
    }
}
