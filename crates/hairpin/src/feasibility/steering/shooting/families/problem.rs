//! What is asked and what is answered.

use super::parameters::Parameters;
use crate::feasibility::steering::shooting::control::Control;
use crate::feasibility::steering::shooting::flat::Status;
use crate::feasibility::steering::shooting::{Curvatures, Goal, Query};
use crate::trajectory::SpeedProfile;
use crate::trajectory::drive::SegmentList;

/// A boundary-value problem with speed and direction of travel: a query in the frame that looks along the first
/// direction of travel.
///
/// The frame looks along the first direction of travel; a body that crabs stands turned in it.
///
/// The body's yaw is that of the path less δ(s), δ = swing · s/L.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Problem {
    /// Where to; driven forward. Its yaw is the change of the body's heading.
    ///
    /// x, y in m in the frame that looks along the first direction of travel; curvatures are the body's.
    pub query: Query,
    /// The speeds at both ends and between; it forms controls that are functions of time.
    pub speed: SpeedProfile,
    /// Change of the direction of travel in the body along the drive, rad, left positive.
    ///
    /// 0: constant. Spread evenly over the arc length.
    pub swing: f64,
    /// Whether the curvature at the end is as it comes. Only velocity polynomials ask for it.
    pub free_end: bool,
}

impl Problem {
    /// Parameters, the length among them, that a family has beyond the conditions of the problem: to go around places
    /// with, or to lower a cost by.
    ///
    /// 0 where a family has no more parameters than conditions: then there is one drive for each way around, and
    /// nothing to bend.
    pub fn spare(&self, control: Control) -> u32 {
        let ends = [self.speed.start(), self.speed.end()];
        let conditions = match control {
            // Where the vehicle stands, κ̇ must vanish.
            Control::TimePolynomial => control.conditions() + ends.iter().filter(|speed| **speed <= 0.0).count(),
            Control::VelocityPolynomial if self.free_end => control.conditions() - 1,
            _ => control.conditions(),
        };
        control.parameters().saturating_sub(conditions) as u32
    }

    /// The path of travel's own question: it turns by the direction, too, and begins and ends with its share of the
    /// bend.
    ///
    /// A start value's question, not a claim: curvatures are clipped to the bounds.
    ///
    /// κ_path = κ_body + swing/L, with the straight way (or half the least radius) for the unknown L.
    pub fn path(&self, bounds: &Curvatures) -> Query {
        let (Query { goal, start_curvature }, most) = (self.query, bounds.most);
        let bend = self.swing / libm::hypot(goal.x, goal.y).max(0.5 / most);
        let kept = |curvature: f64| (curvature + bend).clamp(-most, most);
        let yaw = goal.yaw + self.swing;
        Query { start_curvature: kept(start_curvature), goal: Goal { yaw, curvature: kept(goal.curvature), ..goal } }
    }
}

/// What is in the way of a drive, and ways around it.
#[derive(Clone, Copy)]
pub struct Among<'a> {
    /// Paths of travel to begin with as well, driven forward from the origin.
    pub guides: &'a [SegmentList],
    /// How deep commands, driven forward, come into what is in the way, m; 0 if they stay clear.
    pub depth: &'a dyn Fn(&SegmentList) -> f64,
}

/// What was found.
///
/// κ in the frame of the body's own heading, as commands have it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// Whether it does what was asked, and what it lacks otherwise.
    pub status: Status,
    /// The commands; if not `Ok`, what came nearest.
    pub segments: SegmentList,
    /// The family's own parameters.
    pub parameters: Parameters,
    /// Largest difference between the family's curvature and that of the commands, 1/m; 0 where they are the same
    /// function.
    pub fit_error: f64,
    /// Steps over all descents.
    pub iterations: u32,
}

/// One step of a descent, as an observer gets it.
///
/// `miss` and `bends` in the search's own units, where the least radius is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Iteration {
    /// Which start, from 0.
    pub start: u32,
    /// Which step of it, from 1.
    pub step: u32,
    /// Metres of the drive.
    pub length: f64,
    /// Largest of what is missing at the end, m, rad, 1/m.
    pub miss: f64,
    /// Largest |κ| or |κ′| over its bound.
    pub bends: f64,
}
