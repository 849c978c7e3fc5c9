//! What a run is judged by: the reference of its deviation, and the limits.

use nalgebra::Point3;

use super::{DeviationFrom, SpecSection};
use crate::judgement::{LegMeasures, Limits, Measures, Stress};

/// The terms of a scenario's spec.
#[derive(Debug, Clone, Copy)]
pub struct Terms {
    /// The reference of the deviation.
    pub from: DeviationFrom,
    /// Inside this distance of the leg's own waypoints overshoot is judged instead, m.
    pub corner: f64,
    /// What is within spec.
    ///
    /// m, m/s², s; of drives the margin of tipping over in °. `None`: not judged.
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

    /// How many legs no sample of which was held against the limit of deviation.
    ///
    /// Of a leg shorter than twice `corner` every place lies in one of its corners, and so does what kept to it.
    ///
    /// 0 where nothing is limited, or where the reference is the planned path.
    pub(in crate::campaign) fn in_corners(&self, measures: &Measures, waypoints: &[Point3<f64>]) -> usize {
        let is_judged = self.limits.deviation.is_none() || self.from == DeviationFrom::Path;
        let within = |(ends, leg): &(&[Point3<f64>], &LegMeasures)| {
            (ends[1] - ends[0]).norm() < 2.0 * self.corner && leg.max_deviation <= 0.0
        };
        if is_judged { 0 } else { waypoints.windows(2).zip(&measures.legs).filter(within).count() }
    }

    /// What runs that violate nothing are compared by: what the first limit bounds, the deviation where there is none.
    pub(in crate::campaign) fn gauge(&self) -> Stress {
        self.limited().first().map_or(Stress::default(), |(stress, _)| *stress)
    }

    /// The limits that there are, each with the stress that it bounds: as stresses are, more being worse.
    ///
    /// Limits that must not be fallen short of (clearance, tip-over margin) are turned.
    pub(in crate::campaign) fn limited(&self) -> Vec<(Stress, f64)> {
        let Limits { deviation, overshoot, clearance, tip_over_margin, acceleration, total_time, late, .. } =
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

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn short_legs_lie_in_their_corners() {
        let limits = Limits { deviation: Some(0.1), ..Limits::default() };
        let terms = Terms { from: DeviationFrom::Leg, corner: 1.0, limits };
        let along = |apart: f64| [0.0, 1.0, 2.0].map(|k| Point3::new(k * apart, 0.0, 1.0));
        let off = |by: [f64; 2]| Measures {
            legs: by.map(|max_deviation| LegMeasures { max_deviation, ..LegMeasures::default() }).to_vec(),
            ..Measures::default()
        };
        assert_eq!(terms.in_corners(&off([0.0, 0.0]), &along(1.9)), 2);
        // A place beside the leg, far from both waypoints, was judged; so was the middle of a leg as long as that.
        assert_eq!(terms.in_corners(&off([0.0, 0.05]), &along(1.9)), 1);
        assert_eq!(terms.in_corners(&off([0.0, 0.0]), &along(2.0)), 0);
        // A path says itself how corners are flown, and without a limit nothing is missed.
        let of_path = Terms { from: DeviationFrom::Path, ..terms };
        let free = Terms { limits: Limits { overshoot: Some(0.1), ..Limits::default() }, ..terms };
        assert_eq!([of_path, free].map(|terms| terms.in_corners(&off([0.0, 0.0]), &along(1.9))), [0, 0]);
    }
}
