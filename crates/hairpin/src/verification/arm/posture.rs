//! What is wrong with a posture: axes beyond their bounds, links and tool too near to the cell.

use nalgebra::{Point3, Vector3};

use super::claim::{ArmBodyClaim, ArmSolidClaim, ArmSolidForm};
use super::solids::{distance, holds_around};
use super::{Arm, ROUNDING};

/// What is asked of a posture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Asked<'a> {
    /// Whether links and tool are looked at, and what they keep from the cell, m.
    pub(super) clearance: Option<f64>,
    /// Directions around the tool's line in which words are asked as well.
    pub(super) around: &'a [Vector3<f64>],
    /// Least margin from singularities, a pure number.
    pub(super) singularity: f64,
}

impl Arm<'_> {
    /// What is wrong with a posture.
    ///
    /// Bounds first, then singularities, then the first body that is too near to a solid. A body is points of it
    /// ([`Samples`](super::samples::Samples)), each with the body's radius: an under-estimate of what it fills, so that
    /// no true claim is refused.
    pub(super) fn wrong_at(&self, asked: &Asked, q: &[f64; 6]) -> Option<String> {
        for (k, joint) in self.claim.joints.iter().enumerate() {
            // No number is within no bounds.
            let within = q[k] >= joint.bounds[0] - ROUNDING && q[k] <= joint.bounds[1] + ROUNDING;
            if !within {
                return Some(format!("axis {} is at {:.3}°, beyond its bound", k + 1, q[k].to_degrees()));
            }
        }
        if asked.singularity > 0.0 {
            let (name, margin) = self.margin(q);
            if margin.is_nan() || margin < asked.singularity {
                return Some(format!("{name} singularity, margin {margin:.4}"));
            }
        }
        let clearance = asked.clearance?;
        let carried = self.screws.carried(q);
        self.claim.bodies.iter().zip(&self.samples).find_map(|(body, samples)| {
            let link = carried.link(&self.screws, body.link);
            let near = |form: &ArmSolidForm| {
                let words = matches!(form, ArmSolidForm::Where(_));
                words || distance(form, &(link * samples.center)) <= samples.reach + body.radius + clearance
            };
            let solids = self.claim.solids.iter().zip(&self.boxes);
            let solids = solids.filter(|(solid, _)| body.tool || !solid.tool_only);
            // Of a few points all are asked at once; of many those of solids that are near.
            let few = samples.points.len() <= FEW;
            let mut solids = solids.filter(|(solid, hull)| few || near(hull.as_ref().unwrap_or(&solid.form)));
            let mut points = Vec::new();
            solids.find_map(|(solid, hull)| {
                if points.is_empty() {
                    points.extend(samples.points.iter().map(|p| link * p));
                }
                met(body, &points, (solid, hull.as_ref()), clearance, asked.around)
            })
        })
    }
}

/// Points of a body that are looked at without asking where all of it is.
const FEW: usize = 400;

/// Whether `body`, seen at `points`, is nearer to a solid than it may be.
///
/// `points` are the body's, base frame, m; `hull` is a box around triangles. A solid in words has no distance: it is
/// asked at the points and at places `around` them, the body's radius and clearance away.
fn met(
    body: &ArmBodyClaim,
    points: &[Point3<f64>],
    (solid, hull): (&ArmSolidClaim, Option<&ArmSolidForm>),
    clearance: f64,
    around: &[Vector3<f64>],
) -> Option<String> {
    let room = body.radius + clearance;
    // Triangles are many: where their box is far, they are.
    if hull.is_some_and(|hull| points.iter().all(|p| distance(hull, p) > room)) {
        return None;
    }
    let least = points.iter().map(|p| distance(&solid.form, p)).fold(f64::INFINITY, f64::min);
    if points.iter().any(|p| holds_around(&solid.form, p, room - ROUNDING, around)) {
        return Some(format!("{} comes within {:.2} mm of {}", body.name, 1e3 * room, solid.name));
    }
    (least < room - ROUNDING).then(|| {
        let (left, asked) = (1e3 * (least - body.radius), 1e3 * clearance);
        format!("{} keeps {left:.2} mm from {}, not {asked:.2} mm", body.name, solid.name)
    })
}
