//! Attitudes that no vehicle is under way in: fallen over, or with its up axis down, as quaternions of another
//! convention are read.

use nalgebra::Vector3;

use super::Setup;
use super::implausible::Overturned;
use crate::judgement::{Measures, Violation};
use crate::trajectory::{ATTITUDE_UNKNOWN, Track};

/// So much beyond the tilt of its file a vehicle has fallen over, rad: 5°, which an estimate or a stone may make.
const ROOM: f64 = 0.087;

/// The first sample of `track` whose up axis is more than `most` (rad) from the vertical; `None` where none is, or
/// attitudes are not known.
fn beyond(track: &Track, most: f64) -> Option<Overturned> {
    if track.channel(ATTITUDE_UNKNOWN).is_some() {
        return None;
    }
    let tilt = |i: usize| libm::acos((track.poses()[i].rotation * Vector3::z()).z.clamp(-1.0, 1.0));
    let first = (0..track.len()).find(|i| tilt(*i) > most)?;
    let throughout = (0..track.len()).all(|i| tilt(i) > most);
    Some(Overturned { at_s: track.times()[first], tilt_rad: tilt(first), throughout })
}

/// Angle of its up axis from the vertical, rad, beyond which a vehicle of the scenario's robot is not as it should be;
/// what is no vehicle has no up axis.
fn most(setup: &Setup) -> Option<f64> {
    let bounded = setup.kind().most_tilt().map(|most| most + ROOM);
    bounded.or_else(|| setup.kind().room().map(|_| std::f64::consts::FRAC_PI_2))
}

/// Where a motion is beyond the tilt of its robot's file or, where that bounds none, has its up axis down.
pub(super) fn overturned(setup: &Setup, track: &Track) -> Option<Overturned> {
    beyond(track, most(setup)?)
}

/// The same of a motion of which the largest tilt alone is known, and its moment: nobody knows for how long.
pub(super) fn by_largest(setup: &Setup, measures: &Measures) -> Option<Overturned> {
    let tilt_rad = measures.max_tilt?.to_radians();
    (tilt_rad > most(setup)?).then_some(Overturned { at_s: measures.t_tilt, tilt_rad, throughout: false })
}

/// `found`, of a vehicle whose file bounds its tilt: it has fallen over.
pub(super) fn fallen(setup: &Setup, found: Option<Overturned>) -> Option<Overturned> {
    found.filter(|_| setup.kind().most_tilt().is_some())
}

/// That it has tipped over, as a violation; on the leg of `measures` that its time is in.
pub(super) fn tipped_over(found: &Overturned, track: &Track, measures: &Measures) -> Violation {
    let times = track.times();
    let first =
        if track.has_places() { times.first().copied() } else { times.last().map(|end| end - measures.total_time) };
    let begins = first.unwrap_or_default();
    let leg = measures.leg_after(found.at_s - begins).unwrap_or(measures.legs.len().saturating_sub(1));
    Violation { what: "tip-over".into(), value: found.at_s, limit: 0.0, unit: "s".into(), at: found.at_s, leg }
}

