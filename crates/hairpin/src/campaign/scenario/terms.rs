//! What a run is judged by: the reference of its deviation, and the limits.

use super::{DeviationFrom, SpecSection};
use crate::judgement::{Limits, Stress};

/// The terms of a scenario's spec.
#[derive(Debug, Clone, Copy)]
pub struct Terms {
    /// The reference of the deviation.
    pub from: DeviationFrom,
    /// Inside this distance of the leg's own waypoints overshoot is judged instead, m.
    pub corner: f64,
    /// What is within spec.
    pub limits: Limits,
}

impl Terms {
    /// Keys of the limits of a [`SpecSection`].
    pub(in crate::campaign) const KEYS: &'static [&'static str] = &[
        "spec.deviation.max_m",
        "spec.overshoot.max_m",
        "spec.clearance.min_m",
        "spec.acceleration.max_m_s2",
        "spec.total_time.max_s",
    ];

    /// Of `[spec]`; deviation from the leg where nothing is said of it.
    pub(in crate::campaign) fn of(spec: &SpecSection) -> Self {
        Self {
            from: spec.deviation.map_or(DeviationFrom::Leg, |deviation| deviation.from),
            corner: spec.deviation.map_or(0.0, |deviation| deviation.corner_m),
            limits: Limits {
                deviation: spec.deviation.map(|limit| limit.max_m),
                overshoot: spec.overshoot.map(|limit| limit.max_m),
                clearance: spec.clearance.map(|limit| limit.min_m),
                acceleration: spec.acceleration.map(|limit| limit.max_m_s2),
                total_time: spec.total_time.map(|limit| limit.max_s),
                ..Limits::default()
            },
        }
    }

    /// What runs that violate nothing are compared by: what the first limit bounds, the deviation where there is none.
    pub(in crate::campaign) fn gauge(&self) -> Stress {
        self.limited().first().map_or(Stress::default(), |(stress, _)| *stress)
    }

    /// The limits that there are, each with the stress that it bounds: as stresses are, more being worse.
    ///
    /// Limits that must not be fallen short of (clearance, tip-over margin) are turned.
    pub(in crate::campaign) fn limited(&self) -> Vec<(Stress, f64)> {
        let Limits { deviation, overshoot, clearance, tip_over_margin, acceleration, total_time, late, unfinished: _ } =
            self.limits;
        let least = |limit: Option<f64>| limit.map(|limit| -limit);
        let limits = [
            (Stress::MaxDeviation, deviation),
            (Stress::Overshoot, overshoot),
            (Stress::Clearance, least(clearance)),
            (Stress::Tilt, least(tip_over_margin)),
            (Stress::MaxAcceleration, acceleration),
            (Stress::Time, total_time),
            (Stress::Lateness, late),
        ];
        limits.into_iter().filter_map(|(stress, limit)| Some((stress, limit?))).collect()
    }
}
