//! Recordings with known faults against plans with known times.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

use super::*;
use crate::judgement::Verdict;
use crate::math::cubic::Cubic;
use crate::math::random::{Stream, standard_normals, stream};
use crate::trajectory::{Channel, PlannedMove, PlannedPath, Track};

fn pose(p: &Point3<f64>, angle: f64) -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::from(p.coords), UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle))
}

/// Corners with an angle about z each, joined by straight lines of one second each with a rest of 0.1 s after.
fn plan(corners: &[([f64; 3], f64)]) -> PlannedPath {
    let (mut times, mut poses, mut moves) = (vec![0.0], vec![pose(&corners[0].0.into(), corners[0].1)], Vec::new());
    for (number, pair) in corners.windows(2).enumerate() {
        let (from, to) = (Point3::from(pair[0].0), Point3::from(pair[1].0));
        for i in 1..=50 {
            let share = f64::from(i) / 50.0;
            times.push(1.1 * number as f64 + share);
            poses.push(pose(&(from + (to - from) * share), pair[0].1 + share * (pair[1].1 - pair[0].1)));
        }
        moves.push(PlannedMove { name: format!("p{number}→p{}", number + 1), end: times.len() - 1, stops: true });
        times.push(1.1 * (number + 1) as f64 - 1e-3);
        poses.push(poses[poses.len() - 1]);
    }
    PlannedPath::new(Track::new(times, poses, Vec::new()).unwrap(), moves)
}

/// A to B, back, and out elsewhere through where it came from.
fn revisiting() -> PlannedPath {
    plan(&[
        ([0.0, 0.0, 0.0], 0.0),
        ([0.3, 0.0, 0.0], 0.0),
        ([0.0, 0.0, 0.0], 0.0),
        ([0.3, 0.1, 0.0], 0.3),
        ([0.1, -0.2, 0.1], 0.3),
    ])
}

/// The plan as a recording of 10 ms samples whose time runs as `clock` says, moved by `shift`.
fn record(path: &PlannedPath, until: f64, clock: impl Fn(f64) -> f64, shift: impl Fn(f64) -> Vector3<f64>) -> Track {
    let (times, poses) = (path.track().times(), path.track().poses());
    let n = (until / 0.01).round() as usize;
    let sampled = (0..n).map(|i| {
        let t = clock(i as f64 * 0.01);
        let j = times.partition_point(|time| *time <= t).clamp(1, times.len() - 1);
        let share = ((t - times[j - 1]) / (times[j] - times[j - 1])).clamp(0.0, 1.0);
        let mut at = poses[j - 1].lerp_slerp(&poses[j], share);
        at.translation.vector += shift(t);
        at
    });
    Track::new((0..n).map(|i| i as f64 * 0.01).collect(), sampled.collect(), Vec::new()).unwrap()
}

fn still(_: f64) -> Vector3<f64> {
    Vector3::zeros()
}

fn measure(path: &PlannedPath, recording: &Track) -> Measured {
    measure_moves(path, recording, &MeasureSettings::default()).unwrap()
}

/// Within both.
const NONE: [Vec<usize>; 2] = [Vec::new(), Vec::new()];

/// Moves farther off than 0.5 mm, and those later than 20 ms.
fn beyond(measured: &Measured) -> [Vec<usize>; 2] {
    let moves = |is_beyond: fn(&MoveMeasures) -> bool| {
        let all = measured.moves.iter().enumerate();
        all.filter(|(_, one)| is_beyond(one)).map(|(index, _)| index).collect()
    };
    [
        moves(|one| one.deviation.is_some_and(|most| most > 5e-4)),
        moves(|one| one.late().is_some_and(|late| late > 0.02)),
    ]
}

#[test]
fn what_was_planned_is_on_time_and_on_its_path() {
    let path = revisiting();
    let measured = measure(&path, &record(&path, 4.6, |t| t, still));
    for one in &measured.moves {
        assert!(one.deviation.unwrap() < 1e-9 && one.late().unwrap().abs() < 2e-4, "{one:?}");
        assert!((one.duration.unwrap() - one.planned_duration).abs() < 3e-4);
    }
    assert!((measured.moves[1].planned - 2.1).abs() < 0.01 && (measured.sample - 0.01).abs() < 1e-12);
    assert_eq!(beyond(&measured), NONE);
}

