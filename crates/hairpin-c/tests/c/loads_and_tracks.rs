//! The heaviest paths and judged tracks: what the library answers, and what can be said beforehand.

use std::ffi::c_void;
use std::mem::MaybeUninit;
use std::ptr::null_mut;
use std::sync::atomic::{AtomicUsize, Ordering};

use hairpin_c::judge::hairpin_judge;
use hairpin_c::max_load::{
    HAIRPIN_BELOW_MIN_COST, HAIRPIN_FOUND, HAIRPIN_NO_ARC, HAIRPIN_NO_PATH, LoadPath, MaxLoad, MaxLoadSettings,
    hairpin_max_load, hairpin_max_load_defaults,
};
use hairpin_c::measures::{
    HAIRPIN_UNMEASURED_DEVIATION, HAIRPIN_UNMEASURED_LATE, HAIRPIN_UNMEASURED_WAYPOINTS, TrackLeg, TrackMeasures,
    TrackViolation,
};
use hairpin_c::refusal::HAIRPIN_OK;
use hairpin_c::track::{JudgeSettings, Sample, hairpin_judge_defaults};

use crate::called::name;

/// Paths with their costs, and what else is said.
fn load(costs: &[i64], points: usize, settings: &MaxLoadSettings) -> (MaxLoad, Vec<(i64, Vec<usize>)>) {
    let mut paths: [MaybeUninit<LoadPath>; 4] = [const { MaybeUninit::uninit() }; 4];
    let (mut order, mut answer) = ([usize::MAX; 64], MaybeUninit::<MaxLoad>::uninit());
    // SAFETY: every pointer leads to what its type says, with as much room; what is read was written.
    unsafe {
        let (place, from) = (paths.as_mut_ptr().cast(), order.as_mut_ptr());
        let all = (costs.as_ptr(), points);
        let code = hairpin_max_load(all.0, all.1, settings, place, 4, from, 64, answer.as_mut_ptr(), null_mut());
        assert_eq!(code, HAIRPIN_OK);
        let answer = answer.assume_init();
        let path = |path: &MaybeUninit<LoadPath>| {
            let LoadPath { cost, first, count } = path.assume_init_ref();
            (*cost, order[*first..first + count].to_vec())
        };
        let paths = paths[..answer.paths].iter().map(path).collect();
        (answer, paths)
    }
}

#[test]
fn the_heaviest_paths_are_found_and_proven() {
    let usual = hairpin_max_load_defaults();
    // 0 to 2 and on to 1: 9 + 8, as every other order costs less.
    let costs = [-1, 2, 9, 2, -1, 3, 4, 8, -1];
    let (answer, paths) = load(&costs, 3, &usual);
    assert_eq!((answer.status, answer.proven, answer.bound, answer.points), (HAIRPIN_FOUND, 1, 17, 3));
    assert_eq!(paths, [(17, vec![0, 2, 1])]);
    let (_, paths) = load(&costs, 3, &MaxLoadSettings { paths: 3, ..usual });
    assert_eq!(paths.iter().map(|(cost, _)| *cost).collect::<Vec<_>>(), [17, 11, 10]);
    let (answer, _) = load(&costs, 3, &MaxLoadSettings { min_cost: 18, ..usual });
    assert_eq!((answer.status, answer.paths), (HAIRPIN_BELOW_MIN_COST, 0));
    // There and back again.
    let (answer, paths) = load(&[-1, 3, 2, -1], 2, &MaxLoadSettings { visits: 2, threads: 1, ..usual });
    assert_eq!((answer.proven, paths), (1, vec![(5, vec![0, 1, 0])]));
    let none = [HAIRPIN_NO_ARC; 4];
    let (answer, _) = load(&none, 2, &MaxLoadSettings { start: 0, end: 1, ..usual });
    assert_eq!((answer.status, answer.bound), (HAIRPIN_NO_PATH, HAIRPIN_NO_ARC));
}

