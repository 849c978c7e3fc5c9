//! What was executed, or logged, against the mission's own fences.

use hairpin::campaign::judge::measures_of;
use hairpin::campaign::{Case, CaseResult, Run, Setup, Status};
use hairpin::judgement::{Measures, Violation};
use hairpin::trajectory::Track;
use hairpin::world::terrain::KeepOutShape;
use hairpin_formats::missions::Fences;
use nalgebra::Point3;

use crate::check::{ARDUPILOT, PX4};

/// What a violation of one is called.
pub(crate) const FENCE: &str = "fence";
/// Rows that are kept are as near to what was flown, and places that were given in degrees are rounded, m.
const ROUNDING_M: f64 = 1e-3;
/// Between two rows it is looked at in steps of this, m.
const STEP_M: f64 = 0.05;
/// At most so many.
const MOST_STEPS: f64 = 1e4;
/// That fences are read in two ways.
pub(crate) const READ_OTHERWISE: &str = "it was outside of a fence of the mission that keeps in: ArduPilot (firmwareType 3) demands to be in all of \
                                         them, PX4 (12) in any, and the mission names neither";

/// A motion, and how well it is known.
pub(crate) struct Moved<'a> {
    pub(crate) track: &'a Track,
    /// How far it may have been from the line between a row and the next, m; `None` where nothing is said of that.
    pub(crate) bulge: &'a dyn Fn(usize) -> Option<f64>,
    /// Horizontal standard deviation of a row, m.
    pub(crate) sigma: &'a dyn Fn(usize) -> f64,
}

/// Where a motion was to fences.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Seen {
    /// How far beyond one at most, for certain.
    pub(crate) beyond: Option<Beyond>,
    /// Where it may have been, of what is not certain.
    pub(crate) may_be: Option<MayBe>,
    /// Whether it was by another autopilot's reading.
    pub(crate) otherwise: bool,
}

/// How far, m, and when, s.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Beyond {
    pub(crate) by: f64,
    pub(crate) at: f64,
}

/// Where it was seen, negative within, and how far beyond it may have been, m.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MayBe {
    pub(crate) seen: Beyond,
    pub(crate) most: f64,
    /// What of that its own accuracy makes, m.
    pub(crate) sigma: f64,
}

impl Beyond {
    /// As a violation of `case`, whose waypoints were `reached` when they were.
    pub(crate) fn violation(&self, case: &Case, reached: &[Option<f64>]) -> Violation {
        let passed = reached.iter().skip(1).flatten().filter(|time| **time <= self.at).count();
        self.on_leg(passed.min(case.waypoints.len().saturating_sub(2)))
    }

    /// As a violation on a leg.
    pub(crate) fn on_leg(&self, leg: usize) -> Violation {
        Violation { what: FENCE.into(), value: self.by, limit: 0.0, unit: "m".into(), at: self.at, leg }
    }
}

/// Holds what was executed of `case` against them: beyond one of them is a violation; what may have been between the
/// poses of a program, and what is so by another autopilot's reading alone, decides nothing.
pub(super) fn hold(fences: &Fences, setup: &Setup, case: &Case, runs: &[Run], result: &mut CaseResult) {
    let flown = runs.iter().filter_map(|run| Some((run, run.outcome.as_ref().ok()?)));
    let (mut worst, mut may_be, mut otherwise): (Option<(&Run, Beyond)>, Option<MayBe>, bool) = (None, None, false);
    for (run, flight) in flown {
        let [bulge, rounded] = inexact(setup, case, run);
        let moved = Moved { track: &flight.track, bulge: &|_| Some(bulge), sigma: &|_| rounded };
        let seen = look(fences, &moved);
        otherwise |= seen.otherwise;
        // Of a case that fails already its worst run is told.
        let counts = result.status != Status::Fail || run.run == result.run;
        if let Some(sure) = seen.beyond.filter(|sure| counts && worst.is_none_or(|(_, known)| sure.by > known.by)) {
            worst = Some((run, sure));
        }
        may_be = [may_be, seen.may_be].into_iter().flatten().reduce(|a, b| if b.most > a.most { b } else { a });
    }
    if let Some((run, sure)) = worst {
        let Ok(flight) = &run.outcome else { return };
        if result.status != Status::Fail {
            result.measures = measures_of(setup, case, run);
            if let Some((all, own)) = result.of_runs.as_mut().zip(result.measures.as_ref()) {
                **all = all.worst_of_each(own);
            }
            (result.run, result.drawn, result.message) = (run.run, run.drawn.clone(), None);
            (result.ended, result.left_world) = (flight.ended.word().into(), flight.left_world);
        }
        result.status = Status::Fail;
        result.violations.push(sure.violation(case, &flight.reached));
        return;
    }
    let open = match may_be {
        _ if !matches!(result.status, Status::Pass | Status::Unjudged) => return,
        Some(MayBe { seen, most, .. }) => {
            let rate = setup.swiftness().rate(seen.by.abs().max(ROUNDING_M));
            let rate = rate.map_or("more".into(), |rate| rate.ceil().to_string());
            format!(
                "{FENCE} {:.3} m within at its poses, but {most:.3} m beyond may hide between two of them; {rate} poses a \
                 second decide",
                -seen.by
            )
        }
        None if otherwise => READ_OTHERWISE.into(),
        None => return,
    };
    (result.status, result.message) = (Status::Inconclusive, Some(open));
}