#[test]
fn a_deviation_belongs_to_its_move_even_where_paths_are_revisited() {
    let path = revisiting();
    // On the way back only, aside by 0.8 mm at most, at 1.6 s.
    let aside = |t: f64| Vector3::y() * 8e-4 * (1.0 - (t - 1.6).abs() / 0.3).max(0.0);
    let measured = measure(&path, &record(&path, 4.6, |t| t, aside));
    let back = &measured.moves[1];
    assert!((back.deviation.unwrap() - 8e-4).abs() < 1e-9 && (back.deviation_at - 1.6).abs() < 0.011, "{back:?}");
    for index in [0, 2, 3] {
        assert!(measured.moves[index].deviation.unwrap() < 1e-9);
    }
}

#[test]
fn offsets_are_told_and_removed_only_when_asked() {
    let path = revisiting();
    let late = record(&path, 4.7, |t| t - 0.05, still);
    let measured = measure(&path, &late);
    let offset = measured.offset.unwrap();
    assert!((offset.seconds - 0.05).abs() < 3e-4 && offset.spread < 1e-3 && !offset.removed, "{offset:?}");
    assert_eq!(beyond(&measured), [vec![], vec![0, 1, 2, 3]]);
    let settings = MeasureSettings { clock: Clock::OffsetRemoved, ..MeasureSettings::default() };
    let removed = measure_moves(&path, &late, &settings).unwrap();
    assert!(removed.offset.unwrap().removed && beyond(&removed) == NONE);
    // One late move of four does not move the median.
    let once = measure(&path, &record(&path, 4.8, |t| if t < 3.5 { t } else { t - 0.2 }, still));
    assert!(once.offset.unwrap().seconds.abs() < 1e-3, "{:?}", once.offset);
}

#[test]
fn a_slow_move_is_late_itself_and_makes_the_later_ones_late() {
    let path = revisiting();
    // Halfway through the third move the arm waits for 60 ms.
    let waits = |t: f64| if t < 2.7 { t } else { (t - 0.06).max(2.7) };
    let measured = measure(&path, &record(&path, 4.8, waits, still));
    let late: Vec<i64> = measured.moves.iter().map(|one| (1e3 * one.late().unwrap()).round() as i64).collect();
    assert_eq!(late, [0, 0, 60, 60]);
    let longer = |one: &MoveMeasures| (1e3 * (one.duration.unwrap() - one.planned_duration)).round() as i64;
    assert_eq!(measured.moves.iter().map(longer).collect::<Vec<_>>(), [0, 0, 60, 0]);
    assert_eq!(beyond(&measured), [vec![], vec![2, 3]]);
}

#[test]
fn targets_behind_the_end_of_a_recording_are_not_arrived_at() {
    let path = revisiting();
    let measured = measure(&path, &record(&path, 2.5, |t| t, still));
    let arrived: Vec<bool> = measured.moves.iter().map(|one| one.arrived.is_some()).collect();
    assert_eq!(arrived, [true, true, false, false]);
}

/// Who runs beside the path is on time along it, at whatever distance.
#[test]
fn who_is_never_near_a_target_has_not_come_to_it() {
    let path = revisiting();
    let beside = |aside: f64, is_limited: bool| {
        measure(&path, &record(&path, 4.6, |t| t, |_| Vector3::z() * aside)).beside(is_limited)
    };
    // The longer move beside the first target is 0.3 m long.
    let told = beside(0.04, false).unwrap();
    assert!(
        told.starts_with(
            "the target of move 1 (p0→p1) was passed and never come to: 40.0 mm at the nearest, 30.0 mm taken"
        ),
        "{told}"
    );
    assert_eq!((beside(0.02, false), beside(0.04, true)), (None, None));
    // Turns are looked at whatever limits positions: the third move turns by 0.3 rad.
    let unturned: Vec<Isometry3<f64>> = (record(&path, 4.6, |t| t, still).poses().iter())
        .map(|pose| Isometry3::from_parts(pose.translation, UnitQuaternion::identity()))
        .collect();
    let times = (0..unturned.len()).map(|i| i as f64 * 0.01).collect();
    let unturned = Track::new(times, unturned, Vec::new()).unwrap();
    let told = measure(&path, &unturned).beside(true).unwrap();
    assert!(
        told.starts_with("the target of move 3 (p2→p3)") && told.contains("17.2° at the nearest, 1.7° taken"),
        "{told}"
    );
    let places_alone = MeasureSettings { turn_weight: 0.0, ..MeasureSettings::default() };
    assert_eq!(measure_moves(&path, &unturned, &places_alone).unwrap().beside(true), None);
    // What was passed before the recording begins is not seen.
    let on = plan(&[([0.0; 3], 0.0), ([0.3, 0.0, 0.0], 0.0), ([0.3, 0.3, 0.0], 0.0), ([0.6, 0.3, 0.0], 0.0)]);
    let begun = thinned(&record(&on, 3.5, |t| t, still), |_, t| t > 1.3);
    assert_eq!(measure(&on, &begun).beside(false), None);
}