#[test]
fn a_search_stops_when_it_is_told_to() {
    unsafe extern "C" fn stop(context: *mut c_void) -> i32 {
        // SAFETY: it is the counter below.
        unsafe { &*context.cast::<AtomicUsize>() }.fetch_add(1, Ordering::Relaxed);
        1
    }
    let mut asked = AtomicUsize::new(0);
    let points = 40;
    let cost = |i: usize| {
        ((i as i64 * 7919 + 13) % 1000) * i64::from(i / points != i % points) - i64::from(i / points == i % points)
    };
    let costs: Vec<i64> = (0..points * points).map(cost).collect();
    let context = (&raw mut asked).cast();
    let settings = MaxLoadSettings { stop: Some(stop), stop_context: context, ..hairpin_max_load_defaults() };
    let (answer, paths) = load(&costs, points, &settings);
    assert!(answer.proven == 0 && asked.load(Ordering::Relaxed) > 0 && paths[0].0 <= answer.bound, "{}", answer.bound);
}

/// As examples/04_judge_a_track: along both legs at 1 m/s, carried 0.8 m beyond the corner and back.
fn track() -> Vec<Sample> {
    let place = |t: f64| match t {
        t if t <= 10.0 => [t, 0.0, 2.0],
        t if t <= 12.0 => [10.0 + 0.8 * ((t - 10.0) * std::f64::consts::FRAC_PI_2).sin(), t - 10.0, 2.0],
        t => [10.0, t - 10.0, 2.0],
    };
    let sample = |i: i32| {
        let t_s = f64::from(i) / 10.0;
        let attitude_wxyz = [0.25_f64.cos(), 0.25_f64.sin(), 0.0, 0.0];
        Sample { t_s, position_m: place(t_s), attitude_wxyz, velocity_m_s: [0.0; 3], leg: (t_s > 10.0).into() }
    };
    (0..=200).map(sample).collect()
}

struct Judged {
    measures: TrackMeasures,
    legs: Vec<TrackLeg>,
    off: Vec<f64>,
    violations: Vec<TrackViolation>,
}

fn judge(settings: &JudgeSettings) -> Judged {
    let (track, waypoints) = (track(), [0.0, 0.0, 2.0, 10.0, 0.0, 2.0, 10.0, 10.0, 2.0]);
    let (mut measures, mut legs) = (MaybeUninit::uninit(), Vec::with_capacity(2));
    let (mut off, mut found, mut violated) = (vec![0.0; track.len()], Vec::with_capacity(9), 0);
    // SAFETY: every pointer leads to what its type says, with as much room; what is read was written.
    unsafe {
        let code = hairpin_judge(
            waypoints.as_ptr(),
            3,
            track.as_ptr(),
            track.len(),
            settings,
            measures.as_mut_ptr(),
            legs.as_mut_ptr(),
            off.as_mut_ptr(),
            found.as_mut_ptr(),
            9,
            &mut violated,
            null_mut(),
        );
        assert_eq!(code, HAIRPIN_OK);
        legs.set_len(2);
        found.set_len(violated);
        Judged { measures: measures.assume_init(), legs, off, violations: found }
    }
}

