//! A judge who takes what was measured finds the same events without the motion.

use hairpin::campaign::implausible::{Implausible, Impossible, Overturned};
use hairpin::judgement::{Limits, Measures, Settings, Unresolved, measure, violations};
use nalgebra::Point3;

use super::*;

/// Flies along x for `moving` s at 1 m/s, then stands until it is called off at 20 s; leaves the world at `left`.
fn run(moving: usize, left: Option<f64>) -> Run {
    let times: Vec<f64> = (0..=200).map(|step| f64::from(step) / 10.0).collect();
    let place = |t: &f64| Isometry3::translation(t.min(moving as f64), 0.0, 0.0);
    let legs = times.iter().map(|t| if *t < 2.0 { 0.0 } else { 1.0 }).collect();
    let leg = Channel { name: "leg".into(), values: legs };
    let track = Track::new(times.clone(), times.iter().map(place).collect(), vec![leg]).unwrap();
    let reached = vec![Some(0.0), Some(2.0), None];
    let flight = Flight { track, ended: Ended::Time, left_world: left, reached };
    Run { case: CaseNumber(0), run: 0, drawn: Vec::new(), outcome: Ok(flight), full_rate: None }
}

#[test]
fn what_stood_still_has_stalled_without_its_motion_too() {
    let waypoints = [0.0, 2.0, 40.0].map(|x| Point3::new(x, 0.0, 0.0));
    for (moving, left, expected) in [
        (6, None, "stalled 5.9"),
        (20, None, "unfinished 20.0"),
        (16, None, "unfinished 20.0"),
        (6, Some(1.0), "left-world 1.0, stalled 5.9"),
        (6, Some(9.0), "left-world 9.0, stalled 5.9"),
        (20, Some(1.0), "left-world 1.0, unfinished 20.0"),
    ] {
        let run = run(moving, left);
        let flight = run.outcome.as_ref().unwrap();
        let measures = measure(&flight.track, &waypoints, &Settings::default()).unwrap();
        let found = |flight: &Flight| {
            let found = violations(&measures, flight, &Limits::default());
            found.iter().map(|one| format!("{} {:.1}", one.what, one.at)).collect::<Vec<_>>().join(", ")
        };
        assert_eq!(found(flight), expected, "{moving} {left:?}");
        let bare = RunFacts::of(&run).without_track().unwrap();
        assert_eq!(found(bare.outcome.as_ref().unwrap()), expected, "without its motion: {moving} {left:?}");
    }
}

#[test]
fn what_was_not_measured_is_still_not_when_it_is_read() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("part-00000.parquet");
    let waypoints = [0.0, 2.0, 40.0].map(|x| Point3::new(x, 0.0, 0.0));
    let measured = |corner: f64| {
        let run = run(6, None);
        let settings = Settings { corner, ..Settings::default() };
        let measures = measure(&run.outcome.as_ref().unwrap().track, &waypoints, &settings).unwrap();
        let full_rate =
            FullRate { from: DeviationFrom::Leg, corner, measures, met: BTreeSet::new(), implausible: None };
        RunFacts { run: usize::from(corner > 0.0), full_rate: Some(Box::new(full_rate)), ..RunFacts::of(&run) }
    };
    write_facts(&path, &[measured(0.0), measured(90.0)]).unwrap();
    let read = read_facts(&path).unwrap();
    let off = |facts: &RunFacts| facts.full_rate.as_ref().unwrap().measures.deviation().is_some();
    assert_eq!(read.values().map(off).collect::<Vec<_>>(), [true, false]);
}

#[test]
fn what_may_hide_is_still_known_when_it_is_read() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("part-00000.parquet");
    let waypoints = [0.0, 2.0, 40.0].map(|x| Point3::new(x, 0.0, 0.0));
    let run = run(6, None);
    let measures = measure(&run.outcome.as_ref().unwrap().track, &waypoints, &Settings::default()).unwrap();
    let measures = Measures {
        most_between: Some(1.0),
        overshoot_between: Some(0.5),
        clearance_between: Some(-0.25),
        acceleration_over: Some(0.125),
        edge_between: Some(-0.75),
        acceleration_unresolved: Some(Unresolved { by: 0.5, step: 0.001, over: 0.25 }),
        waypoints_within: vec![0.0, 0.25, 6.5],
        ..measures
    };
    let full_rate =
        FullRate { from: DeviationFrom::Leg, corner: 0.0, measures, met: BTreeSet::new(), implausible: None };
    write_facts(&path, &[RunFacts { full_rate: Some(Box::new(full_rate.clone())), ..RunFacts::of(&run) }]).unwrap();
    let read = read_facts(&path).unwrap();
    let read: Vec<_> = read.values().map(|facts| &facts.full_rate.as_ref().unwrap().measures).collect();
    assert_eq!(read, [&full_rate.measures]);
}

