//! What a run is judged by: the reference of its deviation, and the limits.

use super::scenario::{ArmScenario, DeviationFrom, DriveScenario, FlightScenario, Scenario};
use crate::judgement::Limits;

/// The terms of a scenario's spec.
#[derive(Debug, Clone, Copy)]
pub(super) struct Terms {
    /// The reference of the deviation.
    pub(super) from: DeviationFrom,
    /// Inside this distance of the leg's own waypoints overshoot is judged instead, m.
    pub(super) corner: f64,
    /// What is within spec.
    pub(super) limits: Limits,
}

impl Terms {
    pub(super) fn of(scenario: &Scenario) -> Self {
        match scenario {
            Scenario::Flight(scenario) => Self::of_flight(scenario),
            Scenario::Drive(scenario) => Self::of_drive(scenario),
            Scenario::Arm(scenario) => Self::of_arm(scenario),
        }
    }

    fn of_flight(scenario: &FlightScenario) -> Self {
        let spec = &scenario.spec;
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

    /// Drives follow a planned path: the way between two waypoints is not the straight one.
    fn of_drive(scenario: &DriveScenario) -> Self {
        let spec = &scenario.spec.limits;
        Self {
            from: DeviationFrom::Path,
            corner: 0.0,
            limits: Limits {
                deviation: spec.path_deviation_m,
                clearance: spec.clearance_m,
                tip_over_margin: spec.tip_over_margin_deg,
                total_time: spec.total_time_s,
                ..Limits::default()
            },
        }
    }

    /// Arms are held to the path that was programmed, and to their times at its points.
    fn of_arm(scenario: &ArmScenario) -> Self {
        let spec = &scenario.spec;
        Self {
            from: DeviationFrom::Path,
            corner: 0.0,
            limits: Limits {
                deviation: spec.path.map(|limit| limit.max_mm * 1e-3),
                late: spec.arrival.map(|limit| limit.max_late_ms * 1e-3),
                ..Limits::default()
            },
        }
    }
}
