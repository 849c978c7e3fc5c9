//! Whether a program's run was at every waypoint, one after the other: who says `done` may have left out all that lies
//! between.
//!
//! Whoever flies straight to the end is as fast as can be and near to nothing, so that limits of time, acceleration and
//! clearance are kept by it. Our own simulators are done where they have been everywhere, and nothing is asked of them.

use nalgebra::Point3;

use super::Setup;
use crate::judgement::{Limits, Measures};
use crate::math::segment::point_distance;
use crate::trajectory::{Ended, Flight, Track};

/// The first waypoint that a motion was never at, after those before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Missed {
    /// The waypoint, from 0.
    pub waypoint: usize,
    /// Waypoints of the mission.
    pub of: usize,
    /// How near the motion comes to it from where it was at the one before, m.
    pub nearest_m: f64,
    /// Within how much it would have counted as reached, m.
    pub accept_m: f64,
}

impl Missed {
    /// `waypoint 2 of 0 to 4 was never reached: 3.10 m at the nearest, 1 m accepted`.
    pub fn in_words(&self) -> String {
        let Self { waypoint, of, nearest_m, accept_m } = self;
        let last = of.saturating_sub(1);
        let near = format!("{nearest_m:.2} m at the nearest, {accept_m} m accepted");
        format!("waypoint {waypoint} of 0 to {last} was never reached: {near}")
    }
}

/// The least radius (m) for each waypoint within which `track` was at it and at all before it, in order; straight from
/// each sample to the next.
///
/// With `d_k(j)` the distance of waypoint k from the j-th line between samples, and r₋₁ = 0:
///
/// ```text
/// r_k = min over j of max(r_(k−1) over lines up to j, d_k(j))
/// ```
///
/// So it falls nowhere along the waypoints, and whatever is accepted tells the first that was missed. Within one line
/// the order is not looked at. O(samples · waypoints).
pub(super) fn radii(track: &Track, waypoints: &[Point3<f64>]) -> Vec<f64> {
    let mut radii = vec![f64::INFINITY; waypoints.len()];
    for i in 0..track.len() {
        let (from, to) = (track.position(i.saturating_sub(1)), track.position(i));
        let mut before = 0.0_f64;
        for (radius, waypoint) in radii.iter_mut().zip(waypoints) {
            *radius = radius.min(before.max(point_distance(waypoint, &from, &to)));
            before = *radius;
        }
    }
    radii
}

/// Why a program's run that is done has not flown its mission: the first waypoint that it never was at, within the
/// acceptance radius or the limit of deviation, whichever is more.
///
/// A run that is not at the last one violates, and is not asked.
pub(super) fn missed(setup: &Setup, flight: &Flight, measures: &Measures, limits: &Limits) -> Option<String> {
    if setup.program().is_none() || !limits.unfinished || flight.ended != Ended::Done {
        return None;
    }
    if flight.reached.last() == Some(&None) {
        return None;
    }
    let there = There::of(setup, flight, limits.deviation);
    let radii = measures.waypoints_within.iter().enumerate();
    let (waypoint, nearest_m) = radii
        .map(|(waypoint, radius)| (waypoint, *radius))
        .find(|(waypoint, radius)| !there.is_at(*waypoint, *radius))?;
    Some(Missed { waypoint, of: measures.waypoints_within.len(), nearest_m, accept_m: there.within }.in_words())
}

/// Every waypoint but the last that a program's `flight` was not within the acceptance radius of, after those before it
/// that it was at. Those that it was within the limit of the deviation of count as passed where runs are judged.
///
/// O(samples · waypoints²).
pub fn all_missed(setup: &Setup, flight: &Flight, waypoints: &[Point3<f64>]) -> Vec<Missed> {
    let there = There::of(setup, flight, None);
    let (mut been, mut missed) = (Vec::new(), Vec::new());
    for (waypoint, place) in waypoints.iter().enumerate().take(waypoints.len().saturating_sub(1)) {
        been.push(*place);
        let nearest_m = radii(&flight.track, &been).last().copied().unwrap_or(f64::INFINITY);
        if !there.is_at(waypoint, nearest_m) {
            // One that was left out does not hide those after it.
            been.pop();
            missed.push(Missed { waypoint, of: waypoints.len(), nearest_m, accept_m: there.within });
        }
    }
    missed
}

/// What counts as having been at a waypoint.
struct There<'a> {
    /// `execute.accept_m`, m.
    accept: f64,
    /// That, or the limit of the deviation if it is more, m.
    within: f64,
    reached: &'a [Option<f64>],
}

impl<'a> There<'a> {
    fn of(setup: &Setup, flight: &'a Flight, deviation: Option<f64>) -> Self {
        let accept = setup.scenario.executor().accept;
        Self { accept, within: accept.max(deviation.unwrap_or(0.0)), reached: &flight.reached }
    }