#[test]
fn what_no_robot_does_is_still_known_when_it_is_read() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("part-00000.parquet");
    let waypoints = [0.0, 2.0, 40.0].map(|x| Point3::new(x, 0.0, 0.0));
    let run = run(6, None);
    let measures = measure(&run.outcome.as_ref().unwrap().track, &waypoints, &Settings::default()).unwrap();
    let speed = Impossible { from_s: 1.0, over_s: 0.02, way_m: 15.0, bound_m_s: 70.1 };
    let attitude = Overturned { at_s: 0.1, tilt_rad: 3.1, throughout: true };
    let found = [
        None,
        Some(Implausible::default()),
        Some(Implausible { speed: Some(speed), attitude: None }),
        Some(Implausible { speed: Some(speed), attitude: Some(attitude) }),
    ];
    let facts = |(number, implausible): (usize, &Option<Implausible>)| {
        let (measures, implausible) = (measures.clone(), *implausible);
        let full_rate = FullRate { from: DeviationFrom::Leg, corner: 0.0, measures, met: BTreeSet::new(), implausible };
        RunFacts { run: number, full_rate: Some(Box::new(full_rate)), ..RunFacts::of(&run) }
    };
    let all: Vec<RunFacts> = found.iter().enumerate().map(facts).collect();
    write_facts(&path, &all).unwrap();
    let read = read_facts(&path).unwrap();
    let read: Vec<_> = read.into_values().map(|facts| facts.full_rate.unwrap().implausible).collect();
    assert_eq!(read, found);
    // Runs that nobody looks at need no room for it.
    write_facts(&path, &all[..1]).unwrap();
    assert!(!Table::read(&path).unwrap().has("motion_looked_at"));
    // A part of it is none.
    let broken = Impossible { over_s: 0.0, ..speed };
    let found = Some(Implausible { speed: Some(broken), attitude: None });
    write_facts(&path, &[facts((0, &found))]).unwrap();
    let told = read_facts(&path).unwrap_err().to_string();
    assert!(told.contains("`too_fast_over_s`, row 0: 0, must be > 0"), "{told}");
}

#[test]
fn a_run_that_is_there_twice_is_refused() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("part-00000.parquet");
    let facts = RunFacts::of(&run(6, None));
    write_facts(&path, &[facts.clone(), RunFacts { run: 1, ..facts.clone() }]).unwrap();
    assert_eq!(read_facts(&path).unwrap().len(), 2);
    write_facts(&path, &[facts.clone(), RunFacts { ended: "crash".into(), ..facts }]).unwrap();
    let told = read_facts(&path).unwrap_err().to_string();
    assert!(told.contains("column `run`, row 1: 0, must be there once in case 0000"), "{told}");
}

/// What is done to what was measured.
type Change<'a> = &'a dyn Fn(&mut Measures);

/// What an editor, or a broken disk, makes of a row is refused with case, run and bound; it was judged.
#[test]
fn what_no_run_can_have_measured_is_refused() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("part-00000.parquet");
    let waypoints = [0.0, 2.0, 40.0].map(|x| Point3::new(x, 0.0, 0.0));
    let run = run(6, None);
    let measures = measure(&run.outcome.as_ref().unwrap().track, &waypoints, &Settings::default()).unwrap();
    let read = |change: Change<'_>| {
        let mut measures = measures.clone();
        change(&mut measures);
        let full_rate =
            FullRate { from: DeviationFrom::Leg, corner: 0.0, measures, met: BTreeSet::new(), implausible: None };
        write_facts(&path, &[RunFacts { full_rate: Some(Box::new(full_rate)), ..RunFacts::of(&run) }]).unwrap();
        read_facts(&path).map(drop)
    };
    read(&|_| ()).unwrap();
    let changes: [(Change<'_>, [&str; 3]); 8] = [
        (&|m| m.max_deviation = -1.0, ["`max_deviation_m`", "-1", "≥ 0"]),
        (&|m| m.total_time = -3.0, ["`total_time_s`", "-3", "≥ 0"]),
        (&|m| m.leg_worst = 77, ["`leg_worst`", "77", "0 to 1, one of the legs"]),
        (&|m| m.t_worst = 1e9, ["`t_worst_s`", "1000000000", "0 to 20 s"]),
        (&|m| m.total_time = 0.5, ["_s`", "row 0", "19.5 to 20 s"]),
        (&|m| m.legs[1].max_deviation = 9.0, ["`leg_max_deviation_m`", "9", "the `max_deviation_m`"]),
        (&|m| m.mean_deviation = 9.0, ["`mean_deviation_m`", "9", "the `max_deviation_m`"]),
        (
            &|m| m.legs[0].max_acceleration = 1e6,
            ["`leg_max_acceleration_m_s2`", "1000000", "the `max_acceleration_m_s2`"],
        ),
    ];
    for (change, words) in changes {
        let told = read(change).unwrap_err().to_string();
        let all = words.into_iter().chain(["part-00000.parquet", "case 0000, run 0"]);
        assert!(all.into_iter().all(|word| told.contains(word)), "{told}");
    }
}