/// How far (m) what was flown may have been from the line between two poses: of our own simulators, which look as often
/// as it takes, not at all.
///
/// a Δt²/8 over the longest time between two poses, which is less than that which accelerations are means over; and no
/// more than what may hide of the deviation. With how far rounding has moved a pose at most, m.
fn inexact(setup: &Setup, case: &Case, run: &Run) -> [f64; 2] {
    if setup.program().is_none() {
        return [0.0, 0.0];
    }
    let bounds = |m: &Measures| (m.acceleration_over, m.most_between, m.place_unresolved.unwrap_or(0.0));
    let known = run.full_rate.as_ref().map(|known| bounds(&known.measures));
    let known = known.or_else(|| measures_of(setup, case, run).as_ref().map(bounds));
    let Some((acceleration_over, most_between, rounded)) = known else { return [f64::INFINITY, 0.0] };
    let by_time = setup.swiftness().acceleration.zip(acceleration_over).map(|(a, span)| a * span * span / 8.0);
    [[by_time, most_between].into_iter().flatten().reduce(f64::min).unwrap_or(0.0), rounded]
}

/// Where a motion was to `fences`.
///
/// The line between two rows is looked along; it is as uncertain as the motion between them, and they themselves.
pub(crate) fn look(fences: &Fences, moved: &Moved) -> Seen {
    let shapes: Vec<(bool, KeepOutShape)> = fences.fences.iter().map(|fence| (fence.keeps_in, fence.shape())).collect();
    let mut seen = Seen::default();
    let mut note = |p: Point3<f64>, at: f64, [bulge, sigma]: [f64; 2]| {
        let [by, other] = off(fences.firmware, &shapes, &p);
        seen.otherwise |= other > ROUNDING_M;
        let (least, most) = (by - bulge - sigma, by + bulge + sigma);
        if least > ROUNDING_M && seen.beyond.is_none_or(|known| by > known.by) {
            seen.beyond = Some(Beyond { by, at });
        } else if most > ROUNDING_M && seen.may_be.is_none_or(|known| most > known.most) {
            seen.may_be = Some(MayBe { seen: Beyond { by, at }, most, sigma });
        }
    };
    let (track, times) = (moved.track, moved.track.times());
    for i in 0..times.len() {
        let sigma = (moved.sigma)(i);
        note(track.position(i), times[i], [0.0, sigma]);
        let (Some(next), Some(bulge)) = (times.get(i + 1), (moved.bulge)(i)) else { continue };
        let way = track.position(i + 1) - track.position(i);
        let steps = (way.norm() / STEP_M).ceil().min(MOST_STEPS).max(if bulge > 0.0 { 2.0 } else { 0.0 });
        let sigma = sigma.max((moved.sigma)(i + 1));
        for step in 1..steps as usize {
            let share = step as f64 / steps;
            note(track.position(i) + way * share, times[i] + (next - times[i]) * share, [bulge, sigma]);
        }
    }
    seen
}

/// How far `p` is beyond them, and by another autopilot's reading, m; negative within.
fn off(firmware: Option<u64>, shapes: &[(bool, KeepOutShape)], p: &Point3<f64>) -> [f64; 2] {
    let out = shapes.iter().filter(|(keeps_in, _)| !keeps_in).map(|(_, shape)| -shape.distance(p.x, p.y));
    let out = out.fold(f64::NEG_INFINITY, f64::max);
    let within = || shapes.iter().filter(|(keeps_in, _)| *keeps_in).map(|(_, shape)| shape.distance(p.x, p.y));
    let all = within().fold(f64::NEG_INFINITY, f64::max);
    let any = within().reduce(f64::min).unwrap_or(f64::NEG_INFINITY);
    match firmware {
        Some(PX4) => [out.max(any), f64::NEG_INFINITY],
        Some(ARDUPILOT) => [out.max(all), f64::NEG_INFINITY],
        _ => [out.max(any), all],
    }
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::{CaseNumber, Undone};
    use hairpin::trajectory::{Ended, Flight, Track};
    use hairpin_formats::missions::FenceTold;
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
        hold(&Fences { firmware, fences }, &setup, &case, &[run], &mut result);
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

    /// Two rows beside a fence: what is certain of them, of the line between them, and what may be.
    #[test]
    fn what_is_known_little_of_decides_little() {
        let poses = [0.0, 10.0].map(|x| Isometry3::translation(x, 2.5, 2.0)).to_vec();
        let track = Track::new(vec![0.0, 10.0], poses, vec![]).unwrap();
        // Its edge is 0.5 m beside the middle of the line.
        let fences = Fences { firmware: None, fences: vec![disc(false, 5.0)] };
        let seen = |bulge: Option<f64>, sigma: f64| {
            look(&fences, &Moved { track: &track, bulge: &|_| bulge, sigma: &|_| sigma })
        };
        for (bulge, sigma) in [(None, 0.1), (Some(0.0), 0.0), (Some(0.3), 0.1)] {
            let clear = seen(bulge, sigma);
            assert!(clear.beyond.is_none() && clear.may_be.is_none(), "{clear:?}");
        }
        for (bulge, sigma) in [(0.6, 0.0), (0.3, 0.3), (0.0, 0.6)] {
            let open = seen(Some(bulge), sigma);
            let may_be = open.may_be.unwrap();
            assert!(open.beyond.is_none() && (may_be.most - 0.1).abs() < 0.01, "{may_be:?}");
            assert!((may_be.seen.by + 0.5).abs() < 0.01 && (may_be.seen.at - 5.0).abs() < 0.1, "{may_be:?}");
        }
        // Across its middle: the line is 2 m within.
        let poses = [0.0, 10.0].map(|x| Isometry3::translation(x, 0.0, 2.0)).to_vec();
        let across = Track::new(vec![0.0, 10.0], poses, vec![]).unwrap();
        let seen = |bulge: f64| look(&fences, &Moved { track: &across, bulge: &|_| Some(bulge), sigma: &|_| 0.0 });
        assert!(seen(1.9).beyond.is_some() && seen(2.1).beyond.is_none() && seen(2.1).may_be.is_some());
    }
}
