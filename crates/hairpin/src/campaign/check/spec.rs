//! Bounds of the `[spec]` of what goes from waypoint to waypoint by its own controller.

use super::Findings;
use crate::campaign::scenario::SpecSection;

/// Limits are finite, times at most `longest` (s); the share of violations lies in [0, 1), the confidence in [0.5, 1).
///
/// Lengths are at most 1e6 m, accelerations 1e6 m/s². A limit of deviation, acceleration or time is above 0; corner,
/// overshoot and clearance may be 0. Limits that are not given are not asked.
pub(in crate::campaign) fn check_spec(spec: &SpecSection, longest: f64, found: &mut Findings) {
    if let Some(deviation) = &spec.deviation {
        found.above("spec.deviation.max_m", deviation.max_m, 0.0, 1e6, " m");
        found.from("spec.deviation.corner_m", deviation.corner_m, 0.0, 1e6, " m");
    }
    if let Some(overshoot) = &spec.overshoot {
        found.from("spec.overshoot.max_m", overshoot.max_m, 0.0, 1e6, " m");
    }
    if let Some(clearance) = &spec.clearance {
        found.from("spec.clearance.min_m", clearance.min_m, 0.0, 1e6, " m");
    }
    if let Some(acceleration) = &spec.acceleration {
        found.above("spec.acceleration.max_m_s2", acceleration.max_m_s2, 0.0, 1e6, " m/s²");
    }
    if let Some(time) = &spec.total_time {
        found.above("spec.total_time.max_s", time.max_s, 0.0, longest, " s");
    }
    found.share("spec", spec.violation_share, spec.confidence);
}