    fn is_at(&self, waypoint: usize, radius: f64) -> bool {
        // Programs may accept in a cylinder as high as it is wide, whose rim is farther than its radius.
        let is_in_rim = radius <= std::f64::consts::SQRT_2 * self.accept;
        radius <= self.within || (is_in_rim && self.reached.get(waypoint).is_some_and(Option::is_some))
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Isometry3;
    use serde_json::json;

    use super::*;
    use crate::campaign::testing::quadrotor;
    use crate::campaign::{Case, CaseNumber, CaseResult, Run, Scenario, Status, judge};

    const WAY: [[f64; 3]; 4] = [[3.0, 3.0, 3.0], [13.0, 3.0, 3.0], [13.0, 13.0, 3.0], [23.0, 3.0, 3.0]];

    fn track(points: &[[f64; 3]], every: f64) -> Track {
        let mut places: Vec<Point3<f64>> = vec![points[0].into()];
        for pair in points.windows(2) {
            let (a, b) = (Point3::from(pair[0]), Point3::from(pair[1]));
            let count = ((b - a).norm() / every).round().max(1.0) as usize;
            places.extend((1..=count).map(|i| a + (b - a) * (i as f64 / count as f64)));
        }
        let times = (0..places.len()).map(|i| i as f64 * 0.02).collect();
        let poses = places.iter().map(|p| Isometry3::translation(p.x, p.y, p.z)).collect();
        Track::new(times, poses, vec![]).unwrap()
    }

    /// What is judged of a run straight through `points` by nothing but its duration, with `more` limits.
    fn judged(points: &[[f64; 3]], command: Option<&str>, more: &serde_json::Value) -> CaseResult {
        let mut spec = json!({ "total_time": { "max_s": 100.0 } });
        spec.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        let scenario: Scenario = serde_json::from_value(json!({
            "hairpin": 1, "robot": quadrotor(), "world": { "size_m": [30.0, 30.0, 30.0] },
            "task": { "start_m": WAY[0], "end_m": WAY[3], "length": 4 },
            "execute": command.map_or_else(|| json!({}), |command| json!({ "command": command })), "spec": spec,
        }))
        .unwrap();
        let setup = Setup::new(scenario).unwrap();
        let case = Case::bare(CaseNumber(0), 1, WAY.map(Point3::from).to_vec());
        let track = track(points, 0.04);
        let end = track.times().last().copied();
        let flight = Flight { track, ended: Ended::Done, left_world: None, reached: vec![Some(0.0), None, None, end] };
        let run = Run { case: CaseNumber(0), run: 0, drawn: Vec::new(), outcome: Ok(flight), full_rate: None };
        judge(&setup, &case, &[run]).unwrap()
    }

    #[test]
    fn a_program_that_leaves_out_waypoints_is_no_pass() {
        let none = json!({});
        let skipped = judged(&[WAY[0], WAY[1], WAY[3]], Some("sim"), &none);
        assert_eq!(skipped.status, Status::Inconclusive, "{skipped:?}");
        let why = skipped.message.unwrap();
        // From (13, 13, 3) to the straight line along y = 3.
        assert!(why.starts_with("run 0: waypoint 2 of 0 to 3 was never reached: 10.00 m at the nearest, "), "{why}");
        assert!(why.ends_with(" m accepted"), "{why}");
        // Who was there passes, a limit of deviation accepts as far, and our own simulator is not asked.
        assert_eq!(judged(&WAY, Some("sim"), &none).status, Status::Pass);
        let far = json!({ "deviation": { "max_m": 12.0 } });
        assert_eq!(judged(&[WAY[0], WAY[1], WAY[3]], Some("sim"), &far).status, Status::Pass);
        assert_eq!(judged(&[WAY[0], WAY[1], WAY[3]], None, &none).status, Status::Pass);
        // A violation is one all the same.
        let late = judged(&[WAY[0], WAY[3]], Some("sim"), &json!({ "total_time": { "max_s": 0.1 } }));
        assert_eq!(late.status, Status::Fail, "{late:?}");
    }

    /// Between two samples as well, and only after those before.
    #[test]
    fn radii_are_of_the_way_in_order() {
        let way = WAY.map(Point3::from);
        let sparse = track(&WAY, 1e3);
        assert!(radii(&sparse, &way).iter().all(|radius| *radius < 1e-9));
        let beside = [[3.0, 3.5, 3.0], [23.0, 3.5, 3.0]];
        let near = radii(&track(&beside, 1e3), &[way[0], way[1], way[3]]);
        assert!(near.iter().all(|radius| (radius - 0.5).abs() < 1e-9), "{near:?}");
        // Waypoint 2 first, then 1: it is never at 2 after it was at 1.
        let swapped = radii(&track(&[WAY[0], WAY[2], WAY[1], WAY[3]], 0.5), &way);
        assert!(swapped[1] < 1e-9 + swapped[2] && swapped[2] > 1.0 && swapped[3] >= swapped[2], "{swapped:?}");
    }
}
