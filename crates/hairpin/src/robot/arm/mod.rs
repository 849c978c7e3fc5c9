//! Arms of six turning joints: kinematics both ways, limits, singularities, links as solids, tools and work objects.

mod body;
mod chain;
mod configuration;
mod description;
mod dynamics;
mod opw;
mod rates;
mod singularity;
mod tool;

#[cfg(test)]
mod tests;

pub use body::{Capsule, Link, Mass};
pub use chain::{Chain, Frames, Iterated, Joint};
pub use configuration::{Branch, Configuration};
pub use description::{
    ArmDescription, ArmError, ArmKind, CapsuleDescription, ChainDescription, ChainJoint, JointsDescription,
    MassDescription, OpwDescription,
};
pub use opw::{Opw, WristCentre, nearest_turn, nearest_turns};
pub use rates::{PieceBounds, Sweep};
pub use singularity::{Margin, Singularity};
pub use tool::{Tool, WorkObject, unit_quaternion_of};

use std::f64::consts::TAU;

use nalgebra::Isometry3;

/// Joints of every arm here.
pub const AXES: usize = 6;

/// Joint angles, rad, from the base on.
pub type Joints = [f64; AXES];

/// What one joint may do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointLimit {
    /// Least angle, rad.
    pub lower: f64,
    /// Largest angle, rad.
    pub upper: f64,
    /// Largest |q̇|, rad/s.
    pub speed: f64,
    /// Largest |q̈|, rad/s².
    pub acceleration: f64,
}

impl JointLimit {
    /// How far `angle` lies inside the bounds, rad; negative outside.
    pub fn margin(&self, angle: f64) -> f64 {
        (angle - self.lower).min(self.upper - angle)
    }
}

/// How an arm's inverse is found.
#[derive(Debug, Clone, PartialEq)]
pub enum Kinematics {
    /// In closed form.
    Opw(Opw),
    /// By continuation along the chain.
    Chain,
}

/// An arm: numbers only, all checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Arm {
    /// Name in reports.
    pub name: String,
    /// What must be said wherever the arm is named.
    pub caveat: String,
    /// Where the numbers come from.
    pub source: String,
    /// The joints one after the other.
    pub chain: Chain,
    /// How the inverse is found.
    pub kinematics: Kinematics,
    /// What the joints may do.
    pub limits: [JointLimit; AXES],
    /// Links, the base first.
    pub links: [Link; AXES + 1],
    /// Keys of the file that were derived and not given.
    pub estimated: Vec<&'static str>,
}

impl Arm {
    /// `base_from_flange` at the joint angles `q`, rad.
    pub fn forward(&self, q: &Joints) -> Isometry3<f64> {
        self.chain.forward(q)
    }

    /// Joint angles whose flange is at `flange`, with every angle on the turn nearest to `near`: of arms with a closed form all
    /// solutions in the order of cfx, of others the one that Newton finds from `near`. Limits are not looked at.
    pub fn inverse(&self, flange: &Isometry3<f64>, near: &Joints) -> Vec<Joints> {
        match &self.kinematics {
            Kinematics::Opw(opw) => opw.solutions(flange, near[3]).map(|q| nearest_turns(&q, near)).collect(),
            Kinematics::Chain => self.chain.inverse_near(flange, near).map(|found| found.joints).into_iter().collect(),
        }
    }

    /// The solution of `branch` on the turns nearest to `near`; without a closed form the one that Newton finds from `near`.
    pub fn inverse_in(&self, flange: &Isometry3<f64>, branch: Branch, near: &Joints) -> Option<Iterated> {
        match &self.kinematics {
            Kinematics::Opw(opw) => {
                let joints = nearest_turns(&opw.solve(flange, branch, near[3])?, near);
                Some(Iterated { joints, iterations: 1 })
            }
            Kinematics::Chain => self.chain.inverse_near(flange, near),
        }
    }

    /// Which solution `q` is. Without a closed form only the sign of axis 5 tells.
    pub fn branch(&self, q: &Joints) -> Branch {
        match &self.kinematics {
            Kinematics::Opw(opw) => opw.branch(q),
            Kinematics::Chain => Branch::from_cfx(u8::from(q[4] < 0.0)),
        }
    }

    /// The configuration numbers at `q`.
    pub fn configuration(&self, q: &Joints) -> Configuration {
        Configuration::of(q, self.branch(q))
    }

    /// The nearest singularity at `q`.
    pub fn margin(&self, q: &Joints) -> Margin {
        let Kinematics::Opw(opw) = &self.kinematics else {
            return Margin { of: Singularity::Chain, value: self.chain_margin(q) };
        };
        let at = opw.wrist_centre(q);
        Margin::least([
            Margin { of: Singularity::Wrist, value: libm::sin(at.bend).abs() },
            Margin { of: Singularity::Elbow, value: libm::sin(at.elbow).abs() },
            Margin { of: Singularity::Shoulder, value: at.forward.abs() / (opw.c2 + opw.forearm()) },
        ])
    }

    /// The first axis (from 0) outside its bounds at `q`, and by how much (rad, > 0) it is.
    pub fn outside_limits(&self, q: &Joints) -> Option<(usize, f64)> {
        self.limits.iter().zip(q).map(|(limit, angle)| limit.margin(*angle)).enumerate().find_map(|(axis, margin)| {
            // NaN is outside.
            (margin.is_nan() || margin < 0.0).then_some((axis, -margin))
        })
    }

    /// Every way to reach the same flange pose as `q` by whole turns of joints, within the limits.
    pub fn turns_of(&self, q: &Joints) -> Vec<Joints> {
        let mut all = vec![*q];
        for (axis, limit) in self.limits.iter().enumerate() {
            let turns = |angle: f64| {
                let least = ((limit.lower - angle) / TAU).ceil() as i64;
                let most = ((limit.upper - angle) / TAU).floor() as i64;
                (least..=most).map(move |turn| angle + turn as f64 * TAU)
            };
            all = all
                .iter()
                .flat_map(|q| {
                    turns(q[axis]).map(|angle| {
                        let mut turned = *q;
                        turned[axis] = angle;
                        turned
                    })
                })
                .collect();
        }
        all
    }
}