/// A tool that is turned wrong at every target turns through what is asked for somewhere on its way, too.
#[test]
fn who_is_turned_so_elsewhere_has_not_come_to_a_target() {
    let path = revisiting();
    let plain = record(&path, 4.6, |t| t, still);
    // Off by 0.1 rad about every target, one way before the middle of each move and the other behind it.
    let off = |t: f64| 0.1 * ((t % 1.1 - 0.5) / 0.1).clamp(-1.0, 1.0) * if t % 2.2 < 1.1 { 1.0 } else { -1.0 };
    let turn = |angle: f64| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), angle);
    let poses = plain.times().iter().zip(plain.poses());
    let poses = poses.map(|(t, pose)| Isometry3::from_parts(pose.translation, pose.rotation * turn(off(*t)))).collect();
    let swung = measure(&path, &Track::new(plain.times().to_vec(), poses, Vec::new()).unwrap());
    for is_limited in [false, true] {
        let told = swung.beside(is_limited).unwrap();
        let words =
            "the target of move 1 (p0→p1) was passed and never come to: 5.7° at the nearest, 1.1° taken for there";
        assert!(told.starts_with(words), "{told}");
    }
    assert_eq!(measure(&path, &plain).beside(false), None);
}

/// No arrival is no lateness, and so within any limit of it.
#[test]
fn who_rests_before_a_target_for_good_never_arrives() {
    let path = revisiting();
    // A twentieth of the last move, which is 0.374 m long, is left: near by what counts as near.
    let rests = measure(&path, &record(&path, 6.0, |t| t.min(4.25), still));
    assert_eq!((rests.moves[3].late(), rests.beside(false)), (None, None));
    let told = rests.unarrived().unwrap();
    let words = "the target of move 4 (p3→p4) was never arrived at: 18.7 mm of the way left in the end (1° counts as \
                 1.7 mm), at 1.0 mm it counts as there";
    assert!(told.starts_with(words), "{told}");
    assert_eq!(measure(&path, &record(&path, 4.6, |t| t, still)).unarrived(), None);
    // Where it rests, and is turned wrong there, it has not come to its target either.
    let lay = |t: f64| 0.2 * ((t - 4.0) / 0.2).clamp(0.0, 1.0);
    let plain = record(&path, 6.0, |t| t.min(4.25), still);
    let turn = |angle: f64| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), angle);
    let poses = plain.times().iter().zip(plain.poses());
    let poses = poses.map(|(t, pose)| Isometry3::from_parts(pose.translation, pose.rotation * turn(lay(*t)))).collect();
    let told = measure(&path, &Track::new(plain.times().to_vec(), poses, Vec::new()).unwrap()).beside(true).unwrap();
    let words = "the target of move 4 (p3→p4) was never come to: 11.5° at the nearest, 1.1° taken for there";
    assert!(told.starts_with(words), "{told}");
}

#[test]
fn turns_on_the_spot_arrive_by_orientation() {
    let path = plan(&[([0.0; 3], 0.0), ([0.0; 3], 1.0), ([0.1, 0.0, 0.0], 1.0)]);
    let measured = measure(&path, &record(&path, 2.3, |t| t - 0.03, still));
    for one in &measured.moves {
        assert!((one.late().unwrap() - 0.03).abs() < 1e-3, "{one:?}");
    }
}

#[test]
fn told_moves_and_thinned_alignment_give_the_same() {
    let path = revisiting();
    let plain = record(&path, 4.6, |t| t - 0.02, |t| Vector3::z() * (2e-4 * (7.0 * t).sin()));
    let told: Vec<f64> = plain.times().iter().map(|t| (t / 1.1).floor().min(3.0)).collect();
    let channels = vec![Channel { name: "move".into(), values: told }];
    let with = Track::new(plain.times().to_vec(), plain.poses().to_vec(), channels).unwrap();
    assert_eq!(measure(&path, &plain), measure(&path, &with));
    // So many samples that they are not all aligned at once.
    let n = 20_000;
    let fine = |i: usize| plain.poses()[i * plain.len() / n];
    let times = (0..n).map(|i| 4.6 * i as f64 / n as f64).collect();
    let dense = Track::new(times, (0..n).map(fine).collect(), Vec::new()).unwrap();
    let (dense, plain) = (measure(&path, &dense), measure(&path, &plain));
    for (a, b) in dense.moves.iter().zip(&plain.moves) {
        assert!((a.arrived.unwrap() - b.arrived.unwrap()).abs() < 0.011);
        assert!((a.deviation.unwrap() - b.deviation.unwrap()).abs() < 1e-12);
    }
}

