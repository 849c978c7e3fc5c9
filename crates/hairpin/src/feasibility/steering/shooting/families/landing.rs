//! Where commands end whose direction of travel turns, from the numbers that are handed out.

use crate::math::quadrature::Gauss;
use crate::trajectory::drive::{Motion, Segment};

/// Gauss-Legendre points of a panel.
const POINTS: usize = 8;
/// Longest turn of a panel, rad, and panels of a segment at most.
const PANEL: f64 = 1.0;
const MOST_PANELS: f64 = 1024.0;

/// x, y and change of heading of a forward drive that begins at the origin along x, its direction of travel turning
/// evenly by `swing`.
///
/// x = ∫ cos(θ + δ) ds, y = ∫ sin(θ + δ) ds with δ = swing · s/L; m and rad. Eight Gauss points for each radian of
/// turning; turns in place count for nothing.
///
/// The yaw is the body's, without the direction's turning; gears are not asked. At most 1024 panels a segment.
pub(super) fn landing(segments: &[Segment], swing: f64) -> [f64; 3] {
    let total: f64 = segments.iter().map(Segment::length_m).sum();
    let rate = if total > 0.0 { swing / total } else { 0.0 };
    let rule = Gauss::<POINTS>::RULE;
    let [mut x, mut y, mut yaw] = [0.0; 3];
    let mut driven = 0.0;
    for segment in segments {
        let Motion::Arc { length_m, curvature } = segment.motion else { continue };
        let turned = |s: f64| {
            let mean = (0..6).rev().fold(0.0, |sum, k| sum * s + curvature[k] / (k + 1) as f64);
            s * mean
        };
        let most: f64 = curvature.iter().rev().fold(0.0, |sum, a| sum * length_m + a.abs()) + rate.abs();
        let panels = (most * length_m / PANEL).ceil().clamp(1.0, MOST_PANELS);
        let width = length_m / panels;
        for panel in 0..panels as usize {
            for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                let s = (panel as f64 + node) * width;
                let (sin, cos) = libm::sincos(yaw + turned(s) + rate * (driven + s));
                x += weight * width * cos;
                y += weight * width * sin;
            }
        }
        yaw += turned(length_m);
        driven += length_m;
    }
    [x, y, yaw]
}
