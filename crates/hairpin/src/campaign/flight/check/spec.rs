//! Bounds of `[spec]`.

use crate::campaign::check::Findings;
use crate::campaign::scenario::SpecSection;

/// Limits are finite; the share of violations lies in [0, 1), the confidence in [0.5, 1).
pub(super) fn check(spec: &SpecSection, found: &mut Findings) {
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
        found.above("spec.total_time.max_s", time.max_s, 0.0, 1e6, " s");
    }
    if let Some(share) = spec.violation_share {
        found.require((0.0..1.0).contains(&share), "spec.violation_share", share, "≥ 0 and < 1");
    }
    if let Some(confidence) = spec.confidence {
        let fine = (0.5..1.0).contains(&confidence);
        found.require(fine, "spec.confidence", confidence, "≥ 0.5 and < 1, such as 0.95");
    }
}