/// 48 moves around a polygon.
fn long() -> PlannedPath {
    let corner = |i: usize| {
        let (s, c) = (0.7 * i as f64).sin_cos();
        ([0.3 + 0.1 * c, 0.1 * s, 0.002 * i as f64], 0.0)
    };
    plan(&(0..=48).map(corner).collect::<Vec<_>>())
}

/// Repeats whose every move takes a little more or less, by a normal number of 1.5 ms; `slower` adds to moves.
fn repeats(path: &PlannedPath, runs: usize, random: &mut Stream, slower: &[(usize, f64)]) -> Vec<Measured> {
    let exact = measure(path, &record(path, 53.0, |t| t, still));
    let one = |random: &mut Stream| {
        let mut measured = exact.clone();
        for (index, one) in measured.moves.iter_mut().enumerate() {
            let [jitter] = standard_normals::<1>(random);
            let more = slower.iter().find(|(slow, _)| *slow == index).map_or(0.0, |(_, more)| *more);
            one.duration = Some(one.planned_duration + 1.5e-3 * jitter + more);
        }
        measured
    };
    (0..runs).map(|_| one(random)).collect()
}

#[test]
fn regressions_read_as_designed() {
    let path = long();
    let mut random = stream(1);
    let (old, new) =
        (repeats(&path, 5, &mut random, &[]), repeats(&path, 5, &mut random, &[(17, 0.041), (3, 0.02), (30, 0.03)]));
    let (old, new) = (Release { name: "7.14", runs: &old }, Release { name: "7.15", runs: &new });
    let comparison = compare(&old, &new, &Band::default()).unwrap();
    assert_eq!((comparison.count(Outcome::Worse), comparison.worst().unwrap().index), (3, 17));
    let joined = |comparison: &Comparison| {
        let program = ProgramComparison { program: "0000".into(), comparison: comparison.clone(), trends: Vec::new() };
        let releases = vec![comparison.baseline.clone(), comparison.new.clone()];
        Regression { releases, programs: vec![program] }.join(Verdict::of("PASS 1/1", 0), true)
    };
    let verdict = joined(&comparison);
    let worst = comparison.worst().unwrap();
    assert_eq!(
        verdict.sentence,
        format!(
            "REGRESSION 7.15 against 7.14 (5 + 5 runs): 3/48 moves outside the baseline's band, worst p17→p18 +{:.0} ms (band ±{:.0} ms); \
             all still within spec",
            1e3 * worst.difference(),
            1e3 * worst.band
        )
    );
    assert_eq!(verdict.exit_code, 1);
    assert!((worst.difference() - 0.041).abs() < 3e-3 && (0.004..0.012).contains(&worst.band), "{worst:?}");
    // The other way round everything is better, and that is told.
    let back = compare(&new, &old, &Band::default()).unwrap();
    let verdict = joined(&back);
    assert!(verdict.sentence.starts_with("PASS 1/1; against "), "{}", verdict.sentence);
    assert!(verdict.sentence.ends_with("against 7.15: no move outside the baseline's band; 3 better than the band"));
    assert_eq!(verdict.exit_code, 0);
}

#[test]
fn equal_releases_seldom_differ() {
    let path = long();
    let mut random = stream(2);
    let (mut outside, trials) = (0, 12);
    for _ in 0..trials {
        let (a, b) = (repeats(&path, 3, &mut random, &[]), repeats(&path, 3, &mut random, &[]));
        // Without floors: the quantile alone.
        let band = Band { sigma: 2.0, least_deviation: 1.0, least_samples: 0.0 };
        let found = compare(&Release { name: "a", runs: &a }, &Release { name: "b", runs: &b }, &band).unwrap();
        outside += found.count(Outcome::Worse) + found.count(Outcome::Better);
    }
    // 4.55 % of 12 · 48 moves, with four standard errors.
    let expected = 0.0455 * (48 * trials) as f64;
    assert!((outside as f64 - expected).abs() < 4.0 * expected.sqrt(), "{outside} {expected}");
}

