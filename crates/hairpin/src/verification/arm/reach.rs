//! Joint angles that lead the tool somewhere: Newton's steps on the geometric Jacobian, from sample to sample.

use nalgebra::{Isometry3, Vector6};

use super::Arm;
use super::course::ToolCourse;

/// Length (m) and angle (rad) within which a pose is met.
const MET: f64 = 1e-11;
/// Steps at most; from a near pose two or three do.
const MOST_STEPS: usize = 30;
/// A step this large (rad, of all joints together) has lost the way.
const LOST: f64 = 1.0;
/// Halvings of the way from one sample to the next.
const HALVINGS: usize = 8;

impl Arm<'_> {
    /// Joint angles near `q` with the tool (`link6_from_tcp`) at `pose`.
    ///
    /// q ← q + J(q)⁻¹ (Δp, Δθ) until |Δp| < 10⁻¹¹ m and |Δθ| < 10⁻¹¹ rad: quadratic near a regular posture. `None`
    /// where J is singular, a step is longer than [`LOST`], or [`MOST_STEPS`] do not do.
    pub(super) fn reach(&self, tool: &Isometry3<f64>, q: &[f64; 6], pose: &Isometry3<f64>) -> Option<[f64; 6]> {
        let mut q = *q;
        for _ in 0..MOST_STEPS {
            let carried = self.screws.carried(&q);
            let is = carried.link(&self.screws, 6) * tool;
            let off = twist(&is, pose);
            if off.fixed_rows::<3>(0).norm() < MET && off.fixed_rows::<3>(3).norm() < MET {
                return Some(q);
            }
            let step = carried.jacobian(&self.screws, &is.translation.vector).lu().solve(&off)?;
            if step.norm().is_nan() || step.norm() > LOST {
                return None;
            }
            (0..6).for_each(|k| q[k] += step[k]);
        }
        None
    }

    /// Joint angles at the share `to` of `course`, led on from those at `from`, in halves where the whole is too far.
    pub(super) fn lead(
        &self,
        course: &ToolCourse,
        tool: &Isometry3<f64>,
        q: &[f64; 6],
        [from, to]: [f64; 2],
    ) -> Option<[f64; 6]> {
        self.led(course, tool, q, [from, to], HALVINGS)
    }

    /// At most 2⁸ parts.
    ///
    /// The first half is led before the second, each from where the half before it came to; `None` where the smallest
    /// part cannot be.
    fn led(
        &self,
        course: &ToolCourse,
        tool: &Isometry3<f64>,
        q: &[f64; 6],
        [from, to]: [f64; 2],
        halvings: usize,
    ) -> Option<[f64; 6]> {
        self.reach(tool, q, &course.at(to)).or_else(|| {
            let halvings = halvings.checked_sub(1)?;
            let middle = 0.5 * (from + to);
            let q = self.led(course, tool, q, [from, middle], halvings)?;
            self.led(course, tool, &q, [middle, to], halvings)
        })
    }
}

/// From one pose to the other: the way (m) above the turn (rad), in the frame of both.
///
/// The rotation vector of R_to R_fromᵀ, of the shorter way round: (Δp, Δθ) as columns of the Jacobian have them, base
/// frame.
fn twist(from: &Isometry3<f64>, to: &Isometry3<f64>) -> Vector6<f64> {
    let shift = to.translation.vector - from.translation.vector;
    let turn = to.rotation * from.rotation.conjugate();
    let (axis, cosine) = if turn.w < 0.0 { (-turn.imag(), -turn.w) } else { (turn.imag(), turn.w) };
    let sine = axis.norm();
    // Of small turns the angle is twice the sine of its half.
    let turn = axis * if sine > 1e-12 { 2.0 * libm::atan2(sine, cosine) / sine } else { 2.0 };
    Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z)
}
