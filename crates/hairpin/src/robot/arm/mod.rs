//! Arms of six turning joints: kinematics both ways, limits, singularities, links as solids, tools and work objects.
//!
//! ```text
//! base_from_link_k = Π_{j ≤ k} origin_j · Rot(axis_j, q_j)      base_from_tcp = base_from_flange · flange_from_tcp
//! ẋ = J(q) q̇        τ = M(q) q̈ + C(q, q̇) q̇ + g(q)
//! ```
//!
//! | file | what |
//! | --- | --- |
//! | `joints` | angles and what joints may do |
//! | `chain` | forward kinematics, Jacobian, Newton's inverse: for every arm |
//! | `seeds` | from where Newton begins, until a posture within the limits is found |
//! | `opw` | the closed inverse, eight branches: for spherical wrists |
//! | `coupling` | how a controller tells axis 3 where a parallel rod drives it |
//! | `configuration` | cf1, cf4, cf6, cfx of a controller's robtarget |
//! | `singularity` | margins without unit |
//! | `rates` | bounds of joints on a whole piece of a tool move, from one sample |
//! | `body` | links as capsules and hulls, how far a turn moves them |
//! | `dynamics` | recursive Newton-Euler |
//! | `tool` | tools and work objects |
//!
//! Inside m and rad; the base is the frame of the cell; files have mm and degrees, quaternions w first. Floor 5 follows
//! moves with these, floor 5's act executes them, and the proof has equations of its own.

mod body;
mod chain;
mod configuration;
mod coupling;
mod description;
mod dynamics;
mod joints;
mod opw;
mod rates;
mod seeds;
mod singularity;
mod tool;

#[cfg(feature = "unit-tests")]
mod tests;

pub use body::{APART, Capsule, Hull, Link, Mass, Outline, body_name};
pub use chain::{Chain, Frames, Iterated, Joint};
pub use configuration::{Branch, Configuration};
pub use coupling::Coupling;
pub use description::{
    ArmDescription, ArmError, ArmKind, CapsuleDescription, ChainDescription, ChainJoint, HullDescription,
    JointsDescription, MassDescription, OpwDescription,
};
pub use joints::{AXES, JointLimit, Joints};
pub use opw::{Opw, WristCentre, nearest_turn, nearest_turns};
pub use rates::{PieceBounds, Sweep};
pub use singularity::{Margin, Singularity};
pub use tool::{Tool, WorkObject, unit_quaternion_of};

use std::f64::consts::TAU;

use nalgebra::{Isometry3, Vector3};

/// How an arm's inverse is found.
#[derive(Debug, Clone, PartialEq)]
pub enum Kinematics {
    /// In closed form.
    Opw(Opw),
    /// By Newton's steps along the chain.
    Chain,
}

/// An arm: numbers only, all checked.
///
/// ```
/// use hairpin::robot::arm::ArmDescription;
///
/// let file = serde_json::json!({
///     "kind": "arm", "name": "IRB 120", "opw": { "a1_mm": 0.0, "a2_mm": -70.0, "c1_mm": 290.0, "c2_mm": 270.0,
///         "c3_mm": 302.0, "c4_mm": 72.0, "offsets_deg": [0.0, 0.0, -90.0, 0.0, 0.0, 0.0] },
///     "joints": { "lower_deg": [-165.0, -110.0, -110.0, -160.0, -120.0, -400.0],
///         "upper_deg": [165.0, 110.0, 70.0, 160.0, 120.0, 400.0],
///         "speed_deg_s": [250.0, 250.0, 250.0, 320.0, 320.0, 420.0] },
/// });
/// let arm = serde_json::from_value::<ArmDescription>(file)?.build()?;
/// let q = [0.3, 0.2, -0.1, 0.5, 0.8, -0.4];
/// let flange = arm.forward(&q);
/// // Among its inverse solutions is the one that it came from.
/// let nearest = arm.inverse(&flange, &q).into_iter().map(|s| (0..6).map(|k| (s[k] - q[k]).abs()).sum::<f64>());
/// assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-9);
/// assert!(arm.margin(&q).value > 0.0 && arm.outside_limits(&q).is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Arm {
    /// Name in reports.
    pub name: String,
    /// What must be said wherever the arm is named.
    pub caveat: String,
    /// Where the numbers come from.
    pub source: String,
    /// Where up is in the base frame, of length 1: along z unless the arm hangs.
    pub up: Vector3<f64>,
    /// What the controller counts from: makers' bases are not always the root of a URDF.
    pub base_from_controller: Isometry3<f64>,
    /// The joints one after the other.
    pub chain: Chain,
    /// How the inverse is found.
    pub kinematics: Kinematics,
    /// What the joints may do.
    pub limits: [JointLimit; AXES],
    /// How its controller tells axis 3.
    pub coupling: Coupling,
    /// Time constants of the servos' lag, s, where the file has them.
    pub lags: Option<Joints>,
    /// What the joints are called by ROS.
    pub joint_names: [String; AXES],
    /// Links, the base first.
    pub links: [Link; AXES + 1],
    /// Pairs of bodies that are not held against each other: 0 the base, 1 to 6 the links, 7 the tool.
    pub excluded: Vec<[usize; 2]>,
    /// What was derived and not given: keys of the file, or in words.
    pub estimated: Vec<String>,
}