#[test]
fn violations_come_before_regressions() {
    let path = revisiting();
    let aside = |t: f64| Vector3::z() * 6.5e-4 * (1.0 - (t - 1.6).abs() / 0.3).max(0.0);
    let (good, bad) =
        (measure(&path, &record(&path, 4.6, |t| t, still)), measure(&path, &record(&path, 4.6, |t| t, aside)));
    let (old, new) = ([good.clone(), good.clone()], [good, bad]);
    let comparison =
        compare(&Release { name: "1", runs: &old }, &Release { name: "2", runs: &new[1..] }, &Band::default()).unwrap();
    let program = ProgramComparison { program: "0000".into(), comparison, trends: Vec::new() };
    let joined = Regression { releases: vec!["1".into(), "2".into()], programs: vec![program] };
    let verdict = joined.join(Verdict::of("FAIL 1/1", 1), true);
    assert!(verdict.sentence.starts_with("FAIL 1/1; against 1: 1/4 moves outside the baseline's band"), "{verdict:?}");
    assert!(verdict.sentence.ends_with("worst p1→p2 +0.65 mm (band ±0.02 mm)"), "{verdict:?}");
    assert_eq!(verdict.exit_code, 1);
    let lost = measure(&path, &record(&path, 2.5, |t| t, still));
    let comparison =
        compare(&Release { name: "1", runs: &old }, &Release { name: "2", runs: &[lost] }, &Band::default());
    assert_eq!(comparison.unwrap().lost, [2, 3]);
}

#[test]
fn trends_follow_releases() {
    let path = revisiting();
    let slower = |more: f64| {
        let mut measured = measure(&path, &record(&path, 4.6, |t| t, still));
        measured.moves[2].duration = measured.moves[2].duration.map(|duration| duration + more);
        [measured.clone(), measured]
    };
    let runs = [0.0, 0.004, 0.008, 0.02].map(slower);
    let releases: Vec<Release> = runs.iter().map(|runs| Release { name: "x", runs }).collect();
    let found = trend(&releases).unwrap();
    let third = found.iter().find(|one| one.index == 2 && one.metric == Metric::Duration).unwrap();
    // Slopes 4, 4, 12, 4, 8, 20/3 ms: the median is 16/3.
    assert!((third.slope.unwrap() - 0.016 / 3.0).abs() < 1e-9 && third.correlation == Some(1.0), "{third:?}");
    let first = found.iter().find(|one| one.index == 0).unwrap();
    assert_eq!((first.slope, first.correlation), (Some(0.0), None));
    assert!(trend(&[]).unwrap().is_empty());
}

#[test]
fn what_cannot_be_judged_is_refused() {
    let path = revisiting();
    let good = measure(&path, &record(&path, 4.6, |t| t, still));
    let one = Track::new(vec![0.0], vec![Isometry3::identity()], Vec::new()).unwrap();
    let settings = MeasureSettings::default();
    assert_eq!(measure_moves(&path, &one, &settings), Err(MovesError::Samples { found: 1 }));
    let odd = MeasureSettings { arrival: f64::NAN, ..settings };
    assert!(matches!(measure_moves(&path, &one, &odd), Err(MovesError::Setting { field: "arrival", .. })));
    let single = [good.clone()];
    let release = Release { name: "7.14", runs: &single };
    let error = compare(&release, &release, &Band::default()).unwrap_err();
    assert_eq!(error.to_string(), "`7.14` has 1 runs: must be at least 2");
    let mut other = good.clone();
    other.moves[1].name = "elsewhere".into();
    let runs = [good, other];
    let error = compare(&Release { name: "7.14", runs: &runs }, &release, &Band::default()).unwrap_err();
    assert_eq!(error.to_string(), "`7.14`, run 1: move 1 is `elsewhere`, expected `p1→p2`");
}

/// A point of which the acceleration alone is known.
struct Accelerated<'a> {
    recording: &'a Track,
    most: f64,
}

impl Between for Accelerated<'_> {
    fn hidden(&self, i: usize) -> f64 {
        let seconds = self.recording.times()[i + 1] - self.recording.times()[i];
        self.most * seconds * seconds / 8.0
    }

    fn half(&self, i: usize) -> f64 {
        0.5 * (self.recording.position(i + 1) - self.recording.position(i)).norm()
    }

    fn chord(&self, i: usize, count: usize) -> Vec<Point3<f64>> {
        let (a, b) = (self.recording.position(i), self.recording.position(i + 1));
        (0..=count).map(|n| a + (b - a) * (n as f64 / count as f64)).collect()
    }
}

