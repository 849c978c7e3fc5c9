//! What an arm's recordings are measured against, and how limits are told in the units of arms' users.

use super::ArmSetup;
use super::execute::program_of;
use crate::campaign::Case;
use crate::campaign::scenario::{LogClock, PathFrom};
use crate::judgement::moves::{Clock, MeasureSettings, Measured, measure_moves};
use crate::judgement::{Late, Violation};
use crate::simulation::arm::Plan;
use crate::trajectory::{ATTITUDE_UNKNOWN, PlannedPath, Track};

impl ArmSetup<'_> {
    /// The path that deviations are measured from: with the program's zones, or through its points.
    pub(in crate::campaign) fn reference(&self, case: &Case) -> Option<PlannedPath> {
        match self.scenario.spec.path.map(|limit| limit.from) {
            Some(PathFrom::Sharp) => {
                let orders = self.orders(program_of(case).ok()?).ok()?;
                let plan = Plan::new(&self.station.arm, &self.station.home, &orders, &self.plan_settings()).ok()?;
                plan.sharp_path().ok()
            }
            Some(PathFrom::Blended) | None => self.planned(case).ok(),
        }
    }
}

/// What `recording` did on each move of the programmed path; `None` where it is too short. Distances of samples are
/// left out.
pub(in crate::campaign) fn measured(setup: &ArmSetup, programmed: &PlannedPath, recording: &Track) -> Option<Measured> {
    let turn_weight =
        if recording.channel(ATTITUDE_UNKNOWN).is_some() { 0.0 } else { MeasureSettings::default().turn_weight };
    let clock = match setup.scenario.execute.log_clock {
        LogClock::AsRecorded => Clock::AsRecorded,
        LogClock::OffsetRemoved => Clock::OffsetRemoved,
    };
    let measured =
        measure_moves(programmed, recording, &MeasureSettings { turn_weight, clock, ..MeasureSettings::default() })
            .ok()?;
    Some(Measured { deviations: Vec::new(), ..measured })
}

/// The latest of all arrivals at points; `None` where it arrived nowhere.
pub(in crate::campaign) fn latest(measured: &Measured) -> Option<Late> {
    let arrivals = measured.moves.iter().enumerate();
    let late = arrivals.filter_map(|(leg, m)| Some(Late { by: m.late()?, at: m.arrived?, leg }));
    late.max_by(|a, b| a.by.total_cmp(&b.by))
}

/// The same violation in mm and ms.
pub(in crate::campaign) fn in_small_units(violation: Violation) -> Violation {
    let (factor, unit) = match (violation.unit.as_str(), violation.what.as_str()) {
        ("m", _) => (1e3, "mm"),
        ("s", "late") => (1e3, "ms"),
        _ => return violation,
    };
    Violation { value: violation.value * factor, limit: violation.limit * factor, unit: unit.into(), ..violation }
}
