//! What clocking every move of a graph on the real controller takes.
//!
//! ```text
//! n points, m ≤ n(n − 1) moves that are possible  →  targets in the work object, pairs of rows, one speed for all
//! ```
//!
//! A controller's own times are costs that no model has: this room only says what is to be driven, in which frames,
//! and from where. The times come back as a table of costs.

use super::ArmSetup;
use super::arm_graph::ArmGraph;
use super::handed::{as_the_world, is_wobj0, moved};
use crate::campaign::scenario::MoveName;
use crate::trajectory::program::{JointTarget, PoseTarget, Speed, Tool, WorkObject};

/// A graph's moves as a controller drives them.
///
/// Poses are in [`Self::work_object`], m; `home` in rad.
#[derive(Debug, Clone)]
pub struct ArcClock {
    /// Of all moves.
    pub tool: Tool,
    /// Of all moves.
    pub work_object: WorkObject,
    /// The cloud, row by row.
    pub points: Vec<PoseTarget>,
    /// Moves that are possible, from row to row.
    pub arcs: Vec<(usize, usize)>,
    /// Where it begins and ends.
    pub home: JointTarget,
    /// The row that home is left for and reached from.
    pub start: usize,
    /// Whether configurations are demanded.
    pub configured: bool,
    /// Joint angles at the start, where no configuration tells them.
    pub at_start: Option<JointTarget>,
    /// Of the moves: the first of the scenario's.
    pub speed: Speed,
}

impl ArmSetup {
    /// The moves of `graph`, to be clocked at the first of the scenario's speeds.
    ///
    /// # Errors
    /// Moves that are not straight; no point that home can be left for and reached from, in a sentence's part.
    ///
    /// `points` are all of the cloud, met or not: the rows of `arcs` and [`ArcClock::start`] count in it. The start
    /// is, of the rows that home can be left for and reached from, the one that most moves leave, the first of
    /// equals.
    pub fn arc_clock(&self, graph: &ArmGraph) -> Result<ArcClock, String> {
        let n = graph.points();
        if self.scenario.generate.moves.kind == MoveName::Joint {
            return Err("`generate.moves.kind` = \"joint\": what is clocked is straight moves".into());
        }
        let pairs = (0..n).flat_map(|from| (0..n).map(move |to| (from, to)));
        let arcs: Vec<(usize, usize)> = pairs.filter(|(from, to)| graph.costs[from * n + to].is_some()).collect();
        let leaving = |row: usize| arcs.iter().filter(|(from, _)| *from == row).count();
        let near_home = (0..n).filter(|row| graph.from_home[*row] && graph.to_home[*row]);
        let start = near_home.max_by_key(|row| (leaving(*row), n - row));
        let start = start.ok_or("no point that home can be left for and reached from")?;
        let (tool, mut work_object) = self.frames();
        let object_from_base = work_object.base_from_object().inverse();
        let point = |row| self.target(&object_from_base, row, graph.configuration(self, row));
        let mut points: Vec<PoseTarget> = (0..n).map(point).collect();
        let configured = self.tells_configurations();
        let at_start = if configured { None } else { self.joints_at(&work_object, &points[start]) };
        if !configured {
            points.iter_mut().for_each(|point| point.configuration = None);
        }
        self.in_world(&mut work_object);
        if is_wobj0(&work_object) {
            let world_from_object = work_object.base_from_object();
            points.iter_mut().for_each(|point| moved(&world_from_object, point));
            as_the_world(&mut work_object);
        }
        let speed = self.scenario.generate.moves.speeds.first().and_then(|name| Speed::predefined(name));
        let speed = speed.ok_or("`generate.moves.speeds` is empty")?;
        Ok(ArcClock { tool, work_object, points, arcs, home: self.home(), start, configured, at_start, speed })
    }
}