/// The samples of `recording` that `keep` says, by number and time.
fn thinned(recording: &Track, keep: impl Fn(usize, f64) -> bool) -> Track {
    let kept: Vec<usize> = (0..recording.len()).filter(|i| keep(*i, recording.times()[*i])).collect();
    let times = kept.iter().map(|i| recording.times()[*i]).collect();
    Track::new(times, kept.iter().map(|i| recording.poses()[*i]).collect(), Vec::new()).unwrap()
}

fn not_shown(path: &PlannedPath, recording: &Track, most: f64, estimated: bool, limits: [Option<f64>; 2]) -> Unseen {
    let between = Accelerated { recording, most };
    let estimated = estimated.then_some("acceleration");
    let hidden = Hidden { path: limits[0], late: limits[1], corner: 0.0, between: &between, estimated };
    unseen(path, recording, &MeasureSettings::default(), &hidden, &measure(path, recording)).unwrap()
}

/// a h²/8 beside the chord: what it leaves within the limit is decided, what it does not is open.
#[test]
fn what_a_bound_excludes_is_decided() {
    let path = revisiting();
    let dense = record(&path, 4.5, |t| t, still);
    let at = |every: usize, most: f64, limit: f64| {
        let recording = thinned(&dense, |i, _| i % every == 0);
        not_shown(&path, &recording, most, false, [Some(limit), None]).open
    };
    // 10 ms and 1 m/s²: 12.5 µm. 100 ms: 1.25 mm, and the chords at the corners.
    assert_eq!(at(1, 1.0, 5e-4), None);
    assert_eq!(at(1, 30.0, 5e-4), None);
    assert!(at(1, 50.0, 5e-4).is_some(), "0.625 mm are not excluded");
    assert!(at(10, 1.0, 1e-3).is_some());
    assert_eq!(at(10, 1.0, 5e-2), None);
    let told = at(10, 1.0, 1e-3).unwrap();
    assert!(told.contains("mm off the path are not excluded") && told.contains("the limit is 1.00 mm"), "{told}");
    assert!(!told.contains("estimated"), "{told}");
}

#[test]
fn gaps_are_told_against_the_plan() {
    let path = revisiting();
    let dense = record(&path, 4.5, |t| t, still);
    let hole = thinned(&dense, |_, t| !(0.5..2.6).contains(&t));
    for estimated in [true, false] {
        let unseen = not_shown(&path, &hole, 1.0, estimated, [Some(0.01), None]);
        let gap = &unseen.longest;
        assert!((gap.seconds - 2.11).abs() < 1e-9 && (gap.from - 0.49).abs() < 1e-9, "{gap:?}");
        assert_eq!((gap.moves, gap.names.clone()), ([0, 2], ["p0→p1".into(), "p2→p3".into()]));
        assert!((gap.share - 2.11 / 4.3).abs() < 0.02, "{gap:?}");
        assert_eq!(unseen.seen, [3, 4]);
        let told = unseen.open.unwrap();
        assert!(told.starts_with("a gap of 2.110 s from t = 0.490 s (211 times the usual interval) hides moves 1 (p0→p1) to 3 (p2→p3), 49 % of the plan: "), "{told}");
        assert_eq!(told.contains("estimated"), estimated, "{told}");
    }
    // Within what the limit allows it hides nothing that matters.
    let short = thinned(&dense, |_, t| !(0.50..0.56).contains(&t));
    assert_eq!(not_shown(&path, &short, 1.0, true, [Some(0.01), None]).open, None);
    assert!(not_shown(&path, &short, 1.0, true, [None, None]).open.is_none());
}

/// An estimate decides no way in silence: with it the bound is told, and what the arm's own number would decide.
#[test]
fn what_an_estimate_does_not_exclude_is_open() {
    let path = revisiting();
    let dense = record(&path, 4.6, |t| t, still);
    let last = dense.len() - 1;
    for every in [10, 50, 100] {
        let even = thinned(&dense, |i, _| i % every == 0 || i == last);
        let unseen = not_shown(&path, &even, 40.0, true, [Some(0.015), None]);
        assert_eq!(unseen.seen, [4, 4], "{every}");
        assert!(unseen.not_excluded.unwrap() > 0.015, "{every}");
        let why = unseen.open.unwrap();
        assert!(
            why.contains("(a_max h²/8 of the arm's joints, estimated: `acceleration` in its file decides"),
            "{why}"
        );
    }
    // At the usual rates nothing is hidden, whatever it rests on.
    let dense_enough = not_shown(&path, &dense, 40.0, true, [Some(0.015), None]);
    assert_eq!((dense_enough.open, dense_enough.not_excluded), (None, None));
}

