//! What an arm's recordings are measured against, and how limits are told in the units of arms' users.

use super::ArmSetup;
use super::execute::program_of;
use crate::campaign::Case;
use crate::campaign::scenario::PathFrom;
use crate::judgement::moves::{MeasureSettings, measure_moves};
use crate::judgement::{Late, Violation};
use crate::simulation::arm::Plan;
use crate::trajectory::{PlannedPath, Track};

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

/// The latest of all arrivals of `recording` at the points of the programmed path; `None` where it is too short, or arrived nowhere.
pub(in crate::campaign) fn latest(programmed: &PlannedPath, recording: &Track) -> Option<Late> {
    let measured = measure_moves(programmed, recording, &MeasureSettings::default()).ok()?;
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