/// `found`, of a vehicle whose file bounds no tilt: its up axis points down; of what flies, and may turn over, where it
/// does all the way.
pub(super) fn upside_down(setup: &Setup, found: Option<Overturned>) -> Option<Overturned> {
    let flies = setup.kind().room()?.flies;
    found.filter(|found| setup.kind().most_tilt().is_none() && (found.throughout || !flies))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::{Isometry3, Point3, UnitQuaternion};
    use serde_json::{Value, json};

    use super::*;
    use crate::campaign::testing::quadrotor;
    use crate::campaign::{Case, CaseNumber, CaseResult, Run, Scenario, Status, judge};
    use crate::trajectory::{Ended, Flight};

    /// A shipped robot's table.
    fn robot(file: &str) -> Value {
        let path = format!("{}/../../data/robots/{file}.toml", env!("CARGO_MANIFEST_DIR"));
        toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
    }

    fn drives(file: &str) -> Value {
        json!({
            "hairpin": 1, "robot": robot(file),
            "world": { "terrain": { "generator": "flat", "size_m": 40, "cell_m": 0.25 } },
            "task": { "start": { "x_m": 20, "y_m": 20, "yaw_deg": 0 }, "length": 2, "leg_m": [2, 5] },
            "execute": { "command": "sim" }, "spec": { "limits": { "total_time_s": 1000 } },
        })
    }

    /// What is judged of a run by a program 4 m straight ahead in 100 s, with its roll (rad) over the share of the way.
    fn judged(scenario: Value, roll: &dyn Fn(f64) -> f64) -> CaseResult {
        let scenario: Scenario = serde_json::from_value(scenario).unwrap();
        let setup = Setup::new(scenario).unwrap();
        let way = [[20.0, 20.0, 5.0], [24.0, 20.0, 5.0]].map(Point3::from);
        let times: Vec<f64> = (0..=1000).map(|i| f64::from(i) * 0.1).collect();
        let poses = times.iter().map(|t| {
            let turn = UnitQuaternion::from_euler_angles(roll(t / 100.0), 0.0, 0.0);
            Isometry3::from_parts((way[0] + (way[1] - way[0]) * (t / 100.0)).coords.into(), turn)
        });
        let track = Track::new(times.clone(), poses.collect(), vec![]).unwrap();
        let flight = Flight { track, ended: Ended::Done, left_world: None, reached: vec![Some(0.0), Some(100.0)] };
        let case = Case::bare(CaseNumber(0), 1, way.to_vec());
        let run = Run { case: CaseNumber(0), run: 0, drawn: Vec::new(), outcome: Ok(flight), full_rate: None };
        judge(&setup, &case, &[run]).unwrap()
    }

    /// A rover on its back all the way was PASS.
    #[test]
    fn a_program_that_drives_on_its_back_is_no_pass() {
        let over = |_: f64| 3.1;
        let fails = judged(drives("rover/rocky8"), &over);
        assert_eq!((fails.status, fails.violations[0].what.as_str()), (Status::Fail, "tip-over"), "{fails:?}");
        // Beyond the 45° of its file from half of the way on; within them, and a little over, it stands.
        let late = judged(drives("rover/rocky8"), &|share: f64| if share > 0.5 { 0.9 } else { 0.0 });
        assert!((late.violations[0].at - 50.1).abs() < 1e-9 && late.status == Status::Fail, "{late:?}");
        assert_eq!(judged(drives("rover/rocky8"), &|_| 0.8).status, Status::Pass);
        // A car's file bounds no tilt: on its head nothing is known of it.
        let car = judged(drives("ground/car"), &over);
        assert_eq!(car.status, Status::Inconclusive, "{car:?}");
        let why = car.message.unwrap();
        assert!(why.contains("attitude: upside down (its up axis 178° from the vertical from t = 0.00 s on)"), "{why}");
        assert_eq!(judged(drives("ground/car"), &|_| 0.3).status, Status::Pass);
    }

    /// What flies may turn over, but not be so from its start to its end.
    #[test]
    fn flights_that_are_upside_down_throughout_decide_nothing() {
        let flies = || {
            json!({
                "hairpin": 1, "robot": quadrotor(), "world": { "size_m": [30.0, 30.0, 30.0] },
                "task": { "start_m": [20.0, 20.0, 5.0], "end_m": [24.0, 20.0, 5.0], "length": 2 },
                "execute": { "command": "sim" }, "spec": { "total_time": { "max_s": 1000.0 } },
            })
        };
        let over = judged(flies(), &|_| 3.1);
        assert!(over.message.as_ref().is_some_and(|why| why.contains("attitude: upside down")), "{over:?}");
        let flip = judged(flies(), &|share: f64| if share > 0.5 { 3.1 } else { 0.0 });
        assert_eq!((over.status, flip.status), (Status::Inconclusive, Status::Pass), "{flip:?}");
    }
}
