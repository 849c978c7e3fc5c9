//! What an arm's recordings are measured against, and how limits are told in the units of arms' users.
//!
//! The path a program is judged by is its own with the zones cut (`spec.path.from = "blended"`), or the polyline of
//! its targets (`"sharp"`). Alignment weighs orientation in only where the recording has it.

use super::assumptions::misnamed;
use super::execute::program_of;
use super::program::{Met, slow};
use super::{ArmSetup, obstructions};
use crate::campaign::Case;
use crate::campaign::kind::Programs;
use crate::campaign::learn::MoveFeatures;
use crate::campaign::scenario::{LogClock, PathFrom};
use crate::judgement::Violation;
use crate::judgement::moves::{Clock, MeasureSettings, Measured, measure_moves};
use crate::simulation::arm::Plan;
use crate::trajectory::program::{Program, Zone};
use crate::trajectory::{ATTITUDE_UNKNOWN, PlannedPath, Track};

impl Programs for ArmSetup {
    fn recordings(&self) -> Option<&str> {
        self.scenario.execute.logs.as_deref()
    }

    fn naming_all(&self) -> Program {
        let met = |row| Met { row, configuration: None, speed: slow(), zone: Zone::stop(), passed: false };
        let way: Vec<Met> = (0..self.station.points.len()).map(met).collect();
        self.program(&way, 0, |_, _| false)
    }

    fn misnamed(&self) -> Option<String> {
        misnamed(self)
    }

    fn reference(&self, case: &Case, programmed: Option<&PlannedPath>) -> Option<Track> {
        match self.scenario.spec.path.map(|limit| limit.from) {
            Some(PathFrom::Sharp) => {
                let orders = self.orders(program_of(case).ok()?).ok()?;
                let plan = Plan::new(&self.station.arm, &self.station.home, &orders, &self.plan_settings()).ok()?;
                Some(plan.sharp_path().ok()?.track().clone())
            }
            Some(PathFrom::Blended) | None => Some(programmed?.track().clone()),
        }
    }

    fn programmed(&self, case: &Case) -> Option<PlannedPath> {
        Some(self.with_postures(case, self.planned_path(case).ok()?))
    }

    fn measured(&self, programmed: &PlannedPath, recording: &Track, reference: Option<&Track>) -> Option<Measured> {
        let usual = MeasureSettings::default();
        let orientation_known = recording.channel(ATTITUDE_UNKNOWN).is_none();
        let turn_weight = if orientation_known { usual.turn_weight } else { 0.0 };
        let clock = match self.scenario.execute.log_clock {
            LogClock::AsRecorded => Clock::AsRecorded,
            LogClock::OffsetRemoved => Clock::OffsetRemoved,
        };
        let settings = MeasureSettings { turn_weight, clock, ..usual };
        let measured = measure_moves(programmed, recording, &settings).ok()?;
        let unseen = match self.recordings() {
            Some(_) => self.unseen(programmed, recording, reference, &measured, &settings),
            // The virtual controller leaves nothing out.
            None => None,
        };
        Some(Measured { deviations: Vec::new(), unseen, ..measured })
    }

    fn beyond(&self, recording: &Track) -> Option<String> {
        let stands = self.beyond_bounds(recording).map(|beyond| beyond.in_words());
        stands.or_else(|| self.too_fast(recording).map(|fast| fast.in_words()))
    }

    fn moves_seen(&self, case: &Case) -> Vec<Option<MoveFeatures>> {
        let orders = program_of(case).and_then(Self::as_written).unwrap_or_default();
        (0..orders.len()).map(|index| self.seen_of(&orders, index)).collect()
    }

    /// In mm and ms.
    fn in_the_way(&self) -> Vec<String> {
        obstructions::in_the_way(self)
    }

    fn not_found_out(&self) -> Option<String> {
        self.open_for_estimates()
    }

    /// Every change is another graph, and drawing points for one that has none takes long.
    fn patience(&self) -> f64 {
        3.0
    }

    fn in_their_units(&self, violation: Violation) -> Violation {
        let (factor, unit) = match (violation.unit.as_str(), violation.what.as_str()) {
            ("m", _) => (1e3, "mm"),
            ("s", "late") => (1e3, "ms"),
            _ => return violation,
        };
        Violation { value: violation.value * factor, limit: violation.limit * factor, unit: unit.into(), ..violation }
    }
}