impl Arm {
    /// `base_from_flange` at the joint angles `q`, rad.
    pub fn forward(&self, q: &Joints) -> Isometry3<f64> {
        self.chain.forward(q)
    }

    /// Whether the shape of any link is not known: what is clear of its stand-in need not be clear of it.
    pub fn has_stand_ins(&self) -> bool {
        self.links.iter().any(|link| link.outline == Outline::StandIn)
    }

    /// Joint angles whose flange is at `flange`, with every angle on the turn nearest to `near`: of arms with a closed
    /// form all solutions in the order of cfx, and limits are not looked at; of others the first one within the limits
    /// that Newton finds, beginning at `near` and then elsewhere, else the first one beyond them.
    ///
    /// `flange` is `base_from_flange`. Eight solutions at most with a closed form, none where the wrist centre is out
    /// of reach; one or none by Newton, and that there is none proves nothing unless the flange is farther off than the
    /// arm is long ([`Chain::is_beyond`]). A target may have more on other turns ([`Arm::turns_of`]).
    pub fn inverse(&self, flange: &Isometry3<f64>, near: &Joints) -> Vec<Joints> {
        match &self.kinematics {
            Kinematics::Opw(opw) => opw.solutions(flange, near[3]).map(|q| nearest_turns(&q, near)).collect(),
            Kinematics::Chain => self.searched(flange, near).into_iter().collect(),
        }
    }

    /// The solution of `branch` on the turns nearest to `near`; without a closed form the one that Newton finds from
    /// `near`.
    ///
    /// Following a move means asking for one branch all along it: `near` chooses the turns, and axis 4 where the wrist
    /// is stretched.
    pub fn inverse_in(&self, flange: &Isometry3<f64>, branch: Branch, near: &Joints) -> Option<Iterated> {
        match &self.kinematics {
            Kinematics::Opw(opw) => {
                let joints = nearest_turns(&opw.solve(flange, branch, near[3])?, near);
                Some(Iterated { joints, iterations: 1 })
            }
            Kinematics::Chain => self.chain.inverse_near(flange, near),
        }
    }

    /// Whether all postures that put the flange somewhere are known: of others what is not found may be there.
    pub fn has_closed_inverse(&self) -> bool {
        matches!(self.kinematics, Kinematics::Opw(_))
    }

    /// Whether it is known which posture a controller's cfx means.
    ///
    /// cfx counts from wrist, elbow and shoulder, which only arms with a closed form have: of others [`Arm::branch`]
    /// tells postures apart here, and no controller.
    pub fn knows_configurations(&self) -> bool {
        self.has_closed_inverse()
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
    ///
    /// Wrist |sin θ5|, elbow |sin e|, shoulder |f|/(c2 + k); chains 1/‖J⁻¹‖. Pure numbers, comparable between arms of
    /// different sizes.
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
    ///
    /// The product over axes of the turns that each allows, the first axis slowest: of an axis with ±400° up to three.
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
