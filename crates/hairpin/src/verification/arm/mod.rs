//! An arm's moves followed by equations of their own: those of a program as it was written, and those of a whole graph,
//! sampled densely, against the arm's bounds and the cell.
//!
//! Shares nothing with what proved or executes them: links by products of exponentials (`screws`), all postures of a
//! pose by canonical subproblems (`inverse`), configurations and singularities by where axes lie (`configuration`),
//! bodies by points of them (`samples`), straight moves and arcs by Newton's steps on the geometric Jacobian from
//! sample to sample (`reach`, `follow`), orientations along great arcs of quaternions (`course`), corners that zones
//! cut both as the path about them (`path`) and by points of their triangles (`corner`), distances of points from
//! solids by formulas of their own (`solids`). What is proven to keep a distance everywhere keeps it at every sample,
//! so that no true claim is refused; a false one is found where samples see it.
//!
//! ```text
//! claim   program (moves as written) or graph (postures, poses, ways) · arm · cell, plain numbers
//! follow  E(q) = exp(ξ₁q₁) … exp(ξ₆q₆) · rest;   Newton: q ← q + J(q)⁻¹ log(pose · E(q)⁻¹)      sample to sample
//! look    q within bounds · margin from singularities · distance of every body from every solid
//! end     pose, configuration and posture that the next move begins at
//! ```
//!
//! | asked | answer |
//! | --- | --- |
//! | [`verify_arm_program`] | distance from each waypoint, the first thing wrong on each move and corner |
//! | [`verify_arm_graph`] | the first thing wrong on each move of the graph |
//! | [`ArmPath`] | the path itself, for whoever compares executions with it |

mod claim;
mod configuration;
mod corner;
mod course;
mod follow;
mod graph;
mod inverse;
mod path;
mod posture;
mod program;
mod reach;
mod samples;
mod screws;
mod solids;
mod wrist;

#[cfg(feature = "unit-tests")]
mod tests;

pub use claim::{
    ArmBodyClaim, ArmBuild, ArmClaim, ArmJointClaim, ArmMotion, ArmMoveFinding, ArmProgramClaim, ArmProgramMove,
    ArmSolidClaim, ArmSolidForm, ArmTarget,
};
pub use graph::{ArmWay, ArmWayClaim, verify_arm_graph};
pub use path::{ArmPath, ArmPiece};
pub use program::{ArmProgramReplay, verify_arm_program};

use samples::Samples;
use screws::Screws;
use solids::box_around;
use wrist::Wrist;

/// Points on a body's axis, and of a corner, are this near, m.
const ALONG: f64 = 5e-3;
/// Room for rounding, m and rad.
const ROUNDING: f64 = 1e-6;
/// Why there is no arc.
const NO_ARC: &str = "three points of an arc lie on a line";

/// A share of a move, and what does not hold there.
type Wrong = (f64, String);

/// An arm that is claimed, with what following it takes.
struct Arm<'a> {
    claim: &'a ArmClaim<'a>,
    screws: Screws,
    /// Of an arm that has one.
    wrist: Option<Wrist>,
    /// Around solids of triangles.
    boxes: Vec<Option<ArmSolidForm<'static>>>,
    /// Of every body.
    samples: Vec<Samples>,
}

impl<'a> Arm<'a> {
    fn of(claim: &'a ArmClaim<'a>) -> Self {
        let screws = Screws::of(claim.joints);
        let wrist = matches!(claim.build, ArmBuild::SphericalWrist(_)).then(|| Wrist::of(&screws)).flatten();
        let boxes = claim.solids.iter().map(|solid| box_around(&solid.form)).collect();
        Self {
            claim,
            wrist,
            boxes,
            samples: claim.bodies.iter().map(|body| Samples::of(body, ALONG)).collect(),
            screws,
        }
    }
}
