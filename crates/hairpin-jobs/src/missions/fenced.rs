//! What was executed against the mission's own fences, as a campaign's folder keeps them.

use hairpin::campaign::judge::measures_of;
use hairpin::campaign::{Case, CaseResult, Doubt, Flown, Log, Run, Setup, Status, Why};
use hairpin::judgement::Violation;
use hairpin::trajectory::Flight;
use hairpin::world::terrain::KeepOutShape;
use hairpin_formats::missions::{Fence, Mission};
use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use crate::check::{ARDUPILOT, PX4};

/// What a violation of one is called.
pub(crate) const FENCE: &str = "fence";
/// Rows that are kept are as near to what was flown, and places that were given in degrees are rounded, m.
const ROUNDING_M: f64 = 1e-3;
/// Between two rows it is looked at in steps of this, m.
const STEP_M: f64 = 0.05;
/// At most so many.
const MOST_STEPS: f64 = 1e4;

/// The fences of a mission.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FencesTold {
    /// `MAV_AUTOPILOT` of who flies it, where its file says so.
    firmware: Option<u64>,
    fences: Vec<FenceTold>,
}

/// One of them, in metres of the world: a circle's centre and radius, or corners.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct FenceTold {
    keeps_in: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    circle_m: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    corners_m: Vec<[f64; 2]>,
}

impl FenceTold {
    fn of(fence: &Fence) -> Self {
        let (circle_m, corners_m) = match fence.outline.shape() {
            KeepOutShape::Circle { center_m: [x, y], radius_m } => (Some([x, y, radius_m]), Vec::new()),
            KeepOutShape::Polygon { points_m } => (None, points_m),
        };
        Self { keeps_in: fence.keeps_in, circle_m, corners_m }
    }

    fn shape(&self) -> KeepOutShape {
        match self.circle_m {
            Some([x, y, radius_m]) => KeepOutShape::Circle { center_m: [x, y], radius_m },
            None => KeepOutShape::Polygon { points_m: self.corners_m.clone() },
        }
    }
}

/// How far a motion was beyond fences at most, m, and when, s.
#[derive(Debug, Clone, Copy)]
struct Beyond {
    by: f64,
    at: f64,
}

impl FencesTold {
    pub(crate) fn of(mission: &Mission) -> Self {
        Self { firmware: mission.whose.firmware, fences: mission.fences.iter().map(FenceTold::of).collect() }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.fences.is_empty()
    }

    /// Holds what was executed of `case` against them: beyond one of them is a violation, and what is so by another
    /// autopilot's reading alone decides nothing.
    pub(super) fn hold(&self, setup: &Setup, case: &Case, runs: &[Run], result: &mut CaseResult) {
        let flown = runs.iter().filter_map(|run| Some((run, run.outcome.as_ref().ok()?)));
        let (mut worst, mut doubted): (Option<(&Run, &Flight, Beyond)>, bool) = (None, false);
        for (run, flight) in flown {
            let [sure, other] = self.beyond(flight);
            doubted |= other.by > ROUNDING_M;
            // Of a case that fails already its worst run is told.
            let counts = result.status != Status::Fail || run.run == result.run;
            if counts && sure.by > ROUNDING_M && worst.is_none_or(|(.., known)| sure.by > known.by) {
                worst = Some((run, flight, sure));
            }
        }
        match worst {
            Some((run, flight, Beyond { by, at })) => {
                if result.status != Status::Fail {
                    result.measures = measures_of(setup, case, run);
                    (result.run, result.drawn, result.message) = (run.run, run.drawn.clone(), None);
                    (result.ended, result.left_world) = (flight.ended.word().into(), flight.left_world);
                }
                result.status = Status::Fail;
                let reached = flight.reached.iter().skip(1).flatten().filter(|time| **time <= at).count();
                let leg = reached.min(case.waypoints.len().saturating_sub(2));
                let (what, unit) = (FENCE.to_owned(), "m".to_owned());
                result.violations.push(Violation { what, value: by, limit: 0.0, unit, at, leg });
            }
            None if doubted && matches!(result.status, Status::Pass | Status::Unjudged) => {
                result.status = Status::Inconclusive;
                result.message = Some(
                    "it was outside of a fence of the mission that keeps in: ArduPilot (firmwareType 3) demands to be \
                     in all of them, PX4 (12) in any, and the mission names neither"
                        .into(),
                );
            }
            None => {}
        }
    }

