//! Joint angles along a path of the tool, in one branch, and why they may end.

use std::fmt;

use nalgebra::Isometry3;

use super::settings::PlanSettings;
use crate::robot::arm::{Arm, Branch, Configuration, Joints, Margin, nearest_turns};

/// Why an arm cannot go on.
///
/// With the numbers that a programmer needs: which axis, at what angle, beyond which bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reason {
    /// No joint angles put the tool there in this branch.
    OutOfReach,
    /// An axis would leave its bounds.
    JointLimit {
        /// Axis, from 1.
        axis: usize,
        /// Its angle, rad.
        angle: f64,
        /// The bound that it leaves, rad.
        bound: f64,
    },
    /// A singularity is too near.
    Singular(Margin),
    /// The move ends in another configuration than the target's.
    Configuration {
        /// Of the arm.
        found: Configuration,
        /// Of the target.
        wanted: Configuration,
    },
    /// The three points of an arc lie in line.
    NoArc,
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfReach => f.write_str("out of reach"),
            Self::JointLimit { axis, angle, bound } => {
                let relation = if angle > bound { '>' } else { '<' };
                write!(f, "axis {axis} at {:.1}° {relation} {:.1}°", angle.to_degrees(), bound.to_degrees())
            }
            Self::Singular(margin) => write!(f, "{} singularity, margin {:.4}", margin.of, margin.value),
            Self::Configuration { found, wanted } => write!(f, "configuration {found}, the target's is {wanted}"),
            Self::NoArc => f.write_str("the points of the arc lie in line"),
        }
    }
}

/// Where a program ended before its end.
///
/// `share` is of the move, to where the last pose could be had.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// The move, from 0.
    pub order: usize,
    /// How much of it, 0 … 1.
    pub share: f64,
    /// When the arm stands still, s.
    pub time: f64,
    /// Why.
    pub reason: Reason,
}

/// Solves for joint angles, and counts what that takes.
///
/// Kinematics alone: collisions are nothing that a controller of this kind looks at.
pub(super) struct Follower<'a> {
    /// Its kinematics, bounds and margins.
    pub(super) arm: &'a Arm,
    /// The singularity's margin below which it stops.
    pub(super) settings: &'a PlanSettings,
    /// Inverse kinematics iterations so far.
    pub(super) iterations: u64,
}

impl Follower<'_> {
    /// Joint angles for the flange in `branch`, on the turns nearest to `near`, within limits and away from
    /// singularities.
    ///
    /// Asked in this order: reach, margin, bounds; the first that fails is told. `near` is the sample before, rad,
    /// whose turns are kept.
    pub(super) fn solve(&mut self, flange: &Isometry3<f64>, branch: Branch, near: &Joints) -> Result<Joints, Reason> {
        let found = self.arm.inverse_in(flange, branch, near).ok_or(Reason::OutOfReach)?;
        self.iterations += u64::from(found.iterations);
        let margin = self.arm.margin(&found.joints);
        if margin.value < self.settings.singularity {
            return Err(Reason::Singular(margin));
        }
        self.within(&found.joints)?;
        Ok(found.joints)
    }

    /// Whether every axis keeps its bounds.
    pub(super) fn within(&self, joints: &Joints) -> Result<(), Reason> {
        match self.arm.outside_limits(joints) {
            None => Ok(()),
            Some((axis, _)) => {
                let (limit, angle) = (&self.arm.limits[axis], joints[axis]);
                let bound = if angle > limit.upper { limit.upper } else { limit.lower };
                Err(Reason::JointLimit { axis: axis + 1, angle, bound })
            }
        }
    }

    /// The joint angles that a joint move to `flange` ends in: of the wanted configuration, or those nearest to `near`.
    ///
    /// Without a configuration whole turns count as other solutions, and the least largest turn of an axis wins; with
    /// one the quadrants pick the turns, and bounds are asked afterwards.
    pub(super) fn end(
        &mut self,
        flange: &Isometry3<f64>,
        wanted: Option<Configuration>,
        near: &Joints,
    ) -> Result<Joints, Reason> {
        let Some(wanted) = wanted else {
            let all = self.arm.inverse(flange, near);
            self.iterations += all.len().max(1) as u64;
            let first = *all.first().ok_or(Reason::OutOfReach)?;
            let inside = all.into_iter().flat_map(|q| self.arm.turns_of(&q));
            let distance = |q: &Joints| super::curve::largest_turn(near, q);
            return match inside.min_by(|a, b| distance(a).total_cmp(&distance(b))) {
                Some(nearest) => Ok(nearest),
                None => self.within(&first).map(|()| first),
            };
        };
        let branch = Branch::from_cfx(wanted.cfx);
        let joints = self.led(flange, branch, near)?;
        // The middle of each quadrant picks the turn.
        let middle = |quadrant: i32| (f64::from(quadrant) + 0.5) * std::f64::consts::FRAC_PI_2;
        let mut reference = joints;
        for (axis, quadrant) in [(0, wanted.cf1), (3, wanted.cf4), (5, wanted.cf6)] {
            reference[axis] = middle(quadrant);
        }
        let joints = nearest_turns(&joints, &reference);
        self.within(&joints)?;
        self.meets(&joints, wanted)?;
        Ok(joints)
    }

    /// The angles in `branch` near `near`; of an arm without a closed inverse, where Newton's steps from there lead to
    /// none within the bounds, those that the search for points finds from there.
    fn led(&mut self, flange: &Isometry3<f64>, branch: Branch, near: &Joints) -> Result<Joints, Reason> {
        let found = self.arm.inverse_in(flange, branch, near);
        self.iterations += found.map_or(0, |found| u64::from(found.iterations));
        let joints = found.map(|found| found.joints);
        if self.arm.has_closed_inverse() || joints.is_some_and(|q| !self.arm.turns_of(&q).is_empty()) {
            return joints.ok_or(Reason::OutOfReach);
        }
        self.arm.inverse(flange, near).first().copied().ok_or(Reason::OutOfReach)
    }

    /// Whether `joints` are in the configuration `wanted`; an angle on the border of two quadrants is in both.
    ///
    /// Quadrant k of an axis is k · 90° … (k + 1) · 90°; an angle within 10⁻⁶ rad of a border counts for both sides.
    pub(super) fn meets(&self, joints: &Joints, wanted: Configuration) -> Result<(), Reason> {
        const BORDER: f64 = 1e-6;
        let found = self.arm.configuration(joints);
        let in_quadrant = |axis: usize, quadrant: i32| {
            let from_middle = joints[axis] - (f64::from(quadrant) + 0.5) * std::f64::consts::FRAC_PI_2;
            from_middle.abs() <= std::f64::consts::FRAC_PI_4 + BORDER
        };
        let quadrants = [(0, wanted.cf1), (3, wanted.cf4), (5, wanted.cf6)];
        if found.cfx == wanted.cfx && quadrants.into_iter().all(|(axis, quadrant)| in_quadrant(axis, quadrant)) {
            Ok(())
        } else {
            Err(Reason::Configuration { found, wanted })
        }
    }
}
