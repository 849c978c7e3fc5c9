//! Motions that no robot of the scenario's kind makes: times in another unit, or places of another run.
//!
//! Whoever tells times that are a thousandth of the truth keeps every limit of duration. Only what is beyond the
//! robot's own numbers by a wide factor is refused ([`Setup::ceiling`]), over a time in which noise of places counts
//! for little.

use nalgebra::Isometry3;

use super::implausible::Impossible;
use super::{Case, Setup};
use crate::trajectory::{Flight, Track};

/// What positions come to over so long (s) is a speed; over less it may be the noise of an estimate.
pub(super) const LONG_S: f64 = 1.0;

/// A step of a program's motion may come so much farther than anything moves: its places may be an estimate's, m.
const ROOM_M: f64 = 1.0;

/// The fastest part of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fastest {
    /// The sample that it begins at.
    pub(super) from: usize,
    /// Straight from there, m, without what the places' accuracy explains.
    pub(super) way_m: f64,
    /// In how long, s; > 0.
    pub(super) over_s: f64,
}

impl Fastest {
    /// m/s.
    pub(super) fn speed(&self) -> f64 {
        self.way_m / self.over_s
    }
}

/// The largest mean speed between two places of `track` over the least time from [`LONG_S`] on, within what lies
/// between two of `breaks` (indices of samples, rising); `None` where nothing is as long.
///
/// `sigma` is the standard deviation of a sample's place, m. O(samples).
pub(super) fn fastest(track: &Track, breaks: &[usize], sigma: &dyn Fn(usize) -> f64) -> Option<Fastest> {
    let (mut from, mut most) = (0, None::<Fastest>);
    for to in 0..track.len() {
        if breaks.binary_search(&to).is_ok() {
            from = to;
        }
        let since = |i: usize| track.times()[to] - track.times()[i];
        while from < to && since(from + 1) >= LONG_S {
            from += 1;
        }
        if since(from) >= LONG_S {
            let found = between(track, [from, to], since(from), sigma);
            most = most.filter(|so_far| so_far.speed() >= found.speed()).or(Some(found));
        }
    }
    most
}

/// Of a track that is shorter than [`LONG_S`]: how far it comes from its first place, in all of its time.
fn of_all(track: &Track, sigma: &dyn Fn(usize) -> f64) -> Option<Fastest> {
    let over_s = track.times().last()? - track.times().first()?;
    let all = (1..track.len()).map(|to| between(track, [0, to], over_s, sigma));
    all.max_by(|a, b| a.way_m.total_cmp(&b.way_m)).filter(|_| over_s > 0.0 && over_s < LONG_S)
}

fn between(track: &Track, [from, to]: [usize; 2], over_s: f64, sigma: &dyn Fn(usize) -> f64) -> Fastest {
    let way = (track.position(to) - track.position(from)).norm() - sigma(from) - sigma(to);
    Fastest { from, way_m: way.max(0.0), over_s }
}

/// What of a motion is beyond the ceiling of the scenario's robot; `None` where nothing is, or nothing bounds it.
pub(super) fn impossible(
    setup: &Setup,
    track: &Track,
    breaks: &[usize],
    sigma: &dyn Fn(usize) -> f64,
) -> Option<Impossible> {
    let Fastest { from, way_m, over_s } = fastest(track, breaks, sigma).or_else(|| of_all(track, sigma))?;
    let bound_m_s = setup.ceiling(over_s).filter(|bound| way_m > bound * over_s)?;
    Some(Impossible { from_s: track.times()[from], over_s, way_m, bound_m_s })
}

/// What of the run of a program of the user's is faster than anything of its kind. Our own simulators are not asked.
///
/// The waypoints that it reached are places as well, each known to the radius within which it counts as reached: of
/// what was left out nothing else tells.
pub(super) fn of_program(setup: &Setup, case: &Case, flight: &Flight) -> Option<Impossible> {
    setup.program()?;
    let accept = setup.scenario.executor().accept;
    let by_rows = |track: &Track| impossible(setup, track, &[], &|_| 0.0).or_else(|| leap(setup, track));
    let by_waypoints = || impossible(setup, &of_waypoints(case, flight)?, &[], &|_| accept);
    Some(&flight.track).filter(|track| track.has_places()).and_then(by_rows).or_else(by_waypoints)
}

/// The first step of a program's motion that comes a metre farther than all that is possible in its time: over a second
/// with rests before and after it, it is lost.
fn leap(setup: &Setup, track: &Track) -> Option<Impossible> {
    let times = track.times();
    (1..track.len()).find_map(|to| {
        let over_s = times[to] - times[to - 1];
        let way_m = (track.position(to) - track.position(to - 1)).norm();
        // It need not begin at rest.
        let bound_m_s = setup.ceiling(over_s.max(LONG_S)).filter(|bound| way_m > bound * over_s + ROOM_M)?;
        Some(Impossible { from_s: times[to - 1], over_s, way_m, bound_m_s })
    })
}

