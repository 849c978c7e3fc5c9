//! Who made a case, and what it was asked for, against its waypoints.

use nalgebra::Point3;

use crate::campaign::Case;
use crate::trajectory::{Profile, ProfileLeg};
use crate::verification::{Collector, Proof};

/// Who made a case: whoever opens its folder knows, the case itself does not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::campaign) enum Made {
    /// A search, by the scenario's `[task]`: it is held to that.
    Searched,
    /// Somebody else, as a mission that has a task of its own.
    Elsewhere,
}

/// Where trajectories begin and end, and of how many waypoints they are.
///
/// Coordinates in m; the last is left out of what lies in a plane, and an end that is anywhere is `None`.
pub(in crate::campaign) struct Task<'a> {
    pub(in crate::campaign) start: &'a [f64],
    pub(in crate::campaign) end: Option<&'a [f64]>,
    pub(in crate::campaign) length: u64,
}

/// Waypoints are written with all their digits, m, and so are times, as a share.
const SAME: f64 = 1e-9;

/// Adds to `proof` what does not hold of the task of a case that was searched for: `task.start`, `task.end` (distances,
/// m) and `task.length`.
pub(in crate::campaign) fn verify_task(task: &Task, case: &Case, proof: &mut Proof) {
    let apart = |point: Option<&Point3<f64>>, asked: &[f64]| {
        let square =
            |point: &Point3<f64>| asked.iter().enumerate().map(|(i, at)| (point[i] - at) * (point[i] - at)).sum();
        point.map_or(f64::NAN, |point| f64::sqrt(square(point)))
    };
    let mut found = Collector::about(&mut proof.findings, "task");
    found.above("start", apart(case.waypoints.first(), task.start), SAME, "m");
    if let Some(end) = task.end {
        found.above("end", apart(case.waypoints.last(), end), SAME, "m");
    }
    let (length, asked) = (case.waypoints.len() as f64, task.length as f64);
    found.unless(length == asked, "length", length, asked, "");
}

/// Adds to `proof` what does not hold of the times of a case with the legs of `profile`: each is the case's own
/// (`legs[k].leg_time`, to 10⁻⁹ of it: what others read of the case), and together they are at most `longest`
/// (`limits.time`), s.
pub(in crate::campaign) fn verify_times(case: &Case, profile: &Profile, longest: f64, proof: &mut Proof) {
    for (number, ProfileLeg { duration, .. }) in profile.legs.iter().enumerate() {
        let told = case.leg_times.get(number).copied().unwrap_or(f64::NAN);
        let mut found = Collector::on_leg(&mut proof.findings, number, 0.0);
        found.above("leg_time", (told - duration).abs(), SAME * duration, "s");
    }
    let all: f64 = profile.legs.iter().map(|leg| leg.duration).sum();
    Collector::about(&mut proof.findings, "limits").unless(all <= longest * (1.0 + SAME), "time", all, longest, "s");
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::campaign::CaseNumber;

    #[test]
    fn what_was_searched_for_begins_ends_and_is_as_long_as_asked() {
        let points = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [2.0, 0.0, 1.0]].map(Point3::from);
        let case = Case::bare(CaseNumber(0), 0, points.to_vec());
        let fields = |start: &[f64], end: Option<&[f64]>, length: u64| {
            let mut proof = Proof::default();
            verify_task(&Task { start, end, length }, &case, &mut proof);
            proof.findings.into_iter().map(|finding| finding.field).collect::<Vec<_>>()
        };
        let (start, end): (&[f64], &[f64]) = (&[0.0, 0.0, 1.0], &[2.0, 0.0]);
        assert!(fields(start, Some(end), 3).is_empty() && fields(start, None, 3).is_empty());
        assert_eq!(fields(end, Some(&[1.9, 0.0]), 4), ["task.start", "task.end", "task.length"]);
    }

    #[test]
    fn times_are_those_of_the_legs_and_within_the_limit() {
        let case = Case { leg_times: vec![1.0, 2.0], ..Case::bare(CaseNumber(0), 0, vec![Point3::origin(); 3]) };
        let fields = |durations: &[f64], longest: f64| {
            let mut proof = Proof::default();
            let leg = |duration: &f64| ProfileLeg { duration: *duration, coefficients: [[0.0; 8]; 3] };
            verify_times(&case, &Profile { legs: durations.iter().map(leg).collect() }, longest, &mut proof);
            proof.findings.into_iter().map(|finding| finding.field).collect::<Vec<_>>()
        };
        assert!(fields(&[1.0, 2.0], 3.0).is_empty() && fields(&[1.0, 2.0], f64::INFINITY).is_empty());
        assert_eq!(fields(&[1.0, 2.0], 2.9), ["limits.time"]);
        assert_eq!(fields(&[1.0, 2.1], 9.0), ["legs[1].leg_time"]);
        assert_eq!(fields(&[1.0, 2.0, 1.0], 9.0), ["legs[2].leg_time"], "which the case does not tell");
    }
}