#[test]
fn what_is_missing_at_the_ends_is_not_passed_over() {
    let path = revisiting();
    let early = record(&path, 3.9, |t| t, still);
    let told = not_shown(&path, &early, 1.0, true, [Some(0.01), None]).open.unwrap();
    assert!(told.starts_with("the log ends at t = 3.890 s, ") && told.contains("on move 4 of 4 (p3→p4)"), "{told}");
    let late = thinned(&record(&path, 4.5, |t| t, still), |_, t| t > 0.5);
    let told = not_shown(&path, &late, 1.0, true, [Some(0.01), None]).open.unwrap();
    assert!(told.starts_with("the log begins at t = 0.510 s, ") && told.contains("on move 1 of 4"), "{told}");
}

/// Whoever stands where the program begins and ends is past all of it by the path alone.
#[test]
fn a_program_that_comes_back_is_not_run_by_standing_there() {
    let path = plan(&[([0.0; 3], 0.0), ([0.3, 0.0, 0.0], 0.0), ([0.3, 0.3, 0.0], 0.0), ([0.0; 3], 0.0)]);
    let open = |recording: &Track, limit| not_shown(&path, recording, 1.0, false, [limit, Some(10.0)]).open;
    let whole = record(&path, 3.4, |t| t, still);
    assert_eq!((open(&whole, Some(0.02)), open(&whole, None)), (None, None));
    // It sets out along the first line, goes over to the last after 30 mm and comes back.
    let turns = |t: f64| if t < 0.1 { t } else { (t + 3.0).clamp(3.1, 3.2) };
    let back = record(&path, 3.4, turns, still);
    for limit in [Some(0.02), None] {
        let told = open(&back, limit).unwrap();
        assert!(told.contains("mm away from it: it was left out") && told.contains("and move 3 (p2→p3)"), "{told}");
    }
}

/// An arrival in a gap is late for certain only if it was not there yet when the limit was over.
#[test]
fn arrivals_in_gaps_are_late_only_where_the_gap_says_so() {
    let path = revisiting();
    let dense = record(&path, 4.6, |t| t, still);
    let around = |from: f64, to: f64| thinned(&dense, |_, t| !(from..to).contains(&t));
    let late = |recording: &Track, limit: f64| not_shown(&path, recording, 1.0, true, [None, Some(limit)]);
    // Move 2 is to arrive at 3.2 s; the arm is seen before at 2.99 s, and at 3.5 s on its way on.
    let open = late(&around(3.0, 3.5), 0.1);
    assert!(open.open.as_ref().unwrap().contains("p2→p3 arrived between"), "{open:?}");
    assert_eq!(late(&around(3.0, 3.5), 0.5).open, None);
    assert_eq!(late(&dense, 0.01).open, None);
    // Half a second late in truth, seen not yet there when 0.2 s were over: late, whatever the gap.
    let slow = record(&path, 5.2, |t| t - 0.5, still);
    let slow = thinned(&slow, |_, t| !(3.55..3.9).contains(&t));
    let proven = late(&slow, 0.2);
    assert!(proven.late_proven.is_some(), "{proven:?}");
}

/// Who comes to rest between two samples is late by a straight line between them, and need not be.
#[test]
fn an_arrival_is_known_to_the_interval_of_its_samples() {
    let path = revisiting();
    // Samples 100 ms apart, and each move ends in the middle between two.
    let sparse = |late: f64| thinned(&record(&path, 5.0, |t| t - late, still), |i, _| i % 10 == 5);
    let on_time = sparse(0.0);
    for one in &measure(&path, &on_time).moves {
        let [least, most] = one.late_between().unwrap();
        assert!(least < -0.04 && most > 0.04 && (most - least - 0.1).abs() < 1e-9, "{one:?}");
        assert!(one.late().unwrap() > 0.04, "the estimate is late: {one:?}");
    }
    let late = |recording: &Track, limit: f64| not_shown(&path, recording, 1.0, true, [None, Some(limit)]);
    let open = late(&on_time, 0.02);
    let told = open.open.unwrap();
    assert!(told.starts_with("p0→p1 arrived between -46.") && told.contains(" and 53."), "{told}");
    assert!(told.contains("samples are 0.100 s apart there, the limit is 20.0 ms"), "{told}");
    assert_eq!(open.late_proven, None);
    let within = late(&on_time, 0.06);
    assert_eq!((within.open, within.late_proven), (None, None));
    // 200 ms late: seen 150 ms late on its way, and there 250 ms late.
    let slow = sparse(0.2);
    assert!(late(&slow, 0.1).late_proven.is_some());
    let either = late(&slow, 0.18);
    assert!(either.open.is_some() && either.late_proven.is_none(), "{either:?}");
    let within = late(&slow, 0.26);
    assert_eq!((within.open, within.late_proven), (None, None));
    // An offset that is taken off is known no better than the arrivals that it is estimated from.
    let settings = MeasureSettings { clock: Clock::OffsetRemoved, ..MeasureSettings::default() };
    let removed = measure_moves(&path, &record(&path, 4.7, |t| t - 0.05, still), &settings).unwrap();
    for one in &removed.moves {
        let [least, most] = one.late_between().unwrap();
        assert!((-0.021..0.0).contains(&least) && (0.0..0.021).contains(&most), "{one:?}");
    }
}

