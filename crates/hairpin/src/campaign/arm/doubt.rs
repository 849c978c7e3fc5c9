//! What of a search rests on bodies of which neither is known.
//!
//! A body is not known where the arm's or the tool's file does not give its shape and a stand-in of usual size is
//! taken. A graph that has no way because two stand-ins meet says little of the real arm.

use std::sync::Arc;

use super::ArmSetup;
use super::graph::graph_of;
use super::obstructions::Meetings;
use crate::campaign::kind::{Build, Given};
use crate::campaign::scenario::{ArmMode, RobotSource};
use crate::feasibility::reachability::joint::{TOOL, is_known};
use crate::robot::arm::{APART, AXES};

impl ArmSetup {
    /// The same arm where pairs of bodies of which neither is known are not held against each other; `None` where there
    /// are no such pairs.
    ///
    /// The pairs are those \[low, high\] of bodies at least [`APART`] links from each other, of which neither has a
    /// shape of its own. The cell is held against all bodies as before.
    fn without_doubtful(&self) -> Option<Self> {
        let station = &self.station;
        let known = |body: usize| is_known(&station.arm, &station.tool, body);
        let apart = (0..=AXES).flat_map(|low| (low + APART..=TOOL).map(move |high| [low, high]));
        let doubtful: Vec<[usize; 2]> = apart.filter(|[low, high]| !known(*low) && !known(*high)).collect();
        if doubtful.is_empty() || self.scenario.generate.mode == ArmMode::Cartesian {
            return None;
        }
        let mut scenario = (*self.scenario).clone();
        let RobotSource::Inline(robot) = &mut scenario.robot else { return None };
        robot.exclude.extend(doubtful);
        Self::build(Given { keys: &Arc::new(scenario), files: &self.attachments, known: None }).ok()
    }

    /// Where the arm's graph has no way: whether it had one if shapes that are not known did not meet each other, and
    /// which key says that they do not, in a sentence's part.
    ///
    /// `None` too where the graph has a way as it is, or has none either way. Costs another graph.
    pub fn open_for_estimates(&self) -> Option<String> {
        if graph_of(self).is_ok() {
            return None;
        }
        graph_of(&self.without_doubtful()?).ok()?;
        let pairs: Vec<String> = Meetings::at_home(self).pairs.iter().map(|[a, b]| format!("[{a}, {b}]")).collect();
        let key = match pairs.is_empty() {
            true => "robot.exclude says which pairs do not meet".to_owned(),
            false => format!("robot.exclude = [{}] leaves out those at home", pairs.join(", ")),
        };
        Some(format!("estimated shapes alone are in the way: {key}"))
    }
}
