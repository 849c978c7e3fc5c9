//! Limits that follow from what is ordinary: of many random feasible cases a given share breaks them.
//!
//! A quantile of random feasible cases, with its distribution-free interval: the limit that a stated share of
//! ordinary missions breaks. Nothing is assumed of the distribution.

use serde_json::{Map, Value};

use super::digits::{rounded_up, signed_digits};
use super::judge::{measures_of, unlike};
use super::scenario::Asked;
use super::{Case, Run, Setup};
use crate::judgement::{Limits, Measures, Quantile, exceeded_by, violations};

/// Confidence of the intervals.
const CONFIDENCE: f64 = 0.95;
/// Fewer cases give no limit.
/// An interval of a small share needs them.
pub const LEAST: usize = 200;

/// One key of `[spec]` that a limit stands in.
///
/// Several keys limit the same measure, one for each kind of robots; which ones apply is the scenario's.
struct Key {
    key: &'static str,
    /// The limit that stands there.
    now: fn(&Limits) -> Option<f64>,
    /// What it limits.
    of: fn(&Measures) -> Option<f64>,
    /// From the unit of both to that of the key.
    factor: f64,
    /// Whether less is worse.
    least: bool,
}

const fn key(
    key: &'static str,
    now: fn(&Limits) -> Option<f64>,
    of: fn(&Measures) -> Option<f64>,
    (factor, least): (f64, bool),
) -> Key {
    Key { key, now, of, factor, least }
}

const KEYS: &[Key] = &[
    key("spec.deviation.max_m", |l| l.deviation, Measures::deviation, (1.0, false)),
    key("spec.overshoot.max_m", |l| l.overshoot, |m| Some(m.max_overshoot()), (1.0, false)),
    key("spec.clearance.min_m", |l| l.clearance, |m| m.min_clearance, (1.0, true)),
    key("spec.acceleration.max_m_s2", |l| l.acceleration, Measures::acceleration, (1.0, false)),
    key("spec.total_time.max_s", |l| l.total_time, |m| Some(m.total_time), (1.0, false)),
    key("spec.limits.path_deviation_m", |l| l.deviation, Measures::deviation, (1.0, false)),
    key("spec.limits.tip_over_margin_deg", |l| l.tip_over_margin, |m| m.min_tip_over_margin, (1.0, true)),
    key("spec.limits.clearance_m", |l| l.clearance, |m| m.min_clearance, (1.0, true)),
    key("spec.limits.total_time_s", |l| l.total_time, |m| Some(m.total_time), (1.0, false)),
    key("spec.path.max_mm", |l| l.deviation, Measures::deviation, (1e3, false)),
    key("spec.arrival.max_late_ms", |l| l.late, |m| m.latest.map(|late| late.by), (1e3, false)),
];

/// What the runs of a case came to.
///
/// Turned so that larger is worse, in the key's unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Of every key that limits are proposed for, its worst value over all runs, larger being worse; infinite where a
    /// run crashed or did not finish, `None` where it was not measured.
    worst: Vec<Option<f64>>,
    /// Whether a run crashed or did not finish.
    ended_badly: bool,
    /// Whether a run left the world, a violation beside any limit.
    pub left_world: bool,
}

/// A limit that the wanted share of cases breaks.
///
/// `value` is `None` with a `reason`: too few cases, a share that the interval does not reach, values that are all the
/// same up to there, a measure that no run has.
#[derive(Debug, Clone, PartialEq)]
pub struct Proposal {
    /// The key.
    pub field: &'static str,
    /// The limit, in the key's unit, rounded to where no more cases break it: upper limits up, lower ones down; `None`
    /// where there is none.
    pub value: Option<f64>,
    /// Digits that it is told with: three, or as many as keep it within its interval.
    ///
    /// What many cases come to alike, at a ceiling of the robot's say, has an interval narrower than three digits.
    pub digits: usize,
    /// Its 95 % interval, in the key's unit.
    pub interval: Option<[f64; 2]>,
    /// Cases that it follows from.
    pub cases: usize,
    /// Of these, cases that break `value`: beyond it, not at it.
    pub broken_by: Option<usize>,
    /// Why there is none, in a sentence's part.
    pub reason: Option<String>,
}

/// The keys that limits are proposed for: those of the scenario's limits, or that of the deviation where it has none.
fn keys(setup: &Setup) -> Vec<&'static Key> {
    let head = setup.scenario.head();
    let own = || KEYS.iter().filter(|key| head.limits.contains(&key.key));
    let given: Vec<&Key> = own().filter(|key| (key.now)(&head.terms.limits).is_some()).collect();
    if given.is_empty() { own().take(1).collect() } else { given }
}