#[test]
fn what_was_passed_before_the_recording_begins_is_not_late() {
    let path = plan(&[([0.0; 3], 0.0), ([0.3, 0.0, 0.0], 0.0), ([0.3, 0.3, 0.0], 0.0), ([0.6, 0.3, 0.0], 0.0)]);
    let begun = thinned(&record(&path, 3.5, |t| t, still), |_, t| t > 1.3);
    let measured = measure(&path, &begun);
    assert_eq!(measured.moves[0].late(), None);
    assert!(measured.moves[0].late_between().unwrap()[0] == f64::NEG_INFINITY);
    assert!(measured.moves[1].late().unwrap().abs() < 1e-3 && measured.offset.unwrap().seconds.abs() < 1e-3);
    assert_eq!(beyond(&measured), NONE);
    let unseen = not_shown(&path, &begun, 1.0, true, [None, Some(0.08)]);
    let told = unseen.open.unwrap();
    assert!(told.starts_with("the log begins at t = 1.310 s, behind p0→p1: it arrived at most 31"), "{told}");
    assert_eq!(unseen.late_proven, None);
    assert_eq!(not_shown(&path, &begun, 1.0, true, [None, Some(0.4)]).open, None);
}

/// A quarter of a turn about the origin at 0.5 m in ten pieces, whose chords are 1.5 mm inside.
fn curved() -> PlannedPath {
    let angle = |i: f64| std::f64::consts::FRAC_PI_2 * i / 10.0;
    let place = |i: f64| Point3::new(0.5 * angle(i).cos(), 0.5 * angle(i).sin(), 0.2);
    let rate = |i: f64| Vector3::new(-angle(i).sin(), angle(i).cos(), 0.0) * (0.5 * angle(1.0));
    let poses = (0..=10).map(|i| pose(&place(f64::from(i)), 0.0)).collect();
    let ways = (0..10).map(f64::from);
    let ways = ways.map(|i| Some(Cubic::between(&place(i), &place(i + 1.0), [rate(i), rate(i + 1.0)]))).collect();
    let track = Track::new((0..=10).map(f64::from).collect(), poses, Vec::new()).unwrap().along(ways);
    PlannedPath::new(track, vec![PlannedMove { name: "p0→p1".into(), end: 10, stops: true }])
}

/// Where a path bends between its poses, deviation is from the bend: of samples on it none, and of one that is inside
/// by what chords are inside, that.
#[test]
fn deviation_is_from_curves_and_not_from_chords() {
    let path = curved();
    let at = |t: f64, inside: f64| {
        let angle = std::f64::consts::FRAC_PI_2 * t / 10.0;
        pose(&Point3::new((0.5 - inside) * angle.cos(), (0.5 - inside) * angle.sin(), 0.2), 0.0)
    };
    let times: Vec<f64> = (0..=200).map(|i| 0.05 * f64::from(i)).collect();
    for inside in [0.0, 8e-4] {
        let poses = times.iter().map(|t| at(*t, if (*t - 4.5).abs() < 0.01 { inside } else { 0.0 })).collect();
        let recording = Track::new(times.clone(), poses, Vec::new()).unwrap();
        let measured = measure(&path, &recording);
        let worst = measured.moves[0].deviation.unwrap();
        assert!((worst - inside).abs() < 1e-6, "{inside}: {worst}");
        let waypoints = [recording.position(0), recording.position(200)];
        let settings = crate::judgement::Settings {
            reference: crate::judgement::Reference::Path(path.track()),
            ..crate::judgement::Settings::default()
        };
        let worst = crate::judgement::measure(&recording, &waypoints, &settings).unwrap().max_deviation;
        assert!((worst - inside).abs() < 1e-6, "{inside}: {worst}");
    }
}
