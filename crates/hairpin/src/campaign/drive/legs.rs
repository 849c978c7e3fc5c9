//! What becomes of the legs of a roadmap of drives.

use std::collections::{HashSet, VecDeque};

use nalgebra::Point3;

use crate::campaign::graph::{Counter, Stage};
use crate::feasibility::reach::Reach;
use crate::feasibility::reach::drive::{DriveRoadmap, LegRefusal};

/// Nodes of a roadmap whose legs are solved.
///
/// Each has a leg to try for every heading of about 12 waypoints, each a boundary-value problem.
const NODES: usize = 16;

/// Counts the legs of the first nodes of `roadmap`, of trajectories of `length` waypoints that end at the last one
/// where `ends`.
///
/// Breadth first from the start, 16 nodes at most: a sample near the start, not the whole roadmap. Each leg is solved.
///
/// Refusals are counted once for each pair that was solved, by the stage that they belong to: reach, world, obstacle or
/// limits. A leg that is one but does not lead to the end is lost to `task.end_m`.
pub(super) fn count(roadmap: &DriveRoadmap, points: &[Point3<f64>], length: usize, ends: bool, counter: &mut Counter) {
    let mut open = VecDeque::from([(roadmap.start(), 1)]);
    let mut seen = HashSet::from([roadmap.start()]);
    let mut legs = Vec::new();
    for _ in 0..NODES {
        let Some((node, passed)) = open.pop_front() else { break };
        if passed >= length {
            break;
        }
        legs.clear();
        roadmap.legs(&node, points, &mut legs);
        for leg in &legs {
            if ends && !roadmap.may_arrive(&leg.to, length - passed - 1) {
                counter.lose(Stage::EndPoint, "task.end_m");
                continue;
            }
            counter.keep();
            if seen.insert(leg.to) {
                open.push_back((leg.to, passed + 1));
            }
        }
    }
    let tally = roadmap.tally();
    for reason in LegRefusal::ALL {
        let stage = match reason {
            LegRefusal::Detour | LegRefusal::Unsolved => Stage::Reach,
            LegRefusal::MapEdge | LegRefusal::NoData | LegRefusal::NoRest => Stage::World,
            LegRefusal::KeepOut => Stage::Obstacle,
            LegRefusal::Curvature
            | LegRefusal::Steering
            | LegRefusal::Torque
            | LegRefusal::SteerAngle
            | LegRefusal::SteerRate
            | LegRefusal::WheelSpeed
            | LegRefusal::WheelAcceleration
            | LegRefusal::Tilt
            | LegRefusal::Joint
            | LegRefusal::Belly => Stage::Limits,
        };
        counter.lose_many(stage, reason.says(), tally.refused(reason));
    }
}