/// What the runs of `case` came to; `None` where one was not flown or cannot be judged.
///
/// One run that cannot be judged leaves the whole case out: its worst is not known.
pub fn outcome(setup: &Setup, case: &Case, runs: &[Run]) -> Option<Outcome> {
    let keys = keys(setup);
    let mut found = Outcome { worst: vec![None; keys.len()], ended_badly: false, left_world: false };
    for run in runs {
        let measures = measures_of(setup, case, run)?;
        let flight = run.outcome.as_ref().ok()?;
        // What no robot of the file does says nothing of what is ordinary.
        if unlike(setup, case, run).is_some() {
            return None;
        }
        let events = Limits {
            unfinished: setup.scenario.asked() != Asked::Nothing,
            contact: setup.program().is_some(),
            ..Limits::default()
        };
        let events = violations(&measures, flight, &events);
        found.ended_badly |= events.iter().any(|event| event.is_crash() || event.is_unfinished());
        found.left_world |= flight.left_world.is_some();
        for (worst, key) in found.worst.iter_mut().zip(&keys) {
            let Some(value) = (key.of)(&measures) else { continue };
            let value = if key.least { -value } else { value };
            *worst = Some(worst.map_or(value, |worst: f64| worst.max(value)));
        }
    }
    if found.ended_badly {
        found.worst.iter_mut().for_each(|worst| *worst = Some(f64::INFINITY));
    }
    Some(found)
}

/// The limits that the share `broken` of cases like these break, for every limit that the scenario has or, where it has
/// none, for the deviation.
///
/// A case breaks a limit that one of its runs breaks, and any limit where one crashes or does not finish: how far off
/// it would have been nobody knows. Fewer than 200 cases, and fewer than the interval takes, give no number.
///
/// `broken` in 0 … 1. The value is an order statistic of the cases' worst values; its interval is that of a binomial
/// count at 95 %.
pub fn propose(setup: &Setup, outcomes: &[Outcome], broken: f64) -> Vec<Proposal> {
    let badly = outcomes.iter().filter(|outcome| outcome.ended_badly).count();
    let propose = |(place, key): (usize, &&'static Key)| {
        let values: Vec<f64> = outcomes.iter().filter_map(|outcome| outcome.worst[place]).collect();
        let cases = values.len();
        let none = |reason: String| Proposal {
            field: key.key,
            value: None,
            digits: 0,
            interval: None,
            cases,
            broken_by: None,
            reason: Some(reason),
        };
        let few = format!("{cases} cases were measured");
        // Of what ends badly it is not known whether it would have been measured.
        let ended_well = || outcomes.iter().filter(|outcome| !outcome.ended_badly);
        let unmeasured = badly < outcomes.len() && ended_well().all(|outcome| outcome.worst[place].is_none());
        let limit = match exceeded_by(&values, broken, CONFIDENCE) {
            _ if unmeasured => return none("it is not measured in this scenario".into()),
            _ if cases == badly && cases > 0 => {
                return none("every case crashes or does not finish".into());
            }
            _ if cases < LEAST => return none(format!("{few}, and {LEAST} are the least that a limit follows from")),
            None => return none(format!("{few}, too few for an interval of what {} % break", 100.0 * broken)),
            Some(limit) => limit,
        };
        if limit.high.is_infinite() {
            return none(format!(
                "{badly} of {cases} cases crash or do not finish, whatever the limit, so that it may be that more than {} % \
                 break any",
                100.0 * broken
            ));
        }
        let Quantile { value, low, high } = limit;
        let scale = if key.least { -key.factor } else { key.factor };
        let broken_by = values.iter().filter(|worst| **worst > value).count();
        if value == high {
            // Of what is the same for many no limit divides a share: at it fewer break it, short of it far more.
            let same = values.iter().filter(|worst| **worst == value).count();
            return none(format!(
                "{same} of {cases} cases come to the same {}, and {broken_by} to worse: no limit is one that {} % break",
                signed_digits(scale * value),
                100.0 * broken
            ));
        }
        let ends = if key.least { [high, low] } else { [low, high] };
        // Turned so that larger is worse: rounded up fewer break it, never more.
        let (told, digits) = rounded_up(key.factor * value, key.factor * high);
        let broken_by = values.iter().filter(|worst| **worst > told / key.factor).count();
        Proposal {
            field: key.key,
            value: Some(if key.least { -told } else { told }),
            digits,
            interval: Some(ends.map(|end| scale * end)),
            cases,
            broken_by: Some(broken_by),
            reason: None,
        }
    };
    keys(setup).iter().enumerate().map(propose).collect()
}

