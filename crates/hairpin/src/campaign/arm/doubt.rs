//! What of a search rests on bodies of which neither is known, or on postures that were not found.
//!
//! A body is not known where the arm's or the tool's file does not give its shape and a stand-in of usual size is
//! taken. A graph that has no way because two stand-ins meet says little of the real arm, and so does one that lacks
//! points for which Newton's steps found no posture.

use std::sync::Arc;

use super::ArmSetup;
use super::graph::{graph_of, whole_graph};
use super::obstructions::Meetings;
use crate::campaign::Stop;
use crate::campaign::kind::{Build, Given};
use crate::campaign::scenario::{ArmMode, RobotSource};
use crate::feasibility::reachability::Refusal;
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

    /// Which point was left out since no posture was found there, in a sentence's part; `None` where the arm meets
    /// something at home, from where there is no way then whatever is found.
    fn open_for_postures(&self) -> Option<String> {
        if self.station.arm.has_closed_inverse() || !self.home_meets().is_empty() {
            return None;
        }
        let postures = whole_graph(self, &Stop::never()).ok()?.postures?;
        let row = postures.iter().position(|posture| matches!(posture, Err(Refusal::NotFound { .. })))?;
        Some(format!("no posture at {} was found, which is no proof that there is none", self.point_name(row)))
    }

    /// Where the arm's graph has no way: which point it may lack, or whether it had a way if shapes that are not known
    /// did not meet each other, and which key says that they do not, in a sentence's part.
    ///
    /// `None` too where the graph has a way as it is, or has none either way. Costs another graph.
    pub fn open_for_estimates(&self) -> Option<String> {
        if graph_of(self).is_ok() {
            return None;
        }
        if let Some(open) = self.open_for_postures() {
            return Some(open);
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