    /// Whether autopilots take them otherwise, and nobody says which flies them.
    pub(crate) fn is_ambiguous(&self) -> bool {
        let within = self.fences.iter().filter(|fence| fence.keeps_in).count();
        within > 1 && !matches!(self.firmware, Some(PX4 | ARDUPILOT))
    }

    /// Holds a log against them, and says so in `flown`: a sample that is beyond one by more than its own accuracy is a
    /// violation; what may be, by that or between two samples, is open. An interval is that much wider than the line
    /// between its samples as the motion may bulge out of it
    /// ([`Swiftness::bulge`](hairpin::judgement::Swiftness::bulge)).
    pub(crate) fn hold_log(&self, flown: &mut Flown, log: &Log) {
        let shapes = self.shapes();
        let (track, times) = (&log.flight.track, log.flight.track.times());
        let legs = track.channel("leg");
        let off = |p: &Point3<f64>| self.off(&shapes, p)[0];
        let across = |i: usize| log.accuracy.get(i).copied().flatten().map_or(0.0, |[across, _]| across);
        let of = |i: usize, value: f64| Violation {
            what: FENCE.to_owned(),
            value: value.max(0.0),
            limit: 0.0,
            unit: "m".to_owned(),
            at: times[i],
            leg: legs.map_or(0, |legs| legs[i] as usize),
        };
        let most = |a: &(usize, f64, f64), b: &(usize, f64, f64)| (a.1 + a.2).total_cmp(&(b.1 + b.2));
        let samples = || (0..times.len()).map(|i| (i, off(&track.position(i)), across(i)));
        let sure = samples().filter(|(_, by, sigma)| by - sigma > ROUNDING_M).max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, by, _)) = sure {
            flown.violations.push(of(i, by));
            return;
        }
        let near = samples().filter(|(_, by, sigma)| by + sigma > ROUNDING_M).max_by(most);
        if let Some((i, by, sigma)) = near {
            let why = Why::Accuracy { which: "eph", sigma };
            flown.doubts.push(Doubt { value: of(i, by), why });
            return;
        }
        let between = (0..times.len().saturating_sub(1)).filter(|i| log.breaks.binary_search(&(i + 1)).is_err());
        let reach = between.filter_map(|i| {
            let ends = [track.position(i), track.position(i + 1)];
            let way = ends[1] - ends[0];
            let bulge = flown.swiftness.bulge(times[i + 1] - times[i], way.norm()) + across(i).max(across(i + 1));
            let steps = (way.norm() / STEP_M).ceil().clamp(1.0, MOST_STEPS);
            let along = (0..=steps as usize).map(|step| off(&(ends[0] + way * (step as f64 / steps))));
            let by = along.fold(f64::NEG_INFINITY, f64::max);
            (by + bulge > ROUNDING_M).then_some((i, by, bulge))
        });
        if let Some((i, by, bulge)) = reach.max_by(most) {
            let most = by + bulge;
            flown.doubts.push(Doubt { value: of(i, by), why: Why::Between { most, rate_hz: None } });
        }
    }

    fn shapes(&self) -> Vec<(bool, KeepOutShape)> {
        self.fences.iter().map(|fence| (fence.keeps_in, fence.shape())).collect()
    }

    /// How far a motion was beyond them, surely and by another autopilot's reading.
    fn beyond(&self, flight: &Flight) -> [Beyond; 2] {
        let shapes = self.shapes();
        let mut worst = [Beyond { by: 0.0, at: 0.0 }; 2];
        let mut look = |p: Point3<f64>, at: f64| {
            for (worst, by) in worst.iter_mut().zip(self.off(&shapes, &p)) {
                if by > worst.by {
                    *worst = Beyond { by, at };
                }
            }
        };
        let (track, times) = (&flight.track, flight.track.times());
        for i in 0..times.len() {
            look(track.position(i), times[i]);
            let Some(next) = times.get(i + 1) else { break };
            let way = track.position(i + 1) - track.position(i);
            let steps = (way.norm() / STEP_M).ceil().min(MOST_STEPS);
            for step in 1..steps as usize {
                let share = step as f64 / steps;
                look(track.position(i) + way * share, times[i] + (next - times[i]) * share);
            }
        }
        worst
    }

    /// How far `p` is beyond them, surely and by another autopilot's reading, m; below 0 by how far it is not, −∞ where
    /// there is none.
    fn off(&self, shapes: &[(bool, KeepOutShape)], p: &Point3<f64>) -> [f64; 2] {
        let out = shapes.iter().filter(|(keeps_in, _)| !keeps_in).map(|(_, shape)| -shape.distance(p.x, p.y));
        let out = out.fold(f64::NEG_INFINITY, f64::max);
        let within = || shapes.iter().filter(|(keeps_in, _)| *keeps_in).map(|(_, shape)| shape.distance(p.x, p.y));
        let all = within().fold(f64::NEG_INFINITY, f64::max);
        let any = within().reduce(f64::min).unwrap_or(f64::NEG_INFINITY);
        match self.firmware {
            Some(PX4) => [out.max(any), f64::NEG_INFINITY],
            Some(ARDUPILOT) => [out.max(all), f64::NEG_INFINITY],
            _ => [out.max(any), all],
        }
    }
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::{CaseNumber, Undone};
    use hairpin::trajectory::{Ended, Track};
    use hairpin_formats::scenario::setup_for;
    use nalgebra::Isometry3;

    use super::*;

    fn disc(keeps_in: bool, x: f64) -> FenceTold {
        FenceTold { keeps_in, circle_m: Some([x, 0.0, 2.0]), corners_m: Vec::new() }
    }

    /// A flight along x from 0 to 10 m, of two rows.
    fn held(firmware: Option<u64>, fences: Vec<FenceTold>) -> CaseResult {
        let setup = setup_for("demo-quadrotor", &[]).unwrap();
        let ends = vec![Point3::new(0.0, 0.0, 2.0), Point3::new(10.0, 0.0, 2.0)];
        let poses = ends.iter().map(|p| Isometry3::translation(p.x, p.y, p.z)).collect();
        let track = Track::new(vec![0.0, 10.0], poses, vec![]).unwrap();
        let reached = vec![Some(0.0), Some(10.0)];
        let flight = Flight { track, ended: Ended::Done, left_world: None, reached };
        let run = Run { case: CaseNumber(0), run: 0, drawn: vec![], outcome: Ok(flight), full_rate: None };
        let bare = CaseResult::undone(CaseNumber(0), Undone::NotJudged);
        let mut result = CaseResult { status: Status::Pass, message: None, violations: vec![], ..bare };
        let case = Case::bare(CaseNumber(0), 1, ends);
        FencesTold { firmware, fences }.hold(&setup, &case, &[run], &mut result);
        result
    }

    #[test]
    fn what_was_flown_beyond_a_fence_is_a_violation() {
        // Between two rows, both of them outside.
        let result = held(None, vec![disc(false, 5.0)]);
        let [one] = &result.violations[..] else { panic!("{:?}", result.violations) };
        assert!(result.status == Status::Fail && one.what == FENCE, "{one:?}");
        assert!((one.value - 2.0).abs() < 1e-6 && (one.at - 5.0).abs() < 0.1 && one.leg == 0, "{one:?}");
        assert_eq!(held(None, vec![disc(false, 5.0), disc(false, 50.0)]).violations.len(), 1);
        assert_eq!(held(None, vec![disc(false, 13.0)]).status, Status::Pass);
        // 8 m out of one that keeps in.
        let out = held(None, vec![disc(true, 0.0)]).violations;
        assert!((out[0].value - 8.0).abs() < 1e-6, "{out:?}");
        let wide = FenceTold { circle_m: Some([5.0, 0.0, 6.0]), ..disc(true, 5.0) };
        assert_eq!(held(None, vec![wide.clone()]).status, Status::Pass);
        // Of two that keep in, one of which is left.
        let two = vec![wide, disc(true, 0.0)];
        let status = |firmware| held(firmware, two.clone()).status;
        assert_eq!(
            [status(Some(PX4)), status(Some(ARDUPILOT)), status(None)],
            [Status::Pass, Status::Fail, Status::Inconclusive]
        );
    }
}