#[test]
fn a_track_is_measured_and_held_to_its_limits() {
    unsafe extern "C" fn wall(_: *mut c_void, place: *const f64) -> f64 {
        // SAFETY: three numbers.
        12.0 - unsafe { *place }
    }
    let limits = JudgeSettings {
        told: 5,
        max_deviation_m: 0.9,
        max_overshoot_m: 0.5,
        min_clearance_m: 1.5,
        clearance: Some(wall),
        ..hairpin_judge_defaults()
    };
    let Judged { measures, legs, off, violations } = judge(&limits);
    assert!((measures.max_deviation_m - 0.8).abs() < 1e-12 && (measures.t_worst_s - 11.0).abs() < 1e-9);
    assert!(
        (measures.min_clearance_m - 1.2).abs() < 1e-12 && (measures.max_tilt_deg - 0.5_f64.to_degrees()).abs() < 1e-9
    );
    assert_eq!((measures.leg_worst, measures.legs_assigned, measures.total_time_s), (1, 0, 20.0));
    assert!(legs[0].max_deviation_m < 1e-12 && (legs[1].max_deviation_m - 0.8).abs() < 1e-12);
    assert!((off[110] - 0.8).abs() < 1e-12 && off[50] < 1e-12);
    let told: Vec<String> = violations.iter().map(|violation| name(&violation.what)).collect();
    // By their excess: 60 % of the overshoot's limit, 20 % of the clearance's; the deviation is within its own.
    assert_eq!(told, ["overshoot", "clearance"]);
    assert!((violations[1].value - 1.2).abs() < 1e-12 && violations[1].limit == 1.5);

    // A path is followed where it was meant to be; what was not told is not measured.
    let path: Vec<f64> = track().iter().flat_map(|sample| sample.position_m).collect();
    let flown = JudgeSettings { reference: 2, path_m: path.as_ptr(), path_points: 201, ..hairpin_judge_defaults() };
    let Judged { measures, violations, .. } = judge(&flown);
    assert!(measures.max_deviation_m < 1e-9 && measures.max_tilt_deg.is_nan() && measures.min_clearance_m.is_nan());
    assert!(violations.is_empty() && measures.legs_assigned == 1);

    let reached = [0.0, 10.0, f64::NAN];
    let late = JudgeSettings { ended: 1, reached_s: reached.as_ptr(), ..hairpin_judge_defaults() };
    let Judged { violations, .. } = judge(&late);
    let TrackViolation { value, limit, .. } = violations[0];
    assert_eq!((name(&violations[0].what).as_str(), value, limit), ("unfinished", 2.0, 3.0));

    // The corner was to be reached after 9.75 s, the end at no time.
    let (reached, planned) = ([0.0, 10.0, 20.0], [0.0, 9.75, f64::NAN]);
    let (reached_s, planned_s) = (reached.as_ptr(), planned.as_ptr());
    let late = JudgeSettings { reached_s, planned_s, max_late_s: 0.2, ..hairpin_judge_defaults() };
    let Judged { measures, legs, violations, .. } = judge(&late);
    assert_eq!((measures.latest_s, measures.t_latest_s, measures.leg_latest), (0.25, 10.0, 0));
    assert!(legs[0].lateness_s == 0.25 && legs[1].lateness_s.is_nan());
    let TrackViolation { value, limit, .. } = violations[0];
    assert_eq!((violations.len(), name(&violations[0].what).as_str(), value, limit), (1, "late", 0.25, 0.2));
}

#[test]
fn what_was_not_measured_is_within_no_limit() {
    unsafe extern "C" fn nowhere(_: *mut c_void, _: *const f64) -> f64 {
        f64::INFINITY
    }
    unsafe extern "C" fn inside(_: *mut c_void, place: *const f64) -> f64 {
        // SAFETY: three numbers.
        if unsafe { *place } > 9.5 { f64::NEG_INFINITY } else { 1.0 }
    }
    let usual = hairpin_judge_defaults();
    // All samples lie within the corners.
    let Judged { measures, violations, .. } =
        judge(&JudgeSettings { told: 4, corner_m: 20.0, max_deviation_m: 0.1, ..usual });
    assert!(violations.is_empty() && measures.max_deviation_m.is_nan());
    assert_eq!(measures.unmeasured, HAIRPIN_UNMEASURED_DEVIATION);
    // What was to be reached at a time was not.
    let (reached, planned) = ([0.0, f64::NAN, 20.0], [0.0, 9.75, f64::NAN]);
    let (reached_s, planned_s) = (reached.as_ptr(), planned.as_ptr());
    let late = JudgeSettings { reached_s, planned_s, max_late_s: 0.2, ..usual };
    let Judged { measures, violations, .. } = judge(&late);
    assert!(violations.is_empty());
    assert_eq!(measures.unmeasured, HAIRPIN_UNMEASURED_LATE | HAIRPIN_UNMEASURED_WAYPOINTS);
    // Nor is one of several kept by the others.
    let planned = [0.0, 9.75, 20.0];
    let Judged { measures, .. } = judge(&JudgeSettings { planned_s: planned.as_ptr(), ..late });
    assert_eq!((measures.latest_s, measures.unmeasured), (0.0, 12));
    let passed_by = JudgeSettings { reached_s, max_deviation_m: 5.0, ..usual };
    let Judged { measures, violations, .. } = judge(&passed_by);
    assert!(violations.is_empty() && measures.unmeasured == HAIRPIN_UNMEASURED_WAYPOINTS);
    // No obstacle is far enough away, and what is inside of one is not.
    let clear = JudgeSettings { min_clearance_m: 0.5, clearance: Some(nowhere), ..usual };
    let Judged { measures, violations, .. } = judge(&clear);
    assert!(violations.is_empty() && measures.unmeasured == 0 && measures.min_clearance_m == f64::INFINITY);
    let Judged { violations, .. } = judge(&JudgeSettings { clearance: Some(inside), ..clear });
    assert_eq!((name(&violations[0].what).as_str(), violations[0].value), ("clearance", f64::NEG_INFINITY));
}