/// Where `flight` was when it reached its waypoints, those of one stamp but once; `None` where that is no motion.
fn of_waypoints(case: &Case, flight: &Flight) -> Option<Track> {
    let (mut times, mut poses) = (Vec::new(), Vec::new());
    for (place, time) in case.waypoints.iter().zip(&flight.reached) {
        if let Some(time) = time.filter(|time| times.last().is_none_or(|last| time > last)) {
            times.push(time);
            poses.push(Isometry3::translation(place.x, place.y, place.z));
        }
    }
    Track::new(times, poses, Vec::new()).ok()
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Point3;
    use serde_json::json;

    use super::*;
    use crate::campaign::testing::quadrotor;
    use crate::campaign::{CaseNumber, CaseResult, Run, Scenario, Status, judge};
    use crate::trajectory::{Channel, Ended, ROWS_LEFT_OUT};

    const WAY: [[f64; 3]; 2] = [[3.0, 3.0, 3.0], [23.0, 3.0, 3.0]];

    /// 20 m at 2 m/s, with times that are `share` of that.
    fn track(share: f64) -> Track {
        let times: Vec<f64> = (0..=500).map(|i| f64::from(i) * 0.02 * share).collect();
        let poses = (0..=500).map(|i| Isometry3::translation(3.0 + 0.04 * f64::from(i), 3.0, 3.0)).collect();
        Track::new(times, poses, vec![]).unwrap()
    }

    fn setup(command: Option<&str>) -> Setup {
        let scenario: Scenario = serde_json::from_value(json!({
            "hairpin": 1, "robot": quadrotor(), "world": { "size_m": [30.0, 30.0, 30.0] },
            "task": { "start_m": WAY[0], "end_m": WAY[1], "length": 2 },
            "execute": command.map_or_else(|| json!({}), |command| json!({ "command": command })),
            "spec": { "total_time": { "max_s": 100.0 } },
        }))
        .unwrap();
        Setup::new(scenario).unwrap()
    }

    fn judged(command: Option<&str>, share: f64) -> CaseResult {
        let case = Case::bare(CaseNumber(0), 1, WAY.map(Point3::from).to_vec());
        let track = track(share);
        let end = track.times().last().copied();
        let flight = Flight { track, ended: Ended::Done, left_world: None, reached: vec![Some(0.0), end] };
        let run = Run { case: CaseNumber(0), run: 0, drawn: Vec::new(), outcome: Ok(flight), full_rate: None };
        judge(&setup(command), &case, &[run]).unwrap()
    }

    #[test]
    fn times_of_another_unit_are_no_pass() {
        assert_eq!(judged(Some("sim"), 1.0).status, Status::Pass);
        let thousandth = judged(Some("sim"), 1e-3);
        assert_eq!(thousandth.status, Status::Inconclusive, "{thousandth:?}");
        let why = thousandth.message.unwrap();
        let words =
            "run 0: 20.00 m in 0.0100 s from t = 0.00 s on are 2000.0 m/s, and ten times what its file allows is ";
        assert!(why.starts_with(words), "{why}");
        // Our own simulator is not asked.
        assert_eq!(judged(None, 1e-3).status, Status::Pass);
    }

    /// A second at each end, and nothing in between: in the mean over a second it is no faster than may be.
    #[test]
    fn who_leaps_is_no_pass() {
        let (setup, case) = (setup(Some("sim")), Case::bare(CaseNumber(0), 1, WAY.map(Point3::from).to_vec()));
        let leaping = |length: f64| {
            let times: Vec<f64> = (0..=200).map(|i| 0.01 * f64::from(i)).collect();
            let place = |t: &f64| Isometry3::translation(3.0 + if *t > 1.0 { length } else { 0.0 }, 3.0, 3.0);
            let track = Track::new(times.clone(), times.iter().map(place).collect(), vec![]).unwrap();
            of_program(&setup, &case, &Flight { track, ended: Ended::Done, left_world: None, reached: vec![Some(0.0)] })
        };
        let found = leaping(20.0).unwrap();
        assert!((found.way_m - 20.0).abs() < 1e-9 && (found.over_s - 0.01).abs() < 1e-9, "{found:?}");
        assert_eq!((leaping(1.5), leaping(0.0)), (None, None), "an estimate that is set right");
    }

    /// Where rows were left out the waypoints tell as much, and what stands in their place tells nothing.
    #[test]
    fn who_reaches_waypoints_too_soon_is_found_without_rows() {
        let (setup, case) = (setup(Some("sim")), Case::bare(CaseNumber(0), 1, WAY.map(Point3::from).to_vec()));
        let at = |end: f64| {
            let left_out = Channel { name: ROWS_LEFT_OUT.into(), values: vec![1.0; 2] };
            let poses = [1e9, 0.0].map(|x| Isometry3::translation(x, 0.0, 0.0)).to_vec();
            let track = Track::new(vec![0.0, end], poses, vec![left_out]).unwrap();
            let flight = Flight { track, ended: Ended::Done, left_world: None, reached: vec![Some(0.0), Some(end)] };
            of_program(&setup, &case, &flight)
        };
        assert_eq!(at(10.0), None);
        let found = at(0.01).unwrap();
        assert!(found.way_m < 20.0 && found.way_m > 15.0 && found.over_s == 0.01, "{found:?}");
    }

    /// Ten times as fast as the file says is not refused, and neither is a jump, which is no speed.
    #[test]
    fn what_is_only_fast_is_left_alone() {
        let setup = setup(Some("sim"));
        let most = setup.swiftness().speed.unwrap();
        let times: Vec<f64> = (0..=100).map(|i| f64::from(i) * 0.02).collect();
        let at = |speed: f64, jump: f64| {
            let place = |t: &f64| Isometry3::translation(speed * t + if *t > 1.0 { jump } else { 0.0 }, 0.0, 0.0);
            let poses = times.iter().map(place).collect();
            impossible(&setup, &Track::new(times.clone(), poses, vec![]).unwrap(), &[], &|_| 0.0)
        };
        assert_eq!((at(1.1 * most, 0.0), at(1.0, 5.0)), (None, None));
        let ceiling = setup.ceiling(1.0).unwrap();
        assert!(ceiling > 2.0 * most && setup.ceiling(0.01).unwrap() < ceiling, "{ceiling} {most}");
        let beyond = at(1.1 * ceiling, 0.0).unwrap();
        assert!((beyond.speed() - 1.1 * ceiling).abs() < 1e-6 && beyond.over_s >= LONG_S, "{beyond:?}");
    }
}