/// The scenario's `[spec]` with the proposed limits in it: the value of each of its keys.
pub fn spec(setup: &Setup, proposals: &[Proposal]) -> Map<String, Value> {
    let mut spec = match setup.scenario.section("spec") {
        Some(Value::Object(spec)) => spec,
        _ => Map::new(),
    };
    for proposal in proposals {
        let Some(value) = proposal.value else { continue };
        let path: Vec<&str> = proposal.field.split('.').skip(1).collect();
        let [table, key] = path.as_slice() else { continue };
        let table = spec.entry(*table).or_insert_with(|| Value::Object(Map::new()));
        if let (Value::Object(table), Some(number)) = (table, serde_json::Number::from_f64(value)) {
            table.insert((*key).to_owned(), Value::Number(number));
        }
    }
    spec.retain(|_, value| !value.is_null());
    spec
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::{Isometry3, Point3};
    use serde_json::json;

    use super::*;
    use crate::campaign::testing::quadrotor;
    use crate::campaign::{CaseNumber, Scenario};
    use crate::trajectory::{Ended, Flight, Track};

    fn setup(spec: Value) -> Setup {
        let scenario: Scenario = serde_json::from_value(json!({
            "hairpin": 1,
            "robot": quadrotor(),
            "world": { "size_m": [20.0, 20.0, 20.0] },
            "task": { "start_m": [2.0, 2.0, 5.0], "end_m": [14.0, 14.0, 12.0], "length": 5 },
            "spec": spec,
        }))
        .unwrap();
        Setup::new(scenario).unwrap()
    }

    fn outcomes(count: usize, badly: usize) -> Vec<Outcome> {
        let one = |i: usize| {
            let ended_badly = i < badly;
            let worst = vec![Some(if ended_badly { f64::INFINITY } else { i as f64 / 100.0 })];
            Outcome { worst, ended_badly, left_world: false }
        };
        (0..count).map(one).collect()
    }

    #[test]
    fn a_limit_is_what_the_share_breaks() {
        let setup = setup(json!({ "deviation": { "max_m": 9.0, "from": "path", "corner_m": 1.0 } }));
        let found = propose(&setup, &outcomes(200, 0), 0.05);
        let [only] = found.as_slice() else { panic!("{found:?}") };
        assert_eq!((only.field, only.cases, &only.reason), ("spec.deviation.max_m", 200, &None));
        assert_eq!(only.broken_by, Some(10));
        assert!((only.value.unwrap() - 1.89).abs() < 1e-12, "{only:?}");
        let [low, high] = only.interval.unwrap();
        assert!((low - 1.83).abs() < 1e-12 && (high - 1.96).abs() < 1e-12, "{only:?}");
        assert_eq!(
            json!(spec(&setup, &found)),
            json!({ "deviation": { "max_m": 1.89, "from": "path", "corner_m": 1.0 } })
        );
    }

    /// Rounded down, a limit is broken by more than it promises.
    #[test]
    fn a_limit_is_rounded_so_that_no_more_break_it() {
        let worst = |i: usize| 2.0737 + 0.005 * (i as f64 - 189.0);
        let of = |asked: Value, sign: f64| {
            let one = |i| Outcome { worst: vec![Some(sign + worst(i))], ended_badly: false, left_world: false };
            let setup = setup(asked);
            let found = propose(&setup, &(0..200).map(one).collect::<Vec<_>>(), 0.05).remove(0);
            let told = found.value.unwrap();
            (told, found.broken_by.unwrap(), json!(spec(&setup, &[found])))
        };
        // One of the ten beyond it is within the rounded one.
        let (told, broken_by, spec) = of(json!({ "deviation": { "max_m": 9.0 } }), 0.0);
        assert_eq!((told, broken_by, (0..200).filter(|i| worst(*i) > 2.08).count()), (2.08, 9, 9));
        assert_eq!(spec["deviation"]["max_m"], 2.08);
        // Where less is worse, values are turned: −2.9263 is a clearance of 2.9263 m.
        let (told, broken_by, spec) = of(json!({ "clearance": { "min_m": 0.5 } }), -5.0);
        assert_eq!((told, broken_by), (2.92, 9));
        assert_eq!(spec["clearance"]["min_m"], 2.92);
    }

    /// Accelerations at a robot's ceiling lie closer together than three digits tell.
    #[test]
    fn a_limit_is_told_within_its_interval() {
        let setup = setup(json!({ "acceleration": { "max_m_s2": 5.0 } }));
        let at_a_ceiling = |i: usize| Outcome {
            worst: vec![Some(9.893_779 + 1e-9 * i as f64)],
            ended_badly: false,
            left_world: false,
        };
        let found = propose(&setup, &(0..200).map(at_a_ceiling).collect::<Vec<_>>(), 0.05);
        let [low, high] = found[0].interval.unwrap();
        let told = json!(spec(&setup, &found))["acceleration"]["max_m_s2"].as_f64().unwrap();
        assert!((low..=high).contains(&told) && high - low < 1e-6, "{told} of {low} … {high}");
    }

    /// On flat ground all vehicles stand alike: none is beyond the value that all have.
    #[test]
    fn what_many_have_alike_is_no_limit_and_who_breaks_one_is_counted() {
        let setup = setup(json!("none"));
        let proposed = |worst: &dyn Fn(usize) -> f64| {
            let one = |i| Outcome { worst: vec![Some(worst(i))], ended_badly: false, left_world: false };
            propose(&setup, &(0..200).map(one).collect::<Vec<_>>(), 0.05).remove(0)
        };
        let alike = proposed(&|_| 0.05);
        assert_eq!((alike.value, alike.interval, alike.broken_by), (None, None, None));
        let reason = alike.reason.unwrap();
        assert!(reason.starts_with("200 of 200 cases come to the same 0.0500, and 0 to worse"), "{reason}");
        // Two are beyond it, up to the upper end of the interval (rank 197) nobody is.
        let few = proposed(&|i| if i < 198 { 0.05 } else { 0.06 });
        assert!(few.reason.unwrap().starts_with("198 of 200 cases come to the same 0.0500, and 2 to worse"));
        // A handful that is the same about the limit: seven break it, not ten.
        let some = proposed(&|i| if (185..193).contains(&i) { 1.9 } else { i as f64 / 100.0 });
        assert_eq!((some.value, some.broken_by), (Some(1.9), Some(7)));
    }

    /// A program's stamps in another unit are no duration to limit.
    #[test]
    fn what_no_robot_does_gives_no_limit() {
        let scenario: Scenario = serde_json::from_value(json!({
            "hairpin": 1, "robot": quadrotor(), "world": { "size_m": [30.0, 30.0, 30.0] },
            "task": { "start_m": [3.0, 3.0, 3.0], "end_m": [23.0, 3.0, 3.0], "length": 2 },
            "execute": { "command": "sim" }, "spec": { "total_time": { "max_s": 100.0 } },
        }))
        .unwrap();
        let setup = Setup::new(scenario).unwrap();
        let waypoints = [3.0, 23.0].map(|x| Point3::new(x, 3.0, 3.0)).to_vec();
        let case = Case::bare(CaseNumber(0), 1, waypoints);
        let of = |share: f64| {
            let times = (0..=500).map(|i| f64::from(i) * 0.02 * share).collect();
            let poses = (0..=500).map(|i| Isometry3::translation(3.0 + 0.04 * f64::from(i), 3.0, 3.0)).collect();
            let track = Track::new(times, poses, vec![]).unwrap();
            let reached = vec![Some(0.0), Some(10.0 * share)];
            let flight = Flight { track, ended: Ended::Done, left_world: None, reached };
            let run = Run { case: CaseNumber(0), run: 0, drawn: Vec::new(), outcome: Ok(flight), full_rate: None };
            outcome(&setup, &case, &[run])
        };
        assert!((of(1.0).unwrap().worst.last().unwrap().unwrap() - 10.0).abs() < 1e-9, "{:?}", of(1.0));
        assert_eq!(of(1e-3), None);
    }

    #[test]
    fn too_little_gives_no_number_and_says_why() {
        let setup = setup(json!("none"));
        let reason = |outcomes: &[Outcome], share| {
            let found = propose(&setup, outcomes, share).remove(0);
            assert_eq!((found.value, found.interval), (None, None));
            found.reason.unwrap()
        };
        assert!(reason(&outcomes(199, 0), 0.05).contains("199 cases were measured, and 200 are the least"));
        assert!(reason(&outcomes(200, 0), 0.01).contains("too few for an interval of what 1 % break"));
        assert!(reason(&outcomes(200, 9), 0.05).contains("9 of 200 cases crash"));
        assert!(reason(&outcomes(300, 300), 0.05).contains("every case crashes"));
        let mut blind = outcomes(300, 118);
        blind[118..].iter_mut().for_each(|outcome| outcome.worst[0] = None);
        assert!(reason(&blind, 0.05).contains("it is not measured in this scenario"));
        assert!(reason(&[], 0.05).contains("0 cases were measured"));
        let found = propose(&setup, &outcomes(200, 0), 0.05);
        assert_eq!(json!(spec(&setup, &found)), json!({ "deviation": { "max_m": 1.89 } }));
    }
}
